// SPDX-License-Identifier: Apache-2.0
// A drive of each kind with faults as its maker names them, and what is shown and told of them. Promises to look at
// every step of the way. Never resets a fault by itself.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "gateway/image/shown.hpp"
#include "tests/obey/plant.hpp"

namespace axisgate::test::obey {

inline constexpr std::int64_t kReset = 5;
inline constexpr std::int64_t kUnknownCode = std::numeric_limits<std::uint16_t>::max();
inline constexpr std::int64_t kUnknownVendor = std::numeric_limits<std::uint32_t>::max();

/// A fault as the maker's sheet has it.
struct Cause {
  std::uint16_t as_injected;
  std::uint16_t code;
  std::uint32_t vendor;
  std::string text;
};

inline std::array<Cause, 2> causes_of(Subject subject) {
  if (is_keya(subject))
    return {{{0x0040, 0x2310, 0x0040, "software overcurrent"}, {0x0020, 0x7121, 0x0020, "holding brake"}}};
  if (subject == Subject::id286pro)
    return {{{14, 0x3210, 14, "supply above 90 V"}, {13, 0x3220, 13, "supply below 18 V"}}};
  if (subject == Subject::leadshine)
    return {{{0x3211, 0x3211, 0x0C0, "DC-bus over-voltage"}, {0x4210, 0x4210, 0x0F0, "drive over-temperature"}}};
  return {{{0x0020, 0x3210, 0x0020, "bus voltage too high"}, {0x0200, 0x8611, 0x0200, "following error too large"}}};
}

class Causes : public testing::TestWithParam<Subject> {
 protected:
  void ready() {
    plant_.emplace(GetParam());
    plant_->ready();
  }
  void trip(const Cause& cause) { test::trip(plant_->stage, GetParam(), cause.as_injected); }
  const AxisImage& axis() { return plant_->stage.axis(1); }
  [[nodiscard]] std::int64_t shown(Quantity quantity) { return shown_value(axis(), quantity); }
  [[nodiscard]] bool faulted() { return axis().reachable() && axis().has(AxisInput::fault); }
  [[nodiscard]] bool cause_is_known() { return faulted() && axis()[Quantity::error_code].valid; }
  [[nodiscard]] Instant now() { return plant_->stage.runtime().now(); }
  bool until_faulted() {
    return plant_->stage.run_until([this] { return faulted(); }, std::chrono::seconds(3));
  }
  /// Of what is shown now; empty: nothing.
  std::string wrong_now() {
    if (!axis().reachable()) return "";
    const bool fault = axis().has(AxisInput::fault);
    const bool word = (axis()[Quantity::statusword].value & 0x08) != 0;
    const bool state = axis().axis_state == AxisState::error_stop;
    if (fault != word || fault != state)
      return "fault bit " + std::to_string(fault) + ", in the statusword " + std::to_string(word) + ", in axis_state " +
             std::to_string(state);
    if (!fault) return "";
    if (axis().motion_state == MotionState::active) return "a motion runs beside the fault";
    const auto code = shown(Quantity::error_code), vendor = shown(Quantity::vendor_error);
    const bool unknown = code == kUnknownCode;
    if (code == 0 || (unknown && axis()[Quantity::error_code].valid)) return "error_code " + std::to_string(code);
    if (unknown && (vendor != kUnknownVendor || axis()[Quantity::vendor_error].valid))
      return "vendor_error " + std::to_string(vendor) + " of an unknown cause";
    return "";
  }
  /// Runs until the fault's cause is shown, and looks at every step on the way. Tells what was wrong in one; empty:
  /// nothing.
  std::string wrong_until_known(Duration limit = std::chrono::seconds(3)) {
    std::string wrong;
    std::optional<std::pair<Instant, std::uint32_t>> risen;  // when, and the sequence of then
    const bool known = plant_->stage.run_until(
        [&] {
          if (wrong.empty()) wrong = wrong_now();
          if (faulted() && !risen) risen = {now(), axis().sequence};
          if (cause_is_known() && risen->first != now() && axis().sequence == risen->second && wrong.empty())
            wrong = "the cause has come without a step of sequence";
          return cause_is_known();
        },
        limit);
    if (!known) return risen ? "no cause is shown" : "no fault is shown";
    return wrong.empty() && now() - risen->first > std::chrono::milliseconds(501) ? "the cause comes late" : wrong;
  }
  [[nodiscard]] std::uint64_t told_until_now() { return plant_->stage.gateway().events().added(); }
  /// The faults that log and DDS were told of since then.
  std::vector<Event> faults_told(std::uint64_t from) {
    std::vector<Event> out;
    for (const Event& event : plant_->stage.gateway().events().events())
      if (event.number > from && event.axis == 1 && event.kind == EventKind::fault) out.push_back(event);
    return out;
  }
  static std::string texts(const std::vector<Event>& events) {
    std::string out;
    for (const Event& event : events) out += event.text + '\n';
    return out;
  }
  void expect_shown(const Cause& cause, std::uint64_t from) {
    plant_->run(std::chrono::milliseconds(1500));
    EXPECT_EQ(shown(Quantity::error_code), cause.code);
    EXPECT_EQ(shown(Quantity::vendor_error), cause.vendor);
    const auto told = faults_told(from);
    ASSERT_EQ(told.size(), 1U) << texts(told);
    EXPECT_NE(told.front().text.find(cause.text), std::string::npos) << told.front().text;
    EXPECT_EQ(told.front().code, cause.code);
  }
  void reset() {
    ASSERT_EQ(plant_->a.command(0), kOk);
    ASSERT_EQ(plant_->a.command(kReset), kOk);
    ASSERT_FALSE(axis().has(AxisInput::fault));
    const auto over = [this] { return shown(Quantity::error_code) == 0 && shown(Quantity::vendor_error) == 0; };
    ASSERT_TRUE(plant_->stage.run_until(over, std::chrono::seconds(3)));
  }
  std::optional<Plant> plant_;
};

}  // namespace axisgate::test::obey
