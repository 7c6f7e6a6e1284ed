// SPDX-License-Identifier: Apache-2.0
// The bytes 0x00 or 0xFF that a transceiver makes when it turns the line round, before an answer or glued to it.
// Promises that kMost of them are skipped before each frame, and no more: a line that is held low is noise, not a
// glitch. Never skips a byte that could begin a frame: who asks has seen to that.
#pragma once

#include <cstddef>

#include "gateway/core/bytes.hpp"

namespace axisgate::bus {

class GlitchSkip {
 public:
  static constexpr std::size_t kMost = 8;

  /// A request goes out, or a whole frame has come: what comes next may begin with a glitch.
  void renew() { left_ = kMost; }
  /// `byte` stands where a frame would begin.
  [[nodiscard]] bool skips(Byte byte) {
    if (left_ == 0 || (byte != 0x00 && byte != 0xFF)) return false;
    --left_;
    return true;
  }

 private:
  std::size_t left_ = kMost;
};

}  // namespace axisgate::bus
