// SPDX-License-Identifier: Apache-2.0
// Finds frames in the bytes of a Modbus RTU line: by the length that their function byte tells, as libmodbus does it,
// but for what libmodbus cannot tell from a frame: glitch bytes before one, and the copy of our own request, whose
// third byte would be read as the length of an answer. Promises that such a copy is returned whole, as any other frame,
// and that a frame that may still become one is waited for. Never judges a CRC or what a frame means, and holds no more
// than kHolds bytes.
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "adapters/bus/glitch_skip.hpp"
#include "adapters/modbus_rtu/rtu_link.hpp"

namespace axisgate::modbus_rtu {

class FrameFinder {
 public:
  static constexpr std::size_t kHolds = 512;

  struct Found {
    enum class Kind : std::uint8_t {
      nothing,  ///< more is needed
      frame,    ///< by its length, CRC included and not looked at
      copy,     ///< of the request, byte for byte
      glitch,   ///< bytes before a frame that cannot begin it
      noise,    ///< all that is held, and what comes until the line is silent
    };
    Kind kind = Kind::nothing;
    Bytes bytes{};  ///< until the next call
  };

  /// A request goes out, with its CRC. What has come of a frame by now is to be dropped before.
  void sent(Bytes request);
  /// Room for so many bytes more; never 0 while nothing is found.
  [[nodiscard]] std::size_t room() const { return kHolds - (held_.size() - taken_); }
  void take(Bytes bytes);
  /// What the bytes held begin with. `patience_over`: the rest of a frame that has begun does not come.
  [[nodiscard]] Found next(bool patience_over);
  /// A frame has begun.
  [[nodiscard]] bool unfinished() const { return held_.size() > taken_; }
  /// Drops all that is held; how much that was.
  std::size_t drop();

 private:
  [[nodiscard]] Bytes held() const { return Bytes(held_.data(), held_.size()).subspan(taken_); }
  [[nodiscard]] Found give(Found::Kind kind, std::size_t bytes);

  boost::container::static_vector<Byte, kMaxFrame + 2> request_;  ///< the newest
  boost::container::static_vector<Byte, kHolds> held_;
  std::size_t taken_ = 0;  ///< bytes at the head that were returned
  bus::GlitchSkip glitch_;
};

}  // namespace axisgate::modbus_rtu
