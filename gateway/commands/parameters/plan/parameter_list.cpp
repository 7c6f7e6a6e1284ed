// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/parameters/plan/parameter_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "gateway/drive/plan/planner.hpp"
#include "gateway/profile/make/profile_text.hpp"

namespace axisgate::commands {
namespace {

using model::ObjectId;

// CiA 301: the communication profile area. CiA 402: what one axis has, and the next one 800h above.
constexpr unsigned kCommunicationFirst = 0x1000, kCommunicationLast = 0x1FFF;
constexpr unsigned kStandardFirst = 0x6000, kStandardLast = 0x9FFF, kNextAxis = 0x800;

struct Never {
  std::string_view why{};
  bool changes_itself = false;
};

constexpr Never kOperation{"it is commanded in operation", true};
constexpr Never kCommunication{"communication: the gateway sets it, or a switch at the drive", true};
constexpr Never kAtStart{"the gateway sets it at each start", true};
constexpr Never kStarts{"writing it starts something"};
constexpr Never kMoves{"it is another name of something that moves or enables"};
constexpr Never kNamedLine{"by its name it could lose the drive on its line"};
constexpr Never kNamedCommand{"by its name it could be a command"};
constexpr Never kNameless{"nobody knows what it does"};
constexpr Never kProcess{"the EDS lets it be sent as process data: it could be a target"};

bool has_any(std::string_view name, std::initializer_list<std::string_view> words) {
  std::string small(name);
  std::ranges::transform(small, small.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return std::ranges::any_of(words, [&](std::string_view word) { return small.find(word) != std::string::npos; });
}

bool names_the_line(std::string_view name) {
  return has_any(name,
                 {"node",    "baud",   "bitrate", "bit rate", "bit_rate", "bit-rate",      "station",  "slave",
                  "address", "can id", "can_id",  "can-id",   "cob",      "parity",        "stop bit", "rs232",
                  "rs485",   "rs-232", "rs-485",  "modbus",   "ethernet", "communication", "protocol", "password"});
}

bool names_a_command(std::string_view name) {
  return has_any(
      name,
      {"command",  "control word", "controlword", "control_word", "target", "demand", "set point", "set-point",
       "setpoint", "set value",    "set_point",   "jog",          "start",  "run",    "enable",    "reset",
       "restore",  "default",      "factory",     "store",        "save",   "boot",   "firmware",  "program",
       "trigger",  "execute",      "tuning",      "calibrat",     "test",   "brake",  "output",    "modes of operation",
       "mode of ", "simul",        "forc"});
}

/// Of a profile, whose other objects are known: what switches or starts, and is no command of its own; and targets of
/// a mode that this configuration does not use.
bool names_an_act(std::string_view name) {
  return has_any(name, {"target", "new_position", "command", "controlword", "control_word", "jog", "tuning", "trigger",
                        "calibrat", "brake", "output_control", "output_level", "forced_enable", "simulated"});
}

/// CiA 402: controlword, modes, targets, offsets and set-points of all modes, outputs, touch probes.
bool is_motion_402(unsigned of_first_axis) {
  constexpr std::array kMotion{0x6040U, 0x6042U, 0x6060U, 0x6071U, 0x607AU, 0x60B0U,
                               0x60B1U, 0x60B2U, 0x60B8U, 0x60C1U, 0x60FEU, 0x60FFU};
  return std::ranges::find(kMotion, of_first_axis) != kMotion.end();
}

bool is_standard(unsigned index) { return index >= kStandardFirst && index <= kStandardLast; }

Never by_address(const model::DriveModel& model, unsigned index) {
  if (!takes_eds(model)) return {};
  if (index >= kCommunicationFirst && index <= kCommunicationLast) return kCommunication;
  if (is_standard(index) && is_motion_402(kStandardFirst + (index - kStandardFirst) % kNextAxis)) return kOperation;
  return {};
}

bool writes(const model::Steps& steps, ObjectId id) {
  return std::ranges::any_of(
      steps, [&](const model::Step& step) { return step.verb == model::Step::Verb::write && step.object == id; });
}

bool commands_it(const model::AxisModel& axis, ObjectId id) {
  if (id == axis.controlword || id == axis.mode) return true;
  if (std::ranges::find(axis.zero_before_enable, id) != axis.zero_before_enable.end()) return true;
  if (std::ranges::any_of(axis.keep_alive, [&](const auto& each) { return each.second == id; })) return true;
  if (std::ranges::any_of(axis.bindings, [&](const model::Binding& binding) {
        return binding.object == id && binding.writable && drive::is_target(binding.quantity);
      }))
    return true;
  return std::ranges::any_of(axis.commands, [&](const auto& def) {
    return def && (writes(def->steps, id) ||
                   std::ranges::any_of(def->variants, [&](const auto& variant) { return writes(variant.steps, id); }));
  });
}

bool gateway_sets(const model::DriveModel& model, ObjectId id) {
  return std::ranges::any_of(model.setup, [&](const model::ObjectWrite& write) { return write.object == id; }) ||
         std::ranges::find(model.loss_objects, id) != model.loss_objects.end();
}

Never never_of(const model::DriveModel& model, ObjectId id) {
  const model::ObjectDef& object = model.object(id);
  const auto commanded = [&](ObjectId each) {
    return std::ranges::any_of(model.axes, [&](const auto& axis) { return commands_it(axis, each); });
  };
  if (commanded(id) || std::ranges::any_of(object.aliases, commanded)) return kOperation;
  if (object.composed || object.turns_on) return kOperation;
  if (object.trigger) return kStarts;
  if (object.mailbox_reads_only) return kMoves;
  if (gateway_sets(model, id)) return kAtStart;
  if (const Never never = by_address(model, object.address.index); !never.why.empty()) return never;
  if (names_an_act(object.name)) return kNamedCommand;
  if (object.name.starts_with("register_")) return kNameless;
  return names_the_line(object.name) ? kNamedLine : Never{};
}

Never never_of(const model::DriveModel& model, ObjectAddress address, const profile::EdsObject& object) {
  if (const Never never = by_address(model, address.index); !never.why.empty()) return never;
  if (names_the_line(object.name)) return kNamedLine;
  if (names_a_command(object.name)) return kNamedCommand;
  return object.mappable || object.access == "rww" ? kProcess : Never{};
}

void add(std::map<ObjectAddress, Parameter>& out, model::ObjectDef object, const Never& never) {
  const ObjectAddress at = object.address;
  out.try_emplace(at, Parameter{std::move(object), std::string(never.why), never.changes_itself});
}

void add_profile(const model::DriveModel& model, AxisSlot slot, std::map<ObjectAddress, Parameter>& out) {
  for (std::size_t i = 0; i < model.objects.size(); ++i) {
    const auto id = static_cast<ObjectId>(i);
    const model::ObjectDef& object = model.object(id);
    const bool own = object.slot == kNoAxis || object.slot == slot;
    if (!own || !object.writable || object.emulated || object.is_part()) continue;
    const Never never = never_of(model, id);
    add(out, object, never);
    // Of several names of one place the strictest counts.
    Parameter& parameter = out.at(object.address);
    if (parameter.never.empty() && !never.why.empty()) {
      parameter.never = never.why;
      parameter.changes_itself = never.changes_itself;
    }
  }
}

/// What other axes have, and what the profile only reads, is left out.
bool is_ours(const model::DriveModel& model, AxisSlot slot, ObjectAddress address) {
  if (model.find(address) != model::kNoObject) return false;
  return !is_standard(address.index) || (address.index - kStandardFirst) / kNextAxis == slot;
}

void add_eds(const model::DriveModel& model, AxisSlot slot, const profile::Eds& eds,
             std::map<ObjectAddress, Parameter>& out) {
  for (const auto& [address, entry] : eds.objects) {
    const auto width = profile::width_of(entry.type);
    const bool writable = entry.access.find('w') != std::string::npos;
    if (!writable || !is_ours(model, slot, address)) continue;
    model::ObjectDef object;
    object.name = profile::plain_text(entry.name);
    object.address = address;
    object.writable = true;
    object.readable = width && entry.unclear.empty() && entry.access.find('r') == 0;
    object.nvm = model.nvm;
    Never never = never_of(model, address, entry);
    if (width) {
      object.size = width->size;
      object.is_signed = width->is_signed;
      object.is_real = width->is_real;
    }
    if (width && !width->is_real) {
      object.printed.min = entry.low.value_or(object.printed.min);
      object.printed.max = entry.high.value_or(object.printed.max);
    }
    if (!entry.unclear.empty()) never = {"the EDS is not clear about it"};
    if (!width) never = {"a text or a long number, which is not carried over"};
    add(out, std::move(object), never);
  }
}

}  // namespace

bool takes_eds(const model::DriveModel& model) { return model::is_canopen(model) || model.protocol == "kinco-serial"; }

std::vector<Parameter> parameters_of(const model::DriveModel& model, AxisSlot slot, const profile::Eds* eds) {
  std::map<ObjectAddress, Parameter> by_address;
  add_profile(model, slot, by_address);
  if (eds != nullptr) add_eds(model, slot, *eds, by_address);
  std::vector<Parameter> out;
  for (auto& [address, parameter] : by_address) out.push_back(std::move(parameter));
  return out;
}

}  // namespace axisgate::commands
