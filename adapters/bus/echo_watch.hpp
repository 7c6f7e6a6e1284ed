// SPDX-License-Identifier: Apache-2.0
// Whether a serial line brings our own frames back: an adapter that hears itself, a chain that passes them on, a loop
// in the cable. What is the same as a request may then be its echo, where the protocol has such an answer too. Promises
// that only reads teach it, three in a row that came back; that while it is not known the copy of a write is neither
// echo nor answer; that a line that brought one read back is not known to be without echo any more. Never looks into a
// byte nor at a clock: the wire says what was a copy.
#pragma once

#include <cstdint>

namespace axisgate::bus {

class EchoWatch {
 public:
  /// Reads in a row that came back, after which the line is known to echo.
  static constexpr int kReadsThatCameBack = 3;
  /// Answers in a row without a copy before them, after which a line that echoed is known not to any more; where no
  /// read has come back, one is enough.
  static constexpr int kAnswersWithoutCopy = 3;
  /// Reads in a row that came back and were not answered, after which nothing but copies is said to come.
  static constexpr int kCopiesAlone = 3;

  enum class Belief : std::uint8_t { unknown, silent, echoes };
  /// What a copy of the request is.
  enum class Copy : std::uint8_t {
    echo,       ///< ours: to be dropped
    undecided,  ///< neither: the next read decides
    answer,
  };

  /// A request goes out.
  void on_sent(bool is_read);
  /// A frame came that is the same as the request sent last. `may_be_answer`: a drive could have sent it, too.
  [[nodiscard]] Copy on_copy(bool may_be_answer);
  /// The answer to it came. `clean`: and nothing else that could have been its copy, or an answer owed from before.
  void on_answer(bool clean);
  /// Something came that is neither, noise included.
  void on_other() { copies_alone_ = 0; }
  /// The line is a new one.
  void reset() { *this = EchoWatch{}; }

  [[nodiscard]] Belief belief() const { return belief_; }
  /// Nothing but copies comes, since the last answer.
  [[nodiscard]] bool only_copies() const { return copies_alone_ >= kCopiesAlone; }

 private:
  void read_came_back();

  Belief belief_ = Belief::unknown;
  bool is_read_ = false;
  bool echoed_ = false;   ///< a read came back since it was known to be without echo
  bool copied_ = true;    ///< what was sent last has come back
  bool counted_ = true;   ///< and was counted as a read that did
  bool answered_ = true;  ///< what was sent last
  int came_back_ = 0;     ///< reads in a row
  int without_copy_ = 0;  ///< answers in a row
  int unclean_ = 0;       ///< of those without a copy that may be late ones, in a row
  int copies_alone_ = 0;
};

}  // namespace axisgate::bus
