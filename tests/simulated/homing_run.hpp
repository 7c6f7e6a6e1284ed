// SPDX-License-Identifier: Apache-2.0
// One homing in mode 6, from the start bit to the reference or to failure.
// Promises: search at 6099:01, the last run and the index search at 6099:02 (JD K26, MD C12), ramps of 609A, and that
// the motor ends on the reference it latched. Never runs for ever: a search longer than `longest_search` revolutions
// fails.
#pragma once

#include "tests/simulated/axis.hpp"
#include "tests/simulated/digital_inputs.hpp"
#include "tests/simulated/homing_method.hpp"

namespace axisgate::simulated {

struct HomingSettings {
  Dec search_speed;
  Dec index_speed;
  Dec acceleration;
  FinePosition offset;  // 607C
  bool run_to_offset;   // MD 6099.05 = 0; otherwise the motor stays at the trigger and reads -offset (MD F)
};

class HomingRun {
 public:
  static constexpr std::int64_t longest_search = 1000;  // revolutions

  enum class Outcome : std::uint8_t { running, reference_found, failed };

  HomingRun(int method, const HomingSettings& settings, const Axis& axis, std::int64_t encoder_counts);

  // The speed for the next millisecond.
  Dec next_speed(const Axis& axis, const DigitalInputs& inputs);
  Outcome outcome() const { return outcome_; }
  // What the position counter reads at the end.
  FinePosition final_position() const { return settings_.run_to_offset ? 0 : -settings_.offset; }

 private:
  enum class Stage : std::uint8_t { search, leave, last_run, index, return_to_reference };

  bool signal_active(const Axis& axis, const DigitalInputs& inputs) const;
  bool blocked(const DigitalInputs& inputs, int direction) const;
  Stage first_stage(bool active) const;
  void advance_stage(const Axis& axis, const DigitalInputs& inputs);
  void edge_passed(const Axis& axis);
  void latch(FinePosition reference);
  Dec run(const Axis& axis, int direction, Dec speed) const;

  std::optional<HomingMethod> method_;
  HomingSettings settings_;
  FinePosition started_at_;
  FinePosition longest_;
  Stage stage_ = Stage::search;
  Outcome outcome_ = Outcome::running;
  bool begun_ = false;
  bool turned_ = false;
  int search_direction_ = 0;
  FinePosition reference_ = 0;
};

}  // namespace axisgate::simulated
