// SPDX-License-Identifier: Apache-2.0
// A link that carries bytes: a serial port in the product, a simulated line in tests and simulation.
// Promises to report up and down in turn, bytes in order, and to reopen by itself until it is destroyed.
// Never interprets a byte.
#pragma once

#include <boost/noncopyable.hpp>
#include <string_view>

#include "gateway/core/bytes.hpp"

namespace axisgate::bus {

class ByteLinkEvents : boost::noncopyable {
 public:
  virtual ~ByteLinkEvents() = default;
  virtual void on_link_up() = 0;
  virtual void on_link_down(std::string_view why) = 0;
  virtual void on_bytes(Bytes bytes) = 0;
};

class ByteLink : boost::noncopyable {
 public:
  virtual ~ByteLink() = default;
  /// `events` must outlive the link.
  virtual void start(ByteLinkEvents& events) = 0;
  /// Only while up. The bytes are copied; a short write is finished by the link, a failed one is reported as down
  /// later.
  virtual void send(Bytes bytes) = 0;
  /// Closes and opens again, for a line that babbles. While up: reports down with `why`, then up when
  /// it is open again; either may come from inside this call or later. While down: tries again at once.
  virtual void reopen(std::string_view why) = 0;
};

}  // namespace axisgate::bus
