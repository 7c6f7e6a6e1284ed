// SPDX-License-Identifier: Apache-2.0
// What no section may do by itself: enable or turn a motor that nobody has commanded. Nor two axes that are not said to
// be shared: motors whose commands write one and the same object are not two axes of their own.
#include <algorithm>
#include <array>
#include <set>

#include "gateway/model/cia402.hpp"
#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

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
  for (const QuantitySpec& spec : profile.quantities)
    if (is_target(spec.quantity) || spec.quantity == Quantity::mode)
      out.insert(out.end(), spec.objects.begin(), spec.objects.end());
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

/// One write of one command, as an axis means it.
struct OneWrite {
  const CommandEntry* command = nullptr;
  JsonNode step;
  AxisSlot axis = 0;
  const Object* object = nullptr;
  /// None: not one number, but what a client asks for.
  std::optional<std::int64_t> number{};
};

class Sharing {
 public:
  explicit Sharing(Reading& reading)
      : reading_(reading), profile_(reading.profile), shared_(reading.profile.shared()) {}

  void run() {
    for (std::size_t slot = 0; slot < profile_.axes.size(); ++slot)
      for (const CommandEntry& command : profile_.commands)
        if (command.command != Command::save_parameters)
          each_write(command, [&](const JsonNode& step) { look(command, step, static_cast<AxisSlot>(slot)); });
    for (const QuantitySpec& quantity : profile_.quantities) check_quantity(quantity);
  }

 private:
  void look(const CommandEntry& command, const JsonNode& step, AxisSlot slot) {
    const OneWrite mine{&command, step, slot, profile_.find(step.text("write"), slot),
                        of_axis(step["value"], profile_.axes[slot]).whole()};
    if (mine.object == nullptr || !step.has("value")) return;
    for (const OneWrite& other : written_)
      if (other.axis != slot && meet(command, *other.command) &&
          (mine.object == other.object || are_aliases(*mine.object, *other.object)))
        judge(other, mine);
    written_.push_back(mine);
  }

  /// On one protocol both may be carried out.
  static bool meet(const CommandEntry& a, const CommandEntry& b) {
    return a.protocol.empty() || b.protocol.empty() || a.protocol == b.protocol;
  }

  void judge(const OneWrite& one, const OneWrite& other) {
    const bool alike = !one.number || !other.number || *one.number == *other.number;
    // A register of commands, of which each names its motor.
    if (other.object->trigger && !alike) return;
    if (!shares(one.axis, other.axis)) {
      if (!told_.insert(other.object->name).second) return;
      return reading_.fault(
          other.step.pointer("write"),
          "{} of axis {} writes object \"{}\", as {} of axis {} does: what one motor is told, the other is told as "
          "well. Name an object of each axis, or say \"shared\": [\"{}\", \"{}\"], and the two are enabled, stopped "
          "and reset as one",
          text(other.command->command), profile_.axes[other.axis], other.object->name, text(one.command->command),
          profile_.axes[one.axis], profile_.axes[one.axis], profile_.axes[other.axis]);
    }
    const bool start = needs_ready(one.command->command) && needs_ready(other.command->command) && alike &&
                       one.number &&
                       (other.object->trigger || is_of(reading_, other.step.text("write"), Quantity::controlword));
    if (!start || held_by_enable(other) || !told_.insert(other.command->pointer()).second) return;
    reading_.fault(other.step.pointer(),
                   "{} of axis {} writes {} to object \"{}\", as {} of axis {} does: it starts both motors, and only "
                   "one was asked to. Take the command out with null, or write what starts one motor alone",
                   text(other.command->command), profile_.axes[other.axis], *other.number, other.object->name,
                   text(one.command->command), profile_.axes[one.axis]);
  }

  /// The number that keeps the axes enabled starts nothing.
  [[nodiscard]] bool held_by_enable(const OneWrite& start) const {
    return std::ranges::any_of(written_, [&](const OneWrite& each) {
      return each.command->command == Command::enable && each.object == start.object && each.number == start.number;
    });
  }

  /// A mode is written by the gateway itself, and so are set-points.
  void check_quantity(const QuantitySpec& quantity) {
    const bool mode = quantity.quantity == Quantity::mode;
    if (!mode && !is_target(quantity.quantity)) return;
    for (std::size_t a = 0; a < profile_.axes.size(); ++a)
      for (std::size_t b = a + 1; b < profile_.axes.size(); ++b) {
        const auto one = static_cast<AxisSlot>(a), other = static_cast<AxisSlot>(b);
        if (!have_one_object(quantity, one, other) || (mode && shares(one, other))) continue;
        reading_.fault(quantity.pointer, "axes {} and {} have one object for their {}: {}", profile_.axes[a],
                       profile_.axes[b], row(quantity.quantity).name,
                       mode ? "name an object of each, or say \"shared\"" : "one would move with the other");
        return;
      }
  }
  [[nodiscard]] bool have_one_object(const QuantitySpec& quantity, AxisSlot one, AxisSlot other) const {
    return std::ranges::any_of(quantity.objects, [&](const std::string& name) {
      const Object* object = profile_.find(name, one);
      return object != nullptr && object == profile_.find(name, other);
    });
  }

  [[nodiscard]] bool shares(AxisSlot one, AxisSlot other) const {
    const auto is_shared = [&](AxisSlot slot) { return std::ranges::find(shared_, slot) != shared_.end(); };
    return is_shared(one) && is_shared(other);
  }

  Reading& reading_;
  const Profile& profile_;
  const std::vector<AxisSlot> shared_;
  std::vector<OneWrite> written_;
  std::set<std::string> told_;
};

}  // namespace

bool is_of(const Reading& reading, const std::string& object, Quantity quantity) {
  const QuantitySpec* spec = reading.profile.find(quantity);
  return spec != nullptr && std::ranges::any_of(spec->objects, [&](const std::string& own) {
           return share_an_object(reading, object, own);
         });
}

void check_writes(Reading& reading, const CommandEntry& command) {
  const bool halt = command.command == Command::halt, enable = command.command == Command::enable;
  const bool rests = !may_move(command.command), cia402 = !reading.profile.state.is_virtual;
  const auto goes_on = [](const WriteValue& value) {
    const auto* number = number_in(value);
    return may_enable(value) && (number == nullptr || (*number & model::controlword::kHalt) == 0);
  };
  const auto begins = [&](const WriteValue& value) {
    const auto* number = number_in(value);
    const bool fits = number != nullptr && *number >= 0 && *number <= UINT16_MAX;  // else it is told already
    const std::uint32_t starts = model::controlword::kStart | reading.profile.state.cia402.follow_bits;
    return number == nullptr || (fits && (*number & starts) != 0);
  };
  const auto is_zero = [](const WriteValue& value) { return is_number(value, 0); };
  const auto is_here = [](const WriteValue& value) {
    const auto* quantity = std::get_if<Quantity>(&value);
    return quantity != nullptr && *quantity == Quantity::position_actual;
  };
  each_write(command, [&](const JsonNode& step) {
    const std::vector<WriteValue> values = values_in(reading.profile, step);
    const auto is = [&](Quantity quantity) { return is_of(reading, step.text("write"), quantity); };
    const auto has = [&](auto wrong) { return std::ranges::any_of(values, wrong); };
    const auto refuse = [&](bool wrong, const char* key, const char* why) {
      if (wrong) reading.fault(step.pointer(key), why);
    };
    const bool word = is(Quantity::controlword), mode = cia402 && is(Quantity::mode);
    const bool position = is(Quantity::target_position), velocity = is(Quantity::target_velocity),
               torque = is(Quantity::target_torque);
    refuse(rests && !halt && word && has(may_enable), "value",
           "would enable the motor: bits 0 to 3 of the controlword must not all be 1 in this command");
    refuse(halt && word && has(goes_on), "value",
           "lets the motor run: bits 0 to 3 of the controlword must not all be 1 without bit 8, halt");
    refuse(rests && velocity && has(is_not_zero), "value",
           "would turn the motor: target_velocity must be 0 in this command");
    refuse(rests && torque && has(is_not_zero), "value",
           "would turn the motor: target_torque must be 0 in this command");
    refuse(command.command == Command::set_position && mode, "write",
           "set_position must not change the mode: an old target could start in it. Leave this step out: the gateway "
           "goes to homing mode (6) before the first step, and back after the last");
    refuse(enable && word && has(begins), "value",
           "an enable never moves the axis: bit 4 of the controlword and those of follow_bits must be 0");
    refuse(enable && mode, "write",
           "an enable never moves the axis: a target that the drive holds could start in another mode");
    // Where one object is both, the mode tells which.
    const bool stays = (position && std::ranges::all_of(values, is_here)) ||
                       ((velocity || torque) && std::ranges::all_of(values, is_zero));
    refuse(enable && (position || velocity || torque) && !stays, "value",
           "an enable never moves the axis: a position target takes position_actual in it, any other one 0");
  });
}

// Answered as done, the motor would go on.
void check_stops(Reading& reading, const CommandEntry& command) {
  if (!is_stop(command.command)) return;
  const bool by_word = command.command != Command::halt && !reading.profile.state.is_virtual;
  const auto stops = [](const WriteValue& value) {
    const auto* number = number_in(value);
    return number != nullptr && is_stop(static_cast<std::uint16_t>(*number), true);
  };
  const auto is_stopping = [&](const JsonNode& step) {
    return is_of(reading, step.text("write"), Quantity::controlword) &&
           std::ranges::all_of(values_in(reading.profile, step), stops);
  };
  const auto check = [&](const JsonNode& owner) {
    const std::vector<JsonNode> steps = owner["steps"].elements();
    if (std::ranges::none_of(steps, [](const JsonNode& step) { return step.has("write"); }))
      reading.fault(owner.pointer("steps"), "write nothing, so they stop nothing");
    else if (by_word && std::ranges::none_of(steps, is_stopping))
      reading.fault(owner.pointer("steps"),
                    "write no controlword that stops: bit 1 or bit 2 must be 0, or bits 0 to 3 be 6 or 7");
  };
  if (command.node.has("steps")) check(command.node);
  for (const JsonNode& variant : command.node["variants"].elements()) check(variant);
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

void check_shared(Reading& reading) {
  const JsonNode node = reading.document["shared"];
  for (const std::string& name : reading.document.names("shared"))
    if (const auto& axes = reading.profile.axes; std::ranges::find(axes, name) == axes.end())
      reading.fault(node.pointer(), "\"{}\" is no axis of this drive: not under /axes", name);
  const bool alone = node.is_array() && reading.profile.shared().size() < 2;
  if (alone)
    reading.fault(node.pointer(), "names the motors that are enabled and stopped as one: at least two");
  else
    Sharing(reading).run();
}

}  // namespace axisgate::profile
