// SPDX-License-Identifier: Apache-2.0
// The plan of one write request: what is to be asked of the axis, after role, addresses and values were checked in that
// order (design 3.3, 3.3 Roles). Promises that a refused request has changed nothing, not even the memory of
// edges, but for the stops in it. Never asks anything of an axis itself: WriteRun carries the plan out.
#pragma once

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "gateway/image/command_port.hpp"
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "gateway/upstream/modbus_tcp/read/row_values.hpp"
#include "gateway/upstream/modbus_tcp/read/unit_view.hpp"
#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"
#include "gateway/upstream/modbus_tcp/write/refused_blocks.hpp"

namespace axisgate::modbus_tcp {

/// What a client remembers of its writes to one axis: restored where a request turns out to be refused as a whole.
struct WriteMemory {
  EdgeMemory edges;
  RowMemory rows;
  std::optional<CommandIds> ids;
  std::shared_ptr<ConnectionWords> connection{};  ///< that writes
  LastWords words;                                ///< of it, to this axis
};
[[nodiscard]] WriteMemory memory_of(const Onlooker& onlooker, AxisNumber axis);
void restore(const WriteMemory& memory, Client& client, AxisNumber axis);

/// How the rules of edges see a write to this axis. `Writing::targets` is left to whoever knows the item.
[[nodiscard]] Writing writing_to(const AxisImage& axis, const Onlooker& onlooker, WriteForm form);

/// One request writes to one axis at most: offsets 90 to 99 of a block, and coils 16 to 99, take no write.
struct WritePlan {
  AxisNumber axis = 0;              ///< 0: nothing is asked of an axis (gateway register 8)
  std::uint64_t request = 0;        ///< Writing::request
  std::vector<WriteBatch> batches;  ///< one after another; more than one only where several coils act at once
  Errc afterwards =
      Errc::ok;  ///< how the request ends when all write batches are done: starts that its own stop has dropped
  std::optional<WriteBatch> object;  ///< the mailbox's request, after the write batches; not waited for
  bool reads_alone = false;          ///< rows of the mailbox, and no write by it
  bool single = false;               ///< a single write: where it is not new, its answer is an exception
  BlockWrite block{};                ///< what it is where it is none, for its client to be answered with a refusal
  bool not_new = false;              ///< something in it did not act, and its client is answered: result 10
  bool repeats = false;  ///< a block in which nothing is new: its client's result stands, unless it is refused
  WriteMemory before{};  ///< of the client, before this request
};

/// What stops of a block, alone.
struct AxisStop {
  AxisNumber axis = 0;
  WriteBatch batch;
  WriteMemory after{};  ///< what its client remembers then
};

/// role_forbidden, not_supported, bad_value; for a second mailbox request busy; where function 23 reads what does not
/// answer (listener option "offline_reads") link_lost.
struct Refused {
  Errc code;
  std::optional<std::uint16_t> row{};  ///< of a block write, and not of busy: the first row or coil refused
  std::vector<AxisStop> stops{};       ///< in it: carried out alone
  std::string limit{};                 ///< the limit that stands against it, "3 rpm"
};

/// `client` is the one that writes: what is its own is stored there.
using Planned = std::variant<WritePlan, Refused>;
[[nodiscard]] Planned plan_write(const Request& request, const UnitView& view, const Onlooker& onlooker,
                                 Client& client);

// The two halves of it, by what is written.
[[nodiscard]] Planned plan_register_write(const Request& request, const UnitView& view, const Onlooker& onlooker,
                                          Client& client);
[[nodiscard]] Planned plan_coil_write(const Request& request, const UnitView& view, const Onlooker& onlooker,
                                      Client& client);

/// Of what is written to one row alone: role and address, whatever the value. Errors: role_forbidden, not_supported.
[[nodiscard]] Errc check_row(const Request& request, const UnitView& view, const Onlooker& onlooker);

/// The stops in a write of several rows or coils that act by the rules of edges, of whoever may stop. A block reaches
/// into several axes only where it is refused.
[[nodiscard]] std::vector<AxisStop> stops_in_registers(const Request& request, const UnitView& view,
                                                       const Onlooker& onlooker);
[[nodiscard]] std::vector<AxisStop> stops_in_coils(const Request& request, const UnitView& view,
                                                   const Onlooker& onlooker);
/// The request is a stop: a single write that is one whatever was written before, or a block with one that acts. It
/// starts ahead of a request that has to wait.
[[nodiscard]] bool asks_for_a_stop(const Request& request, const UnitView& view, const Onlooker& onlooker);
/// The axis a write is addressed to, for its result registers; 0 where it is none.
[[nodiscard]] AxisNumber axis_of_write(const Request& request, const UnitView& view, const ProcessImage& image);

}  // namespace axisgate::modbus_tcp
