// The shipped gateway core on Modbus RTU lines of the stage: the link, and a day with each kind of drive.
#include <gmock/gmock.h>

#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::DriveFault;

/// Keeps what the link told.
struct RtuTold final : modbus_rtu::RtuLinkEvents {
  void on_link_up() override { words.push_back("up"); }
  void on_link_down(std::string_view why) override { words.push_back("down " + std::string(why)); }
  void on_frame(modbus_rtu::ExchangeNumber newest, Bytes frame) override {
    words.push_back("frame " + std::to_string(newest) + " of " + std::to_string(frame.size()));
    frames.emplace_back(frame.begin(), frame.end());
    at.push_back(runtime.now());
  }
  void on_bad_frame(modbus_rtu::ExchangeNumber, std::size_t bytes) override { bad += bytes; }

  explicit RtuTold(Runtime& of) : runtime(of) {}
  Runtime& runtime;
  std::vector<std::string> words;
  std::vector<std::vector<Byte>> frames;
  std::vector<Instant> at;
  std::size_t bad = 0;
};

class RtuLinkStage : public testing::Test {
 protected:
  RtuLinkStage() {
    link.line().add(simulated::KincoRtuDrive{});
    link.start(told);
    runtime.run_due();
  }
  void read_status(modbus_rtu::ExchangeNumber number, std::uint16_t count = 1) {
    const simulated::RtuBytes pdu = simulated::read_pdu(0x3200, count);
    std::vector<Byte> frame{1};
    frame.insert(frame.end(), pdu.begin(), pdu.end());
    link.transmit(number, frame);
  }

  ManualRuntime runtime;
  RtuLinkSim link{runtime, {}, 1};
  RtuTold told{runtime};
};

TEST_F(RtuLinkStage, AFrameArrivesWhenTheLineSaysAndNamesTheRequestBeforeIt) {
  const Instant asked = runtime.now();
  read_status(7);
  EXPECT_THAT(told.words, testing::ElementsAre("up"));  // nothing from inside the call
  runtime.advance_by(50ms);
  ASSERT_EQ(told.frames.size(), 1U);
  EXPECT_EQ(told.words.back(), "frame 7 of 5");
  EXPECT_EQ(told.frames[0], (std::vector<Byte>{1, 3, 2, 0x40, 0x50}));
  EXPECT_NEAR(static_cast<double>((told.at[0] - asked).count()), (8 + 3.5 + 7) * 520833, 1000);
  ASSERT_EQ(link.sent.size(), 1U);
  EXPECT_EQ(link.sent[0].bytes.size(), 8U);
}

TEST_F(RtuLinkStage, ALateFrameNamesTheNewestRequestAndOneHeardBeforeThatTheOlder) {
  link.line().faults(0).late_by = 100ms;
  link.line().faults(0).next(DriveFault::late);
  read_status(1);
  runtime.advance_by(60ms);
  read_status(2, 2);
  runtime.advance_by(100ms);
  EXPECT_THAT(told.words, testing::ElementsAre("up", "frame 2 of 5", "frame 2 of 7"));
}

TEST_F(RtuLinkStage, GluedFramesAreBothHeardAndNoiseSilencesTheRest) {
  link.line().faults(0).next(DriveFault::glued);
  read_status(1);
  runtime.advance_by(50ms);
  EXPECT_EQ(told.frames.size(), 2U);
  link.line().faults(0).next(DriveFault::noise_before);
  read_status(2);
  runtime.advance_by(50ms);
  EXPECT_EQ(told.frames.size(), 2U);
  EXPECT_GE(told.bad, 8U);
  read_status(3);  // after the silence all is well
  runtime.advance_by(50ms);
  EXPECT_EQ(told.frames.size(), 3U);
}

TEST_F(RtuLinkStage, HalfAFrameIsBadWhenTheLineHasBeenSilent) {
  link.line().faults(0).next(DriveFault::half);
  read_status(1);
  runtime.advance_by(50ms);
  EXPECT_TRUE(told.frames.empty());
  EXPECT_GE(told.bad, 1U);
  EXPECT_LT(told.bad, 7U);
}

TEST_F(RtuLinkStage, EachFateOfARequest) {
  link.on_traffic = [&](bool to_drive, Bytes) {
    if (to_drive) link.fate = RtuLinkSim::Fate::refused;
  };
  read_status(1);
  runtime.advance_by(50ms);
  EXPECT_EQ(told.frames.back(), (std::vector<Byte>{1, 0x81, 3}));
  EXPECT_EQ(link.line().journal().recorded(), 0U);
  link.on_traffic = [&](bool to_drive, Bytes) {
    if (to_drive) link.fate = RtuLinkSim::Fate::cut_before;
  };
  read_status(2);
  runtime.advance_by(50ms);
  EXPECT_EQ(told.words.back(), "down unplugged");
  EXPECT_EQ(link.line().journal().recorded(), 0U);
  link.plug();
  runtime.advance_by(50ms);
  EXPECT_EQ(told.words.back(), "up");
  link.on_traffic = [&](bool to_drive, Bytes) {
    if (to_drive) link.fate = RtuLinkSim::Fate::cut_after;
  };
  read_status(3);
  runtime.advance_by(50ms);
  EXPECT_EQ(told.words.back(), "down unplugged");
  EXPECT_EQ(link.line().journal().recorded(), 1U);
  EXPECT_EQ(told.frames.size(), 1U);
}

TEST_F(RtuLinkStage, ReopeningGoesDownAndUpAndLosesWhatIsUnderWay) {
  read_status(1);
  link.reopen("noise");
  EXPECT_EQ(told.words.size(), 1U);
  runtime.advance_by(50ms);
  EXPECT_THAT(told.words, testing::ElementsAre("up", "down noise", "up"));
}

std::vector<simulated::RtuDriveOptions> one_rtu_drive_of_each() {
  simulated::KincoRtuDrive jd;
  jd.drive.station = 1;
  simulated::KincoRtuDrive md;
  md.drive.station = 2;
  md.drive.type = simulated::KincoType::md;
  simulated::Id286proOptions stepper;
  stepper.unit = 3;
  return {jd, md, stepper};
}

TEST(RtuStage, AllThreeKindsComeOnlineOnOneLineAndMove) {
  GatewayStage stage({rtu_line_of(one_rtu_drive_of_each(), 1)});
  ASSERT_TRUE(stage.come_online());
  for (AxisNumber axis = 1; axis <= 3; ++axis) {
    SCOPED_TRACE(axis);
    ASSERT_EQ(stage.command(axis, Command::enable).outcome.code, Errc::ok);
    ASSERT_EQ(stage.write(axis, Quantity::profile_velocity, 60'000).outcome.code, Errc::ok);
    ASSERT_EQ(stage.write(axis, Quantity::target_position, 5000).outcome.code, Errc::ok);
    ASSERT_EQ(stage.command(axis, Command::move_absolute).outcome.code, Errc::ok);
  }
  EXPECT_TRUE(stage.run_until([&] {
    return stage.drive(0, 0).position() == 5000 && stage.drive(0, 1).position() == 32768 &&
           stage.id286pro(0, 2).position() == 5000;
  }));
}

TEST(RtuStage, ACableThatIsPulledAndPluggedBringsAllAxesBack) {
  GatewayStage stage({rtu_line_of(one_rtu_drive_of_each(), 1), line_of(simulated::KincoType::jd, 9)});
  ASSERT_TRUE(stage.come_online());
  stage.rtu_link(0).unplug();
  EXPECT_TRUE(stage.run_until([&] { return stage.axis(3).link_state == LinkState::link_down; }, 1s));
  EXPECT_EQ(stage.axis(9).link_state, LinkState::online);
  stage.rtu_link(0).plug();
  EXPECT_TRUE(stage.come_online());
}

TEST(RtuStage, ADriveOfAnotherKindIsToldApart) {
  GatewayStage stage({rtu_line_of(one_rtu_drive_of_each(), 1)});
  EXPECT_THROW((void)stage.drive(0, 2), std::invalid_argument);
  EXPECT_THROW((void)stage.id286pro(0, 0), std::invalid_argument);
}

}  // namespace
}  // namespace axisgate::test
