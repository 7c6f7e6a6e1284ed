// SPDX-License-Identifier: Apache-2.0
// What goes over the cable of a judged run, whatever is spoken on it. Watches that at most one request is outstanding;
// that what is not idempotent is sent once for each time that a client has asked for it; that queues and events keep
// their bounds; that the drives and motors beside axis 1 are neither started nor enabled. Promises to name the first
// violation, and to keep the last second of frames. Never changes anything it looks at.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "tests/judged/cable_words.hpp"
#include "tests/model/write.hpp"
#include "tests/obey/plant.hpp"

namespace axisgate::test::judged {

struct Traffic {
  std::uint64_t requests = 0;  ///< by Modbus, reads too
  std::uint64_t frames = 0;    ///< on the bus
  std::uint64_t hash = 0;      ///< of these frames, and when they came
};

class CableWatch {
 public:
  using Violated = std::function<void(std::string)>;
  /// `also_tell`: who else wants to know of each frame, before it is delivered.
  CableWatch(obey::Plant& plant, Violated violated, std::function<void(const CableFrame&)> also_tell);

  /// A client's write: what it may start and enable, until it is answered, and no later than a motor may start.
  void asked(int request, const reference::Write& write);
  void answered(int request);
  void gateway_died();
  /// The answer to the next start or enable is lost, whenever that comes within `time`.
  void lie_in_wait(Duration time) { in_wait_until_ = plant_.stage.runtime().now() + time; }
  [[nodiscard]] bool lies_in_wait() { return plant_.stage.runtime().now() < in_wait_until_; }
  /// Another master may have enabled the motor in the middle of a bring-up.
  void commanded_by_another() { anothers_until_ = plant_.stage.runtime().now() + std::chrono::seconds(2); }
  /// After each step of the run.
  void look();

  [[nodiscard]] const Traffic& traffic() const { return traffic_; }
  /// In the form of tests/golden, times from the oldest one on.
  [[nodiscard]] std::vector<std::string> last_second() const;

 private:
  /// What a write may do, and has not yet.
  struct Credit {
    int request = 0;
    int starts = 0;
    int enables = 0;
    Instant until = axisgate::kNever;
  };
  struct Kept {
    Instant at;
    bool modbus = false;
    bool to_drive = false;
    can::CanFrame can{};
    bool is_can = false;
    std::vector<Byte> bytes{};
  };
  static constexpr std::size_t kNodes = 256, kMostKept = 4000, kMostHeard = 4096;

  void on_frame(const CableFrame& frame);
  void to_drive(const CableFrame& frame);
  void to_gateway(const CableFrame& frame);
  void check_command(const CableFrame& frame);
  void pay(const Request& request);
  bool take(int Credit::*kind);
  void keep(Kept frame);
  [[nodiscard]] bool outstanding() const;

  obey::Plant& plant_;
  Violated violated_;
  std::function<void(const CableFrame&)> also_tell_;
  Tongue tongue_;
  Duration timeout_;
  std::uint8_t node_of_axis_1_;
  std::optional<Request> request_;  ///< the newest, until it is over
  Instant sent_at_ = axisgate::kLongAgo;
  std::vector<Byte> heard_;  ///< since
  std::array<bool, kNodes> enabled_{};
  std::vector<Credit> credits_;
  Instant in_wait_until_ = axisgate::kLongAgo;
  Instant anothers_until_ = axisgate::kLongAgo;
  std::deque<Kept> kept_;
  Traffic traffic_;
};

}  // namespace axisgate::test::judged
