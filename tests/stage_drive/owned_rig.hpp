// SPDX-License-Identifier: Apache-2.0
// A drive of any kind, its owner, and a wire that is cut and mended while its motor runs. Promises that a cut is either
// silent (frames are lost, nobody is told) or reported (the adapter is pulled). Never decides what is right: the tables
// do.
#pragma once

#include <memory>
#include <string>

#include "tests/stage_drive/drive_rig.hpp"
#include "tests/unit/drive/clients.hpp"

namespace axisgate::test {

enum class Cut : std::uint8_t { silent, reported };
inline constexpr std::array kCuts{Cut::silent, Cut::reported};
[[nodiscard]] std::string name(Cut cut);

class OwnedRig {
 public:
  explicit OwnedRig(Subject subject, std::optional<LeaseRules> lease = {});
  OwnedRig(const OwnedRig&) = delete;
  OwnedRig& operator=(const OwnedRig&) = delete;
  /// Prints the gateway's log where the test has failed.
  ~OwnedRig();

  DriveRig rig;
  std::shared_ptr<ClientLife> owner = client(1, "10.0.0.1");

  /// Its owner gives signs of life each 50 ms, if `lives`.
  void run(Duration time, bool lives = true);
  [[nodiscard]] Errc ask(WriteBatch batch);
  [[nodiscard]] Errc command(Command command) { return ask(with_command(command)); }
  /// Enabled, and its motor turns for so long.
  void set_moving(Duration time = std::chrono::seconds(1));
  void cut(Cut cut);
  void mend() { rig.mend(); }
  /// A gap that no drive answers with a stop of its own: those on CANopen want a heartbeat or a guarding frame each
  /// 1500 ms, and it comes each 500 ms.
  [[nodiscard]] Duration short_gap(Cut cut) const;

  /// Within `limit`.
  [[nodiscard]] bool comes_to_rest(Duration limit = std::chrono::seconds(30));
  /// It does not turn for so long.
  [[nodiscard]] bool stays_at_rest(Duration time = std::chrono::seconds(2));
  [[nodiscard]] bool latched() { return rig.axis().has(AxisInput::stop_latched); }
  [[nodiscard]] bool adopted();
  /// The axis takes an enable as ever, stands, and runs when it is told to.
  void expect_usable();
};

}  // namespace axisgate::test
