// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <utility>

#include "gateway/upstream/modbus_tcp/read/reads.hpp"
#include "gateway/upstream/modbus_tcp/write/claims.hpp"
#include "gateway/upstream/modbus_tcp/write/row_writes.hpp"
#include "gateway/upstream/modbus_tcp/write/write_plan.hpp"

namespace axisgate::modbus_tcp {
namespace {

bool is_quantity(const RegisterRow& row, Quantity quantity) {
  return row.source == Source::quantity && row.quantity == quantity;
}

/// Registers 80..85 as they will be; whether the request in them can be made.
struct MailboxWrite {
  Mailbox mailbox;
  bool requested = false;
  WrongRow refused{};
};

MailboxWrite write_mailbox(const RowWrites& found, const Mailbox& before) {
  MailboxWrite write{before};
  Mailbox& box = write.mailbox;
  const auto take = [&found]<class Number>(Source source, Number& into) {
    if (const RowWrite* const row = found.of(source)) into = static_cast<Number>(row->value);
  };
  take(Source::object_request, box.request);
  take(Source::object_index, box.index);
  take(Source::object_subindex, box.subindex);
  take(Source::object_size, box.size);
  take(Source::object_data, box.data);
  write.requested = found.of(Source::object_request) != nullptr && box.request != 0;
  if (!write.requested) return write;
  if (box.subindex > UINT8_MAX)
    write.refused = {Errc::bad_value, axis_offset(Source::object_subindex)};
  else if (box.size != 1 && box.size != 2 && box.size != 4)
    write.refused = {Errc::bad_value, axis_offset(Source::object_size)};
  else if (before.status == ObjectStatus::busy)
    write.refused = {Errc::busy};
  return write;
}

/// Only what a monitor writes too, to read an object: no sign of life of a program that commands.
bool reads_alone(const RowWrites& found) {
  const RowWrite* const request = found.of(Source::object_request);
  const bool others = std::ranges::any_of(
      found.rows, [](const RowWrite& each) { return each.row->offset < axis_offset(Source::object_request); });
  return !others && (request == nullptr || request->value != 2);
}

/// One register write on its way to a write batch: the client's memory is brought up to date, and what asks is put into
/// it.
class BatchMaker {
 public:
  BatchMaker(const RowWrites& found, const Onlooker& onlooker, Client& client)
      : found_(found),
        onlooker_(onlooker),
        client_(client),
        axis_(found.axis->number),
        own_(client.at(axis_)),
        single_(!found.block),
        writing_(writing_to(*found.axis, onlooker, single_ ? WriteForm::single : WriteForm::block)),
        words_(writing_.own),
        batch_(client.new_batch(onlooker.role)) {}

  struct Made {
    WriteBatch batch;
    bool not_new = false;  ///< something in it was remembered, or repeated, and did not act: its client is told
    bool repeats = false;  ///< nothing in it is new: it asks because the axis does not hold it any more
  };
  [[nodiscard]] Made make() {
    // A viewer comes this far with the mailbox alone, which it may ask to read.
    batch_.renews = !reads_alone(found_);
    batch_.reclaims = onlooker_.role >= Role::operator_ && batch_.renews;
    batch_.all_zero = batch_.zero_speed = found_.zeros;
    // Judged before anything is remembered.
    const bool only_remembered = found_.block && first_block();
    // A command goes by its targets, and what acts in the request lets its set-points ask: so in this order.
    for (const RowWrite& each : found_.rows)
      if (is_remembered(*each.row)) changed_.push_back(own_.rows.write(each.row->offset, each.value));
    if (found_.zeros)
      put_zeros();
    else
      put_words();
    onlooker_.words->axes[axis_] = words_;
    put_heartbeat();
    // A heartbeat that stands still is no sign of a program that has come back.
    if (found_.rows.size() == 1 && found_.of(Source::heartbeat) != nullptr && !batch_.beats) batch_.reclaims = false;
    if (!found_.zeros && !only_remembered) put_rows();
    batch_.claims = register_claims(batch_);
    const bool commands = batch_.command != Command::none || batch_.controlword;
    return {batch_, not_new_, !single_ && !commands && !anew_};
  }

 private:
  [[nodiscard]] const RowWrite* controlword_row() const {
    for (const RowWrite& each : found_.rows)
      if (is_quantity(*each.row, Quantity::controlword)) return &each;
    return nullptr;
  }
  [[nodiscard]] std::uint16_t id() const {
    const RowWrite* const row = found_.of(Source::command_id);
    return row == nullptr ? std::uint16_t{0} : static_cast<std::uint16_t>(row->value);
  }

  /// "On an empty memory a block that carries 40 or 54 only remembers its set-points." The memory of a command with an
  /// id is that of its address.
  [[nodiscard]] bool first_block() const {
    if (found_.of(Source::command) != nullptr)
      return id() != 0 ? !client_.last_id(axis_).has_value() : own_.edges.command_empty();
    return controlword_row() != nullptr && own_.edges.controlword_empty();
  }

  /// What acts lets the set-points beside it ask. A stop claims nothing, and so lets those of the owner ask alone.
  void note_acting(bool stop) {
    const Lease& lease = found_.axis->lease;
    acting_ = acting_ || !stop || !lease.rules.on || lease.owned_by(client_.id);
  }
  void note(Verdict verdict) { not_new_ = not_new_ || verdict == Verdict::not_new; }

  void put_words() {
    if (const RowWrite* const row = controlword_row(); row != nullptr && !row->ignored) {
      const auto word = static_cast<std::uint16_t>(row->value);
      constexpr std::uint16_t kStart = 0x0010;  // bit 4: the other words start nothing that a target belongs to
      writing_.targets = (word & kStart) != 0 ? own_.rows.targets() : 0;
      const Verdict verdict = own_.edges.controlword(word, writing_);
      words_.controlword = word;
      note(verdict);
      if (verdict == Verdict::acts) {
        batch_.controlword = word;
        batch_.single_controlword = single_;
        note_acting(is_stop(word, false));
      }
    }
    if (const RowWrite* const row = found_.of(Source::command)) {
      const auto asked = Command{static_cast<std::uint8_t>(row->value)};
      writing_.targets = own_.rows.targets_of(asked);
      const Verdict verdict = id() != 0 ? own_.edges.command_with_id(asked, id(), client_.host->ids[axis_], writing_)
                                        : own_.edges.command(asked, writing_);
      words_.command = static_cast<std::uint16_t>(asked);
      if (id() != 0) words_.id = id();
      note(verdict);
      if (verdict == Verdict::acts) batch_.command = asked;
      if (verdict == Verdict::acts) note_acting(is_stop(asked));
    }
    if (found_.of(Source::command_id) != nullptr) own_.command_id = batch_.command_id = id();
  }

  /// A scanner's image before its program runs asks for nothing. Two zeros stop all the same.
  void put_zeros() {
    words_.controlword = words_.command = 0;
    if (own_.edges.zeros(writing_)) {
      batch_.controlword = 0;
      batch_.single_controlword = false;
    }
    if (found_.of(Source::command_id) != nullptr) own_.command_id = 0;
  }

  void put_heartbeat() {
    const RowWrite* const row = found_.of(Source::heartbeat);
    if (row == nullptr) return;
    const auto word = static_cast<std::uint16_t>(row->value);
    batch_.beats = !found_.zeros && own_.heartbeat != word;
    own_.heartbeat = word;
  }

  /// Whether a value asks: a single write always; in a block where it changed, where the owner's is no longer the one
  /// accepted last, or where something acts beside it.
  enum class Asks : std::uint8_t { no, by_itself, with_command };
  [[nodiscard]] Asks asks(const RowWrite& write, bool changed) const {
    if (single_ || changed || owner_asks(write)) return Asks::by_itself;
    return acting_ ? Asks::with_command : Asks::no;
  }
  [[nodiscard]] bool owner_asks(const RowWrite& write) const {
    const AxisImage& axis = *found_.axis;
    if (write.row->source == Source::quantity)
      return onlooker_.commands.owner_asks(axis_, client_.id, write.row->quantity, write.value);
    return !write.cached && axis.reachable() && axis.lease.owned_by(client_.id);
  }

  /// What a drive holds and no write may choose, read and carried back: "no homing method", or a value beyond the
  /// limits. But a target beside what acts on it is asked for, and refused.
  [[nodiscard]] bool is_carried_back(const RowWrite& write) const {
    const RegisterRow& row = *write.row;
    const AxisImage& axis = *found_.axis;
    if (!write.cached) return false;
    if (row.source == Source::jog_velocity) return !axis.limit(Quantity::target_velocity).holds(write.value);
    if (row.source != Source::quantity) return false;
    if (row.quantity == Quantity::homing_method) return write.value == 0;
    constexpr std::array kTargets{Quantity::target_position, Quantity::target_velocity, Quantity::target_torque};
    const bool acted_on = acting_ && std::ranges::find(kTargets, row.quantity) != kTargets.end();
    return !acted_on && !axis.limit(row.quantity).holds(write.value);
  }

  /// The distance of a relative move to come, beside the command of the last one: it is no position that a limit could
  /// refuse, and is asked for with its start. Within the limits it may be a position, and is taken as one.
  [[nodiscard]] bool waits_for_its_command(const RowWrite& write) const {
    const RowWrite* const command = found_.of(Source::command);
    return !acting_ && is_quantity(*write.row, Quantity::target_position) && command != nullptr &&
           command->value == static_cast<std::int64_t>(Command::move_relative) &&
           !found_.axis->limit(Quantity::target_position).holds(write.value);
  }

  void put_rows() {
    std::size_t remembered = 0;
    for (const RowWrite& each : found_.rows) {
      if (!is_remembered(*each.row)) continue;
      const bool changed = changed_[remembered++];
      // What the drive holds, or its client has not changed, and this role may not write is nobody's question.
      if (each.ignored || onlooker_.role < each.row->may_write) continue;
      if (is_carried_back(each) || waits_for_its_command(each)) continue;
      const Asks how = asks(each, changed);
      if (how == Asks::no) continue;
      anew_ = anew_ || changed;
      put(each, how == Asks::with_command);
    }
  }

  void put(const RowWrite& write, bool with_command) {
    const RegisterRow& row = *write.row;
    if (row.source == Source::set_position_value) {
      batch_.set_position_value = static_cast<std::int32_t>(write.value);
    } else if (row.source == Source::jog_velocity) {
      batch_.jog_velocity = static_cast<std::uint32_t>(write.value);
    } else if (row.quantity != Quantity::mode) {
      batch_.setpoints.push_back({.quantity = row.quantity, .value = write.value, .with_command = with_command});
    } else if (!with_command || batch_.controlword) {
      // Commands 6 to 11 select the mode they need: one that merely stands beside them would only be left again.
      batch_.mode = static_cast<std::int16_t>(write.value);
    }
  }

  const RowWrites& found_;
  const Onlooker& onlooker_;
  Client& client_;
  AxisNumber axis_;
  ClientAxis& own_;
  bool single_;
  Writing writing_;
  LastWords words_;
  WriteBatch batch_;
  boost::container::static_vector<bool, kMaxWriteRegisters> changed_{};
  bool acting_ = false;
  bool not_new_ = false;
  bool anew_ = false;  ///< a set-point that asks is another one than this client wrote before
};

WriteBatch object_batch(const Mailbox& box, const Client& client, Role role) {
  WriteBatch batch = client.new_batch(role);
  batch.claims = batch.reclaims = box.request == 2;
  batch.object = ObjectRequest{box.request == 2, box.index, static_cast<std::uint8_t>(box.subindex),
                               static_cast<std::uint8_t>(box.size), box.data};
  return batch;
}

/// The stop that a block asks of this axis, by the rules of edges.
std::optional<AxisStop> stop_of(const RowWrites& found, const AxisImage& axis, const Onlooker& onlooker) {
  std::optional<std::uint16_t> word, command;
  std::uint16_t id = 0;
  for (const RowWrite& each : found.rows) {
    if (each.axis != &axis || each.ignored || !takes(axis, *each.row)) continue;
    const auto value = static_cast<std::uint16_t>(each.value);
    if (is_quantity(*each.row, Quantity::controlword)) word = value;
    if (each.row->source == Source::command) command = value;
    if (each.row->source == Source::command_id) id = value;
  }
  AxisStop stop{axis.number, onlooker.client.new_batch(onlooker.role), memory_of(onlooker, axis.number)};
  stop.batch.reclaims = true;
  const Writing writing = writing_to(axis, onlooker, WriteForm::block);
  EdgeMemory edges = stop.after.edges;
  if (command && *command <= kLastCommand) {
    const Command asked{static_cast<std::uint8_t>(*command)};
    CommandIds ids = stop.after.ids.value_or(CommandIds{});
    const auto verdict = [&] {
      return id != 0 ? edges.command_with_id(asked, id, ids, writing) : edges.command(asked, writing);
    };
    if (is_stop(asked) && axis.supports(asked) && verdict() == Verdict::acts) {
      stop.batch.command = asked;
      stop.batch.command_id = id;
      if (id != 0) stop.after.ids = ids;
      stop.after.words.command = *command;
      if (id != 0) stop.after.words.id = id;
      stop.after.edges = edges;
    }
  }
  // Of its owner, and beside another stop, a word that only disables is one as well.
  const bool disables = stop.batch.command != Command::none || axis.lease.owned_by(onlooker.client.id);
  if (word && is_stop(*word, disables) && edges.controlword(*word, writing) == Verdict::acts) {
    stop.batch.controlword = word;
    stop.after.words.controlword = word;
    stop.after.edges = edges;
  }
  return asks_nothing(stop.batch) ? std::nullopt : std::optional(stop);
}

std::vector<AxisStop> stops_in(const RowWrites& found, const Onlooker& onlooker) {
  std::vector<AxisStop> stops;
  if (!found.several || onlooker.role < Role::operator_) return stops;
  const AxisImage* last = nullptr;
  for (const RowWrite& each : found.rows) {
    if (each.axis == nullptr || each.axis == std::exchange(last, each.axis)) continue;
    if (const auto stop = stop_of(found, *each.axis, onlooker)) stops.push_back(*stop);
  }
  return stops;
}

/// Of function 23, what it reads, which is judged before anything is written (V1.1b3 6.17).
Errc check_read(const Request& request, const UnitView& view, const Onlooker& onlooker) {
  if (!request.reads()) return Errc::ok;
  const ModbusException wrong = judge_registers_read(request, view, onlooker);
  if (wrong == ModbusException::none) return Errc::ok;
  return wrong == ModbusException::illegal_data_address ? Errc::not_supported : Errc::link_lost;
}

/// Gateway register 8. Changed by who may command, it is a sign of life for every axis that its client owns, and takes
/// none over: another program at the address of one that has died beats it as well.
void beat(Client& client, std::uint16_t value, const Onlooker& onlooker) {
  client.heartbeat = value;
  if (onlooker.role < Role::operator_ || client.beat == value) return;
  client.beat = value;
  client.life->heartbeat = onlooker.now;
}

}  // namespace

Errc check_row(const Request& request, const UnitView& view, const Onlooker& onlooker) {
  return check_role_and_addresses(resolve_rows(request, view, onlooker), onlooker.role).code;
}

std::vector<AxisStop> stops_in_registers(const Request& request, const UnitView& view, const Onlooker& onlooker) {
  return stops_in(resolve_rows(request, view, onlooker), onlooker);
}

Planned plan_register_write(const Request& request, const UnitView& view, const Onlooker& onlooker, Client& client) {
  const RowWrites found = resolve_rows(request, view, onlooker);
  const auto refuse = [&](const WrongRow& found_wrong) {
    const WrongRow wrong = first_refused(found, found_wrong);
    return Refused{wrong.code, found.several && is_wrong(wrong.code) ? std::optional(wrong.row) : std::nullopt,
                   stops_in(found, onlooker)};
  };
  if (const WrongRow wrong = check_rows(found, onlooker.role); wrong.code != Errc::ok) return refuse(wrong);
  if (const Errc wrong = check_read(request, view, onlooker); wrong != Errc::ok)
    return Refused{wrong, std::nullopt, stops_in(found, onlooker)};

  WritePlan plan;
  if (found.axis == nullptr) {
    beat(client, static_cast<std::uint16_t>(found.rows.front().value), onlooker);
    return plan;
  }
  plan.axis = found.axis->number;
  const ClientAxis* before = client.find(plan.axis);
  const MailboxWrite box = write_mailbox(found, before == nullptr ? Mailbox{} : before->mailbox);
  if (box.refused.code != Errc::ok) return refuse(box.refused);

  ClientAxis& own = client.at(plan.axis);
  plan.before = memory_of(onlooker, plan.axis);
  const BatchMaker::Made made = BatchMaker(found, onlooker, client).make();
  own.mailbox = box.mailbox;
  if (box.requested) {
    own.used = true;
    own.mailbox.status = ObjectStatus::busy;
    own.mailbox.detail = 0;
    plan.object = object_batch(box.mailbox, client, onlooker.role);
  }
  plan.reads_alone = reads_alone(found);
  plan.not_new = made.not_new;
  plan.repeats = made.repeats;
  plan.single = !found.block;
  plan.block = block_write(request, plan.axis);
  // The mailbox's own request stands for a write batch that asks for nothing beside it.
  if (!box.requested || made.batch.beats || !asks_nothing(made.batch)) plan.batches.push_back(made.batch);
  return plan;
}

}  // namespace axisgate::modbus_tcp
