// SPDX-License-Identifier: Apache-2.0
// A drive profile as it was read: typed, named, still without a configuration. docs: schemas/README.md.
// Promises that names refer to what exists and numbers fit, where load_profile() found no fault.
// Never holds JSON, and never says what a configured drive does: that is the resolved model (model.hpp).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gateway/model/model.hpp"
#include "gateway/model/scale.hpp"

namespace axisgate::profile {

struct Constant {
  /// Under "first": the product that the constant is, if its condition holds. Names are objects or other constants.
  struct Rule {
    bool conditional = false;
    bool equal = true;
    model::Factor left, right;
    std::vector<model::Factor> mul, div;
  };
  std::optional<Rational> standard;  ///< key "default"
  std::optional<Rational> min, max;
  bool required = false;
  bool from_drive = false;  ///< key "first": read from the drive at bring-up
  std::vector<Rule> rules;
  std::string text;
};

struct DataType {
  std::uint8_t size = 2;
  bool is_signed = false;
  friend bool operator==(const DataType&, const DataType&) = default;
};

/// Where an object is found on one protocol.
struct Place {
  ObjectAddress address;
  bool write_only = false;   ///< keya-*: a command, which no query tells
  bool composed = false;     ///< keya-rs232, keya-rs485: a field of the one control frame
  bool turns_on = false;     ///< of those: says that its motor is to be on
  bool unsolicited = false;  ///< keya-can: in a frame that the drive sends by itself; nothing asks for it
  std::optional<DataType> type;
  bool derived = false;  ///< follows from a rule of the manual's table, not printed
};

struct Object {
  std::string name;
  AxisSlot slot = kNoAxis;  ///< position of its motor in Profile::axes
  DataType type;
  bool readable = true;
  bool writable = false;
  bool trigger = false;
  bool any_width = false;  ///< canopen: read as wide as the drive answers
  bool mailbox_reads_only = false;
  model::Nvm nvm = model::Nvm::no;
  std::string unit;
  std::optional<Range> range;  ///< raw
  std::string alias_of;
  std::map<std::string, Place, std::less<>> places;  ///< by protocol
  std::string pointer;
  [[nodiscard]] Range numbers() const;  ///< of its type and range together
  [[nodiscard]] DataType type_at(const Place& place) const { return place.type.value_or(type); }
  /// Null: the protocol does not have it.
  [[nodiscard]] const Place* place(std::string_view protocol) const;
};

struct BitsSpec {
  std::string object;
  std::uint8_t from = 0, count = 1, to = 0;
  bool inverted = false;
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

struct ConditionSpec {
  std::string object;
  std::uint32_t mask = 0;
  model::Condition::Test test{};
  std::vector<std::int64_t> values;
  /// Checks: compared with this constant of the configuration, times so many; empty: with `values`.
  std::string constant;
  std::int64_t times = 1;
};

/// Register 78: the position that command set_position asks for.
struct SetPositionValue {};

using ValueSpec = std::variant<std::int64_t, model::Amount, Quantity, SetPositionValue>;

struct StepSpec {
  model::Step::Verb verb{};
  std::string object;
  std::vector<ValueSpec> values;  ///< of a write: one for all axes, or one for each
  ConditionSpec until;
  Duration limit{};
  bool optional = false;
  Errc otherwise = Errc::state_unsuitable;
  std::string pointer;
};

struct CommandSpec {
  struct Variant {
    std::vector<std::int16_t> modes;
    std::vector<StepSpec> steps;
  };
  Command command{};
  std::string protocol;  ///< empty: every one without an override
  std::vector<Variant> variants;
  std::vector<StepSpec> steps;
  bool quick_stop_otherwise = false;
  bool zero_only = false;
  bool repeat_on_change = false;
  bool as_absolute = false;  ///< move_relative: the gateway carries it out as an absolute move
  std::string pointer;
};

struct WriteSpec {
  std::string object;
  std::vector<ValueSpec> values;
  std::vector<std::int64_t> instead_of;  ///< setup: only where the object holds one of these; empty: always
  std::vector<std::string> on;           ///< protocols; empty: all
  std::string why;
  std::string pointer;
  [[nodiscard]] bool is_on(std::string_view protocol) const;
};

struct CheckSpec {
  std::string name;
  ConditionSpec bad;
  AxisAlarm alarm{};
  std::string text;
  std::vector<WriteSpec> remedy;
  std::string pointer;
};

struct AlarmSpec {
  std::uint8_t word = 0;
  std::optional<std::uint8_t> bit;
  std::optional<std::uint32_t> value;
  std::uint16_t code = 0;
  std::string text, remedy;
};

/// A read that may stand as a resynchronisation read.
struct ResyncSpec {
  std::string name;                  ///< an object
  std::vector<std::uint8_t> counts;  ///< modbus-rtu: registers
};

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

struct CanopenSpec {
  struct Tpdo {
    std::uint8_t number = 1;
    std::vector<std::string> map;  ///< full names
    std::uint8_t type = 255;
    std::optional<std::uint16_t> inhibit;  ///< as the drive counts
    Duration inhibit_time{};
    std::optional<std::uint16_t> event_ms;
  };
  Duration heartbeat{};
  Duration guard_time{};
  std::uint8_t life_factor = 3;
  std::string guard_time_object, life_factor_object;  ///< 100Ch and 100Dh; empty: not written
  Duration sync{};
  Duration boot{};
  bool sdo_block = false;
  Duration confirm{};
  std::vector<Tpdo> tpdos;
  std::vector<std::uint8_t> unused_tpdos;
};

struct ProtocolSpec {
  std::vector<ResyncSpec> resync;
  Duration worst_reply{};
  Duration timeout{};
  LossSpec loss;
  Duration heartbeat{};      ///< keya-can only: the drive sends its own so often; 0: not stated
  model::RtuProperties rtu;  ///< modbus-rtu only
  CanopenSpec canopen;       ///< canopen only
  [[nodiscard]] bool stops_by_itself() const { return loss.by != LossSpec::By::nothing; }
};

struct StateSpec {
  bool is_virtual = false;
  bool setpoint_acknowledge = true;
  std::optional<std::uint16_t> follow_bits;  ///< none: all that CiA 402 leaves to the makers
  std::vector<std::int16_t> velocity_modes;
  std::optional<Duration> velocity_lag;
  std::vector<std::string> zero_before_enable;
  std::optional<ConditionSpec> enabled, fault, moving, limit;
  std::optional<ConditionSpec> reached;
  std::int64_t within = 0;  ///< of position_actual, as the drive counts
  bool gate_only = false;
  bool quick_stop_energised = true;
};

/// A parameter that only the maker's tool can reach decides a motor's mode; the configuration says what it was set to.
struct ConfiguredModeSpec {
  std::vector<std::string> constants;  ///< one for each motor; its number is what the drive calls the mode
  std::vector<std::string> fixed_on;   ///< protocols on which the motor has this mode and no other
  std::vector<std::int16_t> only;      ///< elsewhere: modes that can be had only where they are the configured one
  bool needs_disabled = false;         ///< a mode takes effect by an enable
  [[nodiscard]] bool is_fixed_on(std::string_view protocol) const;
};

/// What is repeated for a drive that disables itself when it hears no command.
struct KeepAliveSpec {
  Duration every{};
  std::map<std::int16_t, std::string> resend;  ///< mode -> set-point object
  std::vector<std::string> on;                 ///< protocols; empty: all
  [[nodiscard]] bool is_on(std::string_view protocol) const;
};

struct HomingSpec {
  struct Need {
    std::vector<std::string> any_of;
    std::int64_t equals = 0;
  };
  std::map<std::int16_t, std::int64_t> methods;  ///< CiA 402 method -> what the drive calls it
  std::map<std::int16_t, Need> needs;
  std::optional<ConditionSpec> homed, failed, homed_at;
  std::optional<std::int16_t> in_mode;  ///< homed and failed mean that in this mode alone
};

struct Profile {
  std::string name, title;
  model::Nvm nvm = model::Nvm::unknown;  ///< of objects that do not say it, and of those that are not listed
  std::vector<std::string> axes;         ///< "A", "B": one for each motor
  std::map<std::string, Constant, std::less<>> constants;
  std::map<std::string, model::Unit, std::less<>> units;
  std::map<std::string, ProtocolSpec, std::less<>> protocols;
  std::vector<Object> objects;
  std::vector<QuantitySpec> quantities;
  StateSpec state;
  std::map<std::int16_t, std::int64_t> modes;
  std::optional<ConfiguredModeSpec> configured_mode;
  HomingSpec homing;
  std::vector<CommandSpec> commands;
  std::vector<WriteSpec> setup;
  std::vector<CheckSpec> checks;
  std::vector<std::string> fault_words;
  std::vector<AlarmSpec> alarms;
  std::optional<KeepAliveSpec> keepalive;

  /// The object that `name` means for this motor: its own ("A.speed") before the drive's ("speed").
  [[nodiscard]] const Object* find(std::string_view object, AxisSlot motor) const;
  /// The object of exactly this name.
  [[nodiscard]] const Object* named(std::string_view object) const;
  [[nodiscard]] const QuantitySpec* find(Quantity quantity) const;
};

}  // namespace axisgate::profile
