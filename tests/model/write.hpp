// SPDX-License-Identifier: Apache-2.0
// A write as a PLC's programmer thinks of it: a function code, where it begins, what it carries. Promises that a row of
// 32 bits is written whole, high word first, on axis 1. Never knows a gateway.
#pragma once

#include <boost/container/flat_map.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace axisgate::test::reference {

using Rows = boost::container::flat_map<std::uint16_t, std::int64_t>;  ///< offset in the axis's block: value

namespace row {
inline constexpr std::uint16_t controlword = 40, mode = 41, target_position = 42, target_velocity = 44,
                               target_torque = 46, max_torque = 47, profile_velocity = 48, profile_acceleration = 50,
                               profile_deceleration = 52, command = 54, command_id = 55, heartbeat = 56,
                               jog_velocity = 58, homing_method = 60, homing_speed_switch = 62, homing_speed_zero = 64,
                               homing_acceleration = 66, homing_offset = 68, quick_stop_deceleration = 70,
                               max_velocity = 76, set_position_value = 78, object_request = 80;
}  // namespace row

/// Of row 54.
inline constexpr std::int64_t kEnable = 1, kDisable = 2, kQuickStop = 3, kHalt = 4, kMove = 6, kRelative = 7, kRun = 8,
                              kTorque = 9, kHome = 10, kSetPosition = 11, kSave = 12, kRelease = 13, kTakeOver = 14,
                              kJogForward = 31, kJogReverse = 32, kJogEnd = 33;  // the last three by DDS alone
/// 3.4 Stops: "Asserted stops are commands 2, 3, 4 and coils 2, 3 = 1, nothing else."
[[nodiscard]] constexpr bool is_stop(std::int64_t command) { return command >= kDisable && command <= kHalt; }
inline constexpr std::int64_t kPositionMode = 1, kVelocityMode = 3;  ///< of row 41
/// Of positions, in 1/10000 turn: a count of the coarsest encoder, and rounding.
inline constexpr std::int64_t kClose = 8;

namespace coil {
inline constexpr std::uint16_t enable = 0, fault_reset = 1, quick_stop = 2, halt = 3, start_absolute = 4,
                               start_relative = 5, home = 6, run_velocity = 7, jog_forward = 8, jog_reverse = 9,
                               count = 10;
}  // namespace coil

namespace fc {
inline constexpr int sample = 0,  // no function code: a DDS sample
    write_coil = 5, write_register = 6, write_coils = 15, write_registers = 16, mask_write = 22, read_write = 23,
                     general_reference = 43;  // 43/13, told as the mailbox's rows 80 to 85
}  // namespace fc

/// Design 4, age and which gateway: why a sample may not be carried out.
enum class Flaw : std::uint8_t {
  none,
  old,    ///< its source timestamp is older than max_age_ms
  ahead,  ///< or as far ahead
  half,   ///< of gateway_key and name one alone is this gateway's
};

struct Write {
  int function = fc::write_registers;
  std::uint16_t first = 0;             ///< offset in the axis's block of registers or coils
  std::vector<std::uint16_t> words{};  ///< one for each register, or 0 and 1 for each coil
  Rows sample{};                       ///< of fc::sample: what its mask names, and the command
  Flaw flaw = Flaw::none;              ///< of fc::sample
  std::size_t repeats = 0;             ///< of fc::sample: it has the request_id of so many before; 0: a new one
  [[nodiscard]] bool coils() const { return function == fc::write_coil || function == fc::write_coils; }
};

[[nodiscard]] bool is_wide(std::uint16_t offset);
/// Rows 46, 47 and 62 to 76: what a program sets once.
[[nodiscard]] bool is_parameter(std::uint16_t offset);
/// One half of a row of 32 bits, by function 6: that row's offset. No value: it is none.
[[nodiscard]] std::optional<std::uint16_t> half_row(const Write& write);
/// One row alone. Function 0: 6 where the row has 16 bits, else 16.
[[nodiscard]] Write one(std::uint16_t offset, std::int64_t value, int function = 0);
/// Registers `first` to `last`; rows that are not named are 0.
[[nodiscard]] Write block(std::uint16_t first, std::uint16_t last, const Rows& rows,
                          int function = fc::write_registers);
[[nodiscard]] Write one_coil(std::uint16_t number, bool on, int function = fc::write_coil);
[[nodiscard]] Write coil_block(std::uint16_t first, std::vector<std::uint16_t> values);
/// The rows of it that a table of offsets 40..79 has, with their values; halves of a row are left out.
[[nodiscard]] Rows rows_of(const Write& write);
/// 3.4 Stops: "Asserted stops are commands 2, 3, 4 and coils 2, 3 = 1, nothing else."
[[nodiscard]] bool asserts_stop(const Write& write);
[[nodiscard]] std::string text(const Write& write);

}  // namespace axisgate::test::reference
