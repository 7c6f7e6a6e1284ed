// SPDX-License-Identifier: Apache-2.0
// What has ended an axis's motions, as far as a client must know that commanded one before (design 3.3 Edges): stops
// and commands with who gave them, faults, losses of the link. Promises that nothing is forgotten between two looks,
// however many clients there are. Never tells what happened first: only whether it did.
#pragma once

#include <algorithm>
#include <cstdint>

#include "gateway/image/lease.hpp"

namespace axisgate {

class Endings {
 public:
  /// A point in this history; later ones are greater.
  using Point = std::uint64_t;
  [[nodiscard]] Point now() const { return now_; }

  /// A stop was accepted; by 0: the gateway's own (a lease, a jog button).
  void stopped(ClientId by) { stops_.note(++now_, by); }
  /// A command or controlword was accepted: its place in this history. Whether it ends anything its turn tells.
  [[nodiscard]] Point accepted() { return ++now_; }
  /// It is carried out.
  void commanded(ClientId by, Point accepted) { commands_.note(accepted, by); }
  /// The drive has shown a fault.
  void faulted() { breakdown_ = ++now_; }
  /// link_state is 2 or 3 no longer.
  void lost() { breakdown_ = ++now_; }

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
  Newest stops_;
  Newest commands_;
};

}  // namespace axisgate
