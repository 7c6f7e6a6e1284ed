// SPDX-License-Identifier: Apache-2.0
// Every frame of Keya's own protocols in the sheet against the simulated drive on each of its interfaces.
#include "tests/unit/simulated/sheets.hpp"

namespace axisgate::simulated {
namespace {

constexpr const char* keya_sheet = "keya-kydas4860-2e";

std::int64_t mode_for(const nlohmann::json& decoded) {
  const std::string mode = decoded.value("mode", decoded.value("command", ""));
  if (mode == "torque") return 2;
  return mode == "position" ? 4 : 1;
}

// With both motors in this mode.
LineSpec in_mode(const std::string& drive, std::int64_t mode) {
  const std::string number = std::to_string(mode);
  return spec_of(drive + "+heartbeat=0+0020=" + number + "+0050=" + number);
}

// The drive holds what a reply of the sheet tells; speeds need a motion. Angles stand for counts: 10 poles, 10000
// counts a turn.
void hold(KeyaDrive& drive, const nlohmann::json& decoded) {
  const auto told = [&](const std::string& name) -> std::optional<std::int64_t> {
    if (!decoded.contains(name) || !decoded.at(name).is_number()) return std::nullopt;
    return decoded.at(name).get<std::int64_t>();
  };
  KeyaMeasured& measured = drive.measured();
  measured.voltage = static_cast<std::uint8_t>(told("voltage_V").value_or(0));
  measured.temperature = static_cast<std::int16_t>(told("drive_temp_C").value_or(0));
  measured.version = static_cast<std::uint32_t>(told("version").value_or(0));
  for (const KeyaMotorName name : keya_motors) {
    KeyaMotor& motor = drive.at(name);
    const auto of_motor = [&](const std::string& first, const std::string& last) {
      const auto serial = told(first + (name == motor_a ? "a" : "b") + last);
      return serial ? serial : told(first + (name == motor_a ? "m1" : "m2") + last);
    };
    const auto degrees = told(name == motor_a ? "motor1_temp_C" : "motor2_temp_C");
    measured.motor_temperature[static_cast<std::size_t>(name)] =
        static_cast<std::int16_t>(degrees ? *degrees : of_motor("motor_", "_temp_C").value_or(0));
    if (const auto count = of_motor("encoder_", "")) motor.set_count(static_cast<std::int32_t>(*count));
    if (const auto angle = of_motor("angle_", "")) motor.set_count(static_cast<std::int32_t>(*angle * 2));
    if (const auto current = of_motor("current_", "_A")) motor.show_current(static_cast<std::uint16_t>(*current));
    if (const auto fault = of_motor("fault_", "")) drive.inject_fault(name, static_cast<std::uint16_t>(*fault));
  }
}

// 501 and -498 rpm of 1500, by the world, as if commanded.
void run_up(Bench& bench) {
  for (const KeyaMotorName motor : keya_motors) bench.keya()->enable(motor, KeyaMode::speed, Time{});
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(bench.keya()->set_value(motor_a, 3340, KeyaMode::speed, bench.now));
    EXPECT_TRUE(bench.keya()->set_value(motor_b, -3320, KeyaMode::speed, bench.now));
    bench.pass(milliseconds(500));
  }
  ASSERT_EQ(bench.tell({"speed"}), "501 -498");
}

TEST(keya_can_sheet, every_request_is_answered_and_acted_on) {
  const int requests = each_vector(keya_sheet, "keya-can", "request", [&](const nlohmann::json& vector) {
    const auto& decoded = vector.at("decoded");
    Bench bench(in_mode("keya-can", mode_for(decoded)));
    KeyaDrive& drive = *bench.keya();
    const Bytes request = bytes_in(vector);
    const KeyaMotorName motor = request[3] == 2 ? motor_b : motor_a;
    const std::string command = decoded.value("command", "");
    if (!command.empty() && command != "enable") drive.enable(motor, std::nullopt, Time{});
    const Bytes reply = bench.keya_can(request);
    ASSERT_EQ(reply.size(), 8U);
    EXPECT_EQ(part(reply, 0, 4), (Bytes{0x60, request[1], request[2], request[3]}));
    if (command.empty()) return;
    EXPECT_EQ(part(reply, 4, 8), Bytes(4, 0));
    EXPECT_EQ(drive.enabled(motor), command != "disable");
    const std::int64_t value = decoded.value("value", 0);
    EXPECT_EQ(drive.at(motor).value(), command == "speed" || command == "torque" ? value : 0);
    EXPECT_EQ(drive.moves(motor), command == "position" && value != 0 ? 1U : 0U);
  });
  EXPECT_EQ(requests, 41);
}

TEST(keya_can_sheet, every_reply_is_reproduced_and_the_heartbeat_comes_each_second) {
  const int replies = each_vector(keya_sheet, "keya-can", "response", [&](const nlohmann::json& vector) {
    nlohmann::json decoded = vector.at("decoded");
    Bytes expected = bytes_in(vector);
    const bool commands = expected[2] == 0x20;
    Bench bench(in_mode("keya-can", commands && expected[1] == 1 ? 2 : commands && expected[1] == 2 ? 3 : 1));
    if (vector.at("id") == "can-heartbeat-derived") {
      decoded.erase("fault_m1");  // bit 0 alone: disabled
      hold(*bench.keya(), decoded);
      expected[6] = 0x21;  // the sheet's example is of an analog drive; this one is commanded by CAN
      bench.pass(milliseconds(999));
      EXPECT_TRUE(bench.frames().empty());
      bench.pass(milliseconds(2001));
      EXPECT_EQ(bench.frames().size(), 3U);
      EXPECT_EQ(bench.heard(keya_can::heartbeat + 1), expected);
      return;
    }
    hold(*bench.keya(), decoded);
    if (decoded.contains("speed_m1_rpm")) run_up(bench);
    Bytes request{commands ? std::uint8_t{0x23} : std::uint8_t{0x40}, expected[1], expected[2], expected[3]};
    request.resize(8);
    EXPECT_EQ(bench.keya_can(request), expected);
  });
  EXPECT_EQ(replies, 18);
}

struct Serial {
  const char* line;
  int controls;
  int replies;
};

class KeyaSerialSheet : public testing::TestWithParam<Serial> {
 protected:
  bool addressed() const { return std::string(GetParam().line) == "keya-rs485"; }
};

TEST_P(KeyaSerialSheet, every_control_frame_is_obeyed_and_every_query_answered_whose_reply_is_documented) {
  int controls = 0;
  const int requests = each_vector(keya_sheet, GetParam().line, "request", [&](const nlohmann::json& vector) {
    const auto& decoded = vector.at("decoded");
    const Bytes request = bytes_in(vector);
    const bool is_control = decoded.contains("enable_code");
    const std::int64_t mode = is_control ? mode_for(decoded) : 1;
    Bench bench(in_mode(GetParam().line, mode));
    const Bytes reply = bench.exchange(request);
    if (!is_control) {
      const std::uint8_t code = request[addressed() ? 2 : 1];
      const bool documented = code != 0x01 && code != 0x04;
      ASSERT_EQ(reply.size(), documented ? keya_frame_length : 0U);
      EXPECT_TRUE(!documented || std::equal(request.begin(), request.begin() + (addressed() ? 3 : 2), reply.begin()));
      return;
    }
    ++controls;
    EXPECT_TRUE(reply.empty());
    const int code = decoded.at("enable_code");
    for (const KeyaMotorName motor : keya_motors) {
      const bool first = motor == motor_a;
      EXPECT_EQ(bench.keya()->enabled(motor), (code & (first ? 1 : 2)) != 0);
      if (!bench.keya()->enabled(motor)) continue;
      const std::int64_t value = decoded.at(first ? "motor_a" : "motor_b");
      EXPECT_EQ(bench.keya()->moves(motor), mode == 4 && value != 0 ? 1U : 0U);
      EXPECT_TRUE(mode == 4 || bench.keya()->at(motor).value() == value);
    }
  });
  EXPECT_EQ(controls, GetParam().controls);
  EXPECT_EQ(requests - controls, 10);
}

TEST_P(KeyaSerialSheet, every_reply_is_reproduced) {
  const int replies = each_vector(keya_sheet, GetParam().line, "response", [&](const nlohmann::json& vector) {
    const auto& decoded = vector.at("decoded");
    const Bytes expected = bytes_in(vector);
    if (vector.at("id") == "rs232-heartbeat-derived") {
      Bench bench("keya-rs232+heartbeat=100");
      hold(*bench.keya(), decoded);
      bench.pass(milliseconds(100));
      EXPECT_EQ(bench.received(), expected);
      return;
    }
    // The control state of the sheet is that of an analog drive, which answers queries all the same.
    LineSpec spec = in_mode(GetParam().line, 1);
    if (decoded.contains("control_mode")) spec.keya_drives[0].parameters[19] = decoded.at("control_mode");
    Bench bench(spec);
    hold(*bench.keya(), decoded);
    if (decoded.contains("speed_a_rpm")) run_up(bench);
    KeyaFrame request{};
    std::copy_n(expected.begin(), addressed() ? 3 : 2, request.begin());
    if (addressed()) request = seal_keya(request);
    EXPECT_EQ(bench.exchange(request), expected);
  });
  EXPECT_EQ(replies, GetParam().replies);
}

INSTANTIATE_TEST_SUITE_P(wirings, KeyaSerialSheet,
                         testing::Values(Serial{"keya-rs232", 23, 9}, Serial{"keya-rs485", 27, 8}),
                         [](const auto& it) { return std::string(it.param.line).substr(5); });

}  // namespace
}  // namespace axisgate::simulated
