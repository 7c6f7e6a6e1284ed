// SPDX-License-Identifier: Apache-2.0
#include "tests/stage_drive/owned_rig.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace axisgate::test {

using namespace std::chrono_literals;

std::string name(Cut cut) { return cut == Cut::silent ? "silent" : "reported"; }

OwnedRig::OwnedRig(Subject subject, std::optional<LeaseRules> lease) : rig(subject, lease) { rig.online(); }

OwnedRig::~OwnedRig() {
  if (testing::Test::HasFailure())
    for (const std::string& line : rig.stage.log()) std::cout << line << '\n';
}

void OwnedRig::run(Duration time, bool lives) {
  constexpr Duration kSign = 50ms;
  for (Duration done{}; done < time; done += kSign) {
    if (lives) owner->last_request = rig.stage.runtime().now();
    rig.stage.run(std::min<Duration>(kSign, time - done));
  }
}

Errc OwnedRig::ask(WriteBatch batch) {
  owner->last_request = rig.stage.runtime().now();
  batch.client = owner->id;
  batch.role = owner->role;
  batch.life = owner;
  batch.claims = batch.command != Command::jog_end;
  return rig.ask(batch).outcome.code;
}

void OwnedRig::set_moving(Duration time) {
  ASSERT_EQ(command(Command::enable), Errc::ok);
  ASSERT_EQ(ask(rig.motion()), Errc::ok);
  run(time);
  ASSERT_TRUE(rig.turns()) << "as long as its owner lives";
  owner->last_request = rig.stage.runtime().now();
}

void OwnedRig::cut(Cut cut) {
  if (cut == Cut::silent)
    rig.silence_the_drive();
  else
    rig.unplug();
  rig.stage.run(1ms);
}

Duration OwnedRig::short_gap(Cut cut) const {
  const Subject s = rig.subject();
  const bool watches = s == Subject::jd_can || s == Subject::md_can || s == Subject::leadshine || is_eds(s);
  return watches && cut == Cut::silent ? 350ms : 800ms;
}

bool OwnedRig::comes_to_rest(Duration limit) {
  const Instant end = rig.stage.runtime().now() + limit;
  while (rig.turns())
    if (rig.stage.runtime().now() >= end) return false;
  return true;
}

bool OwnedRig::stays_at_rest(Duration time) {
  const Instant end = rig.stage.runtime().now() + time;
  while (rig.stage.runtime().now() < end)
    if (rig.turns()) return false;
  return true;
}

bool OwnedRig::adopted() { return (rig.axis().alarms >> static_cast<unsigned>(AxisAlarm::adopted_running) & 1U) != 0; }

void OwnedRig::expect_usable() {
  run(2s);  // a drive that has missed the gateway for too long may stop by itself yet
  ASSERT_TRUE(rig.stage.come_online());
  if (rig.axis().has(AxisInput::fault)) {
    EXPECT_EQ(command(Command::fault_reset), Errc::ok);
  }
  EXPECT_EQ(command(Command::enable), Errc::ok);
  EXPECT_FALSE(latched());
  EXPECT_TRUE(stays_at_rest(1s)) << "an enable is an enable and nothing else";
  // Not where it was sent before: it may have arrived there.
  const WriteBatch anew = !has_speeds(rig.subject())
                              ? with_command(Command::move_absolute, {{Quantity::target_position, -5'000'000}})
                              : rig.motion();
  EXPECT_EQ(ask(anew), Errc::ok);
  run(500ms);
  EXPECT_TRUE(rig.turns());
}

}  // namespace axisgate::test
