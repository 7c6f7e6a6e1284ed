// SPDX-License-Identifier: Apache-2.0
// What a fault is called in log and events: cause, remedy, and the words of the drive it was found in.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "gateway/drive/state/axis_core.hpp"

namespace axisgate::drive {
namespace {

std::string named_by(const model::AlarmRow& row) {
  return row.remedy.empty() ? row.text : row.text + "; " + row.remedy;
}

/// The drive has sent a code and named no word: what the alarm table knows of that code.
std::string named_by_code(const AxisCore& core, std::uint16_t code) {
  if (code == 0) return "the drive names no cause";
  const auto& rows = core.drive.alarms;
  const auto row = std::ranges::find_if(rows, [code](const model::AlarmRow& r) { return r.code == code; });
  const std::string sent = fmt::format("error code 0x{:04X}", code);
  return row == rows.end() ? sent + ", which the profile does not list" : sent + ": " + named_by(*row);
}

/// The words as they were read; of `core`'s fault only where they were read after it.
void add_words(const AxisCore& core, const model::AxisModel& axis, bool own, std::string& out) {
  for (const model::ObjectId id : cause_objects(axis)) {
    const ObjectState& word = core.store[id];
    const bool counts = own ? core.names_cause(id) : word.known && word.number != 0;
    if (!counts) continue;
    if (!out.empty()) out += ", ";
    out += fmt::format("{} 0x{:0{}X}", core.object(id).name, static_cast<std::uint32_t>(word.number),
                       2 * core.object(id).size);
  }
}

}  // namespace

std::string place_of(const model::DriveModel& model, model::ObjectId object) {
  const ObjectAddress& at = model.object(object).address;
  if (model.protocol != "modbus-rtu") return fmt::format("0x{:04X}:{:02X}", at.index, at.sub);
  constexpr std::array<std::string_view, 4> kTables{"register", "input register", "coil", "discrete input"};
  return fmt::format("{} {}", kTables.at(at.sub), at.index);
}

// A remedy may send its reader to another word of the drive: all of them stand behind it, of other motors what is not
// 0.
std::string fault_text(const AxisCore& core) {
  const model::AlarmRow* row = active_alarm(core);
  std::string out = row != nullptr ? named_by(*row) : named_by_code(core, core.fault.code());
  std::string words;
  add_words(core, core.model, true, words);
  for (const model::AxisModel& other : core.drive.axes)
    if (&other != &core.model) add_words(core, other, false, words);
  return words.empty() ? out : out + " [" + words + "]";
}

}  // namespace axisgate::drive
