// SPDX-License-Identifier: Apache-2.0
// CiA 402 as tables: what a statusword says, what a controlword asks for.
// Promises that each word falls on exactly one row, as IEC 61800-7-201 (CiA 402-2) tables 27 to 30 print them.
// Never holds a state: the words are all it needs.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace axisgate::model {

/// The states of the power drive system, CiA 402-2 section 8.4.
enum class State402 : std::uint8_t {
  not_ready_to_switch_on,
  switch_on_disabled,
  ready_to_switch_on,
  switched_on,
  operation_enabled,
  quick_stop_active,
  fault_reaction_active,
  fault,
};
[[nodiscard]] State402 state_of(std::uint16_t statusword);
[[nodiscard]] std::string_view text(State402 state);

namespace statusword {
inline constexpr std::uint16_t kWarning = 1U << 7;
inline constexpr std::uint16_t kTargetReached = 1U << 10;
inline constexpr std::uint16_t kInternalLimit = 1U << 11;
inline constexpr std::uint16_t kSetpointAcknowledge = 1U << 12;
inline constexpr std::uint16_t kFollowingError = 1U << 13;
}  // namespace statusword

namespace controlword {
inline constexpr std::uint16_t kEnableVoltage = 1U << 1;
inline constexpr std::uint16_t kQuickStopOff = 1U << 2;  ///< 0 asks for a quick stop
inline constexpr std::uint16_t kStart = 1U << 4;         ///< new set-point (mode 1), homing start (mode 6)
inline constexpr std::uint16_t kRelative = 1U << 6;
inline constexpr std::uint16_t kFaultReset = 1U << 7;
inline constexpr std::uint16_t kHalt = 1U << 8;
inline constexpr std::uint16_t kMaker = 0xF800;  ///< bits 11 to 15 are left to the makers
}  // namespace controlword

/// What a drive that follows CiA 402 does where the standard leaves it to the makers, or otherwise.
struct Cia402Properties {
  bool setpoint_acknowledge = true;  ///< bit 12 of the statusword tells in mode 1 that a set-point was taken
  bool mode_display = true;          ///< false: the mode object itself is read back
  /// Bits of the controlword of which one may make the drive follow each write of its target (mode 1). What the makers'
  /// bits do is not known until a profile says it.
  std::uint16_t follow_bits = controlword::kMaker;
  /// Modes of its own (negative) in which it follows a target velocity at once, as in mode 3.
  std::vector<std::int16_t> velocity_modes{};
};

/// A bit of the mask is 1 that was 0.
[[nodiscard]] constexpr bool rising(std::uint16_t before, std::uint16_t now, std::uint16_t mask) {
  return (now & ~before & mask) != 0;
}

/// The motor has torque and obeys: enabled, or stood still by a quick stop that ends there.
[[nodiscard]] constexpr bool holds_motor(State402 state) {
  return state == State402::operation_enabled || state == State402::quick_stop_active;
}

/// What a raw controlword asks of the state machine (CiA 402-2 table 28).
enum class Request402 : std::uint8_t {
  disable_voltage,   ///< bit 1 = 0
  quick_stop,        ///< bit 1 = 1, bit 2 = 0
  shutdown,          ///< bits 0..3 = 6
  switch_on,         ///< bits 0..3 = 7
  enable_operation,  ///< bits 0..3 = 15
  other,             ///< bits 0..3 = 14: as shutdown, but bit 3
};
[[nodiscard]] Request402 request_of(std::uint16_t controlword);

/// This word takes an axis to operation enabled, or keeps it there.
[[nodiscard]] inline bool enables(std::int64_t controlword) {
  return request_of(static_cast<std::uint16_t>(controlword)) == Request402::enable_operation;
}

/// Modes of CiA 402 in which a target velocity or torque acts at once (design 3.4). A drive's own modes of that kind
/// are facts of its model.
[[nodiscard]] constexpr bool is_continuous(int mode) { return mode == 3 || mode == 4 || mode == 9 || mode == 10; }

}  // namespace axisgate::model
