// SPDX-License-Identifier: Apache-2.0
// axisgate-dds's end of the socket pair to the gateway: records in, records out, one a packet.
// Promises that nothing blocks: what the gateway does not take waits here in its order, at most kMaxPacketsWaiting.
// Never loses what it has accepted, and never interprets a record.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

inline constexpr std::size_t kMaxPacketsWaiting = 4096;

class LinkSocket {
 public:
  /// Takes the descriptor over. Throws StartError where it is no SOCK_SEQPACKET socket.
  explicit LinkSocket(int fd);
  ~LinkSocket();
  LinkSocket(const LinkSocket&) = delete;
  LinkSocket& operator=(const LinkSocket&) = delete;

  enum class Received : std::uint8_t { record, nothing, closed, garbage };
  struct Packet {
    Received what = Received::nothing;
    Record record{};
    std::string problem{};  ///< of garbage
  };
  [[nodiscard]] Packet receive();

  /// False where kMaxPacketsWaiting packets wait already: the record was not taken.
  bool send(const Record& record);
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

}  // namespace axisgate::dds
