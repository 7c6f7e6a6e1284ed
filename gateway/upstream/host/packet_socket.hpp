// SPDX-License-Identifier: Apache-2.0
// The gateway's end of the socket pair to a program: packets in, packets out, none of them ever waited for.
// Promises that one call sends or takes one packet whole, or none.
// Never knows what is in a packet, and keeps none.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "gateway/core/bytes.hpp"

namespace axisgate::host {

class PacketSocket {
 public:
  /// Takes the descriptor over.
  PacketSocket(boost::asio::io_context& context, int descriptor);
  PacketSocket(const PacketSocket&) = delete;
  PacketSocket& operator=(const PacketSocket&) = delete;

  enum class Sent : std::uint8_t { yes, no_room, closed };
  [[nodiscard]] Sent send(Bytes packet);

  /// What was sent and not taken yet, as the system counts it (with what it needs for it itself).
  [[nodiscard]] std::size_t unread() const;

  enum class Got : std::uint8_t { packet, nothing, too_long, closed };
  struct Received {
    Got what = Got::nothing;
    Bytes packet{};  ///< good until the next receive()
  };
  [[nodiscard]] Received receive();

  /// Once each; not after the socket is destroyed. One wait of a kind at a time.
  void when_readable(std::function<void()> call) { wait(Wait::wait_read, std::move(call)); }
  void when_writable(std::function<void()> call) { wait(Wait::wait_write, std::move(call)); }

 private:
  using Wait = boost::asio::posix::stream_descriptor;
  void wait(Wait::wait_type what, std::function<void()> call);

  mutable boost::asio::posix::stream_descriptor descriptor_;
  std::vector<Byte> buffer_;
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace axisgate::host
