// SPDX-License-Identifier: Apache-2.0
// Whether a drive is there, as its answers, its silence and a CANopen node's signs of life tell, and how one that is
// not there is looked for (design 7, point 7). Pure: instants go in. Promises that a drive is given up after
// kMaxTimeouts timeouts in a row, that one which is gone costs its bus one probe per back-off step, and that a node
// which gave no sign of life is asked by SDO once, then called, and asked again after so many calls alone. Never sends.
#pragma once

#include <utility>

#include "adapters/bus/backoff.hpp"
#include "adapters/bus/exchange.hpp"

namespace axisgate::drive {

class NodePresence {
 public:
  /// An unresponsive drive is offline after this many timeouts in a row.
  static constexpr int kMaxTimeouts = 3;
  static constexpr int kCallsPerQuestion = 4;
  /// Alarm duplicate_node stands so long after the last sign of a duplicate node-ID: a second SDO client that asks for
  /// the same object at the same time looks like one, once.
  static constexpr Duration kDuplicateStands = std::chrono::seconds(60);

  /// `is_node`: it speaks CANopen, so that it may give signs of life and can be called. `timeout`: of its bus.
  NodePresence(bool is_node, Duration timeout) : is_node_(is_node), backoff_(timeout) {}

  // What it does.
  void on_link(bool up, Instant now) {
    timeouts_ = 0;
    heard_ = asked_ = false;
    state_ = bus::NodeState::unknown;
    backoff_.reset();
    look_due_ = up ? now : kNever;  // where a reply is still owed, the probe keeps silence first
  }
  void answered() { timeouts_ = 0; }
  /// An exchange got no answer: true from the timeout on by which it counts as gone.
  bool timed_out() { return ++timeouts_ >= kMaxTimeouts; }
  /// It says that it has started.
  void on_started() {
    heard_ = true;
    state_ = bus::NodeState::pre_operational;
    timeouts_ = 0;
  }
  /// A sign of life: true where it tells something new.
  bool on_present(bus::NodeState state) {
    const bool heard_before = std::exchange(heard_, true);
    return std::exchange(state_, state) != state || !heard_before;
  }
  /// Its signs of life have ceased. `was_there`: it counted as there; the search for it begins with the shortest pause.
  void on_gone(bool was_there) {
    heard_ = false;
    if (!was_there) return;
    timeouts_ = 0;
    backoff_.reset();
  }
  void on_duplicate(Instant now) { duplicate_until_ = now + kDuplicateStands; }
  [[nodiscard]] bool duplicated(Instant now) const { return now < duplicate_until_; }
  [[nodiscard]] Instant duplicate_due(Instant now) const { return duplicated(now) ? duplicate_until_ : kNever; }

  // How it is looked for.
  [[nodiscard]] Instant look_due() const { return look_due_; }
  void look_at(Instant when) { look_due_ = when; }
  /// After the pause whose turn it is; the one after is longer.
  void look_later(Instant now) { look_due_ = now + backoff_.next(); }
  /// It is found: the next search begins with the shortest pause.
  void found() { backoff_.reset(); }

  enum class Look : std::uint8_t {
    wake,     ///< it is stopped and answers no SDO: out of that state by NMT, which leaves its motor alone
    give_up,  ///< a call that nobody has answered was the last timeout: it is offline
    call,     ///< is it there? It need not answer
    ask       ///< a read that every drive answers
  };
  /// What is sent now. `first`: it was not found to be gone since the link came up. An unanswered call counts as a
  /// timeout here.
  [[nodiscard]] Look look(bool first) {
    if (is_node_ && heard_ && state_ == bus::NodeState::stopped) return Look::wake;
    // A call that nobody has answered is a timeout as well, but it kept nobody from the wire.
    if (first && !heard_ && calls_ > 0 && ++timeouts_ >= kMaxTimeouts) return Look::give_up;
    return is_node_ && asked_ && !heard_ && calls_ < kCallsPerQuestion ? Look::call : Look::ask;
  }
  void called(Instant now) {
    ++calls_;
    look_later(now);
  }
  void asked() {
    asked_ = true;
    calls_ = 0;
  }

 private:
  bool is_node_;
  bus::Backoff backoff_;
  Instant look_due_ = kNever;
  int timeouts_ = 0;    ///< in a row
  bool heard_ = false;  ///< it gave a sign of life since it was last gone
  bool asked_ = false;  ///< to find what was there before us: a node may know neither guarding nor heartbeat
  int calls_ = 0;       ///< unanswered, since it was asked last
  bus::NodeState state_ = bus::NodeState::unknown;  ///< as the node reported last
  Instant duplicate_until_ = kLongAgo;
};

}  // namespace axisgate::drive
