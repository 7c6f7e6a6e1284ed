// SPDX-License-Identifier: Apache-2.0
// What clients ask in a run, and what they are told.
#include <gtest/gtest-printers.h>

#include <algorithm>
#include <utility>

#include "tests/judged/beginning.hpp"
#include "tests/judged/playing.hpp"

namespace axisgate::test::judged {

using namespace reference;
using obey::Answer;

namespace {

bool may_move(const Write& write) {
  if (write.coils())
    return write.first <= coil::start_relative && write.first + write.words.size() > coil::start_absolute;
  const Rows rows = rows_of(write);
  return rows.contains(row::command) && (rows.at(row::command) == kMove || rows.at(row::command) == kRelative);
}

}  // namespace

void Play::send(std::size_t client, Write write, bool at_once) {
  // A connection has so many requests under way at most (docs/faults.md): what comes behind them is not read before,
  // and what others say meanwhile is.
  constexpr std::ptrdiff_t kPipelined = 4;
  while (!over() && std::ranges::count(open_, client, &Open::client) >= kPipelined) pass(kStepMs);
  if (over() || !clients_.connected(client)) return;
  if (!is_dds(client)) writers_->sent(client, write);
  watch_trouble();
  const std::string before = stamp();
  const int request = contract_->send(client, write);
  watches_->cable.asked(request, write);
  ++outcome_.writes;
  const std::uint64_t number = clients_.begin(client, write);
  outcome_.story.push_back(before + ": " + kNames.at(client) + " " + text(write) + "  -> " + contract_->predicted());
  const bool of_object = rows_of(write).contains(row::object_request);
  const bool posted = plant_.listener.posted_writes && !is_dds(client) && !of_object;
  if (!is_dds(client) && !of_object) {
    told_.at(client).reset();
    // What could not be read has not been written, and register 25 tells nothing of it (ANS-11).
    const bool perhaps_unread = plant_.listener.offline_reads_fail && write.function == fc::read_write;
    newest_.at(client) = perhaps_unread ? 0 : request;
  }
  const Rows rows = write.coils() ? Rows{} : rows_of(write);
  ids_.insert(is_dds(client)                   ? static_cast<std::int64_t>(number & 0xFFFF)
              : rows.contains(row::command_id) ? rows.at(row::command_id)
                                               : 0);
  if (posted) lose_sight_of_posted(client);
  open_.push_back({request, client, number, now_ms(), outcome_.story.size() - 1, of_object, may_move(write),
                   rows.size() > 1 && rows.contains(row::command), posted});
  collect();
  while (!at_once && !over() && std::ranges::any_of(open_, [&](const Open& open) { return open.request == request; }))
    pass(kStepMs);
}

// 3.3: "statusword bit 10 and discrete input 5 are 0 from the acceptance of a motion command until" a statusword from
// after it: what waits behind another request of the same client is not accepted yet.
void Play::watch_acceptance() {
  if (contract_->in_trouble() || !plant_.stage.axis(1).has(AxisInput::target_reached)) return;
  for (Open& open : open_) {
    const auto same = [&](const Open& other) { return other.client == open.client; };
    const bool first = &*std::ranges::find_if(open_, same) == &open;
    if (open.moves && first && now_ms() > open.sent_ms) open.shows_reached = true;
  }
}

void Play::collect() {
  std::erase_if(open_, [this](Open& open) {
    if (over()) return false;
    std::string& line = outcome_.story[open.line];
    if (const auto answer = answer_to(open)) {
      if (answer->empty()) {
        line += "  [posted, and nobody can tell]";
        return never_answered(open), true;
      }
      if (!open.under_way) watches_->cable.answered(open.request);
      line += answer->contains(0) ? "  [ok]" : "  [exception";
      if (!answer->contains(0)) {
        for (const int each : *answer) line += " " + std::to_string(each);
        line += "]";
      }
      const bool tells = !is_dds(open.client) && !open.posted && newest_.at(open.client) == open.request;
      if (tells && answer->contains(0) && open.moves) looks_at_once_.insert(open.client);
      const bool new_ = !open.repeats || contract_->surely_acts(open.request);
      if (tells && new_ && !answer->contains(0)) told_.at(open.client) = *answer->begin();
      if (!contract_->answered(open.request, *answer)) {
        line += "  <-- NO READING HAS THIS ANSWER";
        violated("no reading has this answer; expected: " + contract_->expected());
      } else if (open.shows_reached && answer->contains(0) && !contract_->may_be_over()) {
        violated("target_reached of the move before was shown while this one began");
      } else if (const auto wrong = wrong_beside(open)) {
        violated(std::string("to ") + kNames.at(open.client) + " by function 23 " + *wrong);
      } else {
        line += "\n      then, " + std::to_string(contract_->worlds().size()) + " readings: " + contract_->expected();
      }
      return true;
    }
    if (!clients_.connected(open.client)) violated("the gateway has closed a connection");
    if (now_ms() - open.sent_ms > kSilenceMs) violated("a request was never answered: " + line);
    return false;
  });
  // 3.3: "a PLC never sees the target_reached of the move before".
  const std::set<std::size_t> clients = std::exchange(looks_at_once_, {});
  for (const std::size_t client : clients)
    if (!over() && std::ranges::none_of(open_, [&](const Open& open) { return open.client == client; })) read(client);
}

// What the read of a function 23 shows is of after its write.
std::optional<std::string> Play::wrong_beside(const Open& open) {
  if (open.read.size() != obey::shown::count || open.posted) return {};
  return wrong_in(shown_by(open.read), open.client, *contract_, seen_);
}

// 3.3, "posted": "answered after the checks, the outcome in 25, 26, 30". Empty: nobody can tell.
std::optional<std::set<int>> Play::answer_to(Open& open) {
  if (!open.checked) {
    if (!is_dds(open.client))
      if (const auto answer = clients_.modbus(open.client).answer_of(open.number)) open.read = answer->words;
    const std::optional<std::set<int>> answer = clients_.answer_of(open.client, open.number);
    if (!open.posted || !answer || !answer->contains(0)) return answer;
    open.checked = true;
  }
  if (!clients_.connected(open.client)) return {};
  if (!open.asked_for_result) {
    contract_->asked(open.client);
    open.asked_for_result = clients_.ask_for_result(open.client);
  }
  std::optional<Clients::Posted> became = clients_.posted(open.client, *open.asked_for_result);
  if (!became) return {};
  open.asked_for_result.reset();
  open.pending = open.pending || became->pending;
  if (became->pending) return {};
  // What asks for nothing leaves what was told before, or is told of another client's.
  open.under_way = !open.pending || !contract_->surely_acts(open.request);
  if (!became->stands_for.empty() && open.under_way) became->stands_for.insert(0);
  return became->stands_for;
}

// Register 25 tells of the newest.
void Play::lose_sight_of_posted(std::size_t client) {
  std::erase_if(open_, [&](const Open& open) {
    if (!open.posted || open.client != client) return false;
    never_answered(open);
    return true;
  });
}

void Play::never_answered(const Open& open) { contract_->unanswered(open.request); }

void Play::replace(std::size_t client, bool silently) {
  if (!clients_.connected(client)) return;
  contract_->left(client, silently);
  for (const Open& open : open_)
    if (open.client == client) never_answered(open);
  std::erase_if(open_, [&](const Open& open) { return open.client == client; });
  if (!is_dds(client)) told_.at(client).reset();
  clients_.replace(client, silently);
  outcome_.story.push_back(stamp() + ": " + kNames.at(client) + (silently ? " vanishes" : " begins anew"));
}

// Design 4, signs of life: "MANUAL_BY_TOPIC liveliness".
void Play::be_alive(std::size_t writer) {
  if (over() || !clients_.connected(kModbus + writer)) return;
  contract_->asked(kModbus + writer);
  clients_.dds().assert_liveliness(writer);
}

// Design 4, signs of life: "a changed counter renews ...; the lease is the smaller of lease_ms and the configured one";
// 0: as that is.
void Play::beat(std::size_t writer, bool counts_on) {
  constexpr std::array<std::uint32_t, kWriters> kLeases{0, 1200, 5000};
  if (over() || !clients_.connected(kModbus + writer)) return;
  // Where only a write renews, whether one that asks for a shorter lease ends it is not said.
  const std::uint32_t lease_ms = lease_of(program_, seed_).renew == LeaseRenewal::any ? kLeases.at(writer) : 0;
  if (counts_on) contract_->beats(kModbus + writer, lease_ms == 0 ? kNever : lease_ms);
  clients_.dds().beat(writer, counts_on, lease_ms);
}

// Design 4, signs of life: "if the heartbeat's writer has the GUID prefix of client"; age: "stale samples and
// heartbeats renew nothing".
void Play::beat_in_vain(std::size_t writer, bool too_old) {
  if (!over() && clients_.connected(kModbus + writer)) clients_.dds().beat_in_vain(writer, too_old);
}

Shown Play::shown_by(std::vector<std::uint16_t> words) const {
  return {.words = std::move(words),
          .low_word_first = plant_.listener.low_word_first,
          .float_numbers = plant_.listener.float_numbers,
          .alone = !another_master_ && !was_nearly_right_,
          .statusword_tells = is_cia402(program_.subject)};
}

// 3.2: what is shown as valid was true at its age.
void Play::read(std::size_t client) {
  if (!clients_.connected(client)) return;
  look();
  contract_->asked(client);
  const Answer answer = clients_.modbus(client).answer_to_read(0, obey::shown::count);
  if (!answer.ok()) {
    // 3.2: listener option "offline_reads": "exception" answers 0x0B instead.
    constexpr int kNoAnswer = 11;
    const bool fits = plant_.listener.offline_reads_fail && !plant_.stage.axis(1).reachable();
    if (!fits || answer.exception != kNoAnswer) violated("a read was answered with " + testing::PrintToString(answer));
    return;
  }
  const Shown shown = shown_by(answer.words);
  look();
  const bool open = std::ranges::any_of(open_, [client](const Open& each) { return each.client == client; });
  if (told_.at(client) && !open && !result_fits(*told_.at(client), shown.words[obey::shown::result]))
    violated("register 25 reads " + std::to_string(shown.words[obey::shown::result]) + " after exception " +
             std::to_string(*told_.at(client)));
  if (!ids_.contains(shown.words[obey::shown::motion_id])) violated("register 33 shows an id that nobody has written");
  if (const auto wrong = wrong_in(shown, client, *contract_, seen_))
    violated(std::string("to ") + kNames.at(client) + " " + *wrong);
}

// 3.1: 43/13 reads any object of any drive.
void Play::look_up(std::size_t client) {
  if (over() || !clients_.connected(client)) return;
  const ObjectPlace place = readable_object(program_.subject);
  obey::Client& modbus = clients_.modbus(client);
  const bool well = !contract_->in_trouble();
  contract_->asked(client);
  const obey::RequestNumber number = modbus.ask_for_object(place.index, place.sub);
  told_.at(client).reset();  // a refusal of it shows in register 25 as well
  const std::int64_t asked_ms = now_ms();
  while (!over() && modbus.connected() && !modbus.answer_of(number)) {
    pass(kStepMs);
    if (now_ms() - asked_ms > kSilenceMs) violated("an object that was asked for was never told");
  }
  const auto answer = modbus.answer_of(number);
  if (!answer) return;
  outcome_.story.push_back(stamp() + ": " + kNames.at(client) + " looks up " + testing::PrintToString(*answer));
  if (!answer->ok()) {
    // "not sent: plain exception 0x0A; no answer: 0x0B"; 0x06: "a stop or command for the same node" (7.3), a full
    // queue.
    const std::set<int> expected = well && !contract_->in_trouble() ? std::set{6} : std::set{6, 10, 11, 0xFF};
    if (!expected.contains(answer->exception)) violated("an object was not told");
    return;
  }
  if (!is_cia402(program_.subject)) return;
  constexpr int kStateBits = 0x6F, kOperationEnabled = 0x27;
  const bool enabled = answer->words.size() == 2 && (answer->words[0] & kStateBits) == kOperationEnabled;
  if (answer->words.size() != 2 || !seen_.was_enabled(enabled, now_ms() - asked_ms))
    violated("the drive's statusword was told otherwise");
}

}  // namespace axisgate::test::judged
