// SPDX-License-Identifier: Apache-2.0
// What the gateway and axisgate-web say to each other over their socket pair: one record a packet. Numbers are those of
// the registers, in their units, so that a page cannot show anything else than a PLC reads. Promises that every record
// has a bound (link::kMaxPacket) and that one of another version, an unknown kind or a wrong length is refused whole.
// Never carries a command: what comes back is `ready` and `log` alone.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "gateway/core/numbers.hpp"
#include "gateway/core/time_counts.hpp"
#include "gateway/upstream/link/coder.hpp"

namespace axisgate::web {

/// First byte of each packet. Both ends are installed together: another version is another installation.
inline constexpr std::uint8_t kLinkVersion = 2;
using link::kMaxPacket;
using link::kMillisecond;
using link::kSecond;
using link::SteadyNs;

inline constexpr std::size_t kMaxName = 64;
inline constexpr std::size_t kMaxText = 512;
inline constexpr std::size_t kMaxQuantities = 32;
inline constexpr std::size_t kMaxBuses = 100;
inline constexpr std::size_t kMaxPrograms = 8;
inline constexpr std::size_t kBusCounters = 11;
/// Classes of exchanges, as the arbiter has them: stop, fault cause, command, interactive, setup, poll.
inline constexpr std::size_t kExchangeClasses = 6;
inline constexpr std::size_t kEventKindsShown = 8;   ///< as EventKind
inline constexpr std::size_t kExceptionsShown = 12;  ///< Modbus exceptions by their code, from 0 on
/// Pairs of a command and its result, of one axis.
inline constexpr std::size_t kMaxCommandCounts = 240;

// --- From the gateway ------------------------------------------------------------------------------------------------

/// First of all, once in the process's life, and again after a reload: everything known before is void, the AxisInfo
/// and BusInfo records that follow are all there are.
struct HelloRecord {
  std::string gateway;     ///< its name, empty: none
  std::string version;     ///< of the program
  std::uint64_t boot = 0;  ///< another number for each start of the gateway: event ids are boot.number
  SteadyNs started = 0;
  std::uint16_t axes = 0;   ///< how many AxisInfo records follow
  std::uint16_t buses = 0;  ///< how many BusInfo records follow
  bool low_word_first = false;
  bool float_numbers = false;
  friend bool operator==(const HelloRecord&, const HelloRecord&) = default;
};

struct LimitRow {
  std::uint8_t quantity = 0;
  std::int64_t min = 0;
  std::int64_t max = 0;
  friend bool operator==(const LimitRow&, const LimitRow&) = default;
};

/// What is fixed of an axis while the configuration is as it is. Sent again by itself where its drive has come up with
/// other limits, or with less.
struct AxisInfoRecord {
  std::uint16_t axis = 0;
  std::string name;
  std::uint8_t bus = 0;  ///< position of its BusInfo
  std::string drive;     ///< what the profile calls the drive: "Kinco JD"
  std::string profile;   ///< of its FaultWords
  std::uint16_t node = 0;
  std::int64_t units_numerator = 10000;
  std::int64_t units_denominator = 1;
  std::uint32_t rated_speed = 0;  ///< 0.001 rpm; 0: not known
  std::uint16_t supported_modes = 0;
  std::uint32_t writable = 0;
  std::uint32_t supported_commands = 0;
  std::vector<LimitRow> limits;  ///< of what can be written, in register units
  friend bool operator==(const AxisInfoRecord&, const AxisInfoRecord&) = default;
};

struct BusInfoRecord {
  std::uint8_t bus = 0;  ///< its position in the configuration
  std::string name;
  std::string protocol;  ///< "canopen"
  std::string endpoint;  ///< "/dev/ttyUSB0 at 38400", "can0 at 500 kbit/s"
  /// What `axisgate check` had reckoned.
  std::uint16_t planned_load_permille = 0;
  std::uint16_t planned_cycle_ms = 0;
  friend bool operator==(const BusInfoRecord&, const BusInfoRecord&) = default;
};

/// What a drive's own fault word means, by profile (model::AlarmRow).
struct FaultWordRecord {
  std::string profile;
  std::uint8_t word = 0;  ///< 0: the low half of vendor_error, 1: the high one
  std::uint8_t bit = 0;
  bool whole = false;  ///< the word is `value`, whatever `bit` says
  std::uint32_t value = 0;
  std::uint16_t error_code = 0;  ///< CiA 402 603Fh
  std::string text;
  std::string remedy;
  friend bool operator==(const FaultWordRecord&, const FaultWordRecord&) = default;
};

struct Value {
  std::uint8_t quantity = 0;
  std::int32_t value = 0;    ///< register units; of an u32 its bits
  std::uint32_t age_us = 0;  ///< when the packet was made, at most UINT32_MAX
  friend bool operator==(const Value&, const Value&) = default;
};

/// What was newest of one axis when the packet was made.
struct AxisSample {
  std::uint16_t axis = 0;
  std::uint32_t sequence = 0;
  std::uint8_t link_state = 0;
  std::uint8_t axis_state = 0;
  std::uint8_t motion_state = 0;
  std::uint16_t motion_id = 0;
  std::uint32_t alarms = 0;
  std::uint32_t supported = 0;
  std::uint32_t valid = 0;
  std::uint16_t inputs = 0;  ///< AxisInput bits as a client sees them
  std::uint16_t level_coils = 0;
  std::uint16_t loss_stop_ms = 0;
  std::uint32_t jog_velocity = 0;
  std::uint32_t age_ms = 0;    ///< register age_ms; UINT32_MAX: nothing was received yet
  std::string owner;           ///< empty: nobody
  std::uint32_t lease_ms = 0;  ///< how long it still runs; UINT32_MAX: nothing runs out
  std::uint8_t result = 0;     ///< registers 25, 26, 30 of whoever asked last
  std::uint32_t result_detail = 0;
  std::uint16_t result_id = 0;
  std::string result_who;           ///< who asked
  std::string result_what;          ///< "run_velocity", "profile_velocity", ...
  std::uint32_t result_age_ms = 0;  ///< UINT32_MAX: none since the start
  std::vector<Value> values;        ///< those that changed, or were confirmed, since the packet before
  friend bool operator==(const AxisSample&, const AxisSample&) = default;
};

/// One packet each `sample_ms`, of the axes of which something is new; each axis four times a second at least.
struct SamplesRecord {
  SteadyNs at = 0;
  std::uint32_t gaps = 0;  ///< axes that had no room in a packet since the gateway's start: shown as a gap
  std::vector<AxisSample> axes;
  friend bool operator==(const SamplesRecord&, const SamplesRecord&) = default;
};

struct EventRecord {
  std::uint64_t number = 0;
  SteadyNs at = 0;
  std::uint16_t axis = 0;
  std::uint8_t kind = 0;
  std::uint32_t code = 0;
  std::string text;
  friend bool operator==(const EventRecord&, const EventRecord&) = default;
};

struct BusStatistics {
  std::uint8_t link = 0;
  std::uint16_t load_permille = 0;
  std::uint16_t cycle_ms = 0;
  std::uint16_t queue_depth = 0;
  /// requests, replies, timeouts, bad_frames, late_replies, dropped_bytes, refused, coalesced, superseded, reconnects,
  /// echoes
  std::array<std::uint32_t, kBusCounters> counters{};
  friend bool operator==(const BusStatistics&, const BusStatistics&) = default;
};

struct ProgramStatistics {
  std::string name;  ///< "axisgate-dds"
  bool running = false;
  std::uint32_t restarts = 0;
  friend bool operator==(const ProgramStatistics&, const ProgramStatistics&) = default;
};

/// Once a second.
struct StatisticsRecord {
  SteadyNs at = 0;
  std::uint8_t state = 0;
  std::uint16_t axes_online = 0;
  std::uint16_t alarms = 0;
  std::uint32_t events_lost = 0;    ///< that no page was ever sent
  std::uint32_t worst_turn_us = 0;  ///< how late the core's loop was at most, in the last second
  std::uint32_t modbus_clients = 0;
  std::uint32_t modbus_refused = 0;
  // Since the gateway's start.
  std::uint64_t modbus_requests = 0;
  std::array<std::uint64_t, kExceptionsShown> modbus_exceptions{};
  TimeCounts modbus_took{};  ///< from a request to its answer
  TimeCounts loop_late{};    ///< how late the core's loop was, looked at four times a second
  bool has_dds = false;      ///< the configuration has it
  std::uint64_t dds_sent = 0;
  std::uint64_t dds_received = 0;
  std::array<std::uint64_t, kEventKindsShown> events{};  ///< by kind, those included that no page was sent
  std::vector<ProgramStatistics> programs;
  std::vector<BusStatistics> buses;
  friend bool operator==(const StatisticsRecord&, const StatisticsRecord&) = default;
};

/// Of one bus, since the gateway's start, by class of exchanges.
struct BusCounts {
  using ByClass = std::array<TimeCounts, kExchangeClasses>;
  std::uint8_t bus = 0;       ///< position of its BusInfo
  std::uint64_t busy_us = 0;  ///< how long an exchange was on the wire; on CAN, any frame
  ByClass times{};            ///< how long exchanges took
  ByClass waits{};            ///< how long bus jobs waited for their first one
  friend bool operator==(const BusCounts&, const BusCounts&) = default;
};

struct CommandCount {
  std::uint8_t command = 0;
  std::uint8_t result = 0;  ///< as AxisSample::result
  std::uint32_t count = 0;
  friend bool operator==(const CommandCount&, const CommandCount&) = default;
};

/// Of one axis, since the gateway's start; counted where it happens.
struct AxisCountsRow {
  std::uint16_t axis = 0;
  std::uint32_t faults = 0;
  std::uint32_t lease_expiries = 0;
  std::uint64_t enabled_ms = 0;
  std::uint64_t travel_microturns = 0;
  std::vector<CommandCount> commands;  ///< clients' commands that have ended
  friend bool operator==(const AxisCountsRow&, const AxisCountsRow&) = default;
};

/// Once a second, in as many packets as it takes: all buses, and of the axes those whose counts are others.
struct CountsRecord {
  SteadyNs at = 0;
  std::vector<BusCounts> buses;
  std::vector<AxisCountsRow> axes;
  friend bool operator==(const CountsRecord&, const CountsRecord&) = default;
};

// --- From axisgate-web -----------------------------------------------------------------------------------------------

/// It listens.
struct ReadyRecord {
  std::string version;
  bool confined = false;  ///< the system's filter of calls is in force
  friend bool operator==(const ReadyRecord&, const ReadyRecord&) = default;
};

/// A line for the gateway's log.
struct LogRecord {
  std::uint8_t level = 0;  ///< as LogLevel
  std::string text;
  friend bool operator==(const LogRecord&, const LogRecord&) = default;
};

/// In the order of their kinds on the wire.
using Record = std::variant<HelloRecord, AxisInfoRecord, BusInfoRecord, FaultWordRecord, SamplesRecord, EventRecord,
                            StatisticsRecord, CountsRecord, ReadyRecord, LogRecord>;

/// Texts and lists longer than their bound are cut.
[[nodiscard]] std::vector<Byte> encode(const Record& record);
using Decoded = link::Decoded<Record>;
[[nodiscard]] Decoded decode(Bytes packet);

}  // namespace axisgate::web
