// SPDX-License-Identifier: Apache-2.0
// The DDS writers as clients of the gateway: one ClientLife each, by which leases are judged (design 3.5 and 4). A
// writer is a client from its first sample for this gateway on, with the lease that its heartbeats before that have
// asked for. What a client that is gone has left is taken over by its own liveliness when it is back, and by the
// heartbeat of a writer of its participant that was not heard before. Promises that the number of what is remembered is
// bounded, and that none makes way for a newcomer that owns an axis, holds a button or may have a motor running; that a
// writer whose end is reported or who does not come back is dead to its leases; that the silence of axisgate-dds itself
// is not taken for theirs for as long as their grace. Never speaks to an axis, but to say that a client is gone or
// back.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "gateway/image/command_port.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/upstream/dds/identities.hpp"
#include "gateway/upstream/dds/signs_of_life.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

/// Ids of DDS writers are from here on: below are those of Modbus clients.
inline constexpr ClientId kFirstDdsClient = ClientId{1} << 63U;
/// Writers that were not reported (or not again, after axisgate-dds was restarted) for so long are gone: their grace,
/// and the time in which a new participant finds the others.
inline constexpr Duration kReturnsWithin = std::chrono::seconds(8);
/// Writers at a time that were not reported, and whose heartbeats are remembered for their first command.
inline constexpr std::size_t kMaxBeatsBefore = 64;

/// A jog command is a button that is pressed: the same one again is the button held, until command 33, or the other
/// direction. So nothing that has ended the jog meanwhile is undone by a button that is still held (design 3.4).
struct HeldJog {
  Command direction = Command::none;
  std::uint64_t request_id = 0;  ///< of the press
  bool starting = true;          ///< it has no result yet
};

/// The lease of an axis whose owner went before a writer of its participant was heard.
struct LeftAxis {
  AxisNumber axis = 0;
  ClientId owner = 0;
  bool own = false;  ///< the owner was this writer itself
};

/// One writer. `life` is null as long as it has asked for nothing; it outlives the client where it owns an axis.
struct DdsClient {
  std::shared_ptr<ClientLife> life{};
  std::int32_t strength = 0;  ///< as reported
  std::string where{};
  std::map<AxisNumber, HeldJog> held{};
  std::map<AxisNumber, SteadyNs> released{};  ///< when the newest jog_end was received, of axes that are there
  bool commands = false;                   ///< it writes axis_command; else it may be one that asks for objects alone
  bool unleased = false;                   ///< it has commanded an axis that nobody owns: a motor may run by it
  Instant returns_by = kNever;             ///< kNever: it was reported since the link is up
  bool beats_alone = false;                ///< nothing but its heartbeats is known of it
  std::optional<std::uint32_t> counter{};  ///< of its last heartbeat
  std::optional<Duration> lease_limit{};   ///< of the same: it holds for a client that it becomes later, too
  bool liveliness_logged = false;          ///< the log has its line
  std::vector<LeftAxis> left{};            ///< not taken over so far; at most one an axis
  bool heard = false;                      ///< it has given a sign of life
};

class DdsClients {
 public:
  DdsClients(const Identities& identities, const SignsOfLife& signs, const ProcessImage& image, CommandPort& commands)
      : identities_(identities), signs_(signs), image_(image), commands_(commands) {}

  /// A line for the log; mostly empty.
  [[nodiscard]] std::string on_writer(const WriterRecord& record);
  void on_beats(const BeatRecord& record, Instant now);
  void on_heartbeat(const HeartbeatRecord& record, Instant now);
  /// Who sends this sample: a client from now on, also where the record of it is still to come. nullptr: too many.
  [[nodiscard]] DdsClient* on_sample(const Guid& writer, std::optional<std::int32_t> strength, bool fresh, Instant now);
  /// One of those that are too many, for a stop, which is open to everybody.
  [[nodiscard]] std::shared_ptr<ClientLife> stranger(const Guid& writer, Instant now);
  /// nullptr where it has asked for nothing, or is gone.
  [[nodiscard]] DdsClient* find(const Guid& writer);
  /// For the log.
  [[nodiscard]] std::string name_of(const Guid& writer) const;

  /// This owner of an axis asks for objects alone, and `other` is of the same participant: one program with two
  /// writers, since the topics are two.
  [[nodiscard]] bool asks_for_objects(const ClientLife& owner, const ClientLife& other) const;

  void on_link_up(Instant now);
  void on_link_down(Instant now);
  /// Forgets those that did not come back.
  void on_time(Instant now);
  [[nodiscard]] Instant deadline() const { return deadline_; }
  /// Writers that are clients.
  [[nodiscard]] std::size_t size() const;

 private:
  using Clients = std::map<Guid, DdsClient>;
  [[nodiscard]] std::shared_ptr<ClientLife> new_life(const Guid& writer);
  [[nodiscard]] std::size_t beating_alone() const;
  [[nodiscard]] bool has_place(const Guid& writer) const;
  [[nodiscard]] DdsClient& know(const Guid& writer);
  [[nodiscard]] DdsClient& beating(const Guid& writer, bool is_new, Instant now);
  void make_room_to_beat();
  void take_back(const Guid& writer, bool own_alone, Instant now);
  [[nodiscard]] bool owns(ClientId client) const;
  void leave_axes(const Guid& writer, const ClientLife& life);
  [[nodiscard]] bool makes_way(const DdsClient& client) const;
  [[nodiscard]] bool make_room();
  void end(DdsClient& client);
  void leave(const Guid& writer, DdsClient& client);
  Clients::iterator forget(Clients::iterator client);
  void remember_held(const Guid& writer, DdsClient& client);
  void recall_held(const Guid& writer, DdsClient& client);
  void look_at_deadlines();

  const Identities& identities_;
  const SignsOfLife& signs_;
  const ProcessImage& image_;
  CommandPort& commands_;
  Clients clients_;
  /// Buttons of writers that were taken for gone, kMaxWriters at most, the newest last: one that comes back still holds
  /// them, and has not pressed them again.
  std::deque<std::pair<Guid, std::map<AxisNumber, HeldJog>>> held_before_;
  /// Those that are gone and owned an axis when they went; at most one an axis.
  std::map<Guid, ClientId> gone_owners_;
  ClientId next_id_ = kFirstDdsClient;
  bool link_up_ = false;
  Instant deadline_ = kNever;
};

/// "dds 192.168.1.7 010f3c7a2b1d000001000000:000003".
[[nodiscard]] std::string client_name(const Guid& writer, const std::string& where);

}  // namespace axisgate::dds
