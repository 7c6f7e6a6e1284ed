// SPDX-License-Identifier: Apache-2.0
// Which Modbus registers reach which objects of a Kinco JD or MD (JD 3 and 4, MD 3.3 and 6).
// Promises register = base(index) + sub * 0x10, for the indexes whose base is printed and for no other.
// Never guesses a base from a gap in the sequence, and never lists the second register of a 32-bit object.
#pragma once

#include <map>

#include "tests/simulated/kinco_model.hpp"

namespace axisgate::simulated {

struct KincoRegister {
  ObjectKey object;
  bool derived = false;  // not printed: it follows from the rule, and a drive may not serve it
};

using KincoRegisters = std::map<std::uint16_t, KincoRegister>;

KincoRegisters kinco_registers(const KincoModel& model);

}  // namespace axisgate::simulated
