// SPDX-License-Identifier: Apache-2.0
// Stories told once and kept: the text that a story makes must equal its file. Run with AXISGATE_WRITE_GOLDEN=1 to
// write the files anew; read the difference before committing it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/golden/recorder.hpp"
#include "tests/places.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;
using simulated::KincoType;

void compare(const Recorder& recorder, const std::string& name) {
  const std::string path = test::source_path("tests/golden/") + name + ".txt";
  if (std::getenv("AXISGATE_WRITE_GOLDEN") != nullptr) std::ofstream(path) << recorder.text();
  std::ifstream file(path);
  std::ostringstream expected;
  expected << file.rdbuf();
  EXPECT_EQ(recorder.text(), expected.str()) << "the story in " << path << " is told differently now";
}

TEST(Golden, JdComesUp) {
  Recorder story(KincoType::jd, true);
  story.read(0, 39);
  compare(story, "kinco-jd.bring-up");
}

TEST(Golden, JdIsEnabledMovesAndIsDisabled) {
  Recorder story(KincoType::jd, false);
  story.say("commands with a command_id: command 0 with an id first, then counted on");
  story.write(54, {0, 100});
  story.write(54, {1, 1});
  story.say("target 20000 units and 600 rpm in one block with move_absolute");
  story.write(42, {0, 20000});
  story.write(48, {9, 10176});
  story.write(54, {6, 2});
  story.run(600ms);
  story.write(54, {2, 3});
  story.read(25, 14);
  compare(story, "kinco-jd.move");
}

TEST(Golden, JdIsStoppedQuicklyAndLatched) {
  Recorder story(KincoType::jd, false);
  story.write(54, {1});
  story.write(44, {1, 0x86A0});
  story.write(54, {8});
  story.coil(2, true);
  story.say("latched: a start is refused until it is enabled anew");
  story.write(54, {6});
  story.say("a level acts on 0 -> 1 alone");
  story.coil(0, false);
  story.coil(0, true);
  compare(story, "kinco-jd.quick-stop");
}

TEST(Golden, MdHaltsAndNothingResumes) {
  Recorder story(KincoType::md, false);
  story.write(54, {1});
  story.write(44, {1, 0x86A0});
  story.write(54, {8});
  story.coil(3, true);
  story.coil(3, false);
  story.write(54, {2});
  compare(story, "kinco-md.halt");
}

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

TEST(Golden, ADriveThatRefuses) {
  Recorder story(KincoType::md, false);
  story.say("an object that the drive does not have, through the object mailbox");
  story.write(80, {1, 0x5FFF, 0, 2});
  story.run(50ms);
  story.read(80, 10);
  compare(story, "kinco-md.refusal");
}

simulated::RtuDriveOptions jd_on_rs485() { return simulated::KincoRtuDrive{}; }

TEST(Golden, AStepperComesUp) {
  Recorder story(simulated::Id286proOptions{}, true);
  story.read(0, 39);
  compare(story, "id286pro.bring-up");
}

TEST(Golden, AStepperIsEnabledMovesAndCompletes) {
  Recorder story(simulated::Id286proOptions{}, false);
  story.write(54, {1});
  story.say("target 5000 units, half a turn");
  story.write(42, {0, 5000});
  story.write(54, {0});
  story.write(54, {6});
  story.run(400ms);
  story.read(31, 3);
  story.say("a relative move back by 1000 units");
  story.write(42, {0xFFFF, 0xFC18});
  story.write(54, {7});
  story.run(300ms);
  story.write(54, {2});
  story.read(25, 14);
  compare(story, "id286pro.move");
}

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

TEST(Golden, AStepperIsStoppedQuicklyAndLatched) {
  Recorder story(simulated::Id286proOptions{}, false);
  story.write(54, {1});
  story.write(44, {4, 0x93E0});
  story.write(54, {8});
  story.run(300ms);
  story.coil(2, true);
  story.say("latched: a start is refused until it is enabled anew");
  story.write(54, {6});
  story.coil(0, false);
  story.coil(0, true);
  compare(story, "id286pro.quick-stop");
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

TEST(Golden, JdComesUpOnModbusRtu) {
  Recorder story(jd_on_rs485(), true);
  story.read(0, 39);
  compare(story, "kinco-jd-rtu.bring-up");
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

TEST(Golden, ALeadshineComesUpOnCanAndMakesAMove) {
  Recorder story(simulated::LeadshineOptions{}, true);
  story.run(100ms);
  story.say("enabled, and sent 500 units forward: a twentieth of a turn");
  story.write(54, {1});
  story.write(42, {0, 500});
  story.write(54, {0});
  story.write(54, {6});
  story.run(600ms);
  story.read(31, 3);
  story.write(54, {2});
  compare(story, "leadshine-ld2-can.move");
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
