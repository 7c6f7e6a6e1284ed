// SPDX-License-Identifier: Apache-2.0
// The keys with which a person jogs an axis, from the bytes that a terminal sends for them.
// Promises that a key which arrives in pieces is one key, and that what is no button lets go of every button. Pure.
// Never takes a part of one key for another.
#pragma once

#include <cstdint>
#include <vector>

#include "gateway/core/bytes.hpp"

namespace axisgate::commands {

enum class ManualKey : std::uint8_t {
  forward,  ///< right or up, '+'
  reverse,  ///< left or down, '-'
  quit,     ///< 'q', Ctrl-D
  other,
};

class ManualKeys {
 public:
  [[nodiscard]] std::vector<ManualKey> take(Bytes bytes) {
    std::vector<ManualKey> out;
    for (const Byte byte : bytes) take(byte, out);
    return out;
  }

 private:
  enum class State : std::uint8_t { plain, escape, sequence };
  static constexpr Byte kEscape = 0x1B, kEndOfInput = 0x04, kFirstFinal = 0x40, kLastFinal = 0x7E;

  void take(Byte byte, std::vector<ManualKey>& out) {
    if (byte == kEscape) {
      state_ = State::escape;  // an escape key alone is recognised by what follows it: until then it is no button
      parameters_ = false;
    } else if (state_ == State::escape) {
      state_ = byte == '[' || byte == 'O' ? State::sequence : State::plain;
      if (state_ == State::plain) out.push_back(ManualKey::other);
    } else if (state_ == State::sequence) {
      if (byte < kFirstFinal || byte > kLastFinal) {
        parameters_ = true;  // ESC [ 1 ; 5 C: with Ctrl, which is no button
        return;
      }
      state_ = State::plain;
      out.push_back(parameters_ ? ManualKey::other : arrow(byte));
    } else {
      out.push_back(plain(byte));
    }
  }
  static ManualKey arrow(Byte byte) {
    if (byte == 'A' || byte == 'C') return ManualKey::forward;
    return byte == 'B' || byte == 'D' ? ManualKey::reverse : ManualKey::other;
  }
  static ManualKey plain(Byte byte) {
    if (byte == '+') return ManualKey::forward;
    if (byte == '-') return ManualKey::reverse;
    return byte == 'q' || byte == kEndOfInput ? ManualKey::quit : ManualKey::other;
  }

  State state_ = State::plain;
  bool parameters_ = false;
};

}  // namespace axisgate::commands
