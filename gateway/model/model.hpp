// SPDX-License-Identifier: Apache-2.0
// The model of one configured drive: its profile, resolved for the protocol it is spoken to with and for its axes'
// units. Promises that everything in it was checked when the gateway started: addresses exist, ids are in range,
// factors are exact. Never changes after that, and holds no state of the drive.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/numbers.hpp"
#include "gateway/core/rational.hpp"
#include "gateway/image/axis_image.hpp"
#include "gateway/image/capabilities.hpp"
#include "gateway/image/command.hpp"
#include "gateway/image/lease.hpp"
#include "gateway/model/cia402.hpp"
#include "gateway/model/drive_constant.hpp"
#include "gateway/model/object_def.hpp"
#include "gateway/model/watch_rules.hpp"

namespace axisgate::model {

inline constexpr std::size_t kMaxSteps = 16;

/// Poll classes of design section 5: 20, 100, 1000 ms by default, and once at bring-up (and after each write of it).
enum class PollClass : std::uint8_t { fast, normal, slow, once };

/// A field of bits of an object, put somewhere in a composed quantity (digital_inputs, vendor_error).
struct BitField {
  ObjectId object = kNoObject;
  std::uint8_t from = 0;
  std::uint8_t count = 1;
  std::uint8_t to = 0;
  bool inverted = false;
};

/// How one quantity of one axis is had from, and written to, this drive.
struct Binding {
  Quantity quantity{};
  ObjectId object = kNoObject;  ///< kNoObject where the quantity is composed of bits
  std::vector<BitField> bits;
  /// raw = register value * raw_per_unit, sign of an inverted axis included.
  Rational raw_per_unit{1};
  bool is_real = false;  ///< the drive counts in REAL32: parts of its unit count too
  bool inverse = false;  ///< raw = raw_per_unit / register value: a ramp that the drive counts as a time; 0 is neither
  ScaleRecipe recipe{};
  bool scaled = true;  ///< false: `recipe` waits for the drive's constants; the quantity has no value until then
  /// Codes that the drive numbers otherwise (homing methods): register value -> what the drive calls it. Empty: as is.
  std::vector<std::pair<std::int64_t, std::int64_t>> codes{};
  PollClass poll = PollClass::normal;
  bool writable = false;
  bool limited = false;  ///< the configuration limits it
  Range limits;          ///< register units: profile, drive, width and axis limits together

  /// Exact, rounded once, half away from zero; no value where it does not fit the register (design 2).
  [[nodiscard]] std::optional<std::int64_t> to_register(std::int64_t raw) const;
  /// The same, or the bound of the register's type that it lies beyond. No value: the scale is not known yet.
  [[nodiscard]] std::optional<std::int64_t> to_register_or_bound(std::int64_t raw) const;
  /// Rounded as above, but never from within the limits to beyond them; no value where it does not fit the object.
  [[nodiscard]] std::optional<std::int64_t> to_raw(std::int64_t value, const ObjectDef& object_def) const;
};

/// ((number & mask) compared with values); mask 0 means all bits.
struct Condition {
  enum class Test : std::uint8_t { equals, not_equals, in, not_in };
  ObjectId object = kNoObject;
  std::uint32_t mask = 0;
  Test test = Test::equals;
  std::vector<std::int64_t> values;
  [[nodiscard]] bool holds(const ObjectDef& object_def, std::uint32_t raw) const;
};

/// One step of a command (profile key "commands"): at most kMaxSteps, no loops.
struct Step {
  enum class Verb : std::uint8_t {
    write,    ///< `object` = value
    wait,     ///< read `until.object` until `until` holds, at most `limit`
    require,  ///< `until` must hold on a fresh read, else the command ends with `otherwise`
  };
  enum class Source : std::uint8_t {
    literal,
    quantity,
    set_position,  ///< row 78, in the units of `quantity`
  };
  Verb verb = Verb::write;
  ObjectId object = kNoObject;
  Source source = Source::literal;
  std::int64_t literal = 0;  ///< as the drive counts
  bool joined = false;       ///< in one request with the write after it
  Quantity quantity{};       ///< Source::quantity: what the client last asked for, or position_actual
  Condition until;
  Duration limit{};
  bool optional = false;  ///< a wait that runs out is no failure
  Errc otherwise = Errc::state_unsuitable;
};
using Steps = std::vector<Step>;

/// How a command is carried out on this drive.
struct CommandDef {
  struct Variant {
    std::vector<std::int16_t> modes;  ///< in these modes (unified numbers, negative: the drive's own)
    Steps steps;
  };
  std::vector<Variant> variants;      ///< the first that names the mode in force
  Steps steps;                        ///< in every other mode
  bool quick_stop_otherwise = false;  ///< in every other mode quick_stop takes its place (halt only)
  /// set_position: only the value 0 can be had (the drive's method makes the present position 0).
  bool zero_only = false;
  /// run_velocity: a set-point written while it runs acts only if the steps are carried out once more.
  bool repeat_on_change = false;
};

struct AlarmRow {
  std::uint8_t word = 0;  ///< 0 first, 1 second fault word
  std::uint8_t bit = 0;
  std::optional<std::uint32_t> value{};  ///< active while the word has this value, whatever `bit` says
  std::uint16_t code = 0;                ///< CiA 402 603Fh
  std::string text;
  std::string remedy;
};

struct ObjectWrite {
  ObjectId object = kNoObject;
  std::int64_t raw = 0;
  std::string why;
};

/// A setup write that only takes the place of what the drive left its factory with: what somebody has set stays.
struct FactoryWrite {
  ObjectId object = kNoObject;
  std::vector<std::int64_t> instead_of;  ///< raw; at least one
  Rational amount{1};                    ///< raw = amount * recipe.fixed * product(mul) / product(div)
  ScaleRecipe recipe{};                  ///< what it waits for; `recipe.raw` is what the object takes
  std::string why;
};

/// A setting that a person must decide: read at bring-up, reported, never changed but by `axisgate commission`.
struct Check {
  std::string name;
  Condition bad;
  AxisAlarm alarm{};
  AxisSlot slot = kNoAxis;
  std::string text;  ///< what is wrong and what it means
  std::vector<ObjectWrite> remedy;
};

/// A drive that is no CiA 402 one: what the built-in machine goes by (design 2; virtual_axis.hpp).
struct VirtualProperties {
  Condition enabled;  ///< the drive holds torque
  Condition fault;
  std::optional<Condition> limit;
  /// A motion is over when this holds, having been otherwise since it was started.
  std::optional<Condition> reached;
  std::int64_t within = 0;            ///< and the position is this near to where it should end, as the drive counts
  std::optional<Condition> homed_at;  ///< and, after homing, this holds of the position
  /// The bus cannot take the torque away: the gateway keeps the gate (design 3.4).
  bool gate_only = false;
  /// Where a quick stop ends: standing energised (quick stop active), or without torque.
  bool quick_stop_energised = true;
};

/// A homing method works only if one of these objects (input functions) has this number.
struct HomingNeed {
  std::int16_t method = 0;
  std::vector<ObjectId> any_of;
  std::int64_t equals = 0;
};

/// What the configuration says of an axis, in register units (design 2).
struct AxisSettings {
  AxisNumber number = 0;
  std::string name;
  bool inverted = false;
  Rational units_per_rev{10000};
  std::int64_t standstill_velocity = 1000;  ///< 0.001 rpm
  std::optional<std::int16_t> homing_method;
  Duration homing_timeout = std::chrono::seconds(60);
  LeaseRules lease;
  WatchRules watch;
  Duration jog_timeout = std::chrono::milliseconds(500);
  friend bool operator==(const AxisSettings&, const AxisSettings&) = default;
};

struct AxisModel : Capabilities, AxisSettings {
  std::vector<AxisSlot> shares{};            ///< axes that are enabled, stopped and owned with it, and have its mode
  std::optional<std::uint32_t> rated_speed;  ///< 0.001 rpm; where the profile has a constant for it
  /// velocity_actual may still show what was before a start, a stop or an end. Too short takes what turns for standing.
  Duration velocity_lag = std::chrono::milliseconds(300);
  bool configured_torque_limit = false;
  bool position_commanded = false;  ///< position_actual is what the drive has asked of its motor: nothing to watch

  std::vector<Binding> bindings;                          ///< supported quantities, in the order of their numbers
  std::array<std::int16_t, kQuantityCount> binding_of{};  ///< position in `bindings`, -1: not supported
  ObjectId statusword = kNoObject;
  ObjectId controlword = kNoObject;
  ObjectId mode = kNoObject;
  ObjectId mode_display = kNoObject;  ///< the mode object itself where there is no display
  std::array<ObjectId, 2> fault_words{kNoObject, kNoObject};
  Cia402Properties cia402;
  std::optional<VirtualProperties> virtual_axis;  ///< statusword, controlword and mode are `emulated` objects then
  /// The statusword, or what a virtual axis makes it from; the first is what a drive that is not there is asked for.
  std::vector<ObjectId> state_sources;
  /// Unified mode -> what the drive calls it; absent: refused. In ascending order of the unified number, but that what
  /// a motor was set to by its maker's tool comes first (Keya): a virtual axis begins with the first.
  std::vector<std::pair<std::int16_t, std::int64_t>> modes;
  /// The mode can only be changed while the axis is disabled (Keya: the enable carries it, or it is a parameter).
  bool mode_needs_disabled = false;
  /// What the keep-alive sends again, by the mode in force: the set-point object that moves nothing by being repeated.
  /// A mode that is not listed has none, and its motion ends by the drive's own watchdog.
  std::vector<std::pair<std::int16_t, ObjectId>> keep_alive{};
  std::vector<std::int16_t> homing_methods;
  std::vector<HomingNeed> homing_needs;
  /// Velocity and torque set-points that must hold 0 before torque comes on, also those without a known unit.
  std::vector<ObjectId> zero_before_enable;
  std::optional<int> homed_mode{};  ///< `homed` and `homing_failed` mean that in this mode alone; none: in all
  std::optional<Condition> homed;
  std::optional<Condition> homing_failed;
  std::optional<Condition> moving;  ///< absent: velocity_actual above standstill_velocity
  std::array<std::optional<CommandDef>, kLastCommand + 1> commands;
  std::uint16_t supported_modes = 0;

  [[nodiscard]] const Binding* binding(Quantity q) const;
  /// How the drive counts positions, speeds and ramps is known: without that nothing is started.
  [[nodiscard]] bool counts_known() const;
  /// In one of the drive's own modes it follows a target velocity at once.
  [[nodiscard]] bool is_own_velocity_mode(int in_force) const;
  /// Without this object nobody can say what the axis does: its statusword, or what a virtual axis makes it from.
  [[nodiscard]] bool needs_for_state(ObjectId object) const;
  [[nodiscard]] const std::optional<CommandDef>& command(Command c) const {
    return commands[static_cast<std::size_t>(c)];
  }
};

/// A read that can stand as a resynchronisation read.
struct ResyncRead {
  ObjectId object = kNoObject;
  std::uint8_t registers = 0;  ///< Modbus RTU: so many from the object's register on; 0: the object as it is
};

/// What stands against a late reply after a timeout (design 7, point 4).
struct ResyncProperties {
  std::vector<ResyncRead> candidates;  ///< reads whose replies can be distinguished from one another
  /// Modbus RTU: the reply of a read tells its length and nothing else. Elsewhere a reply names its object.
  bool by_length = false;
  Duration worst_reply = std::chrono::milliseconds(500);
};

/// How a drive speaks Modbus RTU, and what it can read at once.
struct RtuProperties {
  bool low_word_first = true;
  std::uint8_t max_registers = 2;
  std::vector<std::pair<std::uint16_t, std::uint16_t>> runs;  ///< first and last register of ranges without holes
  std::vector<std::uint8_t> error_functions;  ///< bytes that mean an error although they are not function + 0x80
  std::optional<std::uint8_t> broadcast;
  Duration answer{};  ///< how long the drive waits before it answers
};

/// A TPDO as the gateway maps it (CiA 301 section 7.5.2.37); its COB-ID is the predefined one.
struct TpdoProperties {
  std::uint8_t number = 1;                  ///< 1 to 4: 1800h/1A00h + number - 1
  std::vector<ObjectId> map;                ///< 8 bytes at most; what the drive refuses to map is polled
  std::uint8_t type = 255;                  ///< transmission type, sub 2
  std::optional<std::uint16_t> inhibit{};   ///< sub 3, as this drive counts; none: left alone
  Duration inhibit_time{};                  ///< what `inhibit` comes to; 0: nothing keeps it from coming at each change
  std::optional<std::uint16_t> event_ms{};  ///< sub 5; none: the drive is not said to have one
};

/// How a drive speaks CANopen.
struct CanopenProperties {
  Duration heartbeat{};   ///< the drive sends one so often (1017h is in the setup list); 0: it is guarded instead
  Duration guard_time{};  ///< node guarding by the gateway; 0: none
  std::uint8_t life_factor = 3;
  Duration own_heartbeat{};  ///< the gateway's, so that the drive notices its death (1016h, in the setup list); 0: none
  Duration sync{};           ///< SYNC is produced so often; 0: this drive needs none
  Duration boot{};           ///< from reset to boot-up, at most
  bool sdo_block = false;    ///< its server offers block transfer
  std::vector<TpdoProperties> tpdos;
  std::vector<std::uint8_t> unused_tpdos;              ///< switched off at bring-up
  Duration confirm = std::chrono::milliseconds(1000);  ///< a mapped value is read by SDO when it was silent so long
  /// 1018h sub 1 to 4 as the configuration has them: vendor, product, revision, serial.
  std::array<std::optional<std::uint32_t>, 4> identity{};
  [[nodiscard]] bool identity_given() const {
    return std::ranges::any_of(identity, [](const auto& number) { return number.has_value(); });
  }
};

/// Values that a drive sends by itself, in a frame of its own (Keya's heartbeat).
struct UnsolicitedProperties {
  Duration every{};  ///< 0: not known
  std::vector<ObjectId> objects;
};

/// The gateway's own node-ID: in the drives' 1016h, and in no configuration of a drive.
inline constexpr std::uint8_t kOwnNode = 127;

/// What is reported of a profile that was never tried on its drive.
inline constexpr std::string_view kOnlySimulated =
    "numbers from an EDS or a public list, never tried on the real drive";

struct DriveModel {
  std::string profile;          ///< "kinco-jd"
  std::string title;            ///< "Kinco JD"
  bool only_simulated = false;  ///< kOnlySimulated is to be reported
  std::string protocol;         ///< "kinco-serial"
  std::uint8_t node = 1;
  std::vector<ObjectDef> objects;
  std::vector<DriveConstant> constants;  ///< those that are read from the drive
  std::vector<AxisModel> axes;
  std::vector<AlarmRow> alarms;  ///< in the order in which error_code looks for the first active one
  std::vector<ObjectWrite> setup;
  std::vector<FactoryWrite> factory_writes;  ///< judged at each bring-up, see setup_writes()
  std::vector<Check> checks;
  ResyncProperties resync;
  Duration timeout =
      std::chrono::milliseconds(100);  ///< profile's reply timeout, for a bus whose configuration names none
  bool stops_by_itself = false;        ///< it notices a dead gateway on this protocol; else alarm no_comm_watchdog
  Duration loss_after{};  ///< its motors stop so long after the gateway's death; 0: whether they do is not stated
  std::vector<ObjectId> loss_objects;  ///< written at setup so that it notices; where it does not hold them: the alarm
  std::string loss_text;               ///< what the drive then does, and what is not known of it; may be empty
  /// The drive disables itself unless it is commanded so often (profile key "keepalive"); 0: it does not.
  Duration keep_alive{};
  std::vector<ObjectId> composed{};     ///< Keya's serial protocols: the fields of the control frame
  UnsolicitedProperties unsolicited{};  ///< Keya's CAN protocol
  RtuProperties rtu;                    ///< Modbus RTU alone
  CanopenProperties canopen;            ///< CANopen alone
  Nvm nvm = Nvm::no;                    ///< of objects that are not in `objects` (the mailbox reaches them)
  std::array<Duration, 3> poll_period{std::chrono::milliseconds(20), std::chrono::milliseconds(100),
                                      std::chrono::milliseconds(1000)};

  [[nodiscard]] const ObjectDef& object(ObjectId id) const { return objects[id]; }
  /// kNoObject where no object has it. `mask`: of one of its parts.
  [[nodiscard]] ObjectId find(ObjectAddress address, std::uint32_t mask = 0) const;
  /// What goes over the bus for it: itself, or the whole that it is a part of.
  [[nodiscard]] ObjectId whole(ObjectId id) const {
    return id != kNoObject && objects[id].is_part() ? objects[id].part.whole : id;
  }
  /// It, its parts, and those whose direction it says.
  [[nodiscard]] std::vector<ObjectId> with_parts(ObjectId object) const;
  [[nodiscard]] bool needs_for_state(ObjectId object) const;
  /// Without this object nothing may move: what needs_for_state() says, and the position.
  [[nodiscard]] bool needs(ObjectId object) const;
};

[[nodiscard]] inline bool is_canopen(const DriveModel& model) { return model.protocol == "canopen"; }
/// What must be read to know DriveModel::constants, each object once.
[[nodiscard]] std::vector<ObjectId> constant_objects(const DriveModel& model);
/// The setup list as it is due by what the drive holds: all of `setup`, then each of `factory_writes` whose object
/// holds a number it takes the place of, and whose amount is known and fits; once written it is not due again.
[[nodiscard]] std::vector<ObjectWrite> setup_writes(const DriveModel& model, const NumberOf& number_of,
                                                    const IsAbsent& is_absent = {});

}  // namespace axisgate::model
