// SPDX-License-Identifier: Apache-2.0
// What tests of one part of the drive layer alone share: an instant to begin at, and reads.
// Never decides what is right: the tests do.
#pragma once

#include "adapters/bus/exchange.hpp"

namespace axisgate::drive {

inline constexpr Instant kStart = Instant{} + std::chrono::hours(1);

[[nodiscard]] inline bus::Exchange reading(std::uint16_t index, std::uint8_t size = 2) {
  return {1, bus::Access::read, {index, 0}, size, 0};
}

}  // namespace axisgate::drive
