// SPDX-License-Identifier: Apache-2.0
// What stands against a motion of an axis, in the order in which a person clears it: out of reach, fault, alarms that
// refuse an enable, a latched stop, another's lease, no reference, no torque. Promises words of the one table, each
// with what helps; nothing: a start would be accepted. Never claims that of an axis of which nothing is known.
#pragma once

#include <string>
#include <vector>

#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

struct Block {
  std::string word;
  std::string text;
  std::string remedy;
  friend bool operator==(const Block&, const Block&) = default;
};

[[nodiscard]] std::vector<Block> blocked_by(const Picture& picture, const AxisPicture& axis, SteadyNs now);

}  // namespace axisgate::web
