// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/capture/trigger.hpp"

#include <utility>

namespace axisgate::web {

bool TriggerWatch::holds(std::int64_t number, double shown) const {
  const bool set = (static_cast<std::uint64_t>(number) >> trigger_.bit & 1U) != 0;
  switch (trigger_.is) {
    case TriggerIs::above:
      return shown > trigger_.max;
    case TriggerIs::below:
      return shown < trigger_.min;
    case TriggerIs::outside:
      return shown < trigger_.min || shown > trigger_.max;
    case TriggerIs::bit_set:
      return set;
    case TriggerIs::bit_clear:
      return !set;
    case TriggerIs::changes:
      break;
  }
  return last_ && number != *last_;
}

bool TriggerWatch::sees(std::int64_t number, double shown) {
  const bool now = holds(number, shown);
  last_ = number;
  return trigger_.is == TriggerIs::changes ? now : edge_.rises(now);
}

}  // namespace axisgate::web
