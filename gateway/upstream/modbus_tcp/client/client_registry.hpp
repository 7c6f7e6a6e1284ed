// SPDX-License-Identifier: Apache-2.0
// The clients of the Modbus-TCP server: what each of them has written and been answered, per axis (design 3.3 Edges),
// and the life of each that leases are judged by. Promises that memory is bounded whoever connects,
// and that one client never sees what belongs to another. Never speaks to an axis and never reads a clock.
#pragma once

#include <boost/noncopyable.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "gateway/core/clock.hpp"
#include "gateway/core/line_bucket.hpp"
#include "gateway/image/command.hpp"
#include "gateway/upstream/modbus_tcp/client/edges.hpp"
#include "gateway/upstream/modbus_tcp/client/listener_settings.hpp"
#include "gateway/upstream/modbus_tcp/client/object_buffers.hpp"
#include "gateway/upstream/modbus_tcp/client/peer.hpp"
#include "gateway/upstream/modbus_tcp/client/request_figures.hpp"
#include "gateway/upstream/modbus_tcp/client/row_memory.hpp"
#include "gateway/upstream/modbus_tcp/wire/diagnostics.hpp"

namespace axisgate::modbus_tcp {

/// What an address is remembered for after its last connection closed: command ids, and its client where
/// "client" is "address".
inline constexpr Duration kHostKept = std::chrono::seconds(60);
/// Addresses without a connection; beyond it the one that left first is forgotten early.
inline constexpr std::size_t kMaxIdleHosts = 1024;

enum class ObjectStatus : std::uint16_t { idle = 0, busy = 1, done = 2, failed = 3 };

/// Registers 80..88.
struct Mailbox {
  std::uint16_t request = 0;
  std::uint16_t index = 0;
  std::uint16_t subindex = 0;
  std::uint16_t size = 0;
  std::uint32_t data = 0;
  ObjectStatus status = ObjectStatus::idle;
  std::uint32_t detail = 0;
};

/// Of a block write that was refused: the first row or coil, by its offset, and why; of a row's half that was dropped:
/// the row, and never_started.
struct RefusedRow {
  std::uint16_t offset = 0;
  Errc why = Errc::ok;
  friend bool operator==(const RefusedRow&, const RefusedRow&) = default;
};

/// A single write, or one to no axis, that was refused because it is wrong.
struct RefusedWrite {
  std::uint16_t address = 0;  ///< of 43/13: the object's index
  bool coils = false;
  Errc why = Errc::ok;
  friend bool operator==(const RefusedWrite&, const RefusedWrite&) = default;
};

/// One client's side of one axis.
struct ClientAxis {
  /// False until it has used registers 25..28 or 80..89: it sees the axis's latest result till then.
  bool used = false;
  LatestResult result;
  std::uint64_t submission = 0;  ///< counts its write batches: an older one's result does not replace a newer one's
  EdgeMemory edges;
  RowMemory rows;
  bool not_new_logged = false;          ///< in the log, since something of it acted last
  std::optional<RefusedRow> refused{};  ///< in the log, since a block of it succeeded last
  std::uint16_t command_id = 0;
  std::optional<std::uint16_t> heartbeat{};  ///< none written yet: the first one is a change
  Mailbox mailbox;
};

/// What all clients from one address share.
struct Host {
  std::map<AxisNumber, CommandIds> ids;
  std::size_t connections = 0;
  Instant left_at = kLongAgo;  ///< when the last connection closed
  LineBucket refused_lines;    ///< of single writes, in the log
};

/// Of one connection: to which axes it has written what last.
struct ConnectionWords {
  Instant connected_at;
  std::map<AxisNumber, LastWords> axes{};
};

struct Client {
  ClientId id = 0;
  Address address{};
  std::shared_ptr<Host> host;
  std::shared_ptr<ClientLife> life;       ///< never null; outlives the client where it owns an axis
  std::size_t connections = 0;            ///< more than one only where "client" is "address"
  std::map<AxisNumber, ClientAxis> axes;  ///< those it has written to
  std::uint16_t heartbeat = 0;            ///< gateway register 8
  std::optional<std::uint16_t> beat{};    ///< the same as who may command wrote it; none yet: the first is a change
  ObjectBuffers objects;                  ///< function 43/13
  std::uint64_t writes = 0;               ///< counts its write requests, refused ones too
  std::optional<RefusedWrite> refused{};  ///< in the log last
  Instant refusal_logged_at = kLongAgo;

  /// A write batch of this client that asks for nothing yet. `role`: of the connection that it asks by.
  [[nodiscard]] WriteBatch new_batch(Role role) const;
  /// nullptr where it has written nothing to this axis yet.
  [[nodiscard]] const ClientAxis* find(AxisNumber axis) const;
  [[nodiscard]] ClientAxis& at(AxisNumber axis) { return axes[axis]; }
  /// The last command_id other than 0 from its address for this axis, if one is kept.
  [[nodiscard]] std::optional<std::uint16_t> last_id(AxisNumber axis) const;
  /// Register 30: the last that acted, or came with command 0.
  [[nodiscard]] std::optional<std::uint16_t> seen_id(AxisNumber axis) const;
};

class ClientRegistry : boost::noncopyable {
 public:
  ClientRegistry() = default;

  struct Connected {
    std::shared_ptr<Client> client;
    std::optional<ClientId> forgotten;  ///< another client that is gone for good by this
  };
  /// `shared`: listener option "client": "address". Once per connection. A client of several connections has the
  /// highest role of them and the highest rank of those that may command; a viewer changes neither.
  [[nodiscard]] Connected connect(const Peer& peer, bool shared, Instant now);
  /// The client's id where it is gone for good by this. Without a connection left its life says so before.
  std::optional<ClientId> disconnect(const std::shared_ptr<Client>& client, Instant now);

  [[nodiscard]] std::size_t hosts() const { return hosts_.size(); }

  DiagnosticCounters counters;  ///< function 8, of all sessions together
  RequestFigures figures;

 private:
  struct Entry {
    std::shared_ptr<Host> host;
    std::shared_ptr<Client> shared_client;  ///< where "client" is "address"
  };
  [[nodiscard]] std::shared_ptr<Client> make_client(std::shared_ptr<Host> host, std::shared_ptr<ClientLife> life);
  /// `alone`: its client has no other connection.
  static void put_role(ClientLife& life, const Peer& peer, bool alone);
  [[nodiscard]] std::optional<ClientId> forget_oldest_idle();

  std::map<Address, Entry> hosts_;
  ClientId last_id_ = 0;
};

}  // namespace axisgate::modbus_tcp
