#include "gateway/upstream/dds/dds_requests.hpp"

#include <utility>

#include "gateway/core/words.hpp"
#include "gateway/image/shown.hpp"
#include "gateway/upstream/dds/dds_face.hpp"
#include "gateway/upstream/dds/object_groups.hpp"

namespace axisgate::dds {
namespace {

constexpr std::uint8_t kAlreadySeen = 21;  // schemas/axisgate.idl

bool is_press(const CommandRecord& record) {
  const auto command = Command{record.command};
  return command == Command::jog_forward || command == Command::jog_reverse;
}

bool runs(const AxisImage& axis, Command jog) {
  constexpr unsigned kForward = 8, kReverse = 9;  // coils that read back which way it jogs
  const unsigned coils = shown_level_coils(axis);
  return (coils >> (jog == Command::jog_forward ? kForward : kReverse) & 1U) != 0;
}

}  // namespace

/// The groups of one request, one after another.
struct DdsRequests::Run {
  std::weak_ptr<DdsRequests> of;
  CommandPort& commands;
  AxisNumber axis;
  CommandPlan plan;
  Done done;
  std::size_t next = 0;
};

DdsRequests::DdsRequests(const DdsSettings& settings, const UnitsOfAxes& units, const ProcessImage& image,
                         CommandPort& commands, DdsClients& clients, ReplyQueue& replies, std::function<void()> wake,
                         TellLine tell)
    : settings_(settings),
      units_(units),
      image_(image),
      commands_(commands),
      clients_(clients),
      replies_(replies),
      wake_(std::move(wake)),
      tell_(std::move(tell)),
      memory_(kMaxRequestsKept, kRequestsKept) {}

// --- Taking a request ------------------------------------------------------------------------------------------------

DdsRequests::Admitted DdsRequests::admit(const RequestKey& key, bool stops, Instant now) {
  if (!settings_.commands) return dds_result(Errc::role_forbidden);
  const DdsClient* const client = clients_.on_sample(key.writer, now);
  if (client == nullptr && !stops) return dds_result(Errc::queue_full);
  // What is refused here is not remembered, nor is a stop that came when there was no room: it is one as often as it
  // comes.
  if (!replies_.admits() && !stops) return dds_result(Errc::queue_full);
  if (key.request_id != 0) {
    const RequestMemory::Seen seen = memory_.see(key, now);
    if (seen == RequestMemory::Seen::again) return kAlreadySeen;
    if (seen == RequestMemory::Seen::full && !stops) return dds_result(Errc::busy);
  } else if (!stops) {
    return dds_result(Errc::bad_value);
  }
  return client != nullptr ? std::shared_ptr<const ClientLife>(client->life) : clients_.stranger(key.writer, now);
}

Group DdsRequests::new_group(std::shared_ptr<const ClientLife> life, Instant now) const {
  Group group;
  group.client = life->id;
  group.role = life->role;
  group.life = std::move(life);
  group.start_by = now + settings_.start_deadline;
  group.answer_by = now + settings_.reply_deadline;
  return group;
}

void DdsRequests::on_command(const CommandRecord& record, Instant now) {
  const auto refuse = [&](std::uint8_t result) {
    tell_refused(record.writer, record.axis, text(Command{record.command}), result, now);
    reply(record, result);
  };
  const Admitted admitted = admit({record.writer, record.axis, record.request_id}, stops(record), now);
  if (const auto* const result = std::get_if<std::uint8_t>(&admitted)) return refuse(*result);
  const auto& life = std::get<std::shared_ptr<const ClientLife>>(admitted);
  const AxisImage* const axis = image_.find(record.axis);

  DdsClient* const client = clients_.find(record.writer);
  if (client != nullptr) client->commands = true;
  bool held = false;
  if (client != nullptr && is_press(record)) {
    const auto found = client->held.find(record.axis);
    held = found != client->held.end() && found->second.direction == Command{record.command};
  }
  static const DdsUnits kUsual;
  const auto units = units_.find(record.axis);
  PlannedCommand planned =
      plan_command(record, new_group(life, now), axis, units == units_.end() ? kUsual : units->second, held);
  if (const auto* const refused = std::get_if<Errc>(&planned)) return refuse(dds_result(*refused));
  auto& plan = std::get<CommandPlan>(planned);
  if (record.request_id == 0) plan.afterwards = Errc::bad_value;
  press(record, axis, held);
  // Where the participant has written objects of this axis first, by its other writer, that one makes way: for as long
  // as the claim is judged, its lease is one that its own participant may take.
  const auto& owner = axis->lease.owner;
  const auto sibling = owner ? clients_.asks_for_objects(*owner, *life) : nullptr;
  if (sibling) sibling->connected = false;
  start(record.axis, std::move(plan),
        [record, held](DdsRequests& self, const GroupResult& result) { self.end_command(record, held, result); });
  if (sibling) sibling->connected = true;
}

void DdsRequests::on_object(const ObjectRequestRecord& record, Instant now) {
  const auto refuse = [&](std::uint8_t result) {
    ObjectReplyRecord refusal;
    refusal.axis = record.axis;
    refusal.request_id = record.request_id;
    refusal.writer = record.writer;
    refusal.result = result;
    if (record.write) tell_refused(record.writer, record.axis, "a write of an object", result, now);
    replies_.add(refusal);
  };
  const Admitted admitted = admit({record.writer, record.axis, record.request_id}, false, now);
  if (const auto* const result = std::get_if<std::uint8_t>(&admitted)) return refuse(*result);
  auto life = std::get<std::shared_ptr<const ClientLife>>(admitted);
  const AxisImage* const axis = image_.find(record.axis);
  // Objects are asked for by a writer of their own: where its participant commands the axis by another, it is that
  // client who writes.
  if (axis != nullptr && record.write) {
    const auto& owner = axis->lease.owner;
    const bool of_this_face = owner && owner->id >= kFirstDdsClient;
    if (of_this_face && owner->connected && owner->origin == life->origin) life = owner;
  }
  const PlannedObject planned = plan_object(record, new_group(life, now), axis);
  if (const auto* const refused = std::get_if<Errc>(&planned)) return refuse(dds_result(*refused));
  // The bytes that are written belong to the group now; the reply needs none of them.
  ObjectRequestRecord asked = record;
  asked.data.clear();
  start(record.axis, {{std::get<Group>(planned)}, Errc::ok},
        [asked = std::move(asked)](DdsRequests& self, const GroupResult& result) {
          self.replies_.add(object_reply(asked, result));
        });
}

// What the axes themselves refuse is an event of theirs. A request that was seen before has had its line.
void DdsRequests::tell_refused(const Guid& writer, AxisNumber axis, std::string_view what, std::uint8_t result,
                               Instant now) {
  if (!tell_ || result == kAlreadySeen || !refused_lines_.takes(now)) return;
  const Word* const word = find_word(WordKind::result, result);
  const DdsClient* const client = clients_.find(writer);
  tell_((client != nullptr ? client->life->name : client_name(writer, {})) + ": " + std::string(what) + " of axis " +
        std::to_string(axis) + " is refused: result " + std::to_string(result) +
        (word == nullptr ? std::string() : " " + std::string(word->name) + ": " + std::string(word->meaning)) +
        left_out_text(refused_lines_.left_out()));
}

// --- Carrying it out -------------------------------------------------------------------------------------------------

/// `last`: the result of the group before.
std::optional<GroupResult> DdsRequests::carry_on(const std::shared_ptr<Run>& run, GroupResult last) {
  while (last.outcome.code == Errc::ok && run->next < run->plan.groups.size()) {
    const Group& group = run->plan.groups[run->next++];
    const auto at_once = run->commands.submit(run->axis, group, [run](const GroupResult& result) {
      const auto self = run->of.lock();
      if (self == nullptr) return;  // nobody is there to be told, nor to ask for the rest
      const auto end = carry_on(run, result);
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
  const auto run = std::make_shared<Run>(Run{self_, commands_, axis, std::move(plan), std::move(done)});
  replies_.begin();
  const auto result = carry_on(run, {});
  if (!result) return;
  replies_.end();
  run->done(*this, *result);
}

void DdsRequests::end_command(const CommandRecord& record, bool held, const GroupResult& result) {
  const Outcome outcome = is_press(record) ? of_jog(record, held, result.outcome) : result.outcome;
  reply(record, dds_result(outcome.code), outcome.detail);
}

void DdsRequests::reply(const CommandRecord& record, std::uint8_t result, std::uint32_t detail) {
  replies_.add(ReplyRecord{record.axis, record.request_id, record.writer, result, detail});
}

// --- Jog -------------------------------------------------------------------------------------------------------------

void DdsRequests::press(const CommandRecord& record, const AxisImage* axis, bool held) {
  DdsClient* const client = clients_.find(record.writer);
  if (client == nullptr || axis == nullptr) return;
  if (Command{record.command} == Command::jog_end) client->held.erase(record.axis);
  if (is_press(record) && !held) client->held[record.axis] = {Command{record.command}, record.request_id, true};
}

Outcome DdsRequests::of_jog(const CommandRecord& record, bool held, const Outcome& outcome) {
  DdsClient* const client = clients_.find(record.writer);
  const AxisImage* const axis = image_.find(record.axis);
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
  // the axis starts nothing on the day on which the axis is free.
  if (outcome.code != Errc::ok && outcome.code != Errc::not_owner) client->held.erase(found);
  return outcome;
}

}  // namespace axisgate::dds
