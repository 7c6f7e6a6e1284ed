// SPDX-License-Identifier: Apache-2.0
// What another master on the CAN bus says to the drive of axis 1, as the drive's sheet has it: communication begun
// anew, torque on and off, a speed, a start. Promises nothing where no CAN bus is. Never looks at the gateway.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/judged/program.hpp"

namespace axisgate::test::judged {

struct ForeignFrame {
  std::uint32_t id = 0;
  std::vector<std::uint8_t> bytes{};
};

[[nodiscard]] std::vector<ForeignFrame> foreign_frames(Subject subject, const Step& step);
[[nodiscard]] std::string text(const std::vector<ForeignFrame>& frames);

}  // namespace axisgate::test::judged
