// SPDX-License-Identifier: Apache-2.0
// What no section may do by itself: enable or turn a motor that nobody has commanded.
#include <algorithm>
#include <array>

#include "gateway/model/cia402.hpp"
#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

constexpr std::array kChosenByClients{Quantity::mode, Quantity::target_position, Quantity::target_velocity,
                                      Quantity::target_torque};

/// Commands after which a motor may turn, or holds torque.
bool may_move(Command command) {
  return !is_stop(command) && command != Command::fault_reset && command != Command::save_parameters;
}

/// Nor does set_position, although the axis holds torque in it.
bool moves_nothing(Command command) { return !may_move(command) || command == Command::set_position; }

/// The number that is written; null: it is none, or not known beforehand.
const std::int64_t* number_in(const WriteValue& value) { return std::get_if<std::int64_t>(&value); }

bool is_number(const WriteValue& value, std::int64_t number) {
  const auto* its = number_in(value);
  return its != nullptr && *its == number;
}

bool share_an_object(const Reading& reading, const std::string& left, const std::string& right) {
  bool found = false;
  reading.each_meaning(left, [&](const Object& a) {
    reading.each_meaning(right, [&](const Object& b) { found = found || a.name == b.name || are_aliases(a, b); });
  });
  return found;
}

/// What enables, moves or is followed by a motor, the controlword apart: its numbers tell.
std::vector<std::string> moving_objects(const Reading& reading) {
  const Profile& profile = reading.profile;
  std::vector<std::string> out = reading.document["state"].names("zero_before_enable");
  for (const Quantity quantity : kChosenByClients)
    if (const QuantitySpec* spec = profile.find(quantity); spec != nullptr)
      out.insert(out.end(), spec->objects.begin(), spec->objects.end());
  for (const CommandEntry& command : profile.commands)
    if (may_move(command.command))
      each_write(command, [&](const JsonNode& step) {
        if (!is_of(reading, step.text("write"), Quantity::controlword)) out.push_back(step.text("write"));
      });
  return out;
}

bool may_enable(const WriteValue& value) {
  const auto* number = number_in(value);
  return number == nullptr || model::enables(*number);
}

bool is_not_zero(const WriteValue& value) {
  if (const auto* number = number_in(value)) return *number != 0;
  const auto* amount = std::get_if<model::Amount>(&value);
  return amount != nullptr && amount->number != model::Factor(Rational(0));
}

void check_write(Reading& reading, const std::vector<std::string>& moving, const JsonNode& write) {
  const std::string object = write.text("write");
  if (is_of(reading, object, Quantity::controlword)) {
    if (std::ranges::any_of(values_in(reading.profile, write), may_enable))
      reading.fault(write.pointer("value"),
                    "would enable the motor, and only a command may: bits 0 to 3 of the controlword must not all be 1");
    return;
  }
  if (std::ranges::any_of(moving, [&](const std::string& name) { return share_an_object(reading, object, name); }))
    reading.fault(write.pointer("write"), "object \"{}\" may enable or move the motor: only a command may write it",
                  object);
}

}  // namespace

bool is_of(const Reading& reading, const std::string& object, Quantity quantity) {
  const QuantitySpec* spec = reading.profile.find(quantity);
  return spec != nullptr && std::ranges::any_of(spec->objects, [&](const std::string& own) {
           return share_an_object(reading, object, own);
         });
}

void check_never_enables(Reading& reading, const CommandEntry& command) {
  if (may_move(command.command)) return;
  each_write(command, [&](const JsonNode& step) {
    if (!is_of(reading, step.text("write"), Quantity::controlword)) return;
    const auto wrong = [&](const WriteValue& value) {
      const auto* number = number_in(value);
      const bool halts = number != nullptr && (*number & model::controlword::kHalt) != 0;
      return may_enable(value) && !(command.command == Command::halt && halts);
    };
    if (std::ranges::any_of(values_in(reading.profile, step), wrong))
      reading.fault(step.pointer("value"),
                    command.command == Command::halt
                        ? "lets the motor run: bits 0 to 3 of the controlword must not all be 1 without bit 8, halt"
                        : "would enable the motor: bits 0 to 3 of the controlword must not all be 1 in this command");
  });
}

void check_enable_starts_nothing(Reading& reading, const CommandEntry& command) {
  if (command.command != Command::enable) return;
  const std::uint32_t starts = model::controlword::kStart | reading.profile.state.cia402.follow_bits;
  const auto begins = [&](const WriteValue& value) {
    const auto* number = number_in(value);
    const bool fits = number != nullptr && *number >= 0 && *number <= UINT16_MAX;  // else it is told already
    return number == nullptr || (fits && (*number & starts) != 0);
  };
  const auto is_zero = [](const WriteValue& value) { return is_number(value, 0); };
  const auto is_here = [](const WriteValue& value) {
    const auto* quantity = std::get_if<Quantity>(&value);
    return quantity != nullptr && *quantity == Quantity::position_actual;
  };
  each_write(command, [&](const JsonNode& step) {
    const std::string object = step.text("write");
    const std::vector<WriteValue> values = values_in(reading.profile, step);
    if (is_of(reading, object, Quantity::controlword) && std::ranges::any_of(values, begins))
      reading.fault(step.pointer("value"),
                    "an enable never moves the axis: bit 4 of the controlword and those of follow_bits must be 0");
    if (is_of(reading, object, Quantity::mode) && !reading.profile.state.is_virtual)
      reading.fault(step.pointer("write"),
                    "an enable never moves the axis: a target that the drive holds could start in another mode");
    const bool position = is_of(reading, object, Quantity::target_position);
    const bool rate =
        is_of(reading, object, Quantity::target_velocity) || is_of(reading, object, Quantity::target_torque);
    // Where one object is both, the mode tells which.
    const bool stays =
        (position && std::ranges::all_of(values, is_here)) || (rate && std::ranges::all_of(values, is_zero));
    if ((position || rate) && !stays)
      reading.fault(step.pointer("value"),
                    "an enable never moves the axis: a position target takes position_actual in it, any other one 0");
  });
}

void check_stops_by_word(Reading& reading, const CommandEntry& command, const JsonNode& owner) {
  const bool by_word = command.command == Command::quick_stop || command.command == Command::disable;
  if (!by_word || reading.profile.state.is_virtual) return;
  const auto stops = [](const WriteValue& value) {
    const auto* number = number_in(value);
    return number != nullptr && is_stop(static_cast<std::uint16_t>(*number), true);
  };
  const auto is_stopping = [&](const JsonNode& step) {
    return is_of(reading, step.text("write"), Quantity::controlword) &&
           std::ranges::all_of(values_in(reading.profile, step), stops);
  };
  if (std::ranges::none_of(owner["steps"].elements(), is_stopping))
    reading.fault(owner.pointer("steps"),
                  "write no controlword that stops: bit 1 or bit 2 must be 0, or bits 0 to 3 be 6 or 7");
}

void check_turns_nothing(Reading& reading, const CommandEntry& command) {
  if (may_move(command.command)) return;
  each_write(command, [&](const JsonNode& step) {
    if (std::ranges::none_of(values_in(reading.profile, step), is_not_zero)) return;
    for (const Quantity target : {Quantity::target_velocity, Quantity::target_torque})
      if (is_of(reading, step.text("write"), target))
        reading.fault(step.pointer("value"), "would turn the motor: {} must be 0 in this command", row(target).name);
  });
}

// Of a drive with a state machine of its own nothing else tells what a number does.
void check_stops_start_nothing(Reading& reading) {
  if (!reading.profile.state.is_virtual) return;
  const std::vector<CommandEntry>& commands = reading.profile.commands;
  const auto writes_it = [&](const CommandEntry& command, const std::string& object, std::int64_t number) {
    bool found = false;
    const auto is_it = [number](const WriteValue& value) { return is_number(value, number); };
    each_write(command, [&](const JsonNode& step) {
      found = found || (share_an_object(reading, object, step.text("write")) &&
                        std::ranges::any_of(values_in(reading.profile, step), is_it));
    });
    return found;
  };
  const auto check = [&](const JsonNode& step) {
    for (const WriteValue& value : values_in(reading.profile, step)) {
      const auto* number = number_in(value);
      if (number == nullptr || *number == 0) continue;
      const auto mover = std::ranges::find_if(commands, [&](const CommandEntry& command) {
        return !moves_nothing(command.command) && writes_it(command, step.text("write"), *number);
      });
      if (mover != commands.end())
        reading.fault(step.pointer("value"), "is what enables or moves the motor in {}: give the one that does not",
                      mover->pointer());
    }
  };
  for (const CommandEntry& command : commands)
    if (moves_nothing(command.command)) each_write(command, check);
}

void check_unsolicited_writes(Reading& reading) {
  const std::vector<std::string> moving = moving_objects(reading);
  for (const JsonNode& write : reading.document["setup"].elements()) check_write(reading, moving, write);
  for (const JsonNode& check : reading.document["checks"].elements())
    for (const JsonNode& write : check["remedy"].elements()) check_write(reading, moving, write);
}

}  // namespace axisgate::profile
