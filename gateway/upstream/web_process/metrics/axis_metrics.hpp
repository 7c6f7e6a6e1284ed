// SPDX-License-Identifier: Apache-2.0
// Samples of axes. Promises that a value which is not valid has none, that of the states of an axis one alone is 1, and
// units that are the name's. Never looks whether the gateway is joined: whoever calls it does.
#pragma once

#include "gateway/upstream/web_process/metrics/families.hpp"
#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

void add_axis(Families& to, const Picture& picture, std::uint16_t number, const AxisPicture& axis, SteadyNs now);

}  // namespace axisgate::web
