// SPDX-License-Identifier: Apache-2.0
#include "adapters/bus/echo_watch.hpp"

#include <algorithm>

namespace axisgate::bus {

void EchoWatch::on_sent(bool is_read) {
  if (is_read_ && !answered_) {
    if (copied_) {
      copies_alone_ = std::min(copies_alone_ + 1, kCopiesAlone);
    } else {
      came_back_ = 0;
    }
  }
  is_read_ = is_read;
  copied_ = counted_ = answered_ = false;
}

EchoWatch::Copy EchoWatch::on_copy(bool may_be_answer) {
  if (may_be_answer && belief_ == Belief::silent) return Copy::answer;
  const bool first = !copied_;
  copied_ = true;
  if (!may_be_answer) {
    if (first && is_read_) read_came_back();
    return Copy::echo;
  }
  if (belief_ == Belief::echoes) return first ? Copy::echo : Copy::answer;
  return first || !is_read_ ? Copy::undecided : Copy::answer;
}

void EchoWatch::on_answer(bool clean) {
  answered_ = true;
  copies_alone_ = 0;
  if (!is_read_) return;
  if (copied_) {
    read_came_back();
    return;
  }
  // One that may be late says little, several say the same: a line with an echo would have brought a copy by then.
  if (!clean && ++unclean_ < kAnswersWithoutCopy) return;
  unclean_ = 0;
  came_back_ = 0;
  if (++without_copy_ < (echoed_ ? kAnswersWithoutCopy : 1)) return;
  belief_ = Belief::silent;
  echoed_ = false;
  without_copy_ = 0;
}

void EchoWatch::read_came_back() {
  if (counted_) return;
  counted_ = echoed_ = true;
  without_copy_ = unclean_ = 0;
  if (++came_back_ >= kReadsThatCameBack) {
    came_back_ = kReadsThatCameBack;
    belief_ = Belief::echoes;
  } else if (belief_ == Belief::silent) {
    belief_ = Belief::unknown;
  }
}

}  // namespace axisgate::bus
