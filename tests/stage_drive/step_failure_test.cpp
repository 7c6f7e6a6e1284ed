// SPDX-License-Identifier: Apache-2.0
// Every command sequence with each of its exchanges failing, one after another, in every way an exchange can fail.
#include <gmock/gmock.h>

#include <map>

#include "tests/stage_drive/failures.hpp"
#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using enum Situation;

constexpr std::array kSerialFailures{Failure::muted,      Failure::reply_lost, Failure::reply_late, Failure::refused,
                                     Failure::cut_before, Failure::cut_after,  Failure::restarted};

struct Commanded {
  std::string name;
  Situation from;
  WriteBatch batch;
  bool may_turn = false;    ///< the motor may turn whatever fails: it turned before, or a start was asked for
  bool may_enable = false;  ///< an enable was asked for
  bool is_stop = false;
};

std::vector<Commanded> all_commanded() {
  WriteBatch raw_enable;
  raw_enable.controlword = 0x000F;
  raw_enable.single_controlword = true;
  WriteBatch raw_stop = raw_enable;
  raw_stop.controlword = 0x0006;
  WriteBatch mode;
  mode.mode = 3;
  WriteBatch read;
  read.object = ObjectRequest{false, 0x2601, 0, 2, 0};
  WriteBatch write;
  write.object = ObjectRequest{true, 0x2010, 0x0F, 2, 4};
  const Setpoint near{Quantity::target_position, 30'000}, slow{Quantity::profile_velocity, 200'000};
  return {
      {"enable", disabled, with_command(Command::enable), false, true},
      {"disable", running, with_command(Command::disable), true, false, true},
      {"quick stop", running, with_command(Command::quick_stop), true, false, true},
      {"halt in velocity", running, with_command(Command::halt), true, false, true},
      {"halt in position", moving, with_command(Command::halt), true, false, true},
      {"fault reset", faulted, with_command(Command::fault_reset)},
      {"absolute", enabled, with_command(Command::move_absolute, {near, slow}), true},
      {"relative", enabled, with_command(Command::move_relative, {near, slow}), true},
      {"move after halt", halted, with_command(Command::move_absolute, {near}), true},
      {"velocity", enabled, with_command(Command::run_velocity, {{Quantity::target_velocity, 100'000}}), true},
      {"torque", enabled, with_command(Command::run_torque), false},
      {"home", enabled, with_command(Command::home, {{Quantity::homing_method, 19}}), true},
      {"set position", enabled, with_command(Command::set_position)},
      {"save", disabled, with_command(Command::save_parameters)},
      {"setpoints", enabled,
       setpoints({near, {Quantity::profile_velocity, 100'000}, {Quantity::target_velocity, 500'000}})},
      {"raw mode", enabled, mode},
      {"raw enable", disabled, raw_enable, false, true},
      {"raw stop", running, raw_stop, true, false, true},
      {"mailbox read", enabled, read},
      {"mailbox write", enabled, write},
  };
}

/// Frames that the command sequence takes when nothing fails, polls between them included.
std::size_t exchanges_of(KincoType type, const Commanded& talk) {
  Rig rig(type);
  rig.bring_to(talk.from);
  const BatchResult result = rig.ask(talk.batch);
  EXPECT_EQ(result.outcome.code, Errc::ok) << talk.name;
  return rig.requests().size();
}

void fail_at(Rig& rig, std::size_t step, Failure failure) {
  auto& link = rig.stage.link(0);
  link.on_traffic = [&rig, &link, failure, left = step](bool to_drive, Bytes) mutable {
    if (!to_drive || left-- != 0) return;
    left = SIZE_MAX;
    fail_now(link, rig.faults(), failure);
  };
}

void expect_no_write_twice(Rig& rig, const Commanded& talk) {
  std::map<std::tuple<int, int, std::uint32_t>, std::size_t> seen;
  for (const WireRequest& w : rig.writes()) ++seen[{w.index, w.sub, w.data}];
  for (const auto& [what, times] : seen) {
    const auto& [index, sub, data] = what;
    // 0x0F and 0x06 stand more than once in some sequences (set_position, fault reset).
    const std::size_t most = talk.is_stop ? 3 : index == kControlword ? 2 : 1;
    // What set_position puts back; and zeros, once before a mode changes and once in it.
    const bool put_back = index == 0x6060 || index == 0x6098 || index == 0x607C;
    const bool zero = data == 0 && (index == 0x60FF || index == 0x60F6 || index == 0x6071);
    EXPECT_LE(times, put_back || zero ? std::max<std::size_t>(most, 2) : most) << std::hex << index << " := " << data;
  }
}

void expect_recovery(Rig& rig) {
  rig.stage.link(0).on_traffic = [](bool, Bytes) {};
  if (!rig.stage.link(0).plugged()) rig.stage.link(0).plug();
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::online; }, 8s)) << "online again";
  EXPECT_EQ(rig.command(Command::quick_stop).outcome.code, Errc::ok);
  ASSERT_TRUE(rig.stage.run_until([&] { return !rig.motor_enabled() && !rig.turns(); }, 10s)) << "stoppable";
  if (rig.axis().has(AxisInput::fault)) {
    EXPECT_EQ(rig.command(Command::fault_reset).outcome.code, Errc::ok);
  }
  EXPECT_EQ(rig.command(Command::enable).outcome.code, Errc::ok);
  EXPECT_FALSE(rig.turns()) << "an enable never moves";
  rig.stage.run(300ms);
  EXPECT_EQ(rig.ask(with_command(Command::move_relative,
                                 {{Quantity::target_position, 3'000}, {Quantity::profile_velocity, 600'000}}))
                .outcome.code,
            Errc::ok);
  EXPECT_TRUE(rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::completed; }, 5s));
}

class EachStepFails : public testing::TestWithParam<std::tuple<KincoType, Failure>> {};

TEST_P(EachStepFails, EndsOnceAsTheContractSaysAndRecovers) {
  const auto& [type, failure] = GetParam();
  for (const Commanded& talk : all_commanded()) {
    const std::size_t steps = exchanges_of(type, talk);
    for (std::size_t step = 0; step < steps; ++step) {
      SCOPED_TRACE(talk.name + ", " + text_of(failure) + " at exchange " + std::to_string(step));
      Rig rig(type);
      rig.bring_to(talk.from);
      const bool was_enabled = rig.motor_enabled();
      fail_at(rig, step, failure);
      int results = 0;
      std::optional<BatchResult> result;
      WriteBatch batch = talk.batch;
      batch.role = Role::engineer;
      batch.start_by = rig.stage.runtime().now() + 500ms;
      batch.answer_by = rig.stage.runtime().now() + 900ms;
      result = rig.stage.gateway().submit(1, batch, [&](const BatchResult& r) { ++results, result = r; });
      if (result) ++results;
      rig.stage.run_until([&] { return results > 0; }, 4s);
      rig.stage.run(20ms);
      ASSERT_TRUE(result) << "no result";
      EXPECT_TRUE(allowed(failure, result->outcome.code, talk.is_stop)) << text(result->outcome.code);
      expect_no_write_twice(rig, talk);
      rig.stage.run(700ms);  // whatever was repeated or comes late has come by now
      EXPECT_EQ(results, 1);
      if (!talk.may_turn) {
        EXPECT_FALSE(rig.turns()) << "nobody asked for a motion";
      }
      if (!was_enabled && !talk.may_enable) {
        EXPECT_FALSE(rig.motor_enabled());
      }
      if (talk.is_stop && result->outcome.code == Errc::ok) {
        EXPECT_TRUE(rig.stage.run_until([&] { return !rig.turns(); }, 3s)) << "stopped, it said";
      }
      if (failure == Failure::restarted && rig.axis().link_state == LinkState::online) {
        EXPECT_TRUE(!rig.motor_enabled() || talk.may_enable);
      }
      expect_recovery(rig);
      if (testing::Test::HasFailure()) break;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Failures, EachStepFails,
                         testing::Combine(testing::Values(KincoType::jd, KincoType::md),
                                          testing::ValuesIn(kSerialFailures)),
                         [](const auto& case_of) {
                           return test::name(std::get<0>(case_of.param)) + "_" + text_of(std::get<1>(case_of.param));
                         });

}  // namespace
}  // namespace axisgate::test
