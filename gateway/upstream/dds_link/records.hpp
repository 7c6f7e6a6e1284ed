// SPDX-License-Identifier: Apache-2.0
// What the gateway and axisgate-dds say to each other over their socket pair (design 7, point 8): one record a packet.
// Promises that every record has a bound (kMaxPacket) and that one of another version, an unknown kind or a wrong
// length is refused whole. Never knows a DDS type, a socket or a clock.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "gateway/core/bytes.hpp"
#include "gateway/core/numbers.hpp"
#include "gateway/upstream/dds_link/gateway_name.hpp"
#include "gateway/upstream/dds_link/guid.hpp"
#include "gateway/upstream/dds_link/liveliness.hpp"
#include "gateway/upstream/link/coder.hpp"

namespace axisgate::dds {

/// First byte of each packet. Both ends are installed together: another version is another installation.
inline constexpr std::uint8_t kLinkVersion = 5;
using link::kMaxPacket;
using link::kMillisecond;
using link::kSecond;
using link::SteadyNs;
inline constexpr std::size_t kMaxName = 64;
inline constexpr std::size_t kMaxText = 256;
inline constexpr std::size_t kMaxBusesShown = 100;
inline constexpr std::size_t kMaxJoints = 512;     ///< of one sample of joint_commands
inline constexpr std::size_t kMaxBeats = 64;       ///< of one record
inline constexpr std::size_t kMaxIdentities = 64;  ///< certificates that have a role of their own
/// Writers of commands at a time, of a whole domain: most may command other gateways.
inline constexpr std::size_t kMaxWritersKnown = 1024;

// --- From the gateway ------------------------------------------------------------------------------------------------

/// One snapshot of one axis (IDL AxisState); doubles are SI, NaN where there is no value.
struct StateRecord {
  std::uint16_t axis = 0;
  std::string name;
  SteadyNs at = 0;  ///< when its newest value was received
  std::uint32_t sequence = 0;
  std::uint16_t statusword = 0;
  std::int16_t mode = 0;
  double position = 0;
  double velocity = 0;
  double torque = 0;
  double current = 0;
  double following_error = 0;
  std::uint16_t error_code = 0;
  std::uint32_t vendor_error = 0;
  std::uint16_t inputs = 0;
  std::uint16_t outputs = 0;
  double drive_temperature = 0;
  double motor_temperature = 0;
  double voltage = 0;
  std::uint8_t axis_state = 0;
  std::uint8_t motion_state = 0;
  std::uint16_t motion_id = 0;
  std::uint32_t alarms = 0;
  std::uint8_t link_state = 0;
  std::uint32_t supported = 0;
  std::uint32_t valid = 0;
  friend bool operator==(const StateRecord&, const StateRecord&) = default;
};

struct EventRecord {
  std::uint16_t axis = 0;
  SteadyNs at = 0;
  std::uint64_t number = 0;
  std::uint8_t kind = 0;
  std::uint32_t code = 0;
  std::string text;
  friend bool operator==(const EventRecord&, const EventRecord&) = default;
};

struct BusRecord {
  std::string name;
  std::uint8_t link = 0;
  std::uint16_t load_permille = 0;
  std::uint16_t cycle_ms = 0;
  std::uint16_t queue_depth = 0;
  /// requests, replies, timeouts, bad_frames, late_replies, dropped_bytes, refused, coalesced, superseded, reconnects
  std::array<std::uint32_t, 10> counters{};
  friend bool operator==(const BusRecord&, const BusRecord&) = default;
};

struct GatewayRecord {
  std::uint8_t state = 0;
  std::uint16_t axis_count = 0;
  std::uint16_t axes_online = 0;
  std::uint32_t uptime_s = 0;
  std::uint16_t alarms = 0;
  std::uint32_t events_lost = 0;
  std::vector<BusRecord> buses;  ///< at most kMaxBusesShown
  friend bool operator==(const GatewayRecord&, const GatewayRecord&) = default;
};

struct ReplyRecord {
  std::uint16_t axis = 0;
  std::uint64_t request_id = 0;
  Guid writer{};
  std::uint8_t result = 0;
  std::uint32_t detail = 0;
  friend bool operator==(const ReplyRecord&, const ReplyRecord&) = default;
};

struct ObjectReplyRecord {
  std::uint16_t axis = 0;
  std::uint64_t request_id = 0;
  Guid writer{};
  std::uint8_t result = 0;
  std::uint32_t detail = 0;
  std::uint32_t value = 0;
  std::vector<Byte> data;  ///< at most kMaxObjectBytes
  friend bool operator==(const ObjectReplyRecord&, const ObjectReplyRecord&) = default;
};

// --- From axisgate-dds -----------------------------------------------------------------------------------------------

/// The participant is there and all topics are.
struct ReadyRecord {
  std::string version;  ///< of the program, for the log
  friend bool operator==(const ReadyRecord&, const ReadyRecord&) = default;
};

/// A line for the gateway's log.
struct LogRecord {
  std::uint8_t level = 0;  ///< as LogLevel
  std::string text;
  friend bool operator==(const LogRecord&, const LogRecord&) = default;
};

/// A DataWriter of axis_command or object_request was matched, or is gone (deleted, its liveliness or its participant
/// lost).
struct WriterRecord {
  Guid writer{};
  std::int32_t strength = 0;
  bool gone = false;
  std::string where;  ///< its locator, for names in events: "192.168.1.7"; empty: not known
  LivelinessKind liveliness = LivelinessKind::endless;
  friend bool operator==(const WriterRecord&, const WriterRecord&) = default;
};

/// Writers whose liveliness was good when this was sent, each time at least every kBeatPeriod. Only those whose
/// liveliness is a sign of life (dds_link/liveliness.hpp).
struct BeatRecord {
  std::vector<Guid> writers;  ///< at most kMaxBeats
  SteadyNs said = 0;          ///< when this was sent: the gateway may have stood still since
  friend bool operator==(const BeatRecord&, const BeatRecord&) = default;
};

/// A sample of heartbeat, as it came; or, `gone`, its writer has disposed that client's instance.
struct HeartbeatRecord {
  Guid writer{};  ///< of the heartbeat
  Guid client{};  ///< the writer of commands that it speaks for
  std::uint32_t counter = 0;
  std::uint32_t lease_ms = 0;
  SteadyNs written = 0;
  bool gone = false;
  friend bool operator==(const HeartbeatRecord&, const HeartbeatRecord&) = default;
};

/// Another participant has published this axis under our key; or, `gone`, has given it up, or (axis 0) its writer of
/// states is gone.
struct NamesakeRecord {
  Guid writer{};
  std::uint16_t axis = 0;
  std::string where;
  bool gone = false;
  friend bool operator==(const NamesakeRecord&, const NamesakeRecord&) = default;
};

/// A sample of axis_command, as it came: nothing of it has been checked.
struct CommandRecord {
  Guid writer{};
  std::int32_t strength = 0;  ///< of its writer, when this sample was received; 0 of a SHARED one
  SteadyNs written = 0;       ///< its source timestamp, by the clocks' difference of its arrival; 0: it has none
  GatewayId gateway{};
  std::uint16_t axis = 0;
  std::uint64_t request_id = 0;
  std::uint8_t command = 0;
  std::int16_t mode = 0;
  std::uint32_t mask = 0;
  double target_position = 0;
  double target_velocity = 0;
  double target_torque = 0;
  double max_torque = 0;
  double profile_velocity = 0;
  double profile_acceleration = 0;
  double profile_deceleration = 0;
  double jog_velocity = 0;
  double set_position_value = 0;
  std::int16_t homing_method = 0;
  /// When axisgate-dds received it: a stop is sent before what was received before it. 0: unknown.
  SteadyNs received = 0;
  friend bool operator==(const CommandRecord&, const CommandRecord&) = default;
};

/// A sample of object_request, as it came.
struct ObjectRequestRecord {
  Guid writer{};
  SteadyNs written = 0;
  GatewayId gateway{};
  std::uint16_t axis = 0;
  std::uint64_t request_id = 0;
  bool write = false;
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;
  std::uint8_t size = 0;
  std::uint32_t value = 0;
  std::vector<Byte> data;  ///< at most kMaxObjectBytes
  SteadyNs received = 0;   ///< as CommandRecord's
  friend bool operator==(const ObjectRequestRecord&, const ObjectRequestRecord&) = default;
};

/// A sample of ROS 2's joint_commands, as it came: its lists need not be of one length. A name that no axis can have is
/// empty here; of lists longer than kMaxJoints one more is recorded.
struct JointCommandsRecord {
  Guid writer{};
  SteadyNs written = 0;  ///< its source timestamp
  std::vector<std::string> names;
  std::vector<double> positions;
  std::vector<double> velocities;
  std::uint32_t efforts = 0;  ///< how many there are: their values are of no use
  SteadyNs received = 0;      ///< as CommandRecord's
  friend bool operator==(const JointCommandsRecord&, const JointCommandsRecord&) = default;
};

/// A sample of one of an axis's own ROS 2 topics.
struct RosActionRecord {
  Guid writer{};
  SteadyNs written = 0;  ///< its source timestamp
  std::uint16_t axis = 0;
  std::uint8_t action = 0;  ///< RosAction
  SteadyNs received = 0;    ///< as CommandRecord's
  friend bool operator==(const RosActionRecord&, const RosActionRecord&) = default;
};

/// Which participants have the subject of the `number`-th certificate of "roles": DDS-Security makes the first
/// kIdentityBytes of their GUIDs from it (dds_link/guid.hpp), and proves that they are theirs.
struct IdentityRecord {
  std::uint16_t number = 0;
  Guid guid{};
  friend bool operator==(const IdentityRecord&, const IdentityRecord&) = default;
};

/// In the order of their kinds on the wire.
using Record = std::variant<StateRecord, EventRecord, GatewayRecord, ReplyRecord, ObjectReplyRecord, ReadyRecord,
                            LogRecord, WriterRecord, BeatRecord, CommandRecord, ObjectRequestRecord, HeartbeatRecord,
                            NamesakeRecord, JointCommandsRecord, RosActionRecord, IdentityRecord>;

/// Texts and lists longer than their bound are cut.
[[nodiscard]] std::vector<Byte> encode(const Record& record);

using link::DecodeError;
using Decoded = link::Decoded<Record>;
[[nodiscard]] Decoded decode(Bytes packet);

}  // namespace axisgate::dds
