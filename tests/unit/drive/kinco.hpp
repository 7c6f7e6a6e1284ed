// SPDX-License-Identifier: Apache-2.0
// A Kinco JD on CANopen, as its profile has it, for tests of one part of the drive layer alone.
// Promises the shipped profile with axis 1 and nothing configured. Never stages a drive.
#pragma once

#include <variant>

#include "gateway/profile/resolve/profile_resolve.hpp"
#include "tests/places.hpp"

namespace axisgate::drive {

[[nodiscard]] inline model::DriveModel kinco_jd() {
  profile::ResolveInput input;
  input.protocol = "canopen";
  profile::ResolveAxis axis;
  axis.number = 1;
  input.axes = {axis};
  return std::get<model::DriveModel>(
      profile::resolve(profile::load_profile(test::source_path("schemas/drives/kinco-jd.json")), input));
}

}  // namespace axisgate::drive
