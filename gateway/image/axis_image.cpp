// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/axis_image.hpp"

#include <cassert>
#include <string_view>

#include "gateway/core/words.hpp"
#include "gateway/image/shown.hpp"

namespace axisgate {

std::string_view text(AxisAlarm alarm) { return name_of(WordKind::axis_alarm, static_cast<std::uint32_t>(alarm)); }
std::string_view text(LinkState state) { return name_of(WordKind::link_state, static_cast<std::uint32_t>(state)); }
std::string_view text(AxisState state) { return name_of(WordKind::axis_state, static_cast<std::uint32_t>(state)); }

std::uint32_t AxisImage::valid_bits() const {
  if (!reachable()) return 0;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (samples[i].valid && samples[i].received) bits |= 1U << i;
  return bits & supported;
}

LogSource log_source(AxisNumber number, const std::string& name, const std::string& bus) {
  const std::string plain = "axis " + std::to_string(number);
  return {.words = name.empty() || name == plain ? plain : plain + " " + name, .axis = number, .bus = bus};
}

bool shows_the_same(const AxisImage& a, const AxisImage& b) { return view_of(a) == view_of(b); }

}  // namespace axisgate
