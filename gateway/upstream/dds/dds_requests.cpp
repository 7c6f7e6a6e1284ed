// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/dds_requests.hpp"

#include <fmt/format.h>

#include <utility>

#include "gateway/core/words.hpp"
#include "gateway/image/shown.hpp"
#include "gateway/upstream/dds/addressee.hpp"
#include "gateway/upstream/dds/dds_session.hpp"
#include "gateway/upstream/dds/object_batches.hpp"

namespace axisgate::dds {
namespace {

// schemas/axisgate.idl
constexpr std::uint8_t kAlreadySeen = 21, kNameTaken = 22;
constexpr std::uint8_t kPending = static_cast<std::uint8_t>(CommandResult::pending);

template <typename Request>
RequestKey key_of(const Request& record) {
  return {record.writer, record.axis, record.request_id};
}
std::uint8_t number_of(const CommandRecord& record) { return record.command; }
std::uint8_t number_of(const ObjectRequestRecord&) { return 0; }

bool is_press(const CommandRecord& record) { return is_jog(Command{record.command}); }

bool runs(const AxisImage& axis, Command jog) { return (unsigned{shown_level_coils(axis)} >> jog_coil(jog) & 1U) != 0; }

}  // namespace

/// The write batches of one request, one after another.
struct DdsRequests::Run {
  std::weak_ptr<DdsRequests> of;
  CommandPort& commands;
  AxisNumber axis;
  CommandPlan plan;
  Done done;
  std::uint64_t stops = 0;      ///< of the axis through this session, when it began
  AxisRecord::Point since = 0;  ///< when it began
  std::size_t next = 0;
  /// There was a stop, by whichever way: what is left of it was asked before.
  [[nodiscard]] bool stopped(const StopOrder& order, const ProcessImage& image) const {
    if (next == plan.batches.size()) return false;
    const AxisImage* const there = image.find(axis);
    return order.count(axis) != stops ||
           (there != nullptr && there->record.interrupted(since, plan.batches[next].client));
  }
};

DdsRequests::DdsRequests(RequestContext with, DdsClients& clients, ReplyQueue& replies, std::function<void()> wake)
    : with_(std::move(with)),
      clients_(clients),
      replies_(replies),
      wake_(std::move(wake)),
      memory_(RequestBounds{}, kRequestsKept) {}

const DdsUnits& RequestContext::units_of(AxisNumber axis) const {
  static const DdsUnits kUsual;
  const auto found = units.find(axis);
  return found == units.end() ? kUsual : found->second;
}

// --- Taking a request ------------------------------------------------------------------------------------------------

bool DdsRequests::is_for_us(const GatewayId& gateway, const Guid& writer, bool lets_go, Instant now) {
  const Addressee whose = addressee(gateway, with_.settings.gateway);
  if (whose != Addressee::nobody) return whose != Addressee::other;
  // A stop too many is the smaller harm.
  if (!lets_go) {
    tell(writer,
         fmt::format("a request for gateway \"{}\", key {:08x}, is not answered: this one is \"{}\", key {:08x}",
                     gateway.name, gateway.key, with_.settings.gateway.name, with_.settings.gateway.key),
         now);
  }
  return lets_go;
}

DdsRequests::Admitted DdsRequests::admit(const Asked& asked, Instant now) {
  if (!with_.settings.commands) return NotAdmitted{dds_result(Errc::role_forbidden)};
  // Nor is it remembered, or a sign of life: whoever was cut off may ask once more.
  if (!asked.fresh && !asked.lets_go) return NotAdmitted{dds_result(Errc::never_started)};
  const RequestKey& key = asked.key;
  const NotAdmitted busy{dds_result(Errc::queue_full)};
  const DdsClient* const client = clients_.on_sample(key.writer, asked.strength, asked.fresh, now);
  if (client == nullptr && !asked.stops) return busy;
  // What is refused here is not remembered, nor is a stop that came when there was no room: it is one as often as it
  // comes.
  if (!replies_.admits() && !asked.stops) return busy;
  if (key.request_id != 0) {
    const RequestMemory::Seen seen = memory_.see(key, asked.command, now);
    if (seen.known == RequestMemory::Known::full && !asked.stops) return busy;
    if (seen.known == RequestMemory::Known::again) {
      // A stop acts if the command or the id differs from what its writer has asked of the axis last.
      const bool differs = seen.command != asked.command || !seen.newest;
      if (!asked.stops || !differs) return NotAdmitted{kAlreadySeen, seen.result == 0 ? kPending : seen.result};
      memory_.acts(key, asked.command);
    }
  } else if (!asked.stops) {
    return NotAdmitted{dds_result(Errc::bad_value)};
  }
  return client != nullptr ? std::shared_ptr<const ClientLife>(client->life) : clients_.stranger(key.writer, now);
}

WriteBatch DdsRequests::new_batch(std::shared_ptr<const ClientLife> life, bool fresh, Instant now) const {
  WriteBatch batch;
  batch.client = life->id;
  batch.role = life->role;
  batch.life = std::move(life);
  batch.renews = batch.reclaims = fresh;
  batch.start_by = now + with_.settings.start_deadline;
  batch.answer_by = now + with_.settings.reply_deadline;
  return batch;
}

void DdsRequests::on_command(const CommandRecord& asked, Instant now) {
  const std::string_view what = text(Command{asked.command});
  const bool exempt = lets_go(asked);
  if (!is_for_us(asked.gateway, asked.writer, exempt, now)) return;
  const bool named = asked.gateway == with_.settings.gateway;
  if (!named && !exempt) return refuse(asked, what, {dds_result(Errc::bad_value)}, now);
  const bool fresh = with_.signs.fresh(asked.written, asked.received, now);
  const Admitted admitted = admit({.key = key_of(asked),
                                   .command = asked.command,
                                   .strength = asked.strength,
                                   .stops = stops(asked),
                                   .lets_go = exempt,
                                   .fresh = fresh && named},
                                  now);
  if (const auto* const why = std::get_if<NotAdmitted>(&admitted)) return refuse(asked, what, *why, now);
  const auto& life = std::get<std::shared_ptr<const ClientLife>>(admitted);
  if (!exempt && with_.stop_order.overtaken(asked.axis, asked.received)) {
    press_in_vain(asked);
    return end(asked, what, Errc::dropped_by_stop, now);
  }
  const AxisImage* const axis = with_.image.find(asked.axis);

  // Only the stop or the release is carried out of what is too old, or not surely meant for us.
  CommandRecord record = asked;
  if (!fresh || !named) record.mask = 0;
  DdsClient* const client = clients_.find(record.writer);
  if (client != nullptr) {
    client->commands = true;
    if (axis != nullptr && !axis->lease.rules.on && !exempt) client->unleased = true;
  }
  bool held = false;
  if (client != nullptr && is_press(record)) {
    const auto found = client->held.find(record.axis);
    held = found != client->held.end() && found->second.direction == Command{record.command};
  }
  // Of a stop or a release it is what stands beside it that is refused.
  const bool begins = with_.namesakes.taken() && axis != nullptr && begins_beside(record, *axis);
  if (with_.namesakes.taken() && (starts(record, held) || (begins && !exempt)))
    return end(record, what, kNameTaken, now);
  if (begins) record.mask = 0;
  PlannedCommand planned =
      plan_command(record, new_batch(life, fresh && named, now), axis, with_.units_of(record.axis), held);
  if (const auto* const refused = std::get_if<Errc>(&planned)) return end(record, what, *refused, now);
  auto& plan = std::get<CommandPlan>(planned);
  if (record.request_id == 0) plan.afterwards = Errc::bad_value;
  if (record.mask != asked.mask && !begins) plan.afterwards = Errc::never_started;
  press(record, axis, held);
  if (stops(record)) with_.stop_order.stopped(record.axis, record.received);
  // Where the participant has written objects of this axis first, by its other writer, that one makes way.
  const auto& owner = axis->lease.owner;
  if (client != nullptr && owner && clients_.asks_for_objects(*owner, *life)) client->life->goes_on_for = owner->id;
  start(record.axis, std::move(plan), [record, held, begins](DdsRequests& self, const BatchResult& result) {
    if (!begins || result.outcome.code != Errc::ok) return self.end_command(record, held, result);
    self.memory_.ended(key_of(record), record.command, kNameTaken);
    self.reply(record, kNameTaken);
  });
}

void DdsRequests::on_object(const ObjectRequestRecord& record, Instant now) {
  const std::string_view what = record.write ? "a write of an object" : "";
  if (!is_for_us(record.gateway, record.writer, false, now)) return;
  if (record.gateway != with_.settings.gateway) return refuse(record, what, {dds_result(Errc::bad_value)}, now);
  const bool fresh = with_.signs.fresh(record.written, record.received, now);
  const Admitted admitted = admit({.key = key_of(record), .fresh = fresh}, now);
  if (const auto* const why = std::get_if<NotAdmitted>(&admitted)) return refuse(record, what, *why, now);
  if (record.write && with_.stop_order.overtaken(record.axis, record.received))
    return end(record, what, Errc::dropped_by_stop, now);
  // Nobody knows here what an object does: it may enable, or start.
  if (record.write && with_.namesakes.taken()) return end(record, what, kNameTaken, now);
  auto life = std::get<std::shared_ptr<const ClientLife>>(admitted);
  const AxisImage* const axis = with_.image.find(record.axis);
  // Objects are asked for by a writer of their own: where its participant commands the axis by another, it is that
  // client who writes.
  if (axis != nullptr && record.write) {
    const auto& owner = axis->lease.owner;
    const bool of_this_session = owner && owner->id >= kFirstDdsClient;
    if (of_this_session && owner->connected && owner->origin == life->origin) life = owner;
  }
  const PlannedObject planned = plan_object(record, new_batch(life, fresh, now), axis);
  if (const auto* const refused = std::get_if<Errc>(&planned)) return end(record, what, *refused, now);
  // The bytes that are written belong to the write batch now; the reply needs none of them.
  ObjectRequestRecord asked = record;
  asked.data.clear();
  start(record.axis, {{std::get<WriteBatch>(planned)}, Errc::ok},
        [asked = std::move(asked)](DdsRequests& self, const BatchResult& result) {
          const ObjectReplyRecord reply = object_reply(asked, result);
          self.memory_.ended(key_of(asked), number_of(asked), reply.result);
          self.replies_.add(reply);
        });
}

template <typename Request>
void DdsRequests::refuse(const Request& record, std::string_view what, NotAdmitted why, Instant now) {
  if (!what.empty()) tell_refused(record.writer, record.axis, what, why.result, now);
  reply(record, why.result, why.detail);
}

template <typename Request>
void DdsRequests::end(const Request& record, std::string_view what, std::uint8_t result, Instant now) {
  memory_.ended(key_of(record), number_of(record), result);
  refuse(record, what, {result}, now);
}

template <typename Request>
void DdsRequests::end(const Request& record, std::string_view what, Errc code, Instant now) {
  end(record, what, dds_result(code), now);
}

// What the axes themselves refuse is an event of theirs. A request that was seen before has had its line.
void DdsRequests::tell_refused(const Guid& writer, AxisNumber axis, std::string_view what, std::uint8_t result,
                               Instant now) {
  if (result == kAlreadySeen) return;
  const Word* const word = find_word(WordKind::result, result);
  tell(writer,
       std::string(what) + " of axis " + std::to_string(axis) + " is refused: result " + std::to_string(result) +
           (word == nullptr ? std::string() : " " + std::string(word->name) + ": " + std::string(word->meaning)),
       now);
}

void DdsRequests::tell(const Guid& writer, const std::string& what, Instant now) {
  if (!with_.tell || !refused_lines_.takes(now)) return;
  with_.tell(clients_.name_of(writer) + ": " + what + left_out_text(refused_lines_.left_out()));
}

// --- Carrying it out -------------------------------------------------------------------------------------------------

/// `last`: the result of the write batch before.
std::optional<BatchResult> DdsRequests::carry_on(const std::shared_ptr<Run>& run, BatchResult last) {
  while (last.outcome.code == Errc::ok && run->next < run->plan.batches.size()) {
    const WriteBatch& batch = run->plan.batches[run->next++];
    const auto at_once = run->commands.submit(run->axis, batch, [run](const BatchResult& result) {
      const auto self = run->of.lock();
      if (self == nullptr) return;  // nobody is there to be told, nor to ask for the rest
      BatchResult so_far = result;
      if (so_far.outcome.code == Errc::ok && run->stopped(self->with_.stop_order, self->with_.image))
        so_far.outcome = refusal(Errc::dropped_by_stop);
      const auto end = carry_on(run, so_far);
      if (!end) return;
      self->replies_.end();
      run->done(*self, *end);
      self->wake_();
    });
    if (!at_once) return std::nullopt;
    last = *at_once;
  }
  if (last.outcome.code == Errc::ok) last.outcome = refusal(run->plan.afterwards);
  return last;
}

void DdsRequests::start(AxisNumber axis, CommandPlan plan, Done done) {
  const auto run = std::make_shared<Run>(Run{self_, with_.commands, axis, std::move(plan), std::move(done)});
  run->stops = with_.stop_order.count(axis);
  if (const AxisImage* const there = with_.image.find(axis)) run->since = there->record.now();
  replies_.begin();
  const auto result = carry_on(run, {});
  if (!result) return;
  replies_.end();
  run->done(*this, *result);
}

void DdsRequests::end_command(const CommandRecord& record, bool held, const BatchResult& result) {
  const Outcome outcome = is_press(record) ? of_jog(record, held, result.outcome) : result.outcome;
  const std::uint8_t code = dds_result(outcome.code);
  memory_.ended(key_of(record), number_of(record), code);
  reply(record, code, outcome.detail);
}

void DdsRequests::reply(const CommandRecord& record, std::uint8_t result, std::uint32_t detail) {
  replies_.add(ReplyRecord{record.axis, record.request_id, record.writer, result, detail});
}

void DdsRequests::reply(const ObjectRequestRecord& record, std::uint8_t result, std::uint32_t detail) {
  replies_.add(ObjectReplyRecord{record.axis, record.request_id, record.writer, result, detail, 0, {}});
}

// --- Jog -------------------------------------------------------------------------------------------------------------

void DdsRequests::press(const CommandRecord& record, const AxisImage* axis, bool held) {
  DdsClient* const client = clients_.find(record.writer);
  if (client == nullptr || axis == nullptr) return;
  if (Command{record.command} == Command::jog_end) {
    client->held.erase(record.axis);
    client->released[record.axis] = record.received;
  }
  if (is_press(record) && !held) client->held[record.axis] = {Command{record.command}, record.request_id, true};
}

void DdsRequests::press_in_vain(const CommandRecord& record) {
  DdsClient* const client = clients_.find(record.writer);
  if (client == nullptr || !is_press(record)) return;
  const auto released = client->released.find(record.axis);
  if (released != client->released.end() && released->second > record.received) return;
  client->held.try_emplace(record.axis, HeldJog{Command{record.command}, record.request_id, false});
}

Outcome DdsRequests::of_jog(const CommandRecord& record, bool held, const Outcome& outcome) {
  DdsClient* const client = clients_.find(record.writer);
  const AxisImage* const axis = with_.image.find(record.axis);
  if (client == nullptr || axis == nullptr) return outcome;
  const auto found = client->held.find(record.axis);
  if (found == client->held.end()) return outcome;
  HeldJog& jog = found->second;
  if (held) {
    // It is held, but what it began has ended: it says so, rather than "done".
    const bool ended = outcome.code == Errc::ok && !jog.starting && !runs(*axis, Command{record.command});
    return ended ? refusal(Errc::state_unsuitable) : outcome;
  }
  if (jog.request_id != record.request_id) return outcome;
  jog.starting = false;
  // One that was refused has begun nothing, and may be pressed again. But one that is held while another client owns
  // the axis starts nothing on the day on which the axis is free, and one that a stop has ended is not pressed anew by
  // being held.
  const bool is_held = outcome.code == Errc::ok || outcome.code == Errc::not_owner ||
                       outcome.code == Errc::dropped_by_stop || outcome.code == Errc::stopped_by_other;
  if (!is_held) client->held.erase(found);
  return outcome;
}

}  // namespace axisgate::dds
