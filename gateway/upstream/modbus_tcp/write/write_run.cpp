// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/write/write_run.hpp"

#include <utility>

namespace axisgate::modbus_tcp {
namespace {

/// Pressing again is a new press, not the same one twice: nothing has come of it. After an unknown outcome the drive
/// may have acted, so there a repetition within rearm_ms stays one press.
bool did_nothing(Errc code) {
  return code != Errc::ok && code != Errc::stopped_by_other && code != Errc::not_new &&
         command_result(code) != CommandResult::outcome_unknown;
}

/// Of a write batch that asks for nothing, or for what its client asked for before: the client's result registers go on
/// telling of what was asked last.
constexpr std::uint64_t kNoSubmission = 0;

/// CiA 301: "length of service parameter does not match". The object is longer than registers 84 and 85.
constexpr std::uint32_t kAbortLength = 0x06070010;

/// For register 88: the drive's own code (an abort code on CANopen), else one for it, else the exception that says why
/// there is none.
std::uint32_t object_detail(const BatchResult& result) {
  if (result.outcome.code == Errc::ok) return 0;
  if (result.outcome.detail != 0) return result.outcome.detail;
  return result.abort_code != 0 ? result.abort_code : static_cast<std::uint32_t>(modbus_exception(result.outcome.code));
}

}  // namespace

WriteRun::WriteRun(CommandPort& commands, const std::shared_ptr<Client>& client, WritePlan plan, Instant now,
                   const ListenerSettings& settings, const Log& log)
    : commands_(commands), client_(client), plan_(std::move(plan)), log_(log), asked_at_(now) {
  const auto set_deadlines = [&](WriteBatch& batch) {
    batch.start_by = now + settings.start_deadline;
    batch.answer_by = now + settings.reply_deadline;
  };
  for (WriteBatch& batch : plan_.batches) set_deadlines(batch);
  if (plan_.object) set_deadlines(*plan_.object);
}

ClientAxis* WriteRun::own() const {
  const std::shared_ptr<Client> client = client_.lock();
  return client == nullptr ? nullptr : &client->at(plan_.axis);
}

std::optional<Outcome> WriteRun::start(OnDone on_done) {
  on_done_ = std::move(on_done);
  return carry_on();
}

void WriteRun::abandon() {
  abandoned_ = true;
  on_done_ = nullptr;
}

std::optional<Outcome> WriteRun::carry_on() {
  if (const ClientAxis* const axis = own(); axis != nullptr && next_ == 0) submission_ = axis->submission;
  while (next_ < plan_.batches.size()) {
    const WriteBatch& batch = plan_.batches[next_++];
    const std::optional<Shown> pending = shown_pending();
    const bool silent = plan_.repeats || asks_nothing(batch);
    const std::uint64_t submission = silent ? kNoSubmission : begin(batch.command_id);
    // The callback holds the run: results are recorded even when the session that began it is gone.
    const auto at_once = commands_.submit(
        plan_.axis, batch,
        [self = shared_from_this(), submission](const BatchResult& result) { self->on_result(submission, result); });
    if (!at_once) return std::nullopt;
    const Outcome outcome = answered(at_once->outcome);
    // Behind a write batch that has acted the request was not refused as a whole, and others may have come since it
    // began.
    if (is_wrong(outcome.code) && next_ == 1) forget();
    settle(submission, {outcome});
    if (is_wrong(outcome.code))
      tell_refused({.code = at_once->outcome.code, .row = row_of(*at_once), .limit = at_once->limit}, pending);
    if (outcome.code != Errc::ok) return end(outcome);
  }
  if (plan_.not_new) {
    tell_not_new();
    if (plan_.single) return end({Errc::not_new, 0});
  }
  if (plan_.afterwards != Errc::ok) {
    const Outcome dropped{plan_.afterwards, 0};
    settle(begin(0), {dropped});
    return end(dropped);
  }
  return submit_object();
}

/// A scanner that holds what has ended repeats itself, and its own result stands.
Outcome WriteRun::answered(const Outcome& outcome) const {
  return outcome.code == Errc::not_new && !plan_.single ? Outcome{} : outcome;
}

void WriteRun::on_result(std::uint64_t submission, const BatchResult& result) {
  const ClientAxis* const axis = own();
  const bool newest = axis != nullptr && axis->submission == submission;
  settle(submission, result);
  if (is_wrong(result.outcome.code)) {
    tell_refused({.code = result.outcome.code, .row = row_of(result), .limit = result.limit},
                 newest ? std::nullopt : shown());
  }
  std::optional<Outcome> outcome;
  if (result.outcome.code != Errc::ok || abandoned_) {
    outcome = end(result.outcome);
  } else {
    outcome = carry_on();
  }
  // Moved out first: whoever is told may let go of this run.
  if (outcome && on_done_) std::exchange(on_done_, nullptr)(*outcome);
}

std::optional<std::uint16_t> WriteRun::row_of(const BatchResult& result) const {
  return plan_.block.coils ? coil_of(plan_.batches[next_ - 1].command) : result.refused_row;
}

std::optional<WriteRun::Shown> WriteRun::shown() const {
  const ClientAxis* const axis = own();
  return axis == nullptr ? std::nullopt : std::optional(Shown{axis->result, axis->submission});
}

std::optional<WriteRun::Shown> WriteRun::shown_pending() const {
  const std::optional<Shown> now = shown();
  return now && now->result.result == CommandResult::pending ? now : std::nullopt;
}

/// `stays`: what the client's registers tell of all the same, since it was asked later or has not ended yet.
void WriteRun::tell_refused(const Refused& refused, const std::optional<Shown>& stays) {
  const std::shared_ptr<Client> client = client_.lock();
  if (client == nullptr) return;
  BlockWrite block = plan_.block;
  block.limit = refused.limit;
  if (plan_.single) return log_refused_write(block, {refused.code}, *client, asked_at_, log_);
  if (!refused.row) return;
  ClientAxis& axis = client->at(plan_.axis);
  if (stays) {
    axis.result = stays->result;
    axis.submission = stays->submission;
  } else {
    show_refused(axis, *refused.row);
  }
  log_refused(block, {*refused.row, refused.code}, *client, log_);
}

void WriteRun::forget() {
  if (const std::shared_ptr<Client> client = client_.lock()) restore(plan_.before, *client, plan_.axis);
}

/// Its id and its motion stay what they were: nothing new was seen, and nothing has moved. What its client has asked
/// for since stands.
void WriteRun::tell_not_new() {
  ClientAxis* const axis = own();
  if (axis == nullptr || axis->submission != submission_) return;
  axis->used = true;
  axis->result.result = CommandResult::not_new;
  axis->result.detail = 0;
  submission_ = ++axis->submission;
}

std::uint64_t WriteRun::begin(std::uint16_t command_id) {
  ClientAxis* const axis = own();
  if (axis == nullptr) return 0;
  axis->used = true;
  axis->not_new_logged = false;
  axis->result = {CommandResult::pending, 0, command_id};
  return submission_ = ++axis->submission;
}

void WriteRun::note_presses(ClientAxis& axis, const BatchResult& result) const {
  const Errc code = result.outcome.code;
  const WriteBatch& batch = plan_.batches[next_ - 1];
  if (code == Errc::ok) axis.edges.own(plan_.request);
  if (code == Errc::not_owner) axis.edges.disown(plan_.request);
  if (code == Errc::ok || result.controlword_done) axis.edges.controlword_done(plan_.request);
  if (code == Errc::ok && batch.command != Command::none) axis.edges.command_done(plan_.request, batch.command);
  if (did_nothing(code)) axis.edges.forget_presses(plan_.request, result.command_sent);
}

void WriteRun::settle(std::uint64_t submission, const BatchResult& result) {
  const Outcome& outcome = result.outcome;
  ClientAxis* const axis = own();
  if (axis == nullptr) return;
  note_presses(*axis, result);
  if (submission == kNoSubmission) {
    // It asked for nothing, so there is nothing to tell of but a refusal.
    if (outcome.code == Errc::ok) return;
    if (outcome.code == Errc::not_new) return tell_not_new();
    submission = begin(0);
  }
  if (axis->submission != submission) return;
  axis->result.result = command_result(outcome.code);
  axis->result.detail = outcome.detail;
  axis->result.stop = result.stop;
}

Outcome WriteRun::submit_object() {
  if (!plan_.object) return done();
  const std::optional<Shown> pending = shown_pending();
  const auto at_once =
      commands_.submit(plan_.axis, *plan_.object,
                       [self = shared_from_this()](const BatchResult& result) { self->settle_object(result); });
  if (!at_once) return done();  // "writing 80 returns at once and 86 tells the rest"
  settle_object(*at_once);
  if (at_once->outcome.code == Errc::ok) return done();
  if (is_wrong(at_once->outcome.code)) tell_refused({at_once->outcome.code, at_once->refused_row}, pending);
  return at_once->outcome;
}

Outcome WriteRun::done() {
  ClientAxis* const axis = own();
  if (axis != nullptr && !plan_.single) note_block_done(*axis);
  return {};
}

void WriteRun::settle_object(const BatchResult& result) {
  ClientAxis* const axis = own();
  if (axis == nullptr) return;
  Mailbox& box = axis->mailbox;
  const bool done = result.outcome.code == Errc::ok;
  const bool too_long = done && (result.object_size > 4 || result.object_bytes != nullptr);
  box.status = done && !too_long ? ObjectStatus::done : ObjectStatus::failed;
  box.detail = too_long ? kAbortLength : object_detail(result);
  if (box.status == ObjectStatus::done && plan_.object->object && !plan_.object->object->write) {
    box.data = result.object_data;
  }
}

/// The mailbox was promised an end when the request was taken; a failure before its turn is that end.
Outcome WriteRun::end(const Outcome& outcome) {
  if (plan_.object) settle_object({outcome});
  return outcome;
}

}  // namespace axisgate::modbus_tcp
