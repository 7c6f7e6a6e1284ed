// SPDX-License-Identifier: Apache-2.0
#include "tests/model/judge.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace axisgate::test::reference {
namespace {

constexpr std::int64_t kRearmUnsureMs = 150;
constexpr std::array<std::uint16_t, 11> kZeroLeaves{41, 47, 48, 50, 52, 58, 62, 64, 66, 70, 76};  // 3.3 Zeros

}  // namespace

// 3.3 Edges, 3.4 Stops: what is new, of a command without id, a controlword or an edge coil.
Judge::Edge Judge::edge(Item& item, std::int64_t value, bool single, bool stop) {
  if (item.value && *item.value != value) item.unsure = false;
  const Edge edge = new_or_not(item, value, single, stop);
  if (edge == Edge::acts || edge == Edge::remembered) item.acted = edge == Edge::acts;
  if (edge == Edge::remembered || edge == Edge::acts) item.spoilt = false;
  return edge;
}

Judge::Edge Judge::new_or_not(Item& item, std::int64_t value, bool single, bool stop) {
  const std::optional<std::int64_t> before = item.value;
  const std::int64_t quiet = seen_.now_ms - item.written_ms;
  item.value = value;
  item.written_ms = seen_.now_ms;
  // 3.4 Stops: "One acts if the command or the id differs from what is remembered, on an empty memory too, and in a
  // single write always."
  if (stop) return single || before != value ? Edge::acts : Edge::not_new;
  // 3.3 Edges: "new if it differs from the command remembered; a single write also on an empty memory ... A block write
  // on an empty memory only remembers."
  if (item.unsure && readings_.other()) return Edge::not_new;
  // Whether what was refused is remembered is not said.
  if (single && item.refused && readings_.other()) return Edge::acts;
  if (!before) return single ? Edge::acts : Edge::remembered;
  if (*before != value) return Edge::acts;
  // 3.3 Edges: "and when this client has not written it for rearm_ms, but not after another client's stop ... since it
  // acted". 3.3 Edges lets a controlword that another's stop has spoilt not act, and so a stop: the reading that stops
  // is allowed too.
  const bool stop_word = (value & 6) != 6 || (value & 15) == 6 || (value & 15) == 7;
  if (single && &item == &me().controlword && stop_word && readings_.other()) return Edge::acts;
  if (!single || item.spoilt || quiet < options_.rearm_ms - kRearmUnsureMs) return Edge::not_new;
  if (quiet < options_.rearm_ms + kRearmUnsureMs && readings_.other()) return Edge::not_new;
  return Edge::acts;
}

Judge::Edge Judge::command_edge(const Rows& rows, bool single) {
  if (!rows.contains(row::command)) return Edge::absent;  // 3.3 Edges: "Register 55 alone asks for nothing"
  const std::int64_t value = rows.at(row::command);
  const std::int64_t id = rows.contains(row::command_id) ? rows.at(row::command_id) : 0;
  ClientMemory& mine = me();
  const std::optional<std::int64_t> before = mine.command.value;
  // "The command is new if the id differs from the last non-zero id of this address", and of its connection.
  const std::optional<std::int64_t> last_id = this->last_id();
  const bool repeats = mine.own_id == id;
  // Of a pair that a new connection brings back NEW-1 says more.
  auto& ids = world_.clients[std::min(options_.address_of(client_), kModbus)].ids;
  const bool comes_back = !ids.insert(id).second && !mine.own_id;
  Edge edge = Edge::not_new;
  if (id == 0) {
    edge = this->edge(mine.command, value, single, is_stop(value));
    // 3.3 Not new: "so that no tool prints success for nothing": who owns it has something to give back.
    if (edge == Edge::not_new && single && value == kRelease && world_.owner == client_) edge = Edge::acts;
  } else {
    this->last_id() = mine.own_id = id;  // 3.3 Edges: "zeros never erase it", "Command 0 with an id sets the last id"
    mine.command.value = value;
    mine.command.written_ms = seen_.now_ms;
    if (is_stop(value))
      edge = before != value || last_id != id || !repeats ? Edge::acts : Edge::not_new;  // 3.4 Stops
    else if (!last_id)
      edge = Edge::remembered;  // 3.3 Edges: "Where none is kept, the pair is only remembered"
    else
      edge = *last_id != id && !repeats ? Edge::acts : Edge::not_new;  // 3.3 Edges: "only the id decides"
    if (comes_back && edge == Edge::acts && !is_stop(value) && readings_.other()) edge = Edge::not_new;
    if (edge == Edge::acts || before != value) mine.command.acted = edge == Edge::acts;
    if (!mine.command.acted) mine.command.spoilt = false;
  }
  return value == 0 && edge != Edge::remembered ? Edge::nothing : edge;
}

// 3.5, 3.3 What asks: "A write claims an axis only if it asks for something."
void Judge::claim() {
  if (!options_.leases) return;
  world_.owner = client_;
  world_.orphan = false;
  world_.lease_until(seen_.now_ms + options_.lease_of(client_));
}

// 3.3 Outcomes: "another client owns the axis: 0x06". Design 4: "a stronger writer takes the lease from a weaker DDS
// writer, never from a Modbus client"; "equal strength never takes a live lease".
bool Judge::foreign() const {
  if (!options_.leases || !world_.owner || *world_.owner == client_) return false;
  const std::size_t owner = *world_.owner % kGhost;
  const auto strength = [this](std::size_t client) { return options_.strengths.at(client - kModbus); };
  return !is_dds(client_) || !is_dds(owner) || strength(client_) <= strength(owner);
}

bool Judge::refuse_foreign(Verdict& verdict) {
  if (!foreign()) return false;
  verdict = {"refused: another client owns the axis", {6}};
  return refused_foreign_ = true;
}

void Judge::accept(std::uint16_t offset, std::int64_t value, bool claims) {
  if (foreign()) {
    refused_foreign_ = true;
    return;
  }
  if (claims) claim();
  const auto old = world_.accepted.find(offset);
  const bool differs = old == world_.accepted.end() || old->second != value;
  world_.accepted[offset] = value;
  // 3.4 Owed stops lets a run go on that 3.4 has ended: whether a new speed acts on it is not said.
  if (offset == row::target_velocity && differs && world_.broken && world_.motor == Motor::runs && readings_.other())
    world_.motor = Motor::unknown;
  // Whether a jog that runs goes on at another jog_velocity is not said.
  if (offset == row::jog_velocity && differs && world_.jog != 0 && readings_.other()) world_.motor = Motor::unknown;
  if (offset == row::target_velocity) speed_accepted();
  if (offset == row::profile_velocity) world_.fastest = std::max(world_.fastest, value);
  if (differs && (offset == row::target_position || offset == row::target_velocity)) {
    me().command.changed = true;
    for (Item& coil : me().coils) coil.changed = true;
  }
  // 3.3: a mode that changes under a motion; 3.4 does not say what becomes of that.
  if (offset == row::mode) {
    world_.raw_mode = world_.mode = value;
    world_.speed_mode = false;
    if (world_.motor != Motor::stands) world_.motor = Motor::unknown;
  }
  // 3.4: "target_velocity acts at once only while commands 8, 9 or raw modes 3 ... run". Whether an axis enabled in
  // mode 3 by command 1, or halted in it, is one that runs is not said.
  const bool could_run = world_.enabled && !world_.latched && world_.raw_mode == 3;
  const bool speed = world_.accepted.contains(row::target_velocity) && world_.accepted[row::target_velocity] != 0;
  if (could_run && speed && world_.motor == Motor::stands && readings_.other()) world_.motor = Motor::runs;
}

void ClientMemory::write(std::uint16_t offset, std::int64_t value, bool refused) {
  const auto last = rows.find(offset);
  if (refused)
    refused_rows.try_emplace(offset, last == rows.end() ? std::nullopt : std::optional(last->second));
  else
    refused_rows.erase(offset);
  rows[offset] = value;
}

// 3.3 What asks.
void Judge::setpoints(const Rows& rows, bool single, Edge command, Edge controlword, bool refused, bool was_empty) {
  const int carried = (command != Edge::absent ? 1 : 0) + (controlword != Edge::absent ? 1 : 0);
  const int empty = (command == Edge::remembered ? 1 : 0) + (controlword == Edge::remembered ? 1 : 0);
  // "On an empty memory a block that carries 40 or 54 only remembers its set-points." Where one of the two is empty and
  // the other is not, or a stop acts on it, the sentence can be read both ways.
  const bool sure = empty == carried && (command != Edge::acts || !was_empty);
  const bool only_remembers = !single && (empty > 0 || was_empty) && (sure || readings_.other());
  const bool takes_none = command == Edge::acts && takes_no_lease(rows.at(row::command));
  const bool claims = !options_.leases || !takes_none || readings_.other();
  const auto was_refused = [this](const auto& r) { return me().refused_rows.contains(r.first); };
  const bool otherwise = (me().rows_unsure || std::ranges::any_of(rows, was_refused)) && readings_.other();
  const bool acts = (command == Edge::acts && !refused) || controlword == Edge::acts;
  const bool owned = world_.owner == client_;
  std::optional<bool> owns_since;
  for (const auto& [offset, value] : rows) {
    if (offset == row::controlword || offset == row::command || offset == row::command_id) continue;
    const auto last = me().rows.find(offset);
    bool differs = last == me().rows.end() || last->second != value;
    const auto refused_row = me().refused_rows.find(offset);
    if (otherwise && refused_row != me().refused_rows.end()) differs = refused_row->second != value;
    if (me().rows_unsure) differs = otherwise;
    const auto wrote = [&, offset = offset, value = value](bool in_vain) { me().write(offset, value, in_vain); };
    if (!options_.rows.contains(offset)) {
      wrote(false);
      // Not judged here; but what asks claims.
      if (options_.leases && !only_remembers && (differs || acts) && !foreign() && readings_.other()) claim();
      continue;
    }
    const auto now = world_.accepted.find(offset);
    const bool other_value = now == world_.accepted.end() || now->second != value;
    bool asks = single || differs || acts;
    // "or if this client owns the axis and the value last accepted differs"; not with "lease": null. A lease may have
    // run out while the axis was disabled (3.5 Signs of life).
    // Whether the row before it, that has claimed the axis, makes it the owner is not said.
    if (!asks && options_.leases && other_value && world_.owner == client_) {
      if (!owned && !owns_since) owns_since = readings_.other();
      asks = (owned || *owns_since) && (world_.enabled || !readings_.other());
    }
    if (only_remembers) asks = false;
    wrote(asks && foreign());
    if (asks) accept(offset, value, claims);
  }
}

void Judge::leave_motion() {
  if (world_.motor != Motor::stands && !world_.arrived(seen_)) world_.earlier.push_back(world_.motion());
}

void Judge::stopped(bool asserted) {
  stopped_ = true;
  world_.mode.reset();  // how a drive stops is its profile's affair
  // 3.3, the fixed order of one request: what its set-points began ends at once.
  leave_motion();
  if (world_.motor != Motor::stands) world_.stopped_at = seen_.position;
  world_.motor = Motor::stands;  // 3.4: "a stop end[s] every motion for good"
  world_.jog = 0;
  world_.started_ms = seen_.now_ms;  // what a drive shows of standing still lags behind
  world_.stale_speed = true;
  world_.surely_stale = asserted && !speed_here_;
  // 3.3 Edges speaks of "another client's stop"; whether a disabling coil or controlword is one (3.4 Stops: "nothing
  // else") is open.
  const bool spoils = asserted || readings_.other();
  // "Since it acted": what was only remembered never did.
  std::optional<bool> remembered_too;
  for (std::size_t c = 0; c < kModbus; ++c) {
    const auto mark = [&](Item& item) {
      item.ended = true;
      if (c == client_ || !spoils || !item.value || item.unsure || item.spoilt) return;
      if (!item.acted && !remembered_too) remembered_too = readings_.other();
      item.spoilt = item.acted || *remembered_too;
    };
    mark(world_.clients[c].command);
    mark(world_.clients[c].controlword);
    for (Item& coil : world_.clients[c].coils) mark(coil);
  }
}

// 3.3 Zeros: "A block that covers 40..54 and is 0 in all of it asks for nothing and claims nothing".
bool Judge::all_zero(const Write& write, const Rows& rows, Verdict& verdict) {
  const bool covers = write.first <= row::controlword && write.first + write.words.size() > row::command;
  if (!covers || std::ranges::any_of(write.words, [](std::uint16_t word) { return word != 0; })) return false;
  ClientMemory& mine = me();
  const bool falls = mine.controlword.value && *mine.controlword.value != 0;
  mine.controlword.value = mine.command.value = 0;
  mine.controlword.written_ms = mine.command.written_ms = seen_.now_ms;
  // Whether the "last write of the row" (3.3 What asks) knows these zeros is not said.
  if (readings_.other())
    for (const auto& [offset, value] : rows) mine.rows[offset] = value;
  verdict = {"all zero: asks for nothing", {0}};
  if (falls) {
    controlword(0, false, verdict);
    return true;
  }
  // "and the owner's target_velocity or target_torque 0 acts while a run is on"; without leases nobody is the owner.
  if (world_.motor == Motor::runs && (options_.leases ? world_.owner == client_ : readings_.other()) &&
      world_.jog == 0) {
    world_.accepted[row::target_velocity] = 0;
    verdict.says = "all zero: the run's speed is 0";
  }
  return true;
}

Verdict Judge::write(const Write& write) {
  if (write.function == fc::sample) return sample(write);
  const std::optional<Half> before = std::exchange(me().half, std::nullopt);  // 3.1 Panels: "no other write between"
  if (forbidden(write)) {
    me().command.unsure = true;  // whether what is refused so is remembered is not said
    return {"not an operator's", {1}};
  }
  if (write.coils()) return coils(write);
  const auto row = half_row(write);
  if (!row) return registers(write);
  return half({*row, write.first != *row, write.words[0], seen_.now_ms, seen_.troubled}, before);
}

// 3.3 Roles: "Operator: also offsets 40..69, 78 and coils, except command 12. Engineer: also 70..77, command 12,
// mailbox and 43/13 writes ... Otherwise 0x01".
bool Judge::forbidden(const Write& write) const {
  if (!options_.operators.at(client_) || write.coils()) return false;
  const Rows rows = rows_of(write);
  const auto engineers = [](const auto& r) {
    return (r.first >= row::quick_stop_deceleration && r.first < row::set_position_value) ||
           r.first == row::object_request || (r.first == row::command && r.second == kSave);
  };
  return std::ranges::any_of(rows, engineers);
}

// 3.1 Panels: "either half of a 32-bit row first, then the other, same connection, no other write between; a lone half
// is dropped after 1 s; ... a half that comes later than that is a new first half."
Verdict Judge::half(const Half& newest, const std::optional<Half>& before) {
  constexpr std::int64_t kKeptMs = 1000, kUnsureMs = 20;
  if (!options_.staged) return {"half of a 32-bit value", {2}};  // 3.3 Outcomes
  if (before && before->row == newest.row && before->second != newest.second) {
    const std::int64_t age_ms = newest.at_ms - before->at_ms;
    const bool unsure = before->unsure || std::abs(age_ms - kKeptMs) <= kUnsureMs;
    if (unsure ? readings_.other() : age_ms < kKeptMs) {
      Write whole{fc::write_registers, newest.row, {before->word, newest.word}};
      if (before->second) std::swap(whole.words[0], whole.words[1]);
      return registers(whole);
    }
  }
  me().half = newest;
  return {"a first half", {0}};
}

Verdict Judge::registers(const Write& write) {
  Rows rows = rows_of(write);
  const bool single = write.function != fc::read_write && rows.size() == 1;  // 3.3 Edges: "A single write is ..."
  for (const std::uint16_t offset : kZeroLeaves) {
    if (!rows.contains(offset) || rows[offset] != 0) continue;
    if (single) return {"refused: 0 alone", {3}};                 // 3.3 Zeros
    if (me().rows.contains(offset)) me().write(offset, 0, true);  // "last write", or "leave as it is"
    rows.erase(offset);
  }
  Verdict verdict;
  if (single && is_parameter(rows.begin()->first)) return parameter(rows.begin()->first, rows.begin()->second);
  if (rows.contains(row::object_request)) {
    object(write.function, verdict);
    return verdict;
  }
  if (!single && all_zero(write, rows, verdict)) return verdict;
  Item was = me().command;
  const bool with_id = rows.contains(row::command_id) && rows[row::command_id] != 0;
  const bool was_empty = rows.contains(row::command) && (with_id ? !last_id().has_value() : !was.value.has_value());
  const Edge command = command_edge(rows, single);
  const Edge word =
      rows.contains(row::controlword) ? edge(me().controlword, rows[row::controlword], single, false) : Edge::absent;
  const std::int64_t number = command == Edge::absent ? 0 : rows[row::command];
  bool refused = false;
  changes_mode_ = rows.contains(row::mode);
  if (command == Edge::acts && is_start(number) && word != Edge::acts) refused = start_refused(number, verdict);
  // Whether what stands beside a take_over is its new or its old owner's is not said.
  const bool takes_over = command == Edge::acts && number == kTakeOver;
  if (takes_over && rows.size() > 1 && options_.leases && readings_.other()) {
    me().command.refused = true;
    for (const auto& [offset, value] : rows) me().write(offset, value, true);
    return refused_whole();
  }
  if (takes_over) this->command(number, me().command, verdict);
  unclear_ = takes_over && rows.size() > 1;
  // Whether commands 9 to 11 will be refused is not known here.
  const bool will_be = command == Edge::acts && number > kRun && number <= kSetPosition && readings_.other();
  setpoints(rows, single, command, word, refused || will_be, was_empty);
  if (verdict.says.empty())
    verdict.says = command == Edge::remembered || word == Edge::remembered ? "only remembered" : "set-points";
  // 3.3: "it stops at the first failure".
  // An enabling word beside a stop: whether the stop makes it void is not said.
  const bool void_word = word == Edge::acts && command == Edge::acts && is_stop(number) &&
                         (rows[row::controlword] & 15) == 15 && readings_.other();
  if (word == Edge::acts && !void_word && !controlword(rows[row::controlword], single, verdict)) {
    // A stop is accepted in every state; what the two together are answered with is not said.
    if (command == Edge::acts && is_stop(number)) {
      this->command(number, me().command, verdict);
      verdict.any_answer = true;
    } else if (command == Edge::acts) {
      me().command.refused = true;
    }
    return verdict;
  }
  if (command != Edge::absent && number != was.value.value_or(0)) me().command.refused = false;
  if (refused) me().command.refused = true;
  // Of a controlword that is not new nothing is said but that the motor does nothing.
  if (word != Edge::absent && word != Edge::acts && single) verdict.any_answer = true;
  if (command == Edge::acts && !refused && !takes_over) {
    if (word == Edge::acts && is_start(number)) {
      // Two that act in one request: what the first does decides.
      if (start_refused(number, verdict)) {
        me().command.refused = true;
        return verdict;
      }
    }
    this->command(number, me().command, verdict);
    if (word == Edge::acts) verdict.any_answer = true;
  }
  if (command == Edge::not_new && single) answer_not_new(number, was, verdict);
  if (!takes_over) tell_foreign(verdict);
  if (takes_over && !verdict.answers.contains(0)) me().command.refused = true;
  verdict.acts = command == Edge::acts || word == Edge::acts;
  const auto unjudged = [this](const auto& r) {
    return r.first != row::controlword && r.first < row::command && !options_.rows.contains(r.first);
  };
  // Whether a block that repeats set-points which were only remembered asks for them is not said.
  const auto target = [](const auto& r) { return r.first > row::controlword && r.first < row::command; };
  if (foreign() && (std::ranges::any_of(rows, unjudged) || (!single && std::ranges::any_of(rows, target))))
    verdict.answers.insert(6);
  return verdict;
}

// 3.1, the mailbox: "writing 80 returns at once". The drive's own object of a target is that target (a way in like any
// other); what its counts come to is not judged here.
void Judge::object(int function, Verdict& verdict) {
  if (refuse_foreign(verdict)) return;
  // What was told later than at once, and was not carried out, has claimed nothing.
  if (options_.leases && (!seen_.troubled || readings_.other())) claim();
  verdict = {"object request", {0, 4, 6}};
  // 3.1, 43/13: "Refused ...: abort", an extended exception. It "is the same path".
  constexpr int kExtended = 0xFF;
  if (function == fc::general_reference) verdict.answers = {0, 6, 11, kExtended};
  world_.accepted.erase(row::target_position);
  world_.mode.reset();
  for (ClientMemory& client : world_.clients) client.command.changed = client.command.unsure = true;
  if (world_.motor != Motor::stands) world_.motor = Motor::unknown;
}

void Judge::tell_foreign(Verdict& verdict) const {
  if (!refused_foreign_ || !verdict.answers.contains(0)) return;
  // What a stop is answered with whose set-points are refused is not said.
  verdict.answers = stopped_ ? std::set<int>{0, 6} : std::set<int>{6};
  verdict.says += ", another client owns the axis";
}

}  // namespace axisgate::test::reference
