// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/axis/command_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "gateway/core/name_table.hpp"
#include "gateway/core/words.hpp"
#include "gateway/model/cia402.hpp"

namespace axisgate::drive {
namespace {

/// A register's number in the unit that people speak in; empty for codes.
std::string in_words(const AxisCore& core, Kind kind, std::int64_t value) {
  const ShownUnit unit = shown_unit(kind);
  if (unit.name.empty()) return {};
  const double registers = kind == Kind::position ? core.model.units_per_rev.to_double() : unit.registers;
  return fmt::format(" ({:.6g} {})", static_cast<double>(value) / registers, unit.name);
}

std::string_view asked_by(std::uint16_t word) {
  using enum model::Request402;
  static constexpr auto kNames = names_of<model::Request402>({
      {disable_voltage, "disable voltage"},
      {quick_stop, "quick stop"},
      {shutdown, "shutdown"},
      {switch_on, "switch on"},
      {enable_operation, "enable operation"},
      {other, "bits 0 to 3 = 14"},
  });
  static_assert(kNames.has_all_to(other));
  return kNames.of(model::request_of(word));
}

std::string controlword_text(std::uint16_t word) {
  std::string out = fmt::format("controlword 0x{:04X} ({}", word, asked_by(word));
  if ((word & model::controlword::kFaultReset) != 0) out += ", fault reset";
  if ((word & model::controlword::kHalt) != 0) out += ", halt";
  if ((word & model::controlword::kStart) != 0) out += ", bit 4 start";
  return out + ")";
}

std::string mode_text(std::int16_t mode) {
  const Word* word = mode < 0 ? nullptr : find_word(WordKind::mode, static_cast<std::uint32_t>(mode));
  return word == nullptr ? fmt::format("mode {}", mode) : fmt::format("mode {} ({})", mode, word->name);
}

std::string object_text(const ObjectRequest& object) {
  std::string out =
      fmt::format("{} object 0x{:04X}:{:02X}", object.write ? "write of" : "read of", object.index, object.subindex);
  if (!object.write) return out;
  if (object.size == 0) return out + fmt::format(", {} bytes", object.bytes ? object.bytes->size() : std::size_t{0});
  return out + fmt::format(" = 0x{:0{}X}", object.data, 2 * object.size);
}

/// What it uses where the request itself names none.
std::optional<std::int64_t> target_before(const AxisCore& core, Quantity target) {
  if (target != Quantity::target_position) return core.asked.taken(target).value_or(Wanted{}).value;
  const auto wanted = core.target_position();
  return wanted ? std::optional(wanted->value) : std::nullopt;
}

/// "target_velocity 60000 (60 rpm)"
std::string value_text(const AxisCore& core, Quantity quantity, std::int64_t value) {
  return fmt::format("{} {}{}", row(quantity).name, value, in_words(core, row(quantity).kind, value));
}

}  // namespace

std::string limit_text(const AxisCore& core, const PassedLimit& passed) {
  if (passed.kind == Kind::position)
    return fmt::format("{:.6g} turns", static_cast<double>(passed.limit) / core.model.units_per_rev.to_double());
  const std::string words = in_words(core, passed.kind, passed.limit);
  constexpr std::size_t kOpened = 2;  // " ("
  return words.empty() ? fmt::format("{}", passed.limit) : words.substr(kOpened, words.size() - kOpened - 1);
}

bool sets(const WriteBatch& batch, Quantity quantity) {
  return std::ranges::any_of(batch.setpoints, [quantity](const Setpoint& sp) { return sp.quantity == quantity; });
}

std::string command_text(const AxisCore& core, const WriteBatch& batch, std::uint32_t jog_velocity) {
  std::string out;
  const auto add = [&out](const std::string& part) { out += (out.empty() ? "" : ", ") + part; };
  if (batch.command != Command::none) add(std::string(text(batch.command)));
  if (batch.controlword) add(controlword_text(*batch.controlword));
  if (batch.mode) add(mode_text(*batch.mode));
  if (is_jog(batch.command) || batch.jog_velocity)
    add(fmt::format("jog_velocity {}{}", batch.jog_velocity.value_or(jog_velocity),
                    in_words(core, Kind::velocity, batch.jog_velocity.value_or(jog_velocity))));
  if (batch.command == Command::set_position || batch.set_position_value) {
    const std::int64_t position = batch.set_position_value.value_or(core.set_position_value);
    add(fmt::format("set_position_value {}{}", position, in_words(core, Kind::position, position)));
  }
  const auto target = target_of(batch.command);
  if (target && !sets(batch, *target))
    if (const auto value = target_before(core, *target)) add(value_text(core, *target, *value));
  const std::size_t shown = std::min(batch.setpoints.size(), kMaxShownValues);
  for (std::size_t i = 0; i < shown; ++i) add(value_text(core, batch.setpoints[i].quantity, batch.setpoints[i].value));
  if (batch.setpoints.size() > shown) add(fmt::format("{} values more", batch.setpoints.size() - shown));
  if (batch.object) add(object_text(*batch.object));
  return out;
}

}  // namespace axisgate::drive
