// Keya drives on the stage: the serial link, and a whole core against both motors on each interface.
#include <gmock/gmock.h>

#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test {
namespace {

using simulated::KeyaMotorName;
using simulated::KeyaWiring;

struct BytesTold final : bus::ByteLinkEvents {
  void on_link_up() override { events.emplace_back("up"); }
  void on_link_down(std::string_view why) override { events.emplace_back("down: " + std::string(why)); }
  void on_bytes(Bytes bytes) override { received.insert(received.end(), bytes.begin(), bytes.end()); }
  std::vector<std::string> events;
  std::vector<Byte> received;
};

class KeyaLinkSimTest : public testing::Test {
 protected:
  KeyaLinkSimTest() {
    simulated::KeyaOptions options;
    options.heartbeat = {};
    link.line().add(options);
    link.start(told);
    runtime.advance_by(Duration{});
  }
  static constexpr std::array<Byte, 12> ask_voltage{0xED, 0x05};

  ManualRuntime runtime;
  BytesTold told;
  KeyaLinkSim link{runtime, {KeyaWiring::rs232, 115200}, 1};
};

TEST_F(KeyaLinkSimTest, AnAnswerComesWhenTheLineHasCarriedItAndNotFromInsideSend) {
  ASSERT_THAT(told.events, testing::ElementsAre("up"));
  link.send(ask_voltage);
  EXPECT_THAT(told.received, testing::IsEmpty());
  runtime.advance_by(std::chrono::milliseconds(2));  // twice 12 bytes of 87 us: 2.08 ms
  EXPECT_THAT(told.received, testing::IsEmpty());
  runtime.advance_by(std::chrono::milliseconds(1));
  EXPECT_EQ(told.received.size(), 12U);
}

TEST_F(KeyaLinkSimTest, AnUnpluggedLinkLosesWhatIsUnderWayAndADriveThatHeardItsFrameActs) {
  link.on_traffic = [this](bool to_drive, Bytes) {
    if (to_drive) link.fate = KeyaLinkSim::Fate::cut_after;
  };
  const std::array<Byte, 12> enable_both{0xE0, 0x03};
  link.send(enable_both);
  runtime.advance_by(std::chrono::milliseconds(5));
  EXPECT_TRUE(link.line().drive(0).enabled(KeyaMotorName::a));
  EXPECT_THAT(told.events, testing::ElementsAre("up", "down: unplugged"));
  link.plug();
  runtime.advance_by(std::chrono::milliseconds(5));
  EXPECT_EQ(told.events.back(), "up");
}

enum class Way : std::uint8_t { rs232, rs485, can, canopen };

class KeyaStage : public testing::TestWithParam<Way> {
 protected:
  static GatewayStage::Line line() {
    const simulated::KeyaOptions options;
    switch (GetParam()) {
      case Way::rs232:
        return keya_line_of(KeyaWiring::rs232, {options}, 1);
      case Way::rs485:
        return keya_line_of(KeyaWiring::rs485, {options}, 1);
      case Way::can:
        return can_line_of({simulated::KeyaCanDrive{options}}, 1);
      case Way::canopen:
        break;
    }
    return can_line_of({simulated::KeyaCanopenDrive{options}}, 1);
  }
};

TEST_P(KeyaStage, BothMotorsComeOnlineAndAreEnabledEachByItself) {
  GatewayStage stage({line()});
  ASSERT_TRUE(stage.come_online()) << testing::PrintToString(stage.log());
  EXPECT_EQ(stage.command(1, Command::enable).outcome.code, Errc::ok) << testing::PrintToString(stage.log());
  EXPECT_TRUE(stage.keya(0).enabled(KeyaMotorName::a));
  EXPECT_FALSE(stage.keya(0).enabled(KeyaMotorName::b));
  EXPECT_EQ(stage.command(2, Command::enable).outcome.code, Errc::ok) << testing::PrintToString(stage.log());
  EXPECT_TRUE(stage.keya(0).enabled(KeyaMotorName::a));
  EXPECT_TRUE(stage.keya(0).enabled(KeyaMotorName::b));
  EXPECT_EQ(stage.command(1, Command::disable).outcome.code, Errc::ok);
  EXPECT_FALSE(stage.keya(0).enabled(KeyaMotorName::a));
  EXPECT_TRUE(stage.keya(0).enabled(KeyaMotorName::b));
}

// Faults of two enabled motors are all zeros, and so the query's own echo for what can be told of one answer.
TEST_P(KeyaStage, FoundWithBothMotorsEnabledItComesOnlineAdopted) {
  GatewayStage stage({line()});
  for (const KeyaMotorName motor : {KeyaMotorName::a, KeyaMotorName::b})
    stage.keya(0).enable(motor, std::nullopt, simulated::Time{});
  ASSERT_TRUE(stage.come_online()) << testing::PrintToString(stage.log());
  for (const AxisNumber axis : {AxisNumber{1}, AxisNumber{2}})
    EXPECT_NE(stage.axis(axis).alarms & bit(AxisAlarm::adopted_running), 0U) << testing::PrintToString(stage.log());
}

std::string name_of_way(const testing::TestParamInfo<Way>& way) {
  const char* const names[] = {"Rs232", "Rs485", "Can", "Canopen"};
  return names[static_cast<std::size_t>(way.param)];
}

INSTANTIATE_TEST_SUITE_P(Ways, KeyaStage, testing::Values(Way::rs232, Way::rs485, Way::can, Way::canopen), name_of_way);

}  // namespace
}  // namespace axisgate::test
