// SPDX-License-Identifier: Apache-2.0
// AxisCommand.mask: which members of a sample are to be used (schemas/axisgate.idl, HAS_...).
// Promises the IDL's own numbers: axisgate-dds, which knows both, does not compile where one differs.
// Never says what a member means.
#pragma once

#include <cstdint>

namespace axisgate::dds {

enum Has : std::uint32_t {
  kHasMode = 1,
  kHasTargetPosition = 2,
  kHasTargetVelocity = 4,
  kHasTargetTorque = 8,
  kHasMaxTorque = 16,
  kHasProfileVelocity = 32,
  kHasProfileAcceleration = 64,
  kHasProfileDeceleration = 128,
  kHasJogVelocity = 256,
  kHasHomingMethod = 512,
  kHasSetPositionValue = 1024,
};
inline constexpr std::uint32_t kHasAny = 2047;

}  // namespace axisgate::dds
