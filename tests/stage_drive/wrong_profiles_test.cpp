// SPDX-License-Identifier: Apache-2.0
// Wrong profiles, each wrong in one place: what tells it, as early as it can be known, and what the motor did by then.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "gateway/profile/read/profile_loader.hpp"
#include "tests/places.hpp"
#include "tests/profiles/mistakes.hpp"
#include "tests/stage_drive/drive_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kTurn = 10'000;
constexpr std::int64_t kSlowly = 60'000;  // 60 rpm

/// What somebody does with a drive that he has just written a profile for, whatever is refused to him.
using Play = void (*)(DriveRig& rig, const std::function<void(Duration)>& run);

void one_turn(DriveRig& rig, const std::function<void(Duration)>& run) {
  static_cast<void>(rig.ask(with_command(Command::enable)));
  static_cast<void>(rig.ask(with_command(Command::move_absolute,
                                         {{Quantity::profile_velocity, kSlowly}, {Quantity::target_position, kTurn}})));
  run(15s);
  static_cast<void>(rig.ask(with_command(Command::quick_stop)));
  run(3s);
}

void back_and_forth(DriveRig& rig, const std::function<void(Duration)>& run) {
  one_turn(rig, run);
  static_cast<void>(rig.ask(with_command(Command::enable)));
  static_cast<void>(rig.ask(with_command(Command::move_absolute, {{Quantity::target_position, -kTurn}})));
  run(10s);
  static_cast<void>(rig.ask(with_command(Command::quick_stop)));
  run(3s);
}

void some_speed(DriveRig& rig, const std::function<void(Duration)>& run) {
  static_cast<void>(rig.ask(with_command(Command::enable)));
  static_cast<void>(rig.ask(with_command(Command::run_velocity, {{Quantity::target_velocity, kSlowly}})));
  run(30s);
  // What it does about it: nothing that moves is started any more.
  static_cast<void>(rig.ask(with_command(Command::halt)));
  run(4s);
  static_cast<void>(rig.ask(with_command(Command::run_velocity, {{Quantity::target_velocity, kSlowly}})));
  run(2s);
  static_cast<void>(rig.ask(with_command(Command::quick_stop)));
  run(3s);
}

/// Its power comes back: it says so to whoever listens.
void power_cycle(DriveRig& rig, const std::function<void(Duration)>& run) {
  rig.restart_the_drive();
  run(10s);
}

void homing(DriveRig& rig, const std::function<void(Duration)>& run) {
  static_cast<void>(rig.ask(with_command(Command::enable)));
  static_cast<void>(rig.ask(with_command(Command::home, {{Quantity::homing_method, 35}})));
  run(10s);
}

struct Wrong {
  std::string name;
  Subject subject = Subject::leadshine;
  std::string patch;               ///< members of the file, beside what it extends
  std::vector<std::string> words;  ///< each must be told
  double turns = 0;                ///< the motor turns at most so far from where it stood
  Play play = one_turn;
  bool at_the_desk = false;  ///< `axisgate profile check` tells it: it never gets to a drive
  std::function<void(GatewayStage::Line&)> line = [](GatewayStage::Line&) {};
};
void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }

std::string base_of(Subject subject) {
  if (subject == Subject::id286pro) return "id286pro";
  return subject == Subject::leadshine ? "leadshine-ld2-can" : "kinco-jd";
}

const std::vector<Wrong>& wrongs() {
  static const std::vector<Wrong> kWrongs{
      // --- Widths and signs
      {"width_on_canopen",
       Subject::leadshine,
       R"("objects": {"velocity_actual": {"type": "i16"}})",
       {"velocity_actual: the drive answers 4 bytes, the profile says 2", "profile_mismatch: the device refuses"}},
      {"width_on_rtu",
       Subject::jd_rtu,
       R"("objects": {"position_actual": {"type": "i16"}})",
       {"/quantities/position_actual: object \"position_actual\" has 16 bits and \"target_position\" 32"},
       0,
       one_turn,
       true},
      {"sign_of_velocity",
       Subject::leadshine,
       R"("objects": {"velocity_actual": {"type": "u32"}})",
       {"velocity_actual reads 42949", "as a signed number it is -"},
       1.1,
       back_and_forth},
      {"sign_of_position",
       Subject::leadshine,
       R"("objects": {"position_actual": {"type": "u32"}})",
       {"/quantities/position_actual: object \"position_actual\" has no sign and \"target_position\" has one"},
       0,
       one_turn,
       true},
      {"word_order",
       Subject::id286pro,
       R"("protocols": {"modbus-rtu": {"word_order": "high-first"}})",
       {"profile_mismatch: ", "\"word_order\""}},
      {"word_order_of_a_servo",
       Subject::jd_rtu,
       R"("protocols": {"modbus-rtu": {"word_order": "high-first"}})",
       {"profile_mismatch: ", "\"word_order\""}},
      // --- Places
      {"off_by_one",
       Subject::leadshine,
       R"("objects": {"position_actual": {"at": {"canopen": "6065.00"}, "type": "u32"}})",
       {"has no sign"},
       0,
       one_turn,
       true},
      {"off_by_one_of_the_same_width",
       Subject::leadshine,
       R"("objects": {"position_actual": {"at": {"canopen": "5500.01"}}})",
       {"position_actual"},
       1.1},
      {"target_that_is_read_only_here",
       Subject::leadshine,
       R"("objects": {"target_position": {"access": "ro"}})",
       {"/quantities/target_position: object \"target_position\" is read-only"},
       0,
       one_turn,
       true},
      {"target_on_an_object_that_is_read_only_there",
       Subject::leadshine,
       R"("objects": {"target_position": {"at": {"canopen": "6062.00"}}})",
       {"target_position"}},
      {"target_that_the_drive_does_not_have",
       Subject::leadshine,
       R"("objects": {"target_position": {"at": {"canopen": "5FFF.00"}}})",
       {"goes on without: target_position (0x5FFF:00; for target_position)"}},
      {"ramp_that_the_drive_does_not_have",
       Subject::leadshine,
       R"("objects": {"profile_acceleration": {"at": {"canopen": "5FFE.00"}}})",
       {"goes on without: profile_acceleration (0x5FFE:00; for profile_acceleration)"},
       1.1},
      // --- What never comes
      {"enabled_that_never_shows",
       Subject::leadshine,
       R"("commands": {"enable": {"source": "none", "steps": [{"write": "controlword", "value": 6}, {"write": "controlword", "value": 7},
          {"write": "controlword", "value": 15}, {"wait": "statusword", "mask": "0x0067", "equals": "0x0067", "ms": 2000}]}})",
       {"enable was not reached: step 7 (controlword = 0x000F)", "awaited statusword & 0x0067 = 0x0067"}},
      {"reached_that_never_comes",
       Subject::id286pro,
       R"("state": {"reached": {"after": "moving", "when": {"object": "run_state", "equals": 9}}})",
       {"does not say that it is there", "run_state"},
       1.1},
      {"homed_that_never_shows",
       Subject::leadshine,
       R"("homing": {"homed": {"object": "statusword", "mask": "0x0100", "equals": "0x0100"}})",
       {"home was not reached: step 5", "awaited a motion or a change of its bits, read none"},
       0.1,
       homing},
      // --- Units
      {"speed_by_60",
       Subject::leadshine,
       R"("units": {"speed": {"mul": ["units_per_motor_rev", 60]}})",
       {"units_disagree: "},
       2000,
       some_speed},
      {"counts_by_10",
       Subject::jd_can,
       R"("units": {"position": {"mul": ["encoder_counts_per_rev", 10]}})",
       {"units_disagree: "},
       40,
       some_speed},
      // --- Stops
      {"stop_that_enables",
       Subject::leadshine,
       R"("commands": {"quick_stop": {"steps": [{"write": "controlword", "value": 15}]}})",
       {"/commands/quick_stop"},
       0,
       one_turn,
       true},
      {"stop_that_stops_nothing",
       Subject::id286pro,
       R"("commands": {"quick_stop": {"source": "none", "steps": [{"write": "control", "value": 0}]}})",
       {"quick_stop was not reached: step 2 (control = 0x0000): awaited that it slows down, read velocity_actual "
        "60000"},
       1000,
       some_speed},
      // --- Another drive
      {"another_node",
       Subject::leadshine,
       "",
       {"node 2 is heard", "node 1"},
       0,
       power_cycle,
       false,
       [](GatewayStage::Line& line) {
         std::get<simulated::LeadshineOptions>(line.can_drives.front().options).node = 2;
         line.can_drives.front().configured_node = 1;
       }},
      {"another_drive",
       Subject::leadshine,
       "",
       {"profile_mismatch: "},
       0,
       one_turn,
       false,
       [](GatewayStage::Line& line) { line.can_drives.front().profile = "schemas/drives/kinco-jd.json"; }},
  };
  return kWrongs;
}

std::string file_of(const Wrong& wrong) {
  std::string name = wrong.name;
  std::ranges::replace(name, '_', '-');
  return R"({"profile": 1, "name": ")" + name + R"(", "extends": ")" + base_of(wrong.subject) + "\"" +
         (wrong.patch.empty() ? "" : ", " + wrong.patch) + "}";
}

class WrongProfile : public testing::TestWithParam<Wrong> {
 protected:
  [[nodiscard]] std::string written() const {
    std::string name = GetParam().name;
    std::ranges::replace(name, '_', '-');
    return folder_.write(name + ".json", file_of(GetParam())).string();
  }

 private:
  OwnFolder folder_;
};

TEST_P(WrongProfile, IsToldByItsCause) {
  const Wrong& wrong = GetParam();
  const std::string file = written();
  const profile::LoadedProfile loaded = profile::load_profile(file, {source_path("schemas/drives")});
  std::string desk;
  for (const profile::Fault& fault : loaded.faults) desk += text(fault) + "\n";
  ASSERT_EQ(!desk.empty(), wrong.at_the_desk) << desk;
  std::string all = desk;
  double furthest = 0;
  bool turns = false;
  if (!wrong.at_the_desk) {
    GatewayStage::Line line = line_with(wrong.subject, {});
    for (auto& each : line.rtu_drives) each.profile = file;
    for (auto& each : line.can_drives) each.profile = file;
    wrong.line(line);
    DriveRig rig(wrong.subject, std::move(line));
    const std::int64_t from = rig.position();
    const auto run = [&](Duration time) {
      for (Duration gone{}; gone < time; gone += 50ms) {
        rig.stage.run(50ms);
        furthest = std::max(furthest, std::abs(static_cast<double>(rig.position() - from) / kTurn));
      }
    };
    static_cast<void>(rig.stage.run_until([&] { return rig.axis().link_state == LinkState::online; }, 20s));
    wrong.play(rig, run);
    turns = rig.turns();
    for (const std::string& line_of_log : rig.stage.log()) all += line_of_log + "\n";
  }
  for (const std::string& words : wrong.words) EXPECT_NE(all.find(words), std::string::npos) << words;
  EXPECT_LE(furthest, wrong.turns) << "turns";
  if (HasFailure())
    ADD_FAILURE() << "the motor was " << furthest << " turns away" << (turns ? ", and turns" : "") << "; told was:\n"
                  << all;
}

INSTANTIATE_TEST_SUITE_P(All, WrongProfile, testing::ValuesIn(wrongs()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace axisgate::test
