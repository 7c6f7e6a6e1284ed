// SPDX-License-Identifier: Apache-2.0
// Every command sequence with a CANopen drive, with each of its SDO exchanges failing in every way one can fail.
#include <gmock/gmock.h>

#include <map>

#include "tests/stage_drive/can_rig.hpp"
#include "tests/stage_drive/failures.hpp"
#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

constexpr std::array kCanFailures{Failure::muted,   Failure::reply_lost, Failure::reply_late, Failure::reply_twice,
                                  Failure::refused, Failure::cut_before, Failure::cut_after,  Failure::restarted};

struct Talk {
  std::string name;
  bool running = false;  ///< it turns when this is asked
  bool enabled = true;
  WriteBatch batch;
  bool may_turn = false;
  bool is_stop = false;
};

std::vector<Talk> talks() {
  const Setpoint near{Quantity::target_position, 30'000}, slow{Quantity::profile_velocity, 200'000};
  WriteBatch text;
  text.object = ObjectRequest{.index = 0x1008};
  return {
      {"enable", false, false, with_command(Command::enable)},
      {"disable", true, true, with_command(Command::disable), true, true},
      {"quick stop", true, true, with_command(Command::quick_stop), true, true},
      {"halt", true, true, with_command(Command::halt), true, true},
      {"absolute", false, true, with_command(Command::move_absolute, {near, slow}), true},
      {"relative", false, true, with_command(Command::move_relative, {near, slow}), true},
      {"velocity", false, true, with_command(Command::run_velocity, {{Quantity::target_velocity, 100'000}}), true},
      {"home", false, true, with_command(Command::home, {{Quantity::homing_method, 35}})},
      {"setpoints", false, true, setpoints({near, {Quantity::profile_velocity, 100'000}})},
      {"device name", false, true, text},
  };
}

bool turns(CanRig& rig) { return std::llabs(rig.axis()[Quantity::velocity_actual].value) > 1'000; }

void bring_to(CanRig& rig, const Talk& talk) {
  rig.online();
  if (talk.enabled) rig.enable();
  if (talk.running) {
    ASSERT_EQ(
        rig.stage.ask(1, with_command(Command::run_velocity, {{Quantity::target_velocity, 300'000}})).outcome.code,
        Errc::ok);
    rig.stage.run(400ms);
  }
  rig.mark();
}

std::size_t exchanges_of(CanType type, const Talk& talk) {
  CanRig rig({type});
  bring_to(rig, talk);
  WriteBatch batch = talk.batch;
  batch.role = Role::engineer;
  EXPECT_EQ(rig.stage.ask(1, batch).outcome.code, Errc::ok) << talk.name;
  return rig.requests().size();
}

void fail_at(CanRig& rig, std::size_t step, Failure failure) {
  auto& link = rig.stage.can_link(0);
  link.on_traffic = [&rig, &link, failure, left = step](bool to_drive, const can::CanFrame& frame) mutable {
    const bool request = to_drive && frame.id == 0x601 && frame.data[0] != 0x80;
    if (!request || left-- != 0) return;
    left = SIZE_MAX;
    fail_now(link, rig.line().faults(0), failure);
  };
}

void expect_no_write_twice(CanRig& rig, const Talk& talk) {
  std::map<std::tuple<int, int, std::uint32_t>, int> seen;
  for (const SdoRequest& w : rig.writes())
    if (w.index >= 0x6000) ++seen[{w.index, w.sub, w.data}];  // set-up after a restart writes the others anew
  for (const auto& [what, times] : seen) {
    const auto& [index, sub, data] = what;
    const bool zero = data == 0 && (index == 0x60FF || index == 0x60F6 || index == 0x6071);
    // A mode change invalidates what was written before it: the homing method is written once more. A drive that was
    // silent before the start is told the speed of that start anew.
    const bool again = index == 0x6040 || index == 0x6060 || index == 0x6098 || index == 0x6081 || zero;
    const int most = talk.is_stop ? 3 : again ? 2 : 1;
    EXPECT_LE(times, most) << std::hex << index << " := " << data;
  }
}

void expect_recovery(CanRig& rig) {
  auto& link = rig.stage.can_link(0);
  link.on_traffic = [](bool, const can::CanFrame&) {};
  if (!link.plugged()) link.plug();
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::online; }, 20s));
  EXPECT_EQ(rig.stage.command(1, Command::quick_stop).outcome.code, Errc::ok);
  ASSERT_TRUE(rig.stage.run_until([&] { return !turns(rig); }, 10s)) << "stoppable";
  // One that was adopted is set up as soon as it is disabled.
  ASSERT_TRUE(rig.stage.come_online());
  if (rig.axis().has(AxisInput::fault)) {
    EXPECT_EQ(rig.stage.command(1, Command::fault_reset).outcome.code, Errc::ok);
    ASSERT_TRUE(rig.stage.come_online());
  }
  EXPECT_EQ(rig.stage.command(1, Command::enable).outcome.code, Errc::ok);
  EXPECT_FALSE(turns(rig)) << "an enable never moves";
}

class EachSdoFails : public testing::TestWithParam<std::tuple<CanType, Failure>> {};

TEST_P(EachSdoFails, EndsOnceAsTheContractSaysAndRecovers) {
  const auto& [type, failure] = GetParam();
  for (const Talk& talk : talks()) {
    const std::size_t steps = exchanges_of(type, talk);
    for (std::size_t step = 0; step < steps && !HasFailure(); ++step) {
      SCOPED_TRACE(talk.name + ", " + text_of(failure) + " at exchange " + std::to_string(step));
      CanRig rig({type});
      bring_to(rig, talk);
      fail_at(rig, step, failure);
      int results = 0;
      std::optional<BatchResult> result;
      WriteBatch batch = talk.batch;
      batch.role = Role::engineer;
      batch.start_by = rig.stage.runtime().now() + 500ms;
      batch.answer_by = rig.stage.runtime().now() + 900ms;
      result = rig.stage.gateway().submit(1, batch, [&](const BatchResult& r) { ++results, result = r; });
      if (result) ++results;
      rig.stage.run_until([&] { return results > 0; }, 8s);
      ASSERT_TRUE(result) << "no result";
      EXPECT_TRUE(allowed(failure, result->outcome.code, true)) << text(result->outcome.code);
      expect_no_write_twice(rig, talk);
      rig.stage.run(700ms);  // whatever was repeated or comes late has come by now
      EXPECT_EQ(results, 1);
      // The line takes a reply that comes twice for one that is still owed.
      if (failure != Failure::reply_twice) {
        EXPECT_EQ(rig.line().overlapping_requests(), 0U) << "one SDO request outstanding at any time";
      }
      if (!talk.may_turn) {
        EXPECT_FALSE(turns(rig)) << "nobody asked for a motion";
      }
      const bool seen = rig.stage.can_link(0).plugged();
      if (talk.is_stop && result->outcome.code == Errc::ok && seen) {
        EXPECT_TRUE(rig.stage.run_until([&] { return !turns(rig); }, 5s)) << "stopped, it said";
      }
      expect_recovery(rig);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Failures, EachSdoFails,
                         testing::Combine(testing::ValuesIn(kCanTypes), testing::ValuesIn(kCanFailures)),
                         [](const auto& case_of) {
                           return test::name(std::get<0>(case_of.param)) + "_" + text_of(std::get<1>(case_of.param));
                         });

}  // namespace
}  // namespace axisgate::test
