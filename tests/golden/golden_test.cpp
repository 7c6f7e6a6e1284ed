// SPDX-License-Identifier: Apache-2.0
// Stories told once and kept: the text that a story makes must equal its file. Run with AXISGATE_WRITE_GOLDEN=1 to
// write the files anew; read the difference before committing it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/golden/recorder.hpp"
#include "tests/places.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;
using simulated::KincoType;

namespace fs = std::filesystem;

std::string path_of(const std::string& name) { return source_path("tests/golden/") + name + ".txt"; }

void compare(const Recorder& recorder, const std::string& name) {
  const std::string path = path_of(name);
  if (std::getenv("AXISGATE_WRITE_GOLDEN") != nullptr) std::ofstream(path) << recorder.text();
  std::ifstream file(path);
  std::ostringstream expected;
  expected << file.rdbuf();
  EXPECT_EQ(recorder.text(), expected.str()) << "the story in " << path << " is told differently now";
}

// --- Stories whose file says all: the drive in its first line, and what the client does ------------------------------

std::vector<std::string> remarks_of(const std::string& name) {
  std::vector<std::string> remarks;
  std::ifstream file(path_of(name));
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("# ")) remarks.push_back(line.substr(2));
  return remarks;
}

/// Those whose first line names a drive; the others are told below.
std::vector<std::string> told_by_themselves() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(source_path("tests/golden"))) {
    if (entry.path().extension() != ".txt") continue;
    std::string first;
    std::ifstream file(entry.path());
    if (std::getline(file, first) && first.find(" at address ") != std::string::npos)
      names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class GoldenFile : public testing::TestWithParam<std::string> {};

TEST_P(GoldenFile, IsToldAsItWas) {
  const std::vector<std::string> remarks = remarks_of(GetParam());
  Recorder story("# " + remarks.at(0));
  for (std::size_t i = 1; i < remarks.size(); ++i) story.tell(remarks[i]);
  compare(story, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Every, GoldenFile, testing::ValuesIn(told_by_themselves()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

// --- Stories in which something fails
// ---------------------------------------------------------------------------------

TEST(Golden, AReplyThatIsLateIsNeverTakenForAnother) {
  Recorder story(KincoType::jd, false);
  story.say("the reply to the next request comes 150 ms late, after the timeout of 100 ms");
  story.faults().late_by = 150ms;
  story.faults().next(DriveFault::late);
  story.write(48, {0, 1000});
  story.run(300ms);
  story.read(18, 1);
  compare(story, "kinco-jd.late-reply");
}

TEST(Golden, ACableThatIsPulledAndPluggedBack) {
  Recorder story(KincoType::jd, false);
  story.say("the cable is pulled");
  story.stage().link(0).unplug();
  story.run(10ms);
  story.write(54, {1});
  story.say("and plugged back");
  story.stage().link(0).plug();
  story.run(2s);
  story.read(18, 1);
  compare(story, "kinco-jd.cable");
}

TEST(Golden, AFaultOfAServoIsShownAtOnceAndItsCauseNext) {
  Recorder story(KincoType::jd, false);
  constexpr std::uint16_t kSupplyTooHigh = 0x0020;
  story.say("the bus voltage is too high");
  story.stage().drive(0).inject_fault(1, kSupplyTooHigh);
  story.run(150ms);
  story.read(0, 25);
  compare(story, "kinco-jd.fault");
}

simulated::RtuDriveOptions jd_on_rs485() { return simulated::KincoRtuDrive{}; }

TEST(Golden, AStepperHasAFaultAndIsReset) {
  Recorder story(simulated::Id286proOptions{}, false);
  story.write(54, {1});
  story.say("the supply rises above 90 V");
  story.stage().id286pro(0).inject_fault(14);
  story.run(250ms);
  story.read(0, 18);
  story.say("fault_reset while the cause is still there, then after it is gone");
  story.write(54, {5});
  story.stage().id286pro(0).clear_fault_cause();
  story.coil(1, true);
  story.run(150ms);
  story.read(0, 18);
  compare(story, "id286pro.fault");
}

TEST(Golden, AStepperIsLateAndTheResynchronisationReadHasAnotherLength) {
  Recorder story(simulated::Id286proOptions{}, false);
  story.say(
      "the reply to the next request comes 150 ms late: the resynchronisation read asks for one register, not for two");
  story.faults().late_by = 150ms;
  story.faults().next(DriveFault::late);
  story.run(500ms);
  story.read(18, 1);
  story.say(
      "the next two come 300 ms late each: two resynchronisation reads, then offline; nothing counts until the drive "
      "comes up anew");
  story.faults().late_by = 300ms;
  story.faults().next(DriveFault::late, 2);
  story.run(1100ms);
  story.read(18, 1);
  compare(story, "id286pro.late-reply");
}

TEST(Golden, ALateReplyOnModbusRtuIsToldByItsLength) {
  Recorder story(jd_on_rs485(), false);
  story.say(
      "the reply to the next request comes 300 ms late: it is a write, and read back once the resynchronisation read "
      "is answered");
  story.faults().late_by = 300ms;
  story.faults().next(DriveFault::late);
  story.write(48, {0, 1000});
  story.run(300ms);
  story.say("and now a read's");
  story.faults().next(DriveFault::late);
  story.run(1s);
  story.read(18, 1);
  compare(story, "kinco-jd-rtu.late-reply");
}

TEST(Golden, AJdOnCanLosesItsPowerAndComesBack) {
  Recorder story(simulated::KincoCanDrive{}, false);
  story.write(54, {1});
  story.say("its power goes and comes back: a boot-up after a second, everything set up anew, and nothing enabled");
  story.restart();
  story.write(54, {6});
  story.run(3s);
  story.read(18, 1);
  story.read(0, 1);
  compare(story, "kinco-jd-can.restart");
}

}  // namespace
}  // namespace axisgate::test
