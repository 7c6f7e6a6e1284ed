// SPDX-License-Identifier: Apache-2.0
// A drive profile as it was read, still without a configuration. docs: schemas/README.md.
// Promises that names refer to what exists and numbers fit, where load_profile() found no fault. What only a configured
// drive makes anything of (steps, conditions, writes) stays as it is written: a JsonNode that was judged.
// Never says what a configured drive does: that is the resolved model (model.hpp).
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gateway/model/model.hpp"
#include "gateway/model/scale.hpp"
#include "gateway/profile/json/json_node.hpp"

namespace axisgate::profile {

struct Constant {
  std::optional<Rational> standard;  ///< key "default"
  std::optional<Rational> min, max;
  bool required = false;
  bool from_drive = false;  ///< key "first": read from the drive at bring-up
  std::string text;
};

/// An object as one protocol has it. keya-*: `composed` is a field of the one control frame; a command is not readable.
struct Place : model::ObjectDef {
  bool unsolicited = false;  ///< keya-can: in a frame that the drive sends by itself; nothing asks for it
  bool derived = false;      ///< follows from a rule of the manual's table, not printed
};

/// An object of the drive, whatever the protocol; `slot` is the position of its motor in Profile::axes.
struct Object : model::ObjectDef {
  std::string unit;
  std::string alias_of;
  std::string whole;  ///< what it is a part of, in Profile::objects at `part.whole`
  std::string sign;   ///< the object that says its direction, at `part.sign`; empty: none
  std::map<std::string, Place, std::less<>> places;  ///< by protocol; of a part the whole's
  std::string pointer;
  /// Of its type and what is printed together.
  [[nodiscard]] Range numbers() const { return model::intersection(range(), printed); }
  /// Null: the protocol does not have it.
  [[nodiscard]] const Place* place(std::string_view protocol) const;
};

struct BitsSpec : model::BitField {
  std::string name;  ///< of their object
};

struct QuantitySpec {
  Quantity quantity{};
  std::vector<std::string> objects;  ///< the first that the protocol has
  std::vector<std::string> units;    ///< one for all motors, or one for each; empty: the object's
  std::optional<model::PollClass> poll;
  std::optional<model::Amount> min, max;
  std::vector<BitsSpec> bits;
  bool commanded = false;  ///< position_actual: what the drive has asked of its motor, not what that did
  std::string pointer;
  /// What this object counts in, where it stands for the quantity.
  [[nodiscard]] const std::string& unit_of(const Object& object) const;
};

struct Profile;

/// Register 78: the position that command set_position asks for.
struct SetPositionValue {};

/// What a write gives its object; nothing where that is no value.
using WriteValue = std::variant<std::monostate, std::int64_t, model::Amount, Quantity, SetPositionValue>;
[[nodiscard]] WriteValue value_in(const JsonNode& node);
/// "3000 rpm"; nothing where it has another form or an unknown unit.
[[nodiscard]] std::optional<model::Amount> amount_in(const JsonNode& node);
/// A condition as it is written, without its object; `values` is empty where it is compared with a constant.
[[nodiscard]] model::Condition condition_in(const JsonNode& node);
/// The conditions of a constant's rule: "if" is one, or a list of them.
[[nodiscard]] std::vector<JsonNode> conditions_of(const JsonNode& rule);
/// What {"A": 4, "B": 6} says of one axis; what is said of all of them at once.
[[nodiscard]] JsonNode of_axis(const JsonNode& node, const std::string& axis);
/// What a step or another write gives its object: of each axis, and nothing of what is no value.
[[nodiscard]] std::vector<WriteValue> values_in(const Profile& profile, const JsonNode& write);
/// Key "on": every protocol where nothing is said.
[[nodiscard]] bool is_on(const JsonNode& node, std::string_view protocol);

/// An entry of section "commands".
struct CommandEntry {
  Command command{};
  std::string protocol;  ///< empty: every one without an override
  JsonNode node;
  [[nodiscard]] const std::string& pointer() const { return node.pointer(); }
};
/// Calls `check(step)` for each write of a command, whatever the mode.
template <class Check>
void each_write(const CommandEntry& command, Check&& check) {
  const auto writes = [&](const JsonNode& owner) {
    for (const JsonNode& step : owner["steps"].elements())
      if (step.has("write")) check(step);
  };
  writes(command.node);
  for (const JsonNode& variant : command.node["variants"].elements()) writes(variant);
}

/// Stands among the fault words for the error code of the drive's newest EMCY (canopen).
inline constexpr std::string_view kEmergencyWord = "emcy";

/// How the drive itself notices a dead gateway.
struct LossSpec {
  enum class By : std::uint8_t { nothing, heartbeat_consumer, life_guarding, command_watchdog };
  By by = By::nothing;
  std::string object;  ///< what must be written so that it does; empty: nothing
  std::int64_t value = 0;
  Duration after{};
  bool stops = true;  ///< its motors then stop; false: no manual says so
  std::string text;
};

struct ProtocolSpec {
  Duration worst_reply{};
  Duration timeout{};
  LossSpec loss;
  model::RtuProperties rtu;          ///< modbus-rtu only
  model::CanopenProperties canopen;  ///< canopen only; its maps hold positions in Profile::objects
  [[nodiscard]] bool stops_by_itself() const { return loss.by != LossSpec::By::nothing; }
};

struct StateSpec {
  bool is_virtual = false;
  bool quick_stop_energised = true;
  model::Cia402Properties cia402;
  std::map<std::int16_t, std::int64_t> homing_methods;  ///< CiA 402 method -> what the drive calls it
};

/// Whose drive it is: what 1018h sub 1 to 3 may say; an empty list: anything.
struct IdentitySpec {
  static constexpr std::array<std::string_view, 3> kNames{"vendor", "product", "revision"};
  std::array<std::vector<std::uint32_t>, 3> numbers;
  /// The first of them that `found` says otherwise; none: nothing is said against it.
  [[nodiscard]] std::optional<std::size_t> other_in(const std::array<std::optional<std::uint32_t>, 4>& found) const;
};

/// A question that the profile leaves open.
struct Ask {
  std::string of;                   ///< a constant, or "/commands/save_parameters"
  std::string text, where;          ///< the question, and where such a thing stands; `where` may be empty
  std::vector<std::string> before;  ///< what must not be while it is open; empty: nothing that moves depends on it
  std::string pointer;
  /// "How many ...? (manual: ...)"
  [[nodiscard]] std::string question() const { return where.empty() ? text : text + " (" + where + ")"; }
};

/// A constant whose number nobody knows yet, and what counts by it.
struct WantedConstant {
  std::string name;
  std::string text;  ///< what it is, as the profile says
  std::vector<Quantity> quantities;
  friend bool operator==(const WantedConstant&, const WantedConstant&) = default;
};

struct Profile {
  std::string name, title;
  std::optional<IdentitySpec> identity;  ///< none: it names nobody
  bool only_simulated = false;           ///< key "tried": its numbers were never tried on the real drive
  model::Nvm nvm = model::Nvm::unknown;  ///< of objects that do not say it, and of those that are not listed
  std::vector<std::string> axes;         ///< "A", "B": one for each motor
  std::map<std::string, Constant, std::less<>> constants;
  std::map<std::string, model::Unit, std::less<>> units;
  std::map<std::string, ProtocolSpec, std::less<>> protocols;
  std::vector<Object> objects;
  std::vector<QuantitySpec> quantities;
  StateSpec state;
  std::map<std::int16_t, std::int64_t> modes;
  std::vector<CommandEntry> commands;
  std::vector<model::AlarmRow> alarms;
  std::vector<Ask> asks;
  std::shared_ptr<const nlohmann::json> document;  ///< null: nothing was read

  /// As it is written, for what only a configured drive decides.
  [[nodiscard]] JsonNode section(std::string_view key) const;
  /// The object that `name` means for this motor: its own ("A.speed") before the drive's ("speed"). Of kNoAxis: the one
  /// of exactly this name.
  [[nodiscard]] const Object* find(std::string_view object, AxisSlot motor) const;
  [[nodiscard]] const QuantitySpec* find(Quantity quantity) const;
  /// Those of `asks` that nobody has answered, with these constants of a configuration.
  [[nodiscard]] std::vector<Ask> open_asks(const std::map<std::string, Rational>& configured) const;
  /// Constants that are required, or that quantities count by which this protocol has, and that neither this profile
  /// nor the drive nor these constants of a configuration give.
  [[nodiscard]] std::vector<WantedConstant> wanted(std::string_view protocol,
                                                   const std::map<std::string, Rational>& configured) const;
  /// Motors that are enabled, stopped and reset as one, in the order of `axes`.
  [[nodiscard]] std::vector<AxisSlot> shared() const;
  /// The names under "alarms": objects, or kEmergencyWord.
  [[nodiscard]] std::vector<std::string> fault_words() const { return section("alarms").names("words"); }
  /// On this protocol the drive says by EMCY what has failed, and the profile goes by that.
  [[nodiscard]] bool has_emergency_word(std::string_view protocol) const;
};

}  // namespace axisgate::profile
