// SPDX-License-Identifier: Apache-2.0
// A program's end of the socket pair to the gateway: packets in, packets out.
// Promises that nothing blocks: what the gateway does not take waits here in its order, at most kMaxPacketsWaiting.
// Never loses what it has accepted, and never interprets a packet: RecordLink does, by the program's own records.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "gateway/upstream/link/coder.hpp"

namespace axisgate::program {

inline constexpr std::size_t kMaxPacketsWaiting = 4096;

enum class Received : std::uint8_t { packet, nothing, closed, garbage };

class LinkSocket {
 public:
  /// Takes the descriptor over. Throws StartError where it is no SOCK_SEQPACKET socket; `hint`: what else one may have
  /// wanted of this program.
  LinkSocket(int fd, const std::string& hint);
  ~LinkSocket();
  LinkSocket(const LinkSocket&) = delete;
  LinkSocket& operator=(const LinkSocket&) = delete;

  struct Packet {
    Received what = Received::nothing;
    Bytes bytes{};          ///< good until the next receive()
    std::string problem{};  ///< of garbage
  };
  [[nodiscard]] Packet receive();

  /// False where kMaxPacketsWaiting packets wait already: the packet was not taken.
  bool send(std::vector<Byte> packet);
  /// Sends what waits. False: the gateway is gone.
  bool flush();
  /// Nothing waits: what is sent now goes out at once.
  [[nodiscard]] bool idle() const { return waiting_.empty(); }
  [[nodiscard]] int fd() const { return fd_; }

 private:
  int fd_;
  bool gone_ = false;
  std::vector<Byte> buffer_;
  std::deque<std::vector<Byte>> waiting_;
};

}  // namespace axisgate::program
