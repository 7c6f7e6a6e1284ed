// SPDX-License-Identifier: Apache-2.0
// What the contract says of one axis and any sequence of writes, gaps and deaths: a small, slow, obvious reference. It
// knows plain numbers, and each rule stands beside its sentence. Where a sentence can be read in two ways, or nobody
// can know (an acknowledgement was lost), both are allowed: the reference keeps a world for each, and what is answered
// or seen of the motor ends those that it does not fit.
// Promises to know nothing of the gateway: it includes nothing of it.
#pragma once

#include <algorithm>
#include <array>
#include <boost/container/flat_map.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/model/write.hpp"

namespace axisgate::test::reference {

inline constexpr std::size_t kModbus = 3, kWriters = 3, kClients = kModbus + kWriters;  ///< DDS writers come last
[[nodiscard]] constexpr bool is_dds(std::size_t client) { return client >= kModbus; }
inline constexpr std::size_t kGhost = 100;
/// Design 4: "when axisgate-dds dies its clients' leases are prolonged once by 3 s".
inline constexpr std::int64_t kGraceMs = 3'000;
inline constexpr std::int64_t kNever = INT64_MAX / 4, kLongAgo = INT64_MIN / 4;

/// What somebody beside the machine sees.
struct Sight {
  std::int64_t now_ms = 0;
  std::int64_t position = 0;
  std::int64_t velocity = 0;      ///< 0: it stands
  std::optional<bool> enabled{};  ///< none: of this drive nobody can tell
  bool faulted = false;
  bool torque = true;  ///< false: what turns coasts
};

inline constexpr std::int64_t kClearMs = 250;  ///< so long standing or moving: no doubt about it
/// The same when a write is judged.
struct Seen {
  std::int64_t now_ms = 0;
  std::int64_t position = 0;
  bool stands = true;
  bool clear = true;  ///< it has been standing, or moving, for a while: nobody could see it otherwise
  bool troubled = false;
};

/// One thing that acts by edges, as one client has written it.
struct Item {
  std::optional<std::int64_t> value{};  ///< none: empty memory
  std::int64_t written_ms = 0;
  bool spoilt = false;   ///< another client's stop, a fault or a loss since it acted
  bool changed = false;  ///< this client has changed one of its targets since it acted
  bool ended = false;    ///< a stop or another client since it acted
  bool refused = false;  ///< it was not carried out
  bool acted = false;    ///< ever; else it was only remembered
  bool unsure = false;   ///< whether it was carried out nobody knows, or what is remembered of it
  bool operator==(const Item&) const = default;
};

/// One half of a row of 32 bits that waits for the other one (3.1 Panels).
struct Half {
  std::uint16_t row = 0;
  bool second = false;  ///< it is the register behind
  std::uint16_t word = 0;
  std::int64_t at_ms = 0;
  bool unsure = false;  ///< it was written in trouble
  bool operator==(const Half&) const = default;
};

struct ClientMemory {
  Item command, controlword;
  std::array<Item, 10> coils{};
  /// Of each thing that acts by edges both are allowed from now on, until it is written with another value.
  void make_uncertain();
  std::optional<std::int64_t> id{};      ///< the last one that was not 0, of the address: with its first client alone
  std::set<std::int64_t> ids{};          ///< all of its address
  std::optional<std::int64_t> own_id{};  ///< the same of the connection
  Rows rows{};                           ///< as written last, whatever became of it
  /// Of these it was refused, and whether that counts is not said: what was written before, none: nothing.
  boost::container::flat_map<std::uint16_t, std::optional<std::int64_t>> refused_rows{};
  void write(std::uint16_t offset, std::int64_t value, bool refused);
  bool rows_unsure = false;  ///< or otherwise
  std::optional<Half> half{};
  bool operator==(const ClientMemory&) const = default;
};

/// What the motor may do.
struct Motion {
  enum class Kind : std::uint8_t { stands, moves, runs, unknown };
  Kind kind = Kind::stands;
  std::int64_t value = 0;  ///< where a move ends; how fast a run is
  bool operator==(const Motion&) const = default;
};
using Motor = Motion::Kind;

enum class SeenBefore : std::uint8_t { no, yes, perhaps };

struct Verdict {
  std::string says{};        ///< for people
  std::set<int> answers{0};  ///< exceptions that fit; 0: none
  bool any_answer = false;
  bool starts = false;
  bool acts = false;                       ///< a command or controlword in it
  bool stop = false;                       ///< it holds one that acts
  bool takes_over = false;                 ///< the axis is its client's as soon as it is answered
  std::optional<std::int64_t> position{};  ///< where the axis is once it is done, whatever the motor did
  bool operator==(const Verdict&) const = default;
};

/// A request that was not answered yet, as one world sees it.
struct Pending {
  Verdict verdict{};
  bool void_ = false;      ///< in this world it was never carried out: only trouble can be the cause
  bool overtaken = false;  ///< a stop came before or after it: what waits is dropped
  bool unread = false;     ///< not even remembered: what it reads could not be read
  bool alone = true;       ///< there is no world where it was not carried out: that would be the same
  bool more = false;       ///< it holds more than one row
  bool setpoints = false;  ///< it holds nothing else
  bool enables = false;
  bool operator==(const Pending&) const = default;
};

/// One reading of all that was written and seen so far.
struct World {
  std::optional<std::size_t> owner{};       ///< kGhost and more: a connection that is silent for ever
  bool orphan = false;                      ///< its connection has ended
  std::int64_t orphan_asked_ms = kLongAgo;  ///< its last request before
  bool retaken = false;                     ///< it was, before the last request
  bool retake_unsure = false;               ///< whether that request has taken it over nobody can tell
  std::int64_t lease_ends_ms = kNever;     ///< at the earliest; with an owner, or open to all; kNever: nothing runs out
  std::int64_t lease_ends_by_ms = kNever;  ///< at the latest: of some requests nobody can tell whether they renew it
  bool lease_unsure = false;               ///< it may have run out by now
  bool enabled = true;
  bool latched = false;
  bool latch_unsure = false;  ///< what the gateway believed of it decided, out of sight
  bool faulted = false;
  bool adopted = false;                    ///< found enabled after a loss: whether starts are accepted is not said
  bool found = false;                      ///< by a gateway that is new, perhaps enabled: it is nobody's yet
  bool held = false;                       ///< coil 3 is 1
  std::int64_t ladder = 15;                ///< the last raw step of CiA 402 that was taken: 0, 6, 7 or 15
  std::optional<std::int64_t> raw_mode{};  ///< written to row 41 since the last command that selects a mode
  std::optional<std::int64_t> mode{};      ///< what mode_display shows; none: that is not said
  bool speed_mode = false;                 ///< the last command that selects a mode selected 3
  bool other_mode = false;                 ///< it selected torque or homing: how a drive halts there is its own affair
  bool start_bit = false;                  ///< bit 4 may be set in the controlword in effect
  bool stale_speed = false;                ///< the speed was accepted before a stop
  bool surely_stale = false;               ///< and by nobody beside it
  Motor motor = Motor::stands;
  std::int64_t target = 0;        ///< of the move
  std::int64_t fastest = kNever;  ///< that the motor may turn in this motion; kNever: nobody can tell
  std::int64_t started_ms = 0;
  std::int64_t jog = 0;  ///< 1 forward, -1 reverse: the motor runs at the jog velocity
  std::size_t jog_client = 0;
  std::int64_t jog_ends_ms = kNever;
  std::int64_t enable_asked_ms = kLongAgo;
  std::int64_t off_asked_ms = kLongAgo;
  std::int64_t taken_back_by_ms = kLongAgo;  ///< until then an enable that was answered 0x0B may be taken back
  bool broken = false;                       ///< trouble since the motion began: it may have ended anywhere
  // What the motor may still do from before, until it has settled.
  std::vector<Motion> earlier{};
  std::int64_t changed_ms = 0;
  std::int64_t stopped_at = 0;  ///< where a stop came
  int awaits = 0;               ///< the answer of this request; 0: of none
  boost::container::flat_map<int, Pending> pending{};
  Rows accepted{};
  std::array<std::int64_t, kWriters> pressed{};  ///< by DDS: 1 jog_forward, -1 jog_reverse
  // The last: most worlds that differ do so before it. What a DDS writer has is forgotten with its sample.
  std::array<ClientMemory, kModbus + 1> clients{};
  bool operator==(const World&) const = default;
  [[nodiscard]] Motion motion() const;
  /// It stands where its move ends.
  [[nodiscard]] bool arrived(const Seen& seen) const;
  void lease_until(std::int64_t ends_ms) {
    lease_ends_ms = lease_ends_by_ms = ends_ms;
    lease_unsure = retake_unsure = false;
  }
};

class Readings;

struct ContractOptions {
  bool leases = false;
  std::int64_t lease_ms = 2000;
  std::int64_t jog_timeout_ms = 500;
  std::set<std::uint16_t> rows{};  ///< set-points the drive has
  bool no_halt = false;            ///< but in mode 3: the profile stops it by what may latch the axis
  bool both_modes = false;         ///< which mode is in force at a halt is anybody's guess
  bool by_gateway = false;         ///< the CiA 402 machine is the gateway's
  bool by_address = false;         ///< "client": "address"
  bool reads_fail = false;         ///< "offline_reads": "exception"
  bool staged = false;             ///< "halves": "staged"
  bool expiry_acts = true;         ///< false: "on_expiry": "none"
  bool only_writes_renew = false;  ///< "renew": "write"
  std::int64_t rearm_ms = 1000;
  std::array<int, kModbus> ranks{};
  std::array<bool, kModbus> operators{};  ///< the others are engineers
  std::size_t together = 1;               ///< so many of Modbus, the first ones, are connections of one address
  std::int64_t velocity_limit = kNever;   ///< "limits": {"velocity": v}
  std::int64_t homing_speed = kNever;     ///< the greatest of a homing
  std::set<std::uint16_t> parameters{};   ///< of the rows 46, 47 and 62 to 76 those that the drive has
  std::array<int, kWriters> strengths{};
  std::array<std::int64_t, kWriters> limits{kNever, kNever, kNever};  ///< lease_ms of a writer's heartbeat
  std::int64_t settles_ms = 1200;  ///< so long after an answer the motor does what was asked, ramps included
  /// Its first client, for each client.
  [[nodiscard]] std::size_t address_of(std::size_t client) const { return client < together ? 0 : client; }
  /// Design 4, signs of life: "the lease is the smaller of lease_ms and the configured one".
  [[nodiscard]] std::int64_t lease_of(std::size_t client) const {
    return is_dds(client) ? std::min(lease_ms, limits.at(client - kModbus)) : lease_ms;
  }
};

class Contract {
 public:
  Contract(ContractOptions options, World start) : options_(std::move(options)), worlds_{std::move(start)} {}

  /// A write is sent now. Returns its number.
  int send(std::size_t client, const Write& write);
  /// What was answered: an exception, 0 for none, or those that a DDS reply may stand for. False: no reading of the
  /// contract has this answer.
  bool answered(int request, const std::set<int>& exceptions);
  /// A command or controlword of this request acts, in each reading.
  [[nodiscard]] bool surely_acts(int request) const;
  /// It will never be answered: its connection is gone.
  void unanswered(int request);
  /// Any other request of this client.
  void asked(std::size_t client);
  /// A changed counter of this DDS writer's heartbeat.
  void beats(std::size_t client, std::int64_t lease_ms);
  /// axisgate-dds has died; it comes back with the same writers.
  void dds_died();
  /// What registers 28, 34 (bit 7), 29 and 1 tell this client now. False: no reading of the contract has it.
  struct Told {
    int owner = 0;
    bool latched = false;
    int lease_ms = 0;
    std::optional<int> mode{};  ///< where it is valid
  };
  bool shown(std::size_t client, const Told& told);
  /// Whether registers 0 (bit 10) and 32 may tell of a target that is reached.
  [[nodiscard]] bool may_be_over() const;
  /// False: no reading of the contract lets the motor do this.
  bool see(const Sight& sight);

  /// The connection has ended, or is silent for ever and the gateway believes it alive; the next one begins with an
  /// empty memory. Of a DDS writer silently: its successor is of another participant.
  void left(std::size_t client, bool silently);
  /// From here on frames may be lost, and drives be gone, until the axis is online again and nothing is wrong.
  void trouble_begins();
  void trouble_ends();
  void drive_restarted();
  /// By another master: from here on its motor may do anything until a stop, a lease or a button ends it.
  void commanded_by_another();
  void drive_tripped();
  void gateway_died();
  void gateway_started();

  /// What was predicted of the last write, one line for each reading.
  [[nodiscard]] const std::string& predicted() const { return predicted_; }
  [[nodiscard]] std::string expected() const;
  [[nodiscard]] const std::vector<World>& worlds() const { return worlds_; }
  /// There were too many readings: from here on nothing is judged any more.
  [[nodiscard]] bool lost_count() const { return lost_count_; }
  [[nodiscard]] bool in_trouble() const { return trouble_; }
  [[nodiscard]] bool settled() const;

 private:
  struct Asked {
    std::size_t client = 0;
    bool troubled = false;
    std::int64_t at_ms = 0;
    bool stops = false;        ///< it asserts a stop
    bool obeyed = false;       ///< since then the motor got slower, stood, or had no torque
    std::int64_t fastest = 0;  ///< since then
    void see(const Sight& sight);
  };
  /// What a DDS writer has asked for with a request_id of its own.
  struct Said {
    std::int64_t command = 0;
    std::int64_t at_ms = 0;  ///< it was seen last
  };
  struct AllSaid {
    std::vector<Said> all{};
    std::size_t last = 0;  ///< of all: what was seen last
  };
  static constexpr std::size_t kMaxWorlds = 400;
  static constexpr std::size_t kMostBranches = 4000;  // of one write

  [[nodiscard]] bool settled(const World& world) const;
  [[nodiscard]] bool fits(World& world, const Sight& sight) const;
  [[nodiscard]] bool enabling_fits(World& world, const Sight& sight) const;
  [[nodiscard]] bool motion_fits(World& world, const Sight& sight) const;
  void pass_time(std::int64_t now_ms);
  void expire(World& world) const;
  void add_expired();
  void changed(World& world, const World& before) const;
  void drop_equal();
  void keep_different();
  void take_over(World& world, std::size_t client, Readings& readings) const;
  void renew(World& world, std::size_t client) const;
  void heard(std::size_t client);
  void may_have_stopped_for_good();
  static void overtake(World& world, Pending& newest, bool rows);
  [[nodiscard]] static World owed_alone(World stopped, const World& none);
  [[nodiscard]] Seen seen() const;

  [[nodiscard]] SeenBefore seen_before(std::size_t client, const Write& write);

  ContractOptions options_;
  std::vector<World> worlds_;
  std::array<AllSaid, kWriters> said_{};
  std::array<std::int64_t, kModbus> opened_ms_{};  ///< its connection
  std::array<std::int64_t, kModbus> asked_ms_{};   ///< its last request of any kind
  std::array<bool, kWriters> graced_{};            ///< its leases were prolonged, and it was not heard since
  std::map<int, Asked> asked_;
  std::string predicted_;
  Sight sight_{};
  std::optional<bool> was_enabled_{};
  std::int64_t since_ms_ = kLongAgo;  ///< it has been standing, or moving, since
  std::int64_t stood_at_ = 0;
  int way_ = 0;  ///< 1, -1: it has been turning this way, and was judged; 0: it stands
  int requests_ = 0;
  bool trouble_ = false;
  std::int64_t anothers_until_ms_ = kLongAgo;  ///< so long the motor may be enabled by another master
  bool was_anothers_ = false;                  ///< since the trouble began
  bool gateway_is_new_ = false;
  std::int64_t unanswered_ms_ = kLongAgo;  ///< the last request that will never be answered
  bool lost_count_ = false;
};

[[nodiscard]] std::string text(const World& world);

}  // namespace axisgate::test::reference
