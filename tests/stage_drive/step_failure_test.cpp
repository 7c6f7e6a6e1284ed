// SPDX-License-Identifier: Apache-2.0
// Every command sequence with each of its exchanges failing, one after another, in every way an exchange can fail.
#include <gmock/gmock.h>

#include <map>

#include "tests/stage_drive/drive_rig.hpp"
#include "tests/stage_drive/failures.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using enum Situation;

constexpr std::array kFailures{Failure::muted,   Failure::reply_lost, Failure::reply_late, Failure::reply_twice,
                               Failure::refused, Failure::cut_before, Failure::cut_after,  Failure::restarted};

struct Commanded {
  std::string name;
  Situation from;
  WriteBatch batch;
  bool may_turn = false;    ///< the motor may turn whatever fails: it turned before, or a start was asked for
  bool may_enable = false;  ///< an enable was asked for
  bool is_stop = false;
};

bool is_canopen_servo(Subject s) { return s == Subject::leadshine || s == Subject::jd_can || s == Subject::md_can; }

WriteBatch for_object(const ObjectRequest& object) {
  WriteBatch batch;
  batch.object = object;
  return batch;
}

std::vector<Commanded> of_every_servo() {
  const Setpoint near{Quantity::target_position, 30'000}, slow{Quantity::profile_velocity, 200'000};
  const Setpoint method{Quantity::homing_method, 35};
  return {
      {"enable", disabled, with_command(Command::enable), false, true},
      {"disable", running, with_command(Command::disable), true, false, true},
      {"quick stop", running, with_command(Command::quick_stop), true, false, true},
      {"halt in velocity", running, with_command(Command::halt), true, false, true},
      {"absolute", enabled, with_command(Command::move_absolute, {near, slow}), true},
      {"relative", enabled, with_command(Command::move_relative, {near, slow}), true},
      {"velocity", enabled, with_command(Command::run_velocity, {{Quantity::target_velocity, 100'000}}), true},
      {"home", enabled, with_command(Command::home, {method})},
      {"setpoints", enabled,
       setpoints({near, {Quantity::profile_velocity, 100'000}, {Quantity::target_velocity, 500'000}})},
  };
}

/// A Keya begins to move as soon as it is told where to, or how fast.
std::vector<Commanded> of_a_keya(Subject subject) {
  const bool speeds = has_speeds(subject);
  const Setpoint target =
      speeds ? Setpoint{Quantity::target_velocity, 150'000} : Setpoint{Quantity::target_position, 20'000};
  const ObjectPlace object = readable_object(subject);
  return {
      {"enable", disabled, with_command(Command::enable), false, true},
      {"disable", running, with_command(Command::disable), true, false, true},
      {"quick stop", running, with_command(Command::quick_stop), true, false, true},
      {"halt", running, with_command(Command::halt), true, false, true},
      {"raw stop", running, with_controlword(0x0006), true, false, true},
      {"setpoint", running, setpoints({target}), true},
      {"mailbox read", enabled, for_object({.index = object.index, .subindex = object.sub})},
      {"start", enabled, with_command(speeds ? Command::run_velocity : Command::move_absolute, {target}), true},
  };
}

std::vector<Commanded> all_commanded(Subject subject) {
  if (is_keya(subject)) return of_a_keya(subject);
  std::vector<Commanded> out = of_every_servo();
  if (is_canopen_servo(subject)) {
    out.push_back({"device name", enabled, for_object({.index = 0x1008})});
    return out;
  }
  WriteBatch mode;
  mode.mode = 3;
  out.insert(out.end(),
             {
                 {"halt in position", moving, with_command(Command::halt), true, false, true},
                 {"fault reset", faulted, with_command(Command::fault_reset)},
                 {"move after halt", halted,
                  with_command(Command::move_absolute, {{Quantity::target_position, 30'000}}), true},
                 {"torque", enabled, with_command(Command::run_torque, {{Quantity::target_torque, 50}}), true},
                 {"set position", enabled, with_command(Command::set_position)},
                 {"save", disabled, with_command(Command::save_parameters)},
                 {"raw mode", enabled, mode},
                 {"raw enable", disabled, with_controlword(0x000F), false, true},
                 {"raw stop", running, with_controlword(0x0006), true, false, true},
                 {"mailbox read", enabled, for_object({false, 0x2601, 0, 2, 0})},
                 {"mailbox write", enabled, for_object({true, 0x2010, 0x0F, 2, 4})},
             });
  return out;
}

bool is_request(Bytes) { return true; }
bool is_request(const can::CanFrame& frame) { return frame.extended || (frame.id == 0x601 && frame.data[0] != 0x80); }

/// A Keya may have no refusal, and no state that tells of a set-point.
bool allowed(Subject subject, Failure failure, Errc code, bool is_stop) {
  if (allowed(failure, code, is_stop || is_canopen_servo(subject))) return true;
  const bool cut = failure == Failure::cut_before || failure == Failure::cut_after;
  const bool unknown = code == Errc::timed_out || code == Errc::not_reached;
  return is_keya(subject) && !cut && (unknown || (code == Errc::state_unsuitable && !is_stop));
}

class EachStepFails : public testing::TestWithParam<std::tuple<Subject, Failure>> {
 protected:
  /// Requests that the command sequence sends when nothing fails, polls between them included.
  static std::size_t exchanges_of(const Commanded& talk) {
    DriveRig rig(subject());
    rig.bring_to(talk.from);
    std::size_t sent = 0;
    on_each_request(rig, [&sent](auto&) { ++sent; });
    WriteBatch batch = talk.batch;
    batch.role = Role::engineer;
    EXPECT_EQ(rig.ask(batch).outcome.code, Errc::ok) << talk.name;
    return sent;
  }
  static void fail_at(DriveRig& rig, std::size_t step) {
    on_each_request(rig, [&rig, left = step](auto& link) mutable {
      if (left-- != 0) return;
      left = SIZE_MAX;
      fail_now(link, rig.faults(), failure());
    });
  }
  /// Before the drive hears it.
  template <class Act>
  static void on_each_request(DriveRig& rig, const Act& act) {
    rig.stage.at_link(0, [&act](auto& link) {
      link.on_traffic = [&link, act = Act(act)](bool to_drive, const auto& what) mutable {
        if (to_drive && is_request(what)) act(link);
      };
    });
  }
  static void expect_no_write_twice(DriveRig& rig, const Commanded& talk);
  static void expect_recovery(DriveRig& rig);
  static void fail_one(const Commanded& talk, std::size_t step);
  static Subject subject() { return std::get<Subject>(GetParam()); }
  static Failure failure() { return std::get<Failure>(GetParam()); }
};

void EachStepFails::expect_no_write_twice(DriveRig& rig, const Commanded& talk) {
  if (is_keya(subject())) return;  // its frames repeat what holds
  std::map<std::tuple<int, int, std::uint32_t>, std::size_t> seen;
  for (const WireRequest& w : rig.writes()) {
    const bool by_setup = is_canopen_servo(subject()) && w.index < 0x6000;  // after a restart
    if (!by_setup) ++seen[{w.index, w.sub, w.data}];
  }
  for (const auto& [what, times] : seen) {
    const auto& [index, sub, data] = what;
    // What set_position puts back, or a mode change invalidates; and zeros, once before a mode changes and once in it.
    // A drive on CAN that was silent before the start is told the speed of that start anew.
    const bool zero = data == 0 && (index == 0x60FF || index == 0x60F6 || index == 0x6071);
    const bool again = index == kControlword || index == kMode || index == 0x6098 || index == 0x607C || zero ||
                       (is_canopen_servo(subject()) && index == 0x6081);
    const std::size_t most = talk.is_stop ? 3 : again ? 2 : 1;
    EXPECT_LE(times, most) << std::hex << index << " := " << data;
  }
}

void EachStepFails::expect_recovery(DriveRig& rig) {
  rig.stage.at_link(0, [](auto& link) {
    link.on_traffic = [](bool, const auto&) {};
    if (!link.plugged()) link.plug();
  });
  ASSERT_TRUE(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::online; }, 20s)) << "online again";
  EXPECT_EQ(rig.command(Command::quick_stop).outcome.code, Errc::ok);
  ASSERT_TRUE(rig.stage.run_until([&] { return !rig.turns(); }, 10s)) << "stoppable";
  EXPECT_TRUE(subject() == Subject::leadshine || !rig.powered()) << "its quick stop keeps the torque";
  ASSERT_TRUE(rig.stage.come_online()) << "one that was adopted is set up as soon as it is disabled";
  if (rig.axis().has(AxisInput::fault)) {
    EXPECT_EQ(rig.command(Command::fault_reset).outcome.code, Errc::ok);
    ASSERT_TRUE(rig.stage.come_online());
  }
  EXPECT_EQ(rig.command(Command::enable).outcome.code, Errc::ok);
  EXPECT_FALSE(rig.turns()) << "an enable never moves";
  EXPECT_EQ(rig.ask(rig.motion()).outcome.code, Errc::ok);
  rig.stage.run(300ms);
  EXPECT_TRUE(rig.turns()) << "and usable again";
}

void EachStepFails::fail_one(const Commanded& talk, std::size_t step) {
  DriveRig rig(subject());
  rig.bring_to(talk.from);
  const bool was_powered = rig.powered();
  fail_at(rig, step);
  int results = 0;
  std::optional<BatchResult> result;
  WriteBatch batch = talk.batch;
  batch.role = Role::engineer;
  batch.start_by = rig.stage.runtime().now() + 500ms;
  batch.answer_by = rig.stage.runtime().now() + 900ms;
  result = rig.stage.gateway().submit(1, batch, [&](const BatchResult& r) { ++results, result = r; });
  if (result) ++results;
  rig.stage.run_until([&] { return results > 0; }, 8s);
  rig.stage.run(20ms);
  ASSERT_TRUE(result) << "no result";
  const bool done = result->outcome.code == Errc::ok;
  EXPECT_TRUE(allowed(subject(), failure(), result->outcome.code, talk.is_stop)) << text(result->outcome.code);
  expect_no_write_twice(rig, talk);
  rig.stage.run(700ms);  // whatever was repeated or comes late has come by now
  EXPECT_EQ(results, 1);
  // The line takes a reply that comes twice for one that is still owed.
  if (is_canopen_servo(subject()) && failure() != Failure::reply_twice) {
    EXPECT_EQ(rig.stage.can_link(0).line().overlapping_requests(), 0U) << "one SDO request outstanding at any time";
  }
  EXPECT_TRUE(talk.may_turn || !rig.turns()) << "nobody asked for a motion";
  EXPECT_TRUE(was_powered || talk.may_enable || !rig.powered());
  if (talk.is_stop && done && rig.stage.at_link(0, [](auto& link) { return link.plugged(); })) {
    EXPECT_TRUE(rig.stage.run_until([&] { return !rig.turns(); }, 5s)) << "stopped, it said";
  }
  if (failure() == Failure::restarted && rig.axis().link_state == LinkState::online) {
    EXPECT_TRUE(!rig.powered() || talk.may_enable);
  }
  expect_recovery(rig);
}

TEST_P(EachStepFails, EndsOnceAsTheContractSaysAndRecovers) {
  for (const Commanded& talk : all_commanded(subject())) {
    const std::size_t steps = exchanges_of(talk);
    for (std::size_t step = 0; step < steps && !HasFailure(); ++step) {
      SCOPED_TRACE(talk.name + ", " + text_of(failure()) + " at exchange " + std::to_string(step));
      fail_one(talk, step);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Failures, EachStepFails,
                         testing::Combine(testing::Values(Subject::jd_serial, Subject::md_serial, Subject::leadshine,
                                                          Subject::jd_can, Subject::md_can, Subject::keya_can_speed,
                                                          Subject::keya_rs232_position, Subject::keya_canopen_speed),
                                          testing::ValuesIn(kFailures)),
                         [](const auto& case_of) {
                           return name(std::get<0>(case_of.param)) + "_" + text_of(std::get<1>(case_of.param));
                         });

}  // namespace
}  // namespace axisgate::test
