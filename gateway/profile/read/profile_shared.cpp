// SPDX-License-Identifier: Apache-2.0
// Key "shared", and what it has to say: motors whose commands write one and the same object are not two axes of their
// own.
#include <algorithm>
#include <set>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {
namespace {

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
      if (other.axis != slot && meet(command, *other.command) && one_place(*mine.object, *other.object))
        judge(other, mine);
    written_.push_back(mine);
  }

  /// On one protocol both may be carried out.
  static bool meet(const CommandEntry& a, const CommandEntry& b) {
    return a.protocol.empty() || b.protocol.empty() || a.protocol == b.protocol;
  }
  static bool one_place(const Object& a, const Object& b) { return &a == &b || are_aliases(a, b); }

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
    const bool target = quantity.quantity == Quantity::target_position ||
                        quantity.quantity == Quantity::target_velocity || quantity.quantity == Quantity::target_torque;
    if (!mode && !target) return;
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
