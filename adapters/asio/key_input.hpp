// SPDX-License-Identifier: Apache-2.0
// What comes from a descriptor that the shell shares with us, as it comes, and the end of it: a terminal that was
// closed, a pipe nobody writes to. Promises that the loop never waits for it, and that its end is reported once. Never
// changes the descriptor: O_NONBLOCK would be set for the shell as well.
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <functional>

#include "gateway/core/bytes.hpp"

namespace axisgate {

class KeyInput {
 public:
  enum class Wants : std::uint8_t {
    bytes,
    end_alone,  ///< what is typed stays for whoever reads next
  };
  using OnBytes = std::function<void(Bytes)>;

  /// `descriptor` is not closed; a file or /dev/null, which never make anybody wait, tells nothing. Neither callback
  /// comes from inside a call, nor once this is gone.
  KeyInput(boost::asio::io_context& context, int descriptor, Wants wants, OnBytes on_bytes,
           std::function<void()> on_end);

 private:
  void wait();
  void look();

  int descriptor_;
  OnBytes on_bytes_;
  std::function<void()> on_end_;
  /// An epoll that watches the descriptor: Asio waits for this one, and makes this one non-blocking.
  boost::asio::posix::stream_descriptor watch_;
  std::array<Byte, 256> typed_{};
};

}  // namespace axisgate
