// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/commission/commission_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gateway/drive/plan/action.hpp"

namespace axisgate::commands {
namespace {

std::string address_of(const model::DriveModel& model, const model::ObjectDef& object) {
  if (model.protocol == "modbus-rtu") return fmt::format("{} (register {})", object.name, object.address.index);
  return fmt::format("{} ({:04X}.{:02X})", object.name, object.address.index, object.address.sub);
}

/// Reading it tells what a write of it did.
bool tells(const model::ObjectDef& object) { return object.readable && !object.trigger && !object.emulated; }

std::optional<std::int64_t> number_of(const Numbers& numbers, model::ObjectId id) {
  const auto found = numbers.find(id);
  return found == numbers.end() ? std::nullopt : std::optional(found->second);
}

/// The bits that the check looks at: others of its object may change and mean nothing here.
std::int64_t looked_at(const model::Check& check, std::int64_t number) {
  return check.bad.mask == 0 ? number : number & std::int64_t{check.bad.mask};
}

bool is_written(const model::Check& check, model::ObjectId id) {
  return std::ranges::any_of(check.remedy, [&](const model::ObjectWrite& write) { return write.object == id; });
}

bool same(const model::Check& check, model::ObjectId id, std::int64_t one, std::int64_t other) {
  return one == other || (!is_written(check, id) && looked_at(check, one) == looked_at(check, other));
}

}  // namespace

std::vector<Finding> findings(const model::DriveModel& model, const drive::ObjectStore& store, AxisSlot slot) {
  std::vector<Finding> out;
  for (const model::Check& check : model.checks) {
    if (check.slot != kNoAxis && check.slot != slot) continue;
    const drive::ObjectState& state = store[check.bad.object];
    const bool bad =
        state.known && check.bad.holds(model.object(check.bad.object), static_cast<std::uint32_t>(state.number));
    out.push_back({&check, state.known, bad, state.number});
  }
  return out;
}

std::vector<const model::Check*> to_ask(const std::vector<Finding>& found) {
  std::vector<const model::Check*> out;
  for (const Finding& finding : found)
    if (finding.bad && !finding.check->remedy.empty()) out.push_back(finding.check);
  return out;
}

bool leaves_bad(const std::vector<Finding>& found) {
  return std::ranges::any_of(found,
                             [](const Finding& finding) { return finding.bad && finding.check->remedy.empty(); });
}

std::vector<model::ObjectId> objects_of(const model::DriveModel& model, const model::Check& check) {
  std::vector<model::ObjectId> out{check.bad.object};
  for (const model::ObjectWrite& write : check.remedy)
    if (tells(model.object(write.object)) && std::ranges::find(out, write.object) == out.end())
      out.push_back(write.object);
  return out;
}

std::optional<bool> is_bad(const model::DriveModel& model, const model::Check& check, const Numbers& numbers) {
  const auto number = number_of(numbers, check.bad.object);
  if (!number) return std::nullopt;
  return check.bad.holds(model.object(check.bad.object), static_cast<std::uint32_t>(*number));
}

std::string objection(const std::vector<AxisShown>& axes) {
  for (const AxisShown& axis : axes) {
    if (axis.link != LinkState::online) return fmt::format("axis {} is not online ({})", axis.number, text(axis.link));
    if (!axis.state_known) return fmt::format("axis {} does not tell whether it is enabled", axis.number);
    if (axis.enabled)
      return fmt::format("axis {} is enabled: disable it first, settings are not changed under torque", axis.number);
  }
  return "";
}

std::string objection(const model::DriveModel& model, const model::Check& check, const Numbers& shown,
                      const Numbers& now) {
  for (const model::ObjectId id : objects_of(model, check)) {
    const auto before = number_of(shown, id);
    const auto after = number_of(now, id);
    const std::string where = address_of(model, model.object(id));
    if (!after || !before) return fmt::format("{} could not be read", where);
    if (!same(check, id, *before, *after))
      return fmt::format("{} is {:#x} now and was {:#x} when you were asked", where, *after, *before);
  }
  return "";
}

bool means_yes(std::string_view line) { return line == "yes"; }

std::string text(const model::DriveModel& model, const model::ObjectWrite& write) {
  const std::string what = fmt::format("{} = {}", address_of(model, model.object(write.object)), write.raw);
  return write.why.empty() ? what : fmt::format("{}  {}", what, write.why);
}

std::string text(const model::DriveModel& model, const Finding& finding) {
  const model::Check& check = *finding.check;
  const std::string where = address_of(model, model.object(check.bad.object));
  if (!finding.known) return fmt::format("?    {}: {} is not known", check.name, where);
  if (!finding.bad) return fmt::format("ok   {}: {} = {:#x}", check.name, where, finding.value);
  return fmt::format("BAD  {}: {} = {:#x}\n       {}{}", check.name, where, finding.value, check.text,
                     check.remedy.empty() ? "\n       no write remedies this: see the drive's manual" : "");
}

std::string question(const model::DriveModel& model, const model::Check& check, const Numbers& shown) {
  const auto value = number_of(shown, check.bad.object);
  std::string out =
      fmt::format("{}: {} = {}\n  {}\n  a yes writes\n", check.name, address_of(model, model.object(check.bad.object)),
                  value ? fmt::format("{:#x}", *value) : "not known", check.text);
  for (const model::ObjectWrite& write : check.remedy) {
    const auto now = number_of(shown, write.object);
    const bool state_known = now && tells(model.object(write.object));
    out += fmt::format("    {}{}\n", text(model, write), state_known ? fmt::format("  (now {:#x})", *now) : "");
  }
  return out;
}

ReadBack read_back(const model::DriveModel& model, const model::Check& check, const Numbers& after) {
  ReadBack out;
  bool held = true;
  for (const model::ObjectWrite& write : check.remedy) {
    const model::ObjectDef& object = model.object(write.object);
    if (!tells(object)) continue;
    const auto number = number_of(after, write.object);
    const bool holds = number == object.number(drive::wire_bits(write.raw, object.size));
    const std::string reads = number ? fmt::format("reads {:#x}", *number) : "could not be read back";
    // Its reason says when the drive goes by it, too.
    const std::string reason = write.why.empty() ? "" : "  " + write.why;
    out.text += fmt::format("  {} {}{}\n", address_of(model, object), reads,
                            holds || !number ? reason : fmt::format(", although {} was written", write.raw));
    held = held && holds;
  }
  const auto bad = is_bad(model, check, after);
  out.cured = held && bad == false;
  const char* verdict = out.cured     ? "reads as it should"
                        : bad == true ? "STILL BAD"
                                      : "NOT KNOWN, it could not be read back";
  if (bad == false && !held) verdict = "gone, but the drive does not hold what was written";
  out.text += fmt::format("  {}: {}\n", check.name, verdict);
  return out;
}

}  // namespace axisgate::commands
