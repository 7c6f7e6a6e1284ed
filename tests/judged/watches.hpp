// SPDX-License-Identifier: Apache-2.0
// What is watched beside the contract in every judged run: the cable, what the gateway holds of the drives, and the
// drives and motors beside axis 1. Promises the first violation to whoever made it. Never changes anything.
#pragma once

#include "tests/judged/cable_watch.hpp"
#include "tests/judged/neighbours.hpp"
#include "tests/judged/stored_watch.hpp"

namespace axisgate::test::judged {

class Watches {
 public:
  Watches(obey::Plant& plant, bool neighbour, bool other_bus, const std::function<void(std::string)>& violated)
      : cable(plant, violated, [this](const CableFrame& frame) { stored_.on_frame(frame); }),
        stored_(plant, violated),
        neighbours_(plant, neighbour, other_bus, violated) {}
  Watches(const Watches&) = delete;
  Watches& operator=(const Watches&) = delete;

  void gateway_died() {
    cable.gateway_died();
    stored_.gateway_died();
  }
  /// Something befalls the line as a whole, not axis 1's drive alone. `twice`: what is said may come a second time.
  void line_is_troubled(bool twice = false) {
    line_is_whole_ = false;
    twice_ = twice_ || twice;
  }
  /// The event loop has stood: every drive that watches for the gateway may have missed it, and is set up anew when its
  /// pause is over. From here on only what neighbours do is judged, not when.
  void loop_stood() { loop_stood_ = true; }
  void all_is_well() {
    line_is_whole_ = true;
    twice_ = false;
  }
  void look() {
    cable.look();
    stored_.look(twice_);
    neighbours_.look(line_is_whole_ && !loop_stood_);
  }

  [[nodiscard]] bool neighbours_online() { return neighbours_.all_online(); }

  CableWatch cable;

 private:
  StoredWatch stored_;
  Neighbours neighbours_;
  bool line_is_whole_ = true;
  bool twice_ = false;
  bool loop_stood_ = false;
};

}  // namespace axisgate::test::judged
