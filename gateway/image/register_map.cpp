// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/register_map.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "gateway/core/name_table.hpp"
#include "gateway/image/axis_image.hpp"
#include "gateway/image/register_rows.hpp"

namespace axisgate {
namespace {

constexpr std::array<CoilRow, kCoils> kCoilRows{{
    {0, "enable", true, Command::enable, Command::disable, "1 enables, 0 disables; reads: enabled"},
    {1, "fault_reset", false, Command::fault_reset, Command::none, "acts on 0 to 1"},
    {2, "quick_stop", false, Command::quick_stop, Command::none, "acts on 0 to 1"},
    {3, "halt", true, Command::halt, Command::end_halt, "1 halts, 0 ends the halt without moving; reads: halted"},
    {4, "start_absolute", false, Command::move_absolute, Command::none, "acts on 0 to 1"},
    {5, "start_relative", false, Command::move_relative, Command::none, "acts on 0 to 1"},
    {6, "home", false, Command::home, Command::none, "acts on 0 to 1"},
    {7, "run_velocity", true, Command::run_velocity, Command::end_run,
     "1 runs, after a 0 was written; 0 halts while it runs; reads: velocity running"},
    {8, "jog_forward", true, Command::jog_forward, Command::jog_end,
     "0 to 1 runs at jog_velocity for as long as 1 is written again within jog_timeout_ms; 0, or both jog coils at 1, "
     "halts; reads: jogging"},
    {9, "jog_reverse", true, Command::jog_reverse, Command::jog_end, "as jog_forward, the other way"},
}};

constexpr std::array<InputRow, kAxisInputCount> kInputRows{{
    {0, "online", ""},
    {1, "ready", "online, no fault, enable would be tried"},
    {2, "enabled", ""},
    {3, "fault", ""},
    {4, "warning", "statusword bit 7 or an axis alarm"},
    {5, "target_reached", ""},
    {6, "homed", "latched from homing attained or the drive's reference bit; cleared by a drive restart"},
    {7, "moving", "the drive's flag, else above standstill_velocity"},
    {8, "limit_active", ""},
    {9, "quick_stop_active", "or stop-latched"},
    {10, "following_error", ""},
    {11, "owned_by_me", "this client owns the axis"},
    {12, "stop_latched", ""},
}};

}  // namespace

RegisterTable::RegisterTable(std::vector<RegisterRow> rows) : rows_(std::move(rows)) {
  assert(rows_.size() < 127);
  row_of_.fill(-1);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    for (int part = 0; part < rows_[i].registers(); ++part) {
      std::int8_t& place = row_of_.at(rows_[i].offset + static_cast<std::size_t>(part));
      assert(place == -1);
      place = static_cast<std::int8_t>(i);
    }
  }
}

const RegisterRow* RegisterTable::covering(std::uint16_t offset) const {
  if (offset >= kSpan || row_of_[offset] < 0) return nullptr;
  return &rows_[static_cast<std::size_t>(row_of_[offset])];
}

const RegisterTable& register_table(Block block) {
  static const RegisterTable gateway{gateway_register_rows()};
  static const RegisterTable axis{axis_register_rows()};
  static const RegisterTable bus{bus_register_rows()};
  static const RegisterTable overview{overview_register_rows()};
  switch (block) {
    case Block::gateway:
      return gateway;
    case Block::axis:
      return axis;
    case Block::bus:
      return bus;
    case Block::overview:
      return overview;
  }
  return gateway;
}

std::uint16_t axis_offset(Quantity quantity) {
  static const auto kOffsets = [] {
    std::array<std::uint16_t, kQuantityCount> offsets{};
    for (const RegisterRow& row : register_table(Block::axis).rows())
      if (row.source == Source::quantity) offsets.at(static_cast<std::size_t>(row.quantity)) = row.offset;
    return offsets;
  }();
  return kOffsets.at(static_cast<std::size_t>(quantity));
}

std::uint16_t axis_offset(Source source) {
  const auto rows = register_table(Block::axis).rows();
  const auto found = std::ranges::find(rows, source, &RegisterRow::source);
  assert(source != Source::quantity && found != rows.end());
  return found->offset;
}

std::optional<RegisterPlace> place_of(std::uint16_t address) {
  const auto within = [address](Block block, unsigned base, unsigned span) {
    const unsigned from_base = address - base;
    return RegisterPlace{block, static_cast<std::uint16_t>(from_base / span),
                         static_cast<std::uint16_t>(from_base % span)};
  };
  if (address < kAxisBlock) return within(Block::gateway, 0, kAxisBlock);
  if (address < kBusBlocks) return within(Block::axis, 0, kAxisBlock);
  if (address < kOverviewBlocks) return within(Block::bus, kBusBlocks, kBusBlock);
  if (address < kOverviewBlocks + kOverviewBlock * (kMaxAxisNumber + 1)) {
    return within(Block::overview, kOverviewBlocks, kOverviewBlock);
  }
  return std::nullopt;
}

std::uint16_t address_of(Block block, std::uint16_t number) {
  switch (block) {
    case Block::gateway:
      return 0;
    case Block::axis:
      return static_cast<std::uint16_t>(kAxisBlock * number);
    case Block::bus:
      return static_cast<std::uint16_t>(kBusBlocks + kBusBlock * number);
    case Block::overview:
      return static_cast<std::uint16_t>(kOverviewBlocks + kOverviewBlock * number);
  }
  return 0;
}

std::span<const CoilRow> coil_rows() { return kCoilRows; }
std::span<const InputRow> input_rows() { return kInputRows; }

bool Capabilities::supports(Command command) const {
  return command <= Command{kLastCommand} && (supported_commands >> static_cast<unsigned>(command) & 1U) != 0;
}

bool supports(const Capabilities& axis, const CoilRow& coil) {
  return axis.supports(is_jog(coil.on) ? Command::run_velocity : coil.on);
}

bool supports(const Capabilities& axis, const RegisterRow& row) {
  if (row.source == Source::quantity) return axis.supports(row.quantity);
  if (row.source == Source::set_position_value) return axis.supports(Command::set_position);
  return row.source != Source::jog_velocity || axis.supports(Command::run_velocity);
}

bool takes(const Capabilities& axis, const RegisterRow& row) {
  if (!row.writable) return false;
  return row.source == Source::quantity ? axis.takes(row.quantity) : supports(axis, row);
}

std::string_view unit_of(const RegisterRow& row, std::string_view position_unit) {
  if (row.kind == Kind::position) return position_unit;
  return row.kind == Kind::code ? row.unit : unit_text(row.kind);
}

std::string_view text(RegisterType type) {
  using enum RegisterType;
  static constexpr auto kNames = names_of<RegisterType>({{u16, "u16"}, {i16, "i16"}, {u32, "u32"}, {i32, "i32"}});
  static_assert(kNames.has_all_to(i32));
  return kNames.of(type);
}

}  // namespace axisgate
