// The simulated Keya on CAN: what its own protocol leaves unanswered, and its CANopen mode.
#include <gmock/gmock.h>

#include "tests/unit/simulated/keya_bench.hpp"

namespace axisgate::simulated {
namespace {

using testing::IsEmpty;

constexpr std::uint32_t enable_a = 0x030D2001, disable_a = 0x030C2001, enable_b = 0x030D2002;

TEST(KeyaCanProtocol, WhatIsWrongMeetsSilence) {
  KeyaCanBench bench(a_keya());
  for (const char* wrong :
       {"23 00 20 03 00 00 00 00", "23 00 20 00 00 00 00 00", "23 00 20 01 00 00 27 11", "23 01 20 01 FF FF D8 EF",
        "23 00 21 01 00 00 00 00", "40 00 20 01 00 00 00 00", "40 00 21 02 00 00 00 00", "40 0D 21 01 00 00 00 00",
        "40 04 21 01 00 00 00 00", "41 00 21 01 00 00 00 00", "23 0E 20 01 00 00 00 00", "40 00 21 01 00 00 00"}) {
    EXPECT_EQ(bench.ask(wrong), std::nullopt) << wrong;
  }
  EXPECT_EQ(bench.ask(from_hex("40 00 21 01 00 00 00 00"), keya_can::command + 2), std::nullopt);
  EXPECT_THAT(bench.exchange(bus_frame(0x001, from_hex("40 00 21 01 00 00 00 00"))), IsEmpty());
  EXPECT_EQ(bench.drive().controls(), 0U);
  EXPECT_TRUE(bench.ask("40 00 21 01 00 00 00 00"));
}

TEST(KeyaCanProtocol, AnAcknowledgeRepeatsTheSubIndexUnlessATestSaysNo) {
  KeyaOptions options = a_keya();
  options.echoes_sub = false;
  KeyaCanBench bench(options);
  EXPECT_EQ(bench.ask("23 0D 20 02 00 00 00 00"), from_hex("60 0D 20 00 00 00 00 00"));
  EXPECT_EQ(bench.ask("40 04 21 03 00 00 00 00"), from_hex("60 04 21 03 00 00 00 00"));
}

TEST(KeyaCanProtocol, WithAnotherInterfaceSelectedItIsNotThere) {
  KeyaCanBench bench(a_keya({{19, 5}}));
  EXPECT_EQ(bench.ask("40 00 21 01 00 00 00 00"), std::nullopt);
  bench.pass(milliseconds(5000));
  EXPECT_THAT(bench.received, IsEmpty());
}

TEST(KeyaCanProtocol, SharesABusWithACanopenDriveAndArbitratesByAll29Bits) {
  CanLineOptions timed;
  timed.bit_rate = 250000;
  timed.reply_delay = Time{};
  CanBench bench({CanDriveOptions{KeyaCanDrive{a_keya()}}, CanDriveOptions{a_leadshine(2)}}, timed);
  EXPECT_EQ(bench.line().keya(1), nullptr);
  EXPECT_THROW((void)bench.line().node(0), std::invalid_argument);
  BusFrame query = bus_frame(keya_can::command + 1, from_hex("40 00 21 01 00 00 00 00"));
  query.extended = true;
  bench.send(query);
  bench.send(bus_frame(cob::sdo_request + 2, CanBench::request(0x40, 0x6041, 0, 0)));
  bench.pass(milliseconds(10));
  ASSERT_EQ(bench.received.size(), 2U);
  EXPECT_EQ(bench.received[0].frame.id, keya_can::reply + 1);
  EXPECT_EQ(bench.received[1].frame.id, cob::sdo_reply + 2);
  EXPECT_EQ(bench.line().requests_heard(), 2U);
}

class KeyaCanopenMode : public testing::Test {
 protected:
  static KeyaOptions quiet() {
    KeyaOptions options = a_keya();
    options.pdo_on_change = false;
    return options;
  }
  KeyaDrive& keya(CanBench& bench) { return *bench.line().keya(0); }
};

TEST_F(KeyaCanopenMode, AnswersEveryFrameOfTheSheet) {
  int answered = 0;
  const auto rows = keya_vectors("canopen-sdo", "request");
  for (const auto& vector : rows) {
    SCOPED_TRACE(vector.at("id").get<std::string>());
    const Bytes request = bytes_of_vector(vector);
    const auto node =
        static_cast<std::uint8_t>(std::stoul(vector.at("can_id").get<std::string>(), nullptr, 16) - cob::sdo_request);
    CanBench bench(KeyaCanopenDrive{a_keya({}, node)});
    const auto reply = bench.sdo(request, node);
    ASSERT_TRUE(reply.has_value());
    EXPECT_EQ(Bytes(reply->begin() + 1, reply->begin() + 4), Bytes(request.begin() + 1, request.begin() + 4));
    const bool reads = request[0] == 0x40;
    EXPECT_THAT((*reply)[0], reads ? testing::AnyOf(0x43, 0x4B, 0x4F) : testing::AnyOf(0x60, 0x60, 0x60));
    const std::string meaning = vector.at("decoded").value("meaning", "");
    EXPECT_EQ(bench.line().keya(0)->enabled(motor_a), meaning.starts_with("enable motor A"));
    EXPECT_EQ(bench.line().keya(0)->enabled(motor_b), meaning.starts_with("enable motor B"));
    ++answered;
  }
  EXPECT_EQ(answered, 30);
}

TEST_F(KeyaCanopenMode, ReproducesTheRepliesOfTheSheet) {
  int replies = 0;
  const auto rows = keya_vectors("canopen-sdo", "response");
  for (const auto& vector : rows) {
    SCOPED_TRACE(vector.at("id").get<std::string>());
    const Bytes expected = bytes_of_vector(vector);
    const auto node =
        static_cast<std::uint8_t>(std::stoul(vector.at("can_id").get<std::string>(), nullptr, 16) - cob::sdo_reply);
    CanBench bench(KeyaCanopenDrive{a_keya({}, node)});
    Bytes request{0x40, expected[1], expected[2], expected[3], 0, 0, 0, 0};
    const ObjectKey key{static_cast<std::uint16_t>(expected[1] | expected[2] << 8), expected[3]};
    if (expected[0] == 0x80) {
      bench.faults().abort_code = little_endian(CanView(expected).subspan(4));
      bench.faults().next(DriveFault::exception);
    } else if (expected[0] == 0x60) {
      const auto present = bench.node().peek(key, bench.now);
      ASSERT_TRUE(present.has_value());
      request[0] = static_cast<std::uint8_t>(0x23 | (4 - present->size()) << 2);
      std::copy(present->begin(), present->end(), request.begin() + 4);
    } else if (key.index == 0x2011) {
      keya(bench).inject_fault(motor_a, 0x0800);
    } else if (key.index == 0x2012) {  // 150 rpm: 10 % of rated
      ASSERT_EQ(bench.write(0x607A, 0, enable_a, node), 0U);
      ASSERT_EQ(bench.write(0x6081, 0, 1000, node), 0U);
      bench.pass(milliseconds(900));
    } else {
      ASSERT_EQ(bench.node().poke(key, little_endian(CanView(expected).subspan(4)), bench.now), 0U);
    }
    EXPECT_EQ(bench.sdo(request, node), expected);
    ++replies;
  }
  EXPECT_EQ(replies, 18);
}

TEST_F(KeyaCanopenMode, ItsDictionaryHasNoIdentityAndAHeartbeatTimeOfFourBytes) {
  CanBench bench(KeyaCanopenDrive{a_keya()});
  constexpr std::uint16_t none[] = {0x1008, 0x1010, 0x1016, 0x1018, 0x6040, 0x6041, 0x6060, 0x603F};
  for (const std::uint16_t absent : none) {
    EXPECT_EQ(CanBench::code_of(bench.sdo(CanBench::request(0x40, absent, 0, 0))), 0x06020000U) << absent;
  }
  EXPECT_EQ(CanBench::code_of(bench.sdo(CanBench::request(0x40, 0x607A, 1, 0))), 0x06090011U);
  EXPECT_EQ(bench.write_wide(0x1017, 0, 500, 2), 0x06070010U);
  EXPECT_EQ(bench.write_wide(0x1017, 0, 500, 4), 0U);
  bench.received.clear();
  bench.pass(milliseconds(1500));
  EXPECT_EQ(bench.heard(0x701), std::vector<Bytes>(3, Bytes{127}));
  bench.nmt(1);
  bench.pass(milliseconds(500));
  EXPECT_EQ(bench.heard(0x701).back(), Bytes{5});
  EXPECT_EQ(bench.read(0x1009), 1U);
  EXPECT_EQ(CanBench::code_of(bench.sdo(CanBench::request(0x21, 0x6081, 0, 4))), 0x05040001U);  // expedited alone
}

TEST_F(KeyaCanopenMode, ObeysTheCodesOfTheManualAndRefusesOthers) {
  CanBench bench(KeyaCanopenDrive{a_keya()});
  const auto code = [&](std::uint16_t index, std::uint32_t value) { return bench.write(index, 0, value); };
  EXPECT_EQ(code(0x607A, enable_b), 0x06090030U);    // of the other motor
  EXPECT_EQ(code(0x607A, 0x030D2021), 0x06090030U);  // torque has none
  EXPECT_EQ(code(0x607A, enable_a), 0U);
  EXPECT_EQ(keya(bench).at(motor_a).mode(), KeyaMode::speed);
  EXPECT_EQ(code(0x607A, 0x030D2031), 0U);  // while it is enabled
  EXPECT_EQ(keya(bench).at(motor_a).mode(), KeyaMode::absolute);
  EXPECT_EQ(code(0x6083, 0x030D2042), 0U);
  EXPECT_EQ(keya(bench).at(motor_b).mode(), KeyaMode::relative);
  keya(bench).at(motor_a).set_count(777);
  EXPECT_EQ(code(0x607A, 0x030D0000), 0U);
  EXPECT_EQ(keya(bench).at(motor_a).count(), 0);
  EXPECT_TRUE(keya(bench).enabled(motor_a));
  EXPECT_EQ(code(0x607A, disable_a), 0U);
  EXPECT_FALSE(keya(bench).enabled(motor_a));
  keya(bench).inject_fault(motor_b, 0x0040);
  keya(bench).clear_fault_cause(motor_b, 0x0040);
  EXPECT_EQ(bench.read(0x2021), 0x0041U);
  EXPECT_EQ(code(0x6083, 0x030C20F2), 0U);
  EXPECT_EQ(bench.read(0x2021), 0x0001U);
  EXPECT_EQ(bench.write(0x6081, 0, 10001), 0x06090030U);
}

TEST_F(KeyaCanopenMode, TheSpeedLimitOfPositionModeSlowsAMoveDown) {
  CanBench bench(KeyaCanopenDrive{a_keya({{20, 3}, {13, 1}, {30, 1}})});
  EXPECT_EQ(bench.write(0x6099, 1, 1000), 0U);
  EXPECT_EQ(bench.write(0x6099, 2, 10001), 0x06090030U);
  ASSERT_EQ(bench.write(0x607A, 0, enable_a), 0U);
  ASSERT_EQ(bench.write(0x6081, 0, 100000), 0U);
  bench.pass(milliseconds(900));
  EXPECT_EQ(keya(bench).at(motor_a).rpm(), 150);
}

TEST_F(KeyaCanopenMode, AnRpdoCommandsAndACodeOfZeroLeavesTheEnablingAlone) {
  CanBench bench(KeyaCanopenDrive{quiet()});
  bench.send(bus_frame(0x201, from_hex("01 20 0D 03 00 00 00 00")));
  EXPECT_FALSE(keya(bench).enabled(motor_a));  // not started yet
  bench.nmt(1);
  const auto rows = keya_vectors("canopen-pdo", "request");
  EXPECT_EQ(rows.size(), 6U);
  bench.send(bus_frame(0x201, from_hex("01 20 0D 03 00 00 00 00")));
  EXPECT_TRUE(keya(bench).enabled(motor_a));
  bench.send(bus_frame(0x201, from_hex("00 00 00 00 E8 03 00 00")));
  EXPECT_TRUE(keya(bench).enabled(motor_a));
  EXPECT_EQ(keya(bench).at(motor_a).value(), 1000);
  bench.send(bus_frame(0x301, from_hex("02 20 0D 03 00 00 00 00")));
  EXPECT_TRUE(keya(bench).enabled(motor_b));
  bench.send(bus_frame(0x201, from_hex("01 20 0C 03 00 00 00 00")));
  EXPECT_FALSE(keya(bench).enabled(motor_a));
  bench.send(bus_frame(0x201, from_hex("01 20 0D 03 E8 03 00 00")));
  EXPECT_EQ(keya(bench).at(motor_a).value(), 1000);
}

TEST_F(KeyaCanopenMode, EnableAndZeroInOneRpdoIsAMoveToZeroUnlessATestSaysNo) {
  for (const bool moves : {true, false}) {
    KeyaOptions options = quiet();
    options.parameters = {{20, 3}};
    options.enable_with_zero_moves = moves;
    CanBench bench(KeyaCanopenDrive{options});
    bench.nmt(1);
    keya(bench).at(motor_a).set_count(5000);
    bench.send(bus_frame(0x201, from_hex("01 20 0D 03 00 00 00 00")));
    EXPECT_EQ(keya(bench).moves(motor_a), moves ? 1U : 0U);
  }
}

TEST_F(KeyaCanopenMode, AfterAnEnableDataMustComeEachThousandMilliseconds) {
  CanBench bench(KeyaCanopenDrive{quiet()});
  ASSERT_EQ(bench.write(0x607A, 0, enable_a), 0U);
  bench.pass(milliseconds(999));
  ASSERT_EQ(bench.write(0x6084, 0, 0), 0U);  // the other motor's will do
  bench.pass(milliseconds(1000));
  EXPECT_TRUE(bench.read(0x2012));  // a read will not
  EXPECT_EQ(keya(bench).trips(), 0U);
  bench.pass(milliseconds(1));
  EXPECT_EQ(keya(bench).trips(), 1U);
  EXPECT_EQ(bench.read(0x2011), 0x4001U);
  EXPECT_EQ(bench.read(0x203B), 0x40014001U);
}

TEST_F(KeyaCanopenMode, TpdosComeAfterTheirPeriods) {
  CanBench bench(KeyaCanopenDrive{quiet()});
  bench.nmt(1);
  bench.received.clear();
  bench.pass(milliseconds(999));
  EXPECT_THAT(bench.received, IsEmpty());
  bench.pass(milliseconds(1));
  EXPECT_EQ(bench.heard(0x181).size(), 1U);
  bench.pass(milliseconds(11));
  EXPECT_EQ(bench.heard(0x281).size(), 1U);
  bench.pass(milliseconds(11));
  EXPECT_EQ(bench.heard(0x381).size(), 1U);
  EXPECT_EQ(bench.heard(0x381).front(), from_hex("01 00 01 00 30 00 21 00"));
  EXPECT_EQ(bench.write(0x1800, 5, 20), 0U);
  bench.received.clear();
  bench.pass(milliseconds(1000));
  EXPECT_NEAR(static_cast<double>(bench.heard(0x181).size()), 50, 1);
  EXPECT_THAT(bench.heard(0x481), IsEmpty());  // what TPDO4 holds is not described
}

TEST_F(KeyaCanopenMode, TpdosCarryWhatTheSheetMapsAndGoOnChangeNoSoonerThanTheInhibitTime) {
  CanBench bench(KeyaCanopenDrive{a_keya()});
  bench.nmt(1);
  ASSERT_EQ(bench.write(0x607A, 0, enable_a), 0U);
  ASSERT_EQ(bench.write(0x6081, 0, 1000), 0U);
  bench.pass(milliseconds(900));
  keya(bench).at(motor_a).show_current(5);
  keya(bench).at(motor_a).set_count(4772593 - 25 * 10);  // 25 counts a millisecond
  bench.received.clear();
  bench.pass(milliseconds(10));
  EXPECT_THAT(bench.heard(0x181), testing::Contains(from_hex("96 00 05 00 F1 D2 48 00")));
  ASSERT_EQ(bench.write(0x1800, 3, 20), 0U);  // milliseconds, as printed
  ASSERT_EQ(bench.write(0x6081, 0, 1000), 0U);
  bench.received.clear();
  bench.pass(milliseconds(200));
  EXPECT_NEAR(static_cast<double>(bench.heard(0x181).size()), 10, 1);
  EXPECT_LE(bench.heard(0x281).size(), 1U);  // motor B stands: its period alone
}

TEST_F(KeyaCanopenMode, AMappingIsWrittenBeforeTheNodeIsStartedWithoutFurtherSteps) {
  CanBench bench(KeyaCanopenDrive{quiet()});
  EXPECT_EQ(bench.write(0x1A00, 1, 0x20110010), 0U);
  EXPECT_EQ(bench.write(0x1A00, 5, 0), 0x06090011U);
  EXPECT_EQ(bench.read(0x1600, 2), 0x60810020U);
  EXPECT_EQ(bench.read(0x1400, 5), 1000U);
  EXPECT_EQ(bench.read(0x1802, 5), 1022U);
  bench.line().restart(0, bench.now);
  bench.pass(milliseconds(1001));
  EXPECT_EQ(bench.read(0x1A00, 1), 0x20110010U);  // kept over power-off
  bench.nmt(1);
  EXPECT_EQ(bench.write(0x1A00, 1, 0x20120010), 0x08000022U);
}

}  // namespace
}  // namespace axisgate::simulated
