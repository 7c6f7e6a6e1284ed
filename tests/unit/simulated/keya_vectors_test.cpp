// Every frame of Keya's own protocols in the sheet against the simulated drive, read from tests/vectors.
#include <gmock/gmock.h>

#include "tests/unit/simulated/keya_bench.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::uint16_t enable_index = 0x200D;

std::optional<std::int64_t> told(const nlohmann::json& decoded, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (decoded.contains(name) && decoded.at(name).is_number()) return decoded.at(name).get<std::int64_t>();
  }
  return std::nullopt;
}

// Angles stand for counts: 10 poles, 10000 counts a turn.
void hold_motor(KeyaMotor& motor, std::optional<std::int64_t> count, std::optional<std::int64_t> angle,
                std::optional<std::int64_t> current) {
  if (count) motor.set_count(static_cast<std::int32_t>(*count));
  if (angle) motor.set_count(static_cast<std::int32_t>(*angle * 2));
  if (current) motor.show_current(static_cast<std::uint16_t>(*current));
}

// The drive holds what a reply of the sheet tells; speeds need a motion.
void hold(KeyaDrive& drive, const nlohmann::json& told_by) {
  KeyaMeasured& measured = drive.measured();
  measured.voltage = static_cast<std::uint8_t>(told(told_by, {"voltage_V"}).value_or(0));
  measured.temperature = static_cast<std::int16_t>(told(told_by, {"drive_temp_C"}).value_or(0));
  measured.motor_temperature = {
      static_cast<std::int16_t>(told(told_by, {"motor_a_temp_C", "motor1_temp_C"}).value_or(0)),
      static_cast<std::int16_t>(told(told_by, {"motor_b_temp_C", "motor2_temp_C"}).value_or(0))};
  measured.version = static_cast<std::uint32_t>(told(told_by, {"version"}).value_or(0));
  hold_motor(drive.at(motor_a), told(told_by, {"encoder_a", "encoder_m1"}), told(told_by, {"angle_a", "angle_m1"}),
             told(told_by, {"current_a_A", "current_m1_A"}));
  hold_motor(drive.at(motor_b), told(told_by, {"encoder_b", "encoder_m2"}), told(told_by, {"angle_b", "angle_m2"}),
             told(told_by, {"current_b_A", "current_m2_A"}));
  const auto fault_a = told(told_by, {"fault_a", "fault_m1"});
  const auto fault_b = told(told_by, {"fault_b", "fault_m2"});
  if (fault_a) drive.inject_fault(motor_a, static_cast<std::uint16_t>(*fault_a));
  if (fault_b) drive.inject_fault(motor_b, static_cast<std::uint16_t>(*fault_b));
}

// 501 and -498 rpm of 1500.
constexpr std::int32_t value_a = 3340, value_b = -3320;

template <class Repeat>
void run_up(KeyaDrive& drive, Repeat repeat) {
  for (int i = 0; i < 10; ++i) repeat();
  ASSERT_EQ(drive.at(motor_a).rpm(), 501);
  ASSERT_EQ(drive.at(motor_b).rpm(), -498);
}

std::int64_t mode_for(const nlohmann::json& decoded) {
  const std::string command = decoded.value("command", "");
  const std::string mode = decoded.value("mode", command);
  if (mode == "torque") return 2;
  return mode == "position" ? 4 : 1;
}

TEST(KeyaCanVectors, EveryRequestOfTheSheetIsAnsweredAndActedOn) {
  int requests = 0;
  const auto rows = keya_vectors("keya-can", "request");
  for (const auto& vector : rows) {
    SCOPED_TRACE(vector.at("id").get<std::string>());
    const auto& decoded = vector.at("decoded");
    KeyaCanBench bench(a_keya({{20, mode_for(decoded)}, {50, mode_for(decoded)}}));
    const Bytes request = bytes_of_vector(vector);
    const std::uint8_t sub = request[3];
    const KeyaMotorName motor = sub == 2 ? motor_b : motor_a;
    const std::string command = decoded.value("command", "");
    if (!command.empty() && command != "enable") {
      ASSERT_TRUE(bench.write(enable_index, sub));
    }
    const auto reply = bench.ask(request);
    ++requests;
    ASSERT_TRUE(reply.has_value());
    EXPECT_EQ(Bytes(reply->begin(), reply->begin() + 4), (Bytes{0x60, request[1], request[2], request[3]}));
    if (command.empty()) continue;
    EXPECT_EQ(Bytes(reply->begin() + 4, reply->end()), Bytes(4, 0));
    EXPECT_EQ(bench.drive().enabled(motor), command != "disable");
    const std::int64_t value = decoded.value("value", 0);
    const bool turns = command == "speed" || command == "torque";
    EXPECT_EQ(bench.drive().at(motor).value(), turns ? value : 0);
    EXPECT_EQ(bench.drive().moves(motor), command == "position" && value != 0 ? 1U : 0U);
  }
  EXPECT_EQ(requests, 41);
}

TEST(KeyaCanVectors, EveryReplyOfTheSheetIsReproduced) {
  int replies = 0;
  const auto rows = keya_vectors("keya-can", "response");
  for (const auto& vector : rows) {
    const std::string id = vector.at("id");
    if (id == "can-heartbeat-derived") continue;
    SCOPED_TRACE(id);
    const auto& decoded = vector.at("decoded");
    const Bytes expected = bytes_of_vector(vector);
    const bool torque = expected[1] == 0x01 && expected[2] == 0x20;
    const bool position = expected[1] == 0x02 && expected[2] == 0x20;
    KeyaCanBench bench(a_keya({{20, torque ? 2 : position ? 3 : 1}, {50, torque ? 2 : position ? 3 : 1}}));
    hold(bench.drive(), decoded);
    if (decoded.contains("speed_m1_rpm")) {
      (void)bench.write(enable_index, 1);
      (void)bench.write(enable_index, 2);
      run_up(bench.drive(), [&] {
        EXPECT_TRUE(bench.write(0x2000, 1, value_a));
        EXPECT_TRUE(bench.write(0x2000, 2, value_b));
        bench.pass(milliseconds(500));
      });
    }
    Bytes request{expected[2] == 0x20 ? std::uint8_t{0x23} : std::uint8_t{0x40}, expected[1], expected[2], expected[3]};
    request.resize(8);
    EXPECT_EQ(bench.ask(request), expected);
    ++replies;
  }
  EXPECT_EQ(replies, 17);
}

TEST(KeyaCanVectors, TheHeartbeatOfTheSheetComesEachSecond) {
  KeyaCanBench bench(a_keya());
  Bytes expected;
  const auto rows = keya_vectors("keya-can", "response");
  for (const auto& vector : rows) {
    if (vector.at("id") != "can-heartbeat-derived") continue;
    expected = bytes_of_vector(vector);
    nlohmann::json held = vector.at("decoded");
    held.erase("fault_m1");  // bit 0 alone: disabled
    hold(bench.drive(), held);
  }
  expected[6] = 0x21;  // the sheet's example is of an analog drive; this one is commanded by CAN
  bench.pass(milliseconds(999));
  EXPECT_TRUE(bench.heard(keya_can::heartbeat + 1).empty());
  bench.pass(milliseconds(2001));
  EXPECT_THAT(bench.heard(keya_can::heartbeat + 1), testing::ElementsAre(expected, expected, expected));
}

struct Serial {
  KeyaWiring wiring;
  const char* protocol;
  int controls;
  int queries;
  int replies;
};

class KeyaSerialVectors : public testing::TestWithParam<Serial> {
 protected:
  std::size_t shift() const { return GetParam().wiring == KeyaWiring::rs485 ? 1 : 0; }
};

TEST_P(KeyaSerialVectors, EveryControlFrameOfTheSheetIsObeyedWithoutAReply) {
  int controls = 0;
  const auto rows = keya_vectors(GetParam().protocol, "request");
  for (const auto& vector : rows) {
    const auto& decoded = vector.at("decoded");
    if (!decoded.contains("enable_code")) continue;
    SCOPED_TRACE(vector.at("id").get<std::string>());
    const std::int64_t mode = mode_for(decoded);
    KeyaBench bench(GetParam().wiring, {a_keya({{20, mode}, {50, mode}})});
    EXPECT_TRUE(bench.exchange(bytes_of_vector(vector)).empty());
    ++controls;
    const int code = decoded.at("enable_code");
    EXPECT_EQ(bench.drive().enabled(motor_a), (code & 1) != 0);
    EXPECT_EQ(bench.drive().enabled(motor_b), (code & 2) != 0);
    for (const KeyaMotorName motor : keya_motors) {
      const std::int64_t value = decoded.at(motor == motor_a ? "motor_a" : "motor_b");
      if (!bench.drive().enabled(motor)) continue;
      if (mode == 4) {
        EXPECT_EQ(bench.drive().moves(motor), value != 0 ? 1U : 0U);
      } else {
        EXPECT_EQ(bench.drive().at(motor).value(), value);
      }
    }
  }
  EXPECT_EQ(controls, GetParam().controls);
}

TEST_P(KeyaSerialVectors, EveryQueryOfTheSheetIsAnsweredWithItsCodeUnlessItsReplyIsNotDocumented) {
  int queries = 0;
  const auto rows = keya_vectors(GetParam().protocol, "request");
  for (const auto& vector : rows) {
    const auto& decoded = vector.at("decoded");
    if (decoded.contains("enable_code")) continue;
    SCOPED_TRACE(vector.at("id").get<std::string>());
    KeyaBench bench(GetParam().wiring, {a_keya()});
    const Bytes request = bytes_of_vector(vector);
    const Bytes reply = bench.exchange(request);
    ++queries;
    if (request[1 + shift()] == 0x01 || request[1 + shift()] == 0x04) {
      EXPECT_TRUE(reply.empty());
      continue;
    }
    ASSERT_EQ(reply.size(), keya_frame_length);
    const auto head = static_cast<std::ptrdiff_t>(2 + shift());
    EXPECT_EQ(Bytes(reply.begin(), reply.begin() + head), Bytes(request.begin(), request.begin() + head));
  }
  EXPECT_EQ(queries, GetParam().queries);
}

TEST_P(KeyaSerialVectors, EveryReplyOfTheSheetIsReproduced) {
  int replies = 0;
  const auto rows = keya_vectors(GetParam().protocol, "response");
  for (const auto& vector : rows) {
    const std::string id = vector.at("id");
    if (id == "rs232-heartbeat-derived") continue;
    SCOPED_TRACE(id);
    const auto& decoded = vector.at("decoded");
    const Bytes expected = bytes_of_vector(vector);
    // The control state of the sheet is that of an analog drive, which answers queries all the same.
    std::map<int, std::int64_t> parameters;
    if (decoded.contains("control_mode")) parameters[19] = decoded.at("control_mode").get<std::int64_t>();
    KeyaBench bench(GetParam().wiring, {a_keya(parameters)});
    hold(bench.drive(), decoded);
    if (decoded.contains("speed_a_rpm")) {
      run_up(bench.drive(), [&] {
        if (shift() != 0) bench.control_at(1, 3, value_a, value_b);
        if (shift() == 0) bench.control(3, value_a, value_b);
        bench.pass(milliseconds(500));
      });
    }
    Bytes request(expected.begin(), expected.begin() + static_cast<std::ptrdiff_t>(2 + shift()));
    request.resize(keya_frame_length);
    KeyaFrame frame{};
    std::copy(request.begin(), request.end(), frame.begin());
    if (shift() != 0) frame = seal_keya(frame);
    EXPECT_EQ(bench.exchange(Bytes(frame.begin(), frame.end())), expected);
    ++replies;
  }
  EXPECT_EQ(replies, GetParam().replies);
}

INSTANTIATE_TEST_SUITE_P(Wirings, KeyaSerialVectors,
                         testing::Values(Serial{KeyaWiring::rs232, "keya-rs232", 23, 10, 8},
                                         Serial{KeyaWiring::rs485, "keya-rs485", 27, 10, 8}),
                         [](const auto& it) { return it.param.wiring == KeyaWiring::rs232 ? "Rs232" : "Rs485"; });

TEST(KeyaSerialVectors, TheHeartbeatOfTheSheetComesOnRs232) {
  KeyaOptions options = a_keya();
  options.heartbeat = milliseconds(100);
  KeyaBench bench(KeyaWiring::rs232, {options});
  Bytes expected;
  const auto rows = keya_vectors("keya-rs232", "response");
  for (const auto& vector : rows) {
    if (vector.at("id") != "rs232-heartbeat-derived") continue;
    expected = bytes_of_vector(vector);
    hold(bench.drive(), vector.at("decoded"));
  }
  bench.pass(milliseconds(100));
  EXPECT_EQ(bench.received(), expected);
}

}  // namespace
}  // namespace axisgate::simulated
