// SPDX-License-Identifier: Apache-2.0
// The table that `axisgate top` shows: registers in, text out. Pure: no socket, no terminal, no clock.
// Promises that a value which is not good now is marked ('?' after it, '?' alone where there never was one, '-' where
// the drive has none), so that nobody takes an old number for a fresh one; states, alarms and faults in words. Where
// the terminal is narrow an axis takes several lines. Never cuts a number short. An alarm beside a state that is right
// colours its own words alone: a whole line in colour is an axis that fails.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/rational.hpp"
#include "gateway/image/axis_image.hpp"

namespace axisgate::commands {

/// The part of an axis's block that a cyclic scanner reads (design 3.1): offsets 0..38.
inline constexpr std::uint16_t kAxisRegisters = 39;
/// Of the gateway block: up to and with the word-order test.
inline constexpr std::uint16_t kGatewayRegisters = 12;

struct AxisReading {
  AxisNumber axis = 0;
  std::array<std::uint16_t, kAxisRegisters> registers{};
  std::string name{};                       ///< by the configuration, where it is known
  std::optional<Rational> units_per_rev{};  ///< by the configuration: its position is shown in turns as well
};

struct TopReading {
  std::string server;  ///< "127.0.0.1:1502"
  std::array<std::uint16_t, kGatewayRegisters> gateway{};
  std::vector<AxisReading> axes;
  bool float_numbers = false;  ///< position and velocity are IEEE 754, in turns and rpm
};

enum class WordOrder : std::uint8_t { high_first, low_first, unknown };
/// The number of 32 bits in two registers.
[[nodiscard]] std::uint32_t pair_at(std::span<const std::uint16_t> registers, std::size_t at, WordOrder order);
/// From the test value in registers 10 and 11, whatever the listener is set to.
[[nodiscard]] WordOrder word_order(std::span<const std::uint16_t, kGatewayRegisters> gateway);

/// The gateway would not say anything of it but that it is not there: shown offline, its last values as not good.
void mark_out_of_reach(AxisReading& axis);

/// Below this one line an axis has no room.
inline constexpr std::size_t kNarrow = 80;

/// How much a line of the table asks for somebody's attention, from its character `asks_from` on.
enum class Attention : std::uint8_t { none, look, act };
struct TopLine {
  std::string text;
  Attention asks = Attention::none;
  std::size_t asks_from = 0;
};

/// The first line tells of the gateway, the next names the columns, then the axes: one line each, or two and more where
/// that would not fit into `columns` (at least kNarrow is needed; 0: there is no end).
[[nodiscard]] std::vector<TopLine> table_lines(const TopReading& reading, std::size_t columns = 0);
/// What stands below it: which command says more of what is coloured (nothing where nothing is), then each of `notes`.
[[nodiscard]] std::vector<TopLine> lines_below(const TopReading& reading, std::span<const std::string> notes,
                                               std::size_t columns, bool colours);
/// The same as text, each line ended by '\n'.
[[nodiscard]] std::string text_of(std::span<const TopLine> lines);

}  // namespace axisgate::commands
