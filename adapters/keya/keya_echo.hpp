// SPDX-License-Identifier: Apache-2.0
// Whether a serial line brings our own frames back (an RS485 adapter that hears itself, a loop in the cable). A query's
// echo is byte for byte the answer whose data are all 0: "no fault, standing still".
// Promises that such a frame is called an answer only on a line that is known not to echo, and never for a query that
// no drive answers with zeros: a looped cable must not look like a healthy drive. Never looks at a clock.
#pragma once

#include <utility>

#include "adapters/keya/keya_serial_codec.hpp"

namespace axisgate::keya {

/// The drive's interface, its supply voltage and its version's date are never 0.
[[nodiscard]] constexpr bool is_never_zero(std::uint8_t code) {
  const auto query = static_cast<Query>(code);
  return query == Query::control_state || query == Query::voltage || query == Query::version;
}

class EchoWatch {
 public:
  /// Answers in a row, without an echo before them or noise around them, after which a line that echoed is believed not
  /// to any more.
  static constexpr int kAnswersWithoutEcho = 3;

  void on_sent(const FrameBytes& bytes) {
    sent_ = bytes;
    due_ = true;
  }
  /// A whole frame came. `may_be_drives`: a drive could have sent it, too.
  [[nodiscard]] bool is_echo(const FrameBytes& bytes, bool may_be_drives) {
    if (!due_ || bytes != sent_ || (may_be_drives && belief_ == Belief::silent)) return false;
    due_ = false;
    if (!may_be_drives) believe_in_echo();
    return true;
  }
  /// The answer awaited came; `clean`: and nothing else since the request.
  void on_answer(bool clean) {
    const bool came_without = std::exchange(due_, false);
    if (!came_without) {
      believe_in_echo();
    } else if (clean && (++without_echo_ >= kAnswersWithoutEcho || belief_ == Belief::unknown)) {
      belief_ = Belief::silent;
    }
  }
  [[nodiscard]] const FrameBytes& sent() const { return sent_; }
  void reset() { *this = EchoWatch{}; }

 private:
  enum class Belief : std::uint8_t { unknown, silent, echoes };
  void believe_in_echo() {
    belief_ = Belief::echoes;
    without_echo_ = 0;
  }

  FrameBytes sent_{};
  bool due_ = false;  ///< the echo of what was sent last has not come
  Belief belief_ = Belief::unknown;
  int without_echo_ = 0;
};

}  // namespace axisgate::keya
