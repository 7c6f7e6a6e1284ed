// SPDX-License-Identifier: Apache-2.0
// The button of a jog that a key holds: pressed and kept pressed as the key repeats, released when it does not. Pure.
// Promises that nothing but a key presses it, that kKeyLapse without one lets it go, and that one press at a time is on
// its way: what waited in a slow network would be pressed late. Never goes from one direction to the other at once.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "gateway/commands/manual/plan/manual_keys.hpp"
#include "gateway/core/clock.hpp"

namespace axisgate::commands {

class JogButton {
 public:
  /// A button is held only while its key repeats at least so often.
  static constexpr Duration kKeyLapse = std::chrono::milliseconds(300);

  enum class Which : std::uint8_t { none, forward, reverse };
  /// What is to be written of it. Each is answered once.
  struct Write {
    Which which = Which::none;
    bool on = false;
  };

  [[nodiscard]] Which held() const { return held_; }
  [[nodiscard]] Instant due() const { return held_ == Which::none ? kNever : last_key_ + kKeyLapse; }

  /// Whatever is no button lets go; of two directions the other's next key is the press.
  [[nodiscard]] std::optional<Write> on_key(ManualKey key, Instant now) {
    if (key != ManualKey::forward && key != ManualKey::reverse) return release();
    if (now < keys_count_from_) return std::nullopt;
    const Which wanted = key == ManualKey::forward ? Which::forward : Which::reverse;
    if (held_ != Which::none && held_ != wanted) return release();
    std::optional<Write> out;
    if (waiting_ == 0) out = sent({held_ = wanted, true});
    if (held_ == wanted) last_key_ = now;
    return out;
  }
  [[nodiscard]] std::optional<Write> on_time(Instant now) { return now >= due() ? release() : std::nullopt; }
  [[nodiscard]] std::optional<Write> release() {
    if (held_ == Which::none) return std::nullopt;
    return sent({std::exchange(held_, Which::none), false});
  }
  /// Written 0 before its first press: a button acts on 1 once it was 0.
  [[nodiscard]] Write up(Which which) { return sent({which, false}); }
  void on_answer() { waiting_ = std::max(0, waiting_ - 1); }
  /// Keys before then may have been typed while nobody looked.
  void ignore_keys_until(Instant then) { keys_count_from_ = then; }

 private:
  Write sent(Write write) {
    ++waiting_;
    return write;
  }

  Which held_ = Which::none;
  int waiting_ = 0;  ///< writes of it that are not answered
  Instant last_key_ = kLongAgo;
  Instant keys_count_from_ = kLongAgo;
};

}  // namespace axisgate::commands
