// SPDX-License-Identifier: Apache-2.0
// Every command sequence with a drive of two motors, with each of its exchanges failing in every way an exchange can
// fail.
#include <gmock/gmock.h>

#include "tests/stage_drive/keya_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

enum class Start : std::uint8_t { disabled, enabled, running };

struct Talk {
  std::string name;
  Start from;
  WriteBatch batch;
  bool is_stop = false;
  bool may_enable = false;
  bool may_run = false;
};

WriteBatch word(std::uint16_t controlword) {
  WriteBatch batch = KeyaRig::batch_of(Command::none);
  batch.controlword = controlword;
  batch.single_controlword = true;
  return batch;
}

std::vector<Talk> talks(std::int16_t mode) {
  const Setpoint target =
      mode == 1 ? Setpoint{Quantity::target_position, 20'000} : Setpoint{Quantity::target_velocity, kRpm150};
  WriteBatch read = KeyaRig::batch_of(Command::none);
  read.object = ObjectRequest{false, kFaultQuery, 1, 2, 0};
  std::vector<Talk> out{
      {"enable", Start::disabled, KeyaRig::batch_of(Command::enable), false, true},
      {"disable", Start::running, KeyaRig::batch_of(Command::disable), true, false, true},
      {"quick stop", Start::running, KeyaRig::batch_of(Command::quick_stop), true, false, true},
      {"halt", Start::running, KeyaRig::batch_of(Command::halt), true, false, true},
      {"raw stop", Start::running, word(6), true, false, true},
      {"set-point", Start::running, KeyaRig::batch_of(Command::none, {target}), false, false, true},
      {"mailbox read", Start::enabled, read},
  };
  if (mode == 1)
    out.push_back({"move", Start::enabled, KeyaRig::batch_of(Command::move_absolute, {target}), false, false, true});
  else
    out.push_back({"run", Start::enabled, KeyaRig::batch_of(Command::run_velocity, {target}), false, false, true});
  return out;
}

KeyaOptions options(Speech speech, std::int16_t mode) { return {.speech = speech, .modes = {mode}}; }

/// Motor B runs through all of it; A is where the command sequence begins.
void bring_to(KeyaRig& rig, Start start, std::int16_t mode) {
  rig.online();
  rig.enable(1);
  if (mode == 3) rig.run_at(1, -kRpm150);
  if (start == Start::disabled) return;
  rig.enable(0);
  if (start != Start::running) return;
  const WriteBatch go = mode == 1
                            ? KeyaRig::batch_of(Command::move_absolute, {{Quantity::target_position, 5'000'000}})
                            : KeyaRig::batch_of(Command::run_velocity, {{Quantity::target_velocity, 2 * kRpm150}});
  if (KeyaRig::code(rig.ask(0, go)) != Errc::ok) throw std::runtime_error("does not run");
  rig.run(50ms);
}

bool allowed(Fate fate, Errc code, const Talk& talk) {
  switch (fate) {
    case Fate::answered:
      return code == Errc::ok;
    case Fate::muted:
    case Fate::reply_lost:
      return code == Errc::ok || code == Errc::timed_out || code == Errc::not_reached ||
             (!talk.is_stop && code == Errc::state_unsuitable);
    case Fate::refused:
      return code == Errc::ok || code == Errc::refused_by_drive || (talk.is_stop && code == Errc::timed_out) ||
             code == Errc::not_reached;
    case Fate::cut_before:
    case Fate::cut_after:
      return code == Errc::ok || code == Errc::link_lost || code == Errc::offline;
  }
  return false;
}

bool turns(KeyaRig& rig) {
  const double before = rig.motor(0).position;
  rig.run(100ms);
  return std::abs(rig.motor(0).position - before) > 1;
}

class KeyaEachStepFails : public testing::TestWithParam<std::tuple<Speech, std::int16_t, Fate>> {
 protected:
  void fail_one(const Talk& talk, std::size_t step);
};

void KeyaEachStepFails::fail_one(const Talk& talk, std::size_t step) {
  const auto& [speech, mode, fate] = GetParam();
  KeyaRig rig(options(speech, mode));
  bring_to(rig, talk.from, mode);
  const int enables = rig.motor(0).enables, enables_b = rig.motor(1).enables;
  rig.wire->fate = [fate = fate, left = step](const bus::Exchange&) mutable {
    return left-- == 0 ? fate : Fate::answered;
  };
  rig.mark();
  const auto result = rig.begin(0, talk.batch);
  ASSERT_TRUE(rig.run_until([&] { return result->has_value(); }, 10s)) << "no result";
  EXPECT_TRUE(allowed(fate, KeyaRig::code(**result), talk)) << text(KeyaRig::code(**result));
  rig.run(700ms);
  EXPECT_LE(rig.motor(0).enables, enables + (talk.may_enable ? 1 : 0)) << "turned on unasked";
  EXPECT_LE(rig.motor(1).enables, enables_b) << "the neighbour was turned on";
  if (talk.is_stop && KeyaRig::code(**result) == Errc::ok) {
    EXPECT_FALSE(turns(rig)) << "stopped, it said";
  }
  if (!talk.may_run && talk.from != Start::running) {
    EXPECT_FALSE(turns(rig)) << "nobody asked for a motion";
  }
  rig.wire->fate = {};
  if (fate == Fate::cut_before || fate == Fate::cut_after) rig.wire->plug();
  ASSERT_TRUE(rig.run_until([&] { return rig.axis(0).link_state == LinkState::online; }, 8s));
  EXPECT_EQ(KeyaRig::code(rig.command(0, Command::quick_stop)), Errc::ok) << "stoppable";
  EXPECT_FALSE(rig.motor(0).enabled);
  EXPECT_EQ(KeyaRig::code(rig.command(1, Command::quick_stop)), Errc::ok);
  EXPECT_FALSE(rig.motor(1).enabled);
  EXPECT_EQ(KeyaRig::code(rig.command(0, Command::enable)), Errc::ok) << "and usable again";
  EXPECT_FALSE(turns(rig)) << "an enable never moves";
}

TEST_P(KeyaEachStepFails, EndsOnceAsTheContractSaysAndRecovers) {
  const auto& [speech, mode, fate] = GetParam();
  for (const Talk& talk : talks(mode)) {
    KeyaRig whole(options(speech, mode));
    bring_to(whole, talk.from, mode);
    whole.mark();
    ASSERT_EQ(KeyaRig::code(whole.ask(0, talk.batch)), Errc::ok) << talk.name;
    const std::size_t steps = whole.since_mark().size() + 1;
    for (std::size_t step = 0; step < steps; ++step) {
      SCOPED_TRACE(talk.name + ", " + name(fate) + " at exchange " + std::to_string(step));
      fail_one(talk, step);
    }
  }
}

std::string case_name(const testing::TestParamInfo<KeyaEachStepFails::ParamType>& info) {
  const auto& [speech, mode, fate] = info.param;
  std::string out = (speech == Speech::single ? "single" : "composed") + std::to_string(mode) + name(fate);
  std::erase(out, ' ');
  return out;
}

INSTANTIATE_TEST_SUITE_P(All, KeyaEachStepFails,
                         testing::Combine(testing::Values(Speech::single, Speech::composed),
                                          testing::Values(std::int16_t{1}, std::int16_t{3}),
                                          testing::Values(Fate::muted, Fate::reply_lost, Fate::refused,
                                                          Fate::cut_before, Fate::cut_after)),
                         case_name);

}  // namespace
}  // namespace axisgate::test
