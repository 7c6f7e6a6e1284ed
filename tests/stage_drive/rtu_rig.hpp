// SPDX-License-Identifier: Apache-2.0
// Three simulated drives on one Modbus RTU line behind the shipped core: the one under test as axis 1, and one of each
// other kind beside it. Promises that every step is watched: no value that its drive did not send for it, no write but
// a stop to a drive that is suspect or gone, and neighbours that stay online. Never decides which faults there are.
#pragma once

#include <map>

#include "tests/stage_drive/drive_rig.hpp"
#include "tests/stage_drive/rtu_truth.hpp"

namespace axisgate::test {

inline constexpr std::array kOnRtu{Subject::jd_rtu, Subject::md_rtu, Subject::id286pro};

struct RtuRigOptions {
  simulated::KincoRtuOptions kinco{};
  bool neighbours = true;
  bool neighbours_stay = true;  ///< that one leaves the state online is wrong
  Duration timeout = std::chrono::milliseconds(200);
};

class RtuRig {
 public:
  /// A step is the time between two looks; nothing goes faster than an exchange of a dozen bytes.
  static constexpr Duration kStep = std::chrono::milliseconds(2);

  explicit RtuRig(Subject kind, const RtuRigOptions& options = {});
  RtuRig(const RtuRig&) = delete;
  RtuRig& operator=(const RtuRig&) = delete;

  GatewayStage stage;

  [[nodiscard]] Subject kind() const { return kind_; }
  [[nodiscard]] const AxisImage& axis(AxisNumber number = 1) { return stage.axis(number); }
  [[nodiscard]] simulated::DriveFaults& faults(std::size_t position = 0) {
    return stage.rtu_link(0).line().faults(position);
  }
  [[nodiscard]] bool online(AxisNumber number = 1) { return axis(number).link_state == LinkState::online; }

  /// All axes online; the one under test enabled and running at 60 rpm, so that its position is another each time.
  void come_up_running();
  /// Runs in steps, each of them watched.
  void run(Duration time);
  bool run_until(const std::function<bool()>& done, Duration limit);
  /// A set-point with a value never used before, and a read of an object through the mailbox; nobody waits for either.
  void ask_something();

  /// Told of each request before the line hears it.
  std::function<void(const RtuRequest&)> on_request = [](const RtuRequest&) {};
  /// What was seen that must not be, each kind once.
  [[nodiscard]] const std::vector<std::string>& wrongs() const { return wrongs_; }
  /// The longest pause between two requests to the same neighbour, all of them being up.
  [[nodiscard]] Duration longest_wait() const { return longest_wait_; }
  void forget_waits() { longest_wait_ = {}; }
  [[nodiscard]] std::uint64_t looked_at() const { return truths_.front()->looked_at(); }

  /// Registers of the drive under test: its position, and what tells its state.
  [[nodiscard]] std::uint16_t position_register() const { return kind_ == Subject::id286pro ? 117 : 0x3700; }
  [[nodiscard]] std::uint16_t state_register() const { return kind_ == Subject::id286pro ? 108 : 0x3200; }

 private:
  void watch();
  void wrong(const std::string& what);
  [[nodiscard]] bool is_stop(const RtuRequest& request) const;

  Subject kind_;
  bool neighbours_stay_;
  std::vector<std::unique_ptr<RtuTruth>> truths_;
  std::vector<std::string> wrongs_;
  std::map<std::uint8_t, Instant> served_;  ///< by unit
  Duration longest_wait_{};
  std::int64_t next_value_ = 600'000;
};

}  // namespace axisgate::test
