// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/parameters/plan/parameter_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gateway/commands/try/plan/object_reads.hpp"
#include "gateway/core/words.hpp"
#include "gateway/drive/state/nvm_budget.hpp"
#include "gateway/model/real32.hpp"

namespace axisgate::commands {
namespace {

std::string hexadecimal(const std::optional<std::uint32_t>& number) {
  return number ? fmt::format("{:#x}", *number) : "not known";
}

/// A value that the profile calls bad is a person's decision: an input function that enables, a drive that enables
/// itself. Null: none does.
const model::Check* check_against(const model::DriveModel& model, const model::ObjectDef& object, std::int64_t number) {
  const auto found = std::ranges::find_if(model.checks, [&](const model::Check& check) {
    const model::ObjectDef& checked = model.object(check.bad.object);
    return checked.address == object.address && check.bad.holds(checked, object.raw(number));
  });
  return found == model.checks.end() ? nullptr : &*found;
}

/// Why this value is not written to this object; empty: it may be.
std::string against(const model::DriveModel& model, const Parameter& parameter, const SavedParameter& saved,
                    const Reading& now) {
  const model::ObjectDef& object = parameter.object;
  if (!parameter.never.empty()) return parameter.never;
  if (!saved.reading.number) return "it was not read when the file was saved: " + saved.reading.why;
  if (saved.type != type_text(object))
    return fmt::format("the file has it as {}, and here it is {}", saved.type, type_text(object));
  if (!now.number) return "it cannot be read now, so nobody would see what a write did: " + now.why;
  if (!object.printed.holds(*saved.reading.number))
    return fmt::format("{} is outside its range of {} to {}", number_text(object, *saved.reading.number),
                       number_text(object, object.printed.min), number_text(object, object.printed.max));
  if (const model::Check* check = check_against(model, object, *saved.reading.number))
    return fmt::format("{}: axisgate commission decides about that", check->text);
  return "";
}

std::string value_text(const model::ObjectDef& object, const Reading& reading) {
  return reading.number ? number_text(object, *reading.number) : fmt::format("nothing ({})", reading.why);
}

}  // namespace

ObjectRequest read_request(const model::DriveModel& model, const Parameter& parameter) {
  const model::ObjectDef& object = parameter.object;
  ObjectRequest out{false, object.address.index, object.address.sub, object.size, 0};
  if (model::is_canopen(model)) {
    out.size = 0;  // as wide as the drive answers
    out.count = object.size;
  }
  return out;
}

ObjectRequest write_request(const Parameter& parameter, std::int64_t number) {
  const model::ObjectDef& object = parameter.object;
  return {true, object.address.index, object.address.sub, object.size, object.raw(number)};
}

std::string refusal_text(const BatchResult& answer) {
  if (answer.outcome.code != Errc::refused_by_drive) {
    const std::string limit = answer.limit.empty() ? "" : fmt::format(" (limit {})", answer.limit);
    return fmt::format("{}{}", text(answer.outcome.code), limit);
  }
  const Word* const word = find_word(WordKind::abort_code, answer.abort_code);
  const std::string name = word == nullptr ? "" : fmt::format(" {} ({})", word->name, word->meaning);
  return fmt::format("refused by the drive: {:#010x}{}", answer.abort_code, name);
}

Reading reading_of(const model::DriveModel& model, const Parameter& parameter, const BatchResult& answer) {
  const model::ObjectDef& object = parameter.object;
  if (answer.outcome.code != Errc::ok) return {{}, refusal_text(answer), true};
  if (model::is_canopen(model) && answer.object_size != object.size) {
    const std::size_t bytes = answer.object_bytes ? answer.object_bytes->size() : answer.object_size;
    return {{}, fmt::format("the drive answers {} bytes, and {} were expected", bytes, object.size)};
  }
  const std::int64_t number = object.number(answer.object_data);
  if (object.is_real && (number > model::kLargestReal || number < -model::kLargestReal))
    return {{}, "it holds what is no number"};
  return {number, {}};
}

After after(const BatchResult& answer) {
  switch (answer.outcome.code) {
    case Errc::busy:
    case Errc::queue_full:
      return After::again;
    case Errc::timed_out:
    case Errc::link_lost:
    case Errc::offline:
    case Errc::never_started:
    case Errc::bad_reply:
    case Errc::identity_mismatch:
      return After::end;
    default:
      return After::next;
  }
}

std::optional<Written> changed(const Parameter& parameter, std::int64_t shown, const std::optional<Reading>& now) {
  if (!now) return Written{.ends = true, .text = "not written: the drive does not answer any more"};
  if (now->number == shown) return std::nullopt;
  return Written{.text = fmt::format("not written: it holds {} now, and held {} when you were asked",
                                     value_text(parameter.object, *now), number_text(parameter.object, shown))};
}

Written written(const Parameter& parameter, std::int64_t number, const BatchResult& answer,
                const std::optional<Reading>& held) {
  if (after(answer) == After::end)
    return {.ends = true, .text = fmt::format("{}: whether it was written is not known", text(answer.outcome.code))};
  if (answer.outcome.code != Errc::ok)
    return {.try_later = answer.outcome.code == Errc::refused_by_drive, .text = "not written: " + refusal_text(answer)};
  if (!held) return {.ends = true, .text = "written, and the drive does not answer any more"};
  if (held->number == number) return {.held = true, .text = "written"};
  return {.text = fmt::format("the drive holds {}, although {} was written", value_text(parameter.object, *held),
                              number_text(parameter.object, number))};
}

std::vector<SavedParameter> saved(const std::vector<Parameter>& parameters, const Readings& readings) {
  std::vector<SavedParameter> out;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const model::ObjectDef& object = parameters[i].object;
    out.push_back({object.address, object.name, type_text(object), readings[i]});
  }
  return out;
}

std::vector<Difference> differences(const model::DriveModel& model, const std::vector<Parameter>& parameters,
                                    const Readings& readings, const ParameterFile& file) {
  std::vector<Difference> out;
  for (const SavedParameter& saved : file.objects) {
    const auto found = std::ranges::lower_bound(parameters, saved.address, {},
                                                [](const Parameter& parameter) { return parameter.object.address; });
    if (found == parameters.end() || found->object.address != saved.address) {
      if (!saved.reading.number) continue;
      out.push_back({.known = false,
                     .text = fmt::format("{} ({})", saved.name, place_text(model.protocol, saved.address)),
                     .not_written = "neither the profile nor an EDS given here can write it"});
      continue;
    }
    Difference difference;
    difference.place = static_cast<std::size_t>(found - parameters.begin());
    const Reading& now = readings[difference.place];
    if (saved.reading.number == now.number) continue;  // or nobody could read it, then as now
    const model::ObjectDef& object = found->object;
    difference.text = fmt::format("{}: {} in the file, {} in the drive", address_text(model, object),
                                  value_text(object, saved.reading), value_text(object, now));
    difference.counts = !found->changes_itself;
    difference.not_written = against(model, *found, saved, now);
    if (difference.not_written.empty()) {
      difference.write = saved.reading.number;
      difference.now = *now.number;
    }
    out.push_back(std::move(difference));
  }
  return out;
}

bool any_counts(const std::vector<Difference>& found) { return std::ranges::any_of(found, &Difference::counts); }

std::string objection(const DriveFacts& saved, const DriveFacts& now) {
  if (saved.profile != now.profile)
    return fmt::format("the file is of a drive with profile {}, and this one has {}", saved.profile, now.profile);
  if (saved.protocol != now.protocol)
    return fmt::format("the file was saved by {}, and this drive is reached by {}", saved.protocol, now.protocol);
  constexpr std::array kWho{"vendor", "product"};
  for (std::size_t i = 0; i < kWho.size(); ++i)
    if (saved.identity[i] && saved.identity[i] != now.identity[i])
      return fmt::format("the file is of a drive with {} {}, and this one says {}", kWho[i],
                         hexadecimal(saved.identity[i]), hexadecimal(now.identity[i]));
  return "";
}

std::vector<std::string> remarks(const DriveFacts& saved, const DriveFacts& now) {
  constexpr std::size_t kRevision = 2, kSerial = 3;
  std::vector<std::string> out;
  if (!saved.identity[0] && !now.identity[0])
    out.emplace_back("this drive does not say what it is: only its profile is compared");
  if (saved.identity[kSerial] != now.identity[kSerial])
    out.push_back(fmt::format("another serial number: {} in the file, {} here", hexadecimal(saved.identity[kSerial]),
                              hexadecimal(now.identity[kSerial])));
  if (saved.identity[kRevision] != now.identity[kRevision] || saved.firmware != now.firmware)
    out.push_back(fmt::format(
        "another firmware: revision {} \"{}\" in the file, {} \"{}\" here: a setting may mean something else",
        hexadecimal(saved.identity[kRevision]), saved.firmware, hexadecimal(now.identity[kRevision]), now.firmware));
  return out;
}

bool has_save_command(const model::DriveModel& model, AxisSlot slot) {
  return model.axes[slot].supports(Command::save_parameters);
}

std::vector<std::string> cost(const model::DriveModel& model, AxisSlot slot, const std::vector<Parameter>& parameters,
                              const std::vector<Difference>& found) {
  int all = 0;
  int wearing = 0;
  for (const Difference& difference : found) {
    if (!difference.write) continue;
    ++all;
    if (parameters[difference.place].object.nvm == model::Nvm::yes) ++wearing;
  }
  std::vector<std::string> out;
  const bool saves = has_save_command(model, slot);
  if (wearing > 0) out.push_back(fmt::format("{} of {} go to the drive's memory (EEPROM) at once", wearing, all));
  const int later = wearing - drive::NvmBudget::kAtOnce;
  if (later > 0)
    out.push_back(fmt::format("{} at once and then one a minute, to spare it: this takes {} minutes",
                              drive::NvmBudget::kAtOnce, later));
  if (saves) out.emplace_back("then the drive stores them, once");
  if (!saves && wearing < all)
    out.emplace_back("the profile has no command that stores them: whether they outlive a restart, its manual says");
  return out;
}

std::string progress_text(std::size_t done, std::size_t all, Duration took) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(took).count();
  const auto left = done == 0 ? 0 : seconds * static_cast<std::int64_t>(all - done) / static_cast<std::int64_t>(done);
  return fmt::format("read {} of {}, about {} s to go", done, all, left);
}

}  // namespace axisgate::commands
