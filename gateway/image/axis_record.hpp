// SPDX-License-Identifier: Apache-2.0
// The record of one axis: what was accepted for it and seen of it, each at a point (design 3.3 Edges, 3.4). Whether
// this came after that is answered by comparing two points. Promises that nothing is forgotten between two looks,
// however many clients there are, and that a point never comes again. Never decides what follows from it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "gateway/image/lease.hpp"

namespace axisgate {

class AxisRecord {
 public:
  /// A place in the order of all that is recorded; later ones are greater. 0: never.
  using Point = std::uint64_t;
  [[nodiscard]] Point now() const { return now_; }

  // --- What is accepted ---------------------------------------------------------------------------------------------

  /// Something was accepted that is to be carried out later: its point.
  [[nodiscard]] Point accepted() { return ++now_; }
  /// A command or controlword is carried out; `accepted`: its point.
  void commanded(ClientId by, Point accepted) { commands_.note(accepted, by); }
  /// A client's stop was accepted; by 0: the gateway's own (a lease, a jog button).
  void stopped(ClientId by) { stops_.note(++now_, by); }
  /// The axis stops by what was accepted at this point: what was accepted before starts and enables nothing.
  void stop(Point accepted) { stop_ = std::max(stop_, accepted); }
  /// What ran is over for good: velocity and torque are needed again.
  void end() { end_ = ++now_; }
  /// What clients asked for runs: by a start, or by a raw word that enables.
  void run() { run_ = ++now_; }
  /// Velocity and torque asked for until now run by a start or an enable alone: they came with a stop, or from who owns
  /// the axis no more.
  void set_aside() { aside_ = ++now_; }

  // --- What is seen -------------------------------------------------------------------------------------------------

  /// The drive has shown a fault.
  void faulted() { breakdown_ = ++now_; }
  /// link_state is 2 or 3 no longer.
  void lost() { breakdown_ = ++now_; }
  /// The drive has come up from scratch.
  void restarted() { restart_ = ++now_; }
  /// The drive's constants were read: it may count otherwise.
  void rescaled() { rescale_ = ++now_; }

  /// A write did not pass the way out. In a correct program there is none.
  void hold_back() { ++held_back_; }
  [[nodiscard]] std::uint64_t held_back() const { return held_back_; }

  // --- What follows -------------------------------------------------------------------------------------------------

  [[nodiscard]] Point newest_stop() const { return stop_; }
  [[nodiscard]] bool stopped_since(Point since) const { return stop_ > since; }
  /// A velocity or torque that was accepted then is void.
  [[nodiscard]] bool void_since(Point since) const { return end_ > since; }
  [[nodiscard]] bool set_aside_since(Point since) const { return aside_ > std::max(since, run_); }
  [[nodiscard]] bool restarted_since(Point since) const { return restart_ > since; }
  [[nodiscard]] bool rescaled_since(Point since) const { return rescale_ > since; }
  /// Another client's stop, a fault or a link loss: what `me` asked for before must be armed again.
  [[nodiscard]] bool interrupted(Point since, ClientId me) const {
    return breakdown_ > since || stops_.by_another(since, me);
  }
  /// What `me` commanded then is over: any stop, a fault, a loss, or another client's command.
  [[nodiscard]] bool ended(Point since, ClientId me) const {
    return breakdown_ > since || stops_.last > since || commands_.by_another(since, me);
  }

 private:
  /// The newest of all, and the newest that is not by the same client.
  struct Newest {
    Point last = 0;
    ClientId by = 0;
    Point by_others = 0;
    void note(Point at, ClientId who) {
      if (at < last) {  // reported late: what was accepted after it was reported before
        if (who != by) by_others = std::max(by_others, at);
        return;
      }
      if (last != 0 && who != by) by_others = last;
      last = at;
      by = who;
    }
    [[nodiscard]] bool by_another(Point since, ClientId me) const { return (by == me ? by_others : last) > since; }
  };
  Point now_ = 0;
  Point breakdown_ = 0;
  Point stop_ = 0;
  Point end_ = 0;
  Point run_ = 0;
  Point aside_ = 0;
  Point restart_ = 0;
  Point rescale_ = 0;
  std::uint64_t held_back_ = 0;
  Newest stops_;
  Newest commands_;
};

}  // namespace axisgate
