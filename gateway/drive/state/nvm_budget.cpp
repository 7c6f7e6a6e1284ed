// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/state/nvm_budget.hpp"

#include <algorithm>

namespace axisgate::drive {

bool NvmBudget::take(model::Nvm nvm, Instant now) {
  if (nvm == model::Nvm::no) return true;
  if (nvm == model::Nvm::unknown) {
    ++unknown_;
    return true;
  }
  const Instant whole_at = std::max(whole_at_, now) + kOneMore;
  refused_ = whole_at - now > kAtOnce * kOneMore;
  if (refused_) return false;
  whole_at_ = whole_at;
  ++stored_;
  return true;
}

bool NvmBudget::alarm(Instant now) const {
  return (refused_ && whole_at_ + kOneMore - now > kAtOnce * kOneMore) || unknown_ >= kManyUnknown;
}

}  // namespace axisgate::drive
