// SPDX-License-Identifier: Apache-2.0
#include "tests/stage_drive/gap_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

}  // namespace

std::string name(Cut cut) { return cut == Cut::silent ? "silent" : "reported"; }

std::vector<Subject> all_subjects() {
  std::vector<Subject> out(kSubjects.begin(), kSubjects.end());
  out.push_back(Subject::jd_serial);
  out.push_back(Subject::md_serial);
  return out;
}

std::vector<Subject> jogging_subjects() {
  std::vector<Subject> out = all_subjects();
  std::erase_if(out, positions_alone);
  return out;
}

GapRig::GapRig(Subject subject, std::optional<LeaseRules> lease) : rig(subject, lease) { rig.online(); }

GapRig::~GapRig() {
  if (testing::Test::HasFailure())
    for (const std::string& line : rig.stage.log()) std::cout << line << '\n';
}

void GapRig::run(Duration time, bool lives) {
  constexpr Duration kSign = 50ms;
  for (Duration done{}; done < time; done += kSign) {
    if (lives) owner->last_request = rig.stage.runtime().now();
    rig.stage.run(std::min<Duration>(kSign, time - done));
  }
}

Errc GapRig::ask(WriteBatch batch) {
  owner->last_request = rig.stage.runtime().now();
  batch.client = owner->id;
  batch.role = owner->role;
  batch.life = owner;
  batch.claims = batch.command != Command::jog_end;
  return rig.ask(batch).outcome.code;
}

void GapRig::set_moving() {
  ASSERT_EQ(command(Command::enable), Errc::ok);
  ASSERT_EQ(ask(rig.motion()), Errc::ok);
  run(1s);
  ASSERT_TRUE(rig.turns());
  owner->last_request = rig.stage.runtime().now();
}

void GapRig::cut(Cut cut) {
  if (cut == Cut::silent)
    rig.silence_the_drive();
  else
    rig.unplug();
  rig.stage.run(1ms);
}

Duration GapRig::short_gap(Cut cut) const {
  const Subject s = rig.subject();
  const bool watches = s == Subject::jd_can || s == Subject::md_can || s == Subject::leadshine;
  return watches && cut == Cut::silent ? 350ms : 800ms;
}

bool GapRig::comes_to_rest(Duration limit) {
  const Instant end = rig.stage.runtime().now() + limit;
  while (rig.turns())
    if (rig.stage.runtime().now() >= end) return false;
  return true;
}

bool GapRig::stays_at_rest(Duration time) {
  const Instant end = rig.stage.runtime().now() + time;
  while (rig.stage.runtime().now() < end)
    if (rig.turns()) return false;
  return true;
}

bool GapRig::adopted() { return (rig.axis().alarms >> static_cast<unsigned>(AxisAlarm::adopted_running) & 1U) != 0; }

void GapRig::expect_usable() {
  run(2s);  // a drive that has missed the gateway for too long may stop by itself yet
  ASSERT_TRUE(rig.stage.come_online());
  if (rig.axis().has(AxisInput::fault)) {
    EXPECT_EQ(command(Command::fault_reset), Errc::ok);
  }
  EXPECT_EQ(command(Command::enable), Errc::ok);
  EXPECT_FALSE(latched());
  EXPECT_TRUE(stays_at_rest(1s)) << "an enable is an enable and nothing else";
  // Not where it was sent before: it may have arrived there.
  const WriteBatch anew = positions_alone(rig.subject())
                              ? with_command(Command::move_absolute, {{Quantity::target_position, -5'000'000}})
                              : rig.motion();
  EXPECT_EQ(ask(anew), Errc::ok);
  run(500ms);
  EXPECT_TRUE(rig.turns());
}

bool GapRig::told(const std::string& part) {
  const auto& log = rig.stage.log();
  return std::any_of(log.begin(), log.end(), [&](const std::string& line) { return line.find(part) != line.npos; });
}

}  // namespace axisgate::test
