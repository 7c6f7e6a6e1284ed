// SPDX-License-Identifier: Apache-2.0
// The Kinco JD's objects that RS232 can reach, as tables from kinco-jd.md section 4.
// Promises every row of 4.1 to 4.14 with its width, access, default and range.
// Never lists the CANopen communication areas of 4.15: the sheet prints no sub-indexes for them.
#pragma once

#include <span>

#include "tests/simulated/object_entry.hpp"

namespace axisgate::simulated {

std::span<const ObjectEntry> jd_motion_objects();
std::span<const ObjectEntry> jd_setup_objects();

}  // namespace axisgate::simulated
