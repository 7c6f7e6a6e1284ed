// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/axis_json.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "gateway/core/words.hpp"
#include "gateway/image/command.hpp"
#include "gateway/image/register_map.hpp"
#include "gateway/upstream/web_process/api/blocked_by.hpp"
#include "gateway/upstream/web_process/api/fault_json.hpp"
#include "gateway/upstream/web_process/api/words_json.hpp"
#include "gateway/upstream/web_process/values/value_names.hpp"

namespace axisgate::web {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// What is told of one axis, and how much of it counts now.
struct View {
  const Picture& picture;
  const AxisPicture& axis;
  const Now& now;
  bool joined;

  [[nodiscard]] bool valid(Quantity quantity) const {
    return joined && (axis.sample.valid & axis.sample.supported & bit(quantity)) != 0 && axis.of(quantity).known;
  }
};

Json name_json(const View& of, WordKind kind, std::uint32_t number, std::uint32_t unknown) {
  return name_of(kind, of.joined ? number : unknown);
}

std::string_view state_text(const View& of) {
  const auto unknown = static_cast<std::uint32_t>(AxisState::unknown);
  return axis_state_text(of.joined ? of.axis.sample.axis_state : unknown, of.axis.latched_and_stands());
}

/// Since the sample it has become older.
Json age_json(const View& of) {
  if (of.axis.sampled == 0 || of.axis.sample.age_ms == kNone) return nullptr;
  return of.axis.sample.age_ms + ms_since(of.axis.sampled, of.now.at);
}

void add_values(const View& of, Json& out) {
  Json supported = Json::array(), values = Json::object(), last = Json::object();
  for (const QuantityRow& row : quantity_table()) {
    const std::string name(value_name(row.quantity));
    if ((of.axis.sample.supported & bit(row.quantity)) != 0) supported.push_back(name);
    const HeldValue& held = of.axis.of(row.quantity);
    const bool valid = of.valid(row.quantity);
    values[name] = valid ? value_json(row.quantity, held.value, of.axis.info) : Json();
    if (!valid && held.known)
      last[name] = {{"value", value_json(row.quantity, held.value, of.axis.info)},
                    {"age_ms", ms_since(held.at, of.now.at)}};
  }
  out["supported"] = std::move(supported);
  out["values"] = std::move(values);
  out["last"] = std::move(last);
}

Json inputs_json(const View& of) {
  Json out = Json::array();
  for (const InputRow& row : input_rows())
    if (of.joined && (of.axis.sample.inputs >> row.offset & 1U) != 0) out.push_back(row.name);
  return out;
}

std::string mode_name(std::int64_t mode) {
  const Word* word = mode < 0 ? nullptr : find_word(WordKind::mode, static_cast<std::uint32_t>(mode));
  return word == nullptr ? fmt::format("mode {}", mode) : std::string(word->name);
}

Json mode_json(const View& of) {
  if (!of.valid(Quantity::mode_display)) return nullptr;
  return mode_name(of.axis.of(Quantity::mode_display).value);
}

Json blocks_json(const View& of) {
  Json out = Json::array();
  for (const Block& block : blocked_by(of.picture, of.axis, of.now.at))
    out.push_back({{"word", block.word}, {"text", block.text}, {"remedy", block.remedy}});
  return out;
}

std::string result_text(const AxisSample& sample) {
  const Word* word = find_word(WordKind::result, sample.result);
  std::string out(word == nullptr ? "" : word->meaning);
  if (sample.result_detail == 0) return out;
  if (sample.result == static_cast<std::uint8_t>(CommandResult::not_reached))
    return out + fmt::format(" (step {})", sample.result_detail);
  const Word* detail = find_word(WordKind::abort_code, sample.result_detail);
  return out + fmt::format(" (detail 0x{:08X}{}{})", sample.result_detail, detail == nullptr ? "" : ": ",
                           detail == nullptr ? "" : detail->meaning);
}

Json result_json(const View& of) {
  const AxisSample& sample = of.axis.sample;
  if (of.axis.sampled == 0 || sample.result_age_ms == kNone) return nullptr;
  return {{"who", sample.result_who},
          {"what", sample.result_what},
          {"result", name_of(WordKind::result, sample.result)},
          {"detail", sample.result_detail},
          {"text", result_text(sample)},
          {"at", utc_text(of.axis.result, of.now)}};
}

/// What the drive can, by its configuration.
void add_abilities(const AxisInfoRecord& info, Json& out) {
  constexpr unsigned kModes = 16;
  Json modes = Json::array(), commands = Json::array(), limits = Json::object();
  for (unsigned i = 0; i < kModes; ++i)  // 6502h: bit 0 is mode 1
    if ((info.supported_modes >> i & 1U) != 0) modes.push_back(mode_name(i + 1));
  for (unsigned i = 1; i <= kLastCommand; ++i)
    if ((info.supported_commands >> i & 1U) != 0) commands.push_back(text(static_cast<Command>(i)));
  for (const LimitRow& row : info.limits)
    if (const auto quantity = static_cast<Quantity>(row.quantity); row.quantity < kQuantityCount)
      limits[std::string(value_name(quantity))] = {{"min", value_json(quantity, row.min, info)},
                                                   {"max", value_json(quantity, row.max, info)}};
  out["supported_modes"] = std::move(modes);
  out["commands"] = std::move(commands);
  out["limits"] = std::move(limits);
}

Json rated_json(const AxisInfoRecord& info) {
  return info.rated_speed == 0 ? Json() : value_json(Quantity::max_velocity, info.rated_speed, info);
}

}  // namespace

Json axis_now_json(const Picture& picture, const AxisPicture& axis, const Now& now) {
  const View of{picture, axis, now, picture.joined(now.at) && axis.sampled != 0};
  const AxisInfoRecord& info = axis.info;
  const AxisSample& sample = axis.sample;
  const auto bus = picture.buses().find(info.bus);
  Json out;
  out["axis"] = info.axis;
  out["name"] = info.name;
  out["bus"] = bus == picture.buses().end() ? "" : bus->second.info.name;
  out["node"] = info.node;
  out["drive"] = info.drive;
  out["profile"] = info.profile;
  out["joined"] = of.joined;
  out["link_state"] = name_json(of, WordKind::link_state, sample.link_state, 0);
  out["axis_state"] = state_text(of);
  out["motion_state"] = name_of(WordKind::motion_state, sample.motion_state);
  out["motion_id"] = sample.motion_id;
  out["sequence"] = sample.sequence;
  out["age_ms"] = age_json(of);
  add_values(of, out);
  out["inputs"] = inputs_json(of);
  out["mode_text"] = mode_json(of);
  out["alarms"] = alarms_json(WordKind::axis_alarm, sample.alarms, info.axis);
  out["fault"] = fault_json(picture, axis, now);
  out["capture"] = axis.capture.empty() ? Json() : Json(axis.capture);
  out["blocked_by"] = blocks_json(of);
  out["owner"] = sample.owner.empty() ? Json() : Json(sample.owner);
  out["lease_ms"] = sample.owner.empty() || sample.lease_ms == kNone ? Json() : Json(sample.lease_ms);
  out["last_result"] = result_json(of);
  out["loss_stop_ms"] = axis.sampled == 0 || sample.loss_stop_ms == kLossNotKnown ? Json() : Json(sample.loss_stop_ms);
  return out;
}

Json axis_json(const Picture& picture, const AxisPicture& axis, const Now& now) {
  const AxisInfoRecord& info = axis.info;
  Json out = axis_now_json(picture, axis, now);
  out["units_per_rev"] = static_cast<double>(info.units_numerator) / static_cast<double>(info.units_denominator);
  out["rated_speed_rpm"] = rated_json(info);
  add_abilities(info, out);
  return out;
}

}  // namespace axisgate::web
