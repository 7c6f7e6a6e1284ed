// SPDX-License-Identifier: Apache-2.0
// The Kinco MD's objects that RS232 can reach, as tables from kinco-md.md section 6.
// Promises every row of groups A to O with its width, access, default and range.
// Never lists 2F80.01, which the sheet believes to be a misprint of 100B.00 (MD C1), nor the JD's 6061, 6079 and
// 60F7:0B.
#pragma once

#include <span>

#include "tests/simulated/object_entry.hpp"

namespace axisgate::simulated {

std::span<const ObjectEntry> md_motion_objects();
std::span<const ObjectEntry> md_setup_objects();

}  // namespace axisgate::simulated
