// SPDX-License-Identifier: Apache-2.0
// The image of one axis as a sample of axis_state.
// Promises that it says what the registers say at the same moment, by the rules of gateway/image/shown.hpp, and NaN
// where they show no value. Never changes the image and never mixes two moments.
#pragma once

#include "gateway/image/axis_image.hpp"
#include "gateway/upstream/dds/dds_units.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

[[nodiscard]] StateRecord state_record(const AxisImage& axis, const DdsUnits& units);

}  // namespace axisgate::dds
