// Every frame of Keya's own protocols in the sheet against the simulated drive, read from tests/vectors.
#include "tests/unit/simulated/scenes.hpp"

namespace axisgate::simulated {
namespace {

constexpr const char* keya_sheet = "keya-kydas4860-2e";

Bytes bytes_in(const nlohmann::json& vector) {
  return from_hex(vector.value("hex_corrected", vector.at("hex").get<std::string>()));
}

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

std::int64_t mode_for(const nlohmann::json& decoded) {
  const std::string command = decoded.value("command", "");
  const std::string mode = decoded.value("mode", command);
  if (mode == "torque") return 2;
  return mode == "position" ? 4 : 1;
}

// The drive of the sheet on one of its interfaces.
class Keya {
 public:
  Keya(const KeyaOptions& options, std::optional<KeyaWiring> wiring) {
    if (wiring) serial_ = std::make_unique<KeyaBench>(*wiring, std::vector{options});
    if (!wiring) can_ = std::make_unique<CanBench>(std::vector<CanDriveOptions>{KeyaCanDrive{options}});
  }
  KeyaDrive& drive() { return serial_ ? serial_->line.drive(0) : *can_->line.keya(0); }
  Bytes ask(const Bytes& request) {
    if (serial_) return serial_->exchange(request);
    BusFrame frame = bus_frame(keya_can::command + 1, request);
    frame.extended = true;
    can_->received.clear();
    can_->send(frame);
    return can_->heard(keya_can::reply + 1);
  }
  void pass(Time time) { serial_ ? serial_->pass(time) : can_->pass(time); }
  // By the world, as if commanded.
  void run_up() {
    drive().enable(motor_a, KeyaMode::speed, Time{});
    drive().enable(motor_b, KeyaMode::speed, Time{});
    for (int i = 0; i < 10; ++i) {
      EXPECT_TRUE(drive().set_value(motor_a, value_a, KeyaMode::speed, now_));
      EXPECT_TRUE(drive().set_value(motor_b, value_b, KeyaMode::speed, now_));
      pass(milliseconds(500));
      now_ += milliseconds(500);
    }
    ASSERT_EQ(drive().at(motor_a).rpm(), 501);
    ASSERT_EQ(drive().at(motor_b).rpm(), -498);
  }

 private:
  std::unique_ptr<KeyaBench> serial_;
  std::unique_ptr<CanBench> can_;
  Time now_{};
};

TEST(keya_can_sheet, every_request_is_answered_and_acted_on) {
  int requests = 0;
  each_vector(keya_sheet, "keya-can", "request", [&](const nlohmann::json& vector) {
    const auto& decoded = vector.at("decoded");
    Keya keya(in_mode(mode_for(decoded)), std::nullopt);
    const Bytes request = bytes_in(vector);
    const KeyaMotorName motor = request[3] == 2 ? motor_b : motor_a;
    const std::string command = decoded.value("command", "");
    if (!command.empty() && command != "enable") keya.drive().enable(motor, std::nullopt, Time{});
    const Bytes reply = keya.ask(request);
    ++requests;
    ASSERT_EQ(reply.size(), 8U);
    EXPECT_EQ(Bytes(reply.begin(), reply.begin() + 4), (Bytes{0x60, request[1], request[2], request[3]}));
    if (command.empty()) return;
    EXPECT_EQ(Bytes(reply.begin() + 4, reply.end()), Bytes(4, 0));
    EXPECT_EQ(keya.drive().enabled(motor), command != "disable");
    const std::int64_t value = decoded.value("value", 0);
    EXPECT_EQ(keya.drive().at(motor).value(), command == "speed" || command == "torque" ? value : 0);
    EXPECT_EQ(keya.drive().moves(motor), command == "position" && value != 0 ? 1U : 0U);
  });
  EXPECT_EQ(requests, 41);
}

TEST(keya_can_sheet, every_reply_is_reproduced) {
  int replies = 0;
  each_vector(keya_sheet, "keya-can", "response", [&](const nlohmann::json& vector) {
    if (vector.at("id") == "can-heartbeat-derived") return;
    const auto& decoded = vector.at("decoded");
    const Bytes expected = bytes_in(vector);
    const bool commands = expected[2] == 0x20;
    Keya keya(in_mode(commands && expected[1] == 1 ? 2 : commands && expected[1] == 2 ? 3 : 1), std::nullopt);
    hold(keya.drive(), decoded);
    if (decoded.contains("speed_m1_rpm")) keya.run_up();
    Bytes request{commands ? std::uint8_t{0x23} : std::uint8_t{0x40}, expected[1], expected[2], expected[3]};
    request.resize(8);
    EXPECT_EQ(keya.ask(request), expected);
    ++replies;
  });
  EXPECT_EQ(replies, 17);
}

TEST(keya_can_sheet, its_heartbeat_comes_each_second) {
  each_vector(keya_sheet, "keya-can", "response", [&](const nlohmann::json& vector) {
    if (vector.at("id") != "can-heartbeat-derived") return;
    CanBench bench({KeyaCanDrive{a_keya()}});
    nlohmann::json held = vector.at("decoded");
    held.erase("fault_m1");  // bit 0 alone: disabled
    hold(*bench.line.keya(0), held);
    Bytes expected = bytes_in(vector);
    expected[6] = 0x21;  // the sheet's example is of an analog drive; this one is commanded by CAN
    bench.pass(milliseconds(999));
    EXPECT_TRUE(bench.received.empty());
    bench.pass(milliseconds(2001));
    EXPECT_EQ(bench.received.size(), 3U);
    EXPECT_EQ(bench.heard(keya_can::heartbeat + 1), expected);
  });
}

struct Serial {
  KeyaWiring wiring;
  const char* protocol;
  int controls;
};

class KeyaSerialSheet : public testing::TestWithParam<Serial> {
 protected:
  std::size_t shift() const { return GetParam().wiring == KeyaWiring::rs485 ? 1 : 0; }
};

TEST_P(KeyaSerialSheet, every_control_frame_is_obeyed_and_every_query_answered_whose_reply_is_documented) {
  int controls = 0;
  int queries = 0;
  each_vector(keya_sheet, GetParam().protocol, "request", [&](const nlohmann::json& vector) {
    const auto& decoded = vector.at("decoded");
    const Bytes request = bytes_in(vector);
    const bool is_control = decoded.contains("enable_code");
    const std::int64_t mode = is_control ? mode_for(decoded) : 1;
    Keya keya(in_mode(mode), GetParam().wiring);
    const Bytes reply = keya.ask(request);
    if (!is_control) {
      ++queries;
      const bool documented = request[1 + shift()] != 0x01 && request[1 + shift()] != 0x04;
      ASSERT_EQ(reply.size(), documented ? keya_frame_length : 0U);
      EXPECT_TRUE(!documented || std::equal(request.begin(), request.begin() + (shift() != 0 ? 3 : 2), reply.begin()));
      return;
    }
    ++controls;
    EXPECT_TRUE(reply.empty());
    const int code = decoded.at("enable_code");
    for (const KeyaMotorName motor : keya_motors) {
      const bool first = motor == motor_a;
      EXPECT_EQ(keya.drive().enabled(motor), (code & (first ? 1 : 2)) != 0);
      if (!keya.drive().enabled(motor)) continue;
      const std::int64_t value = decoded.at(first ? "motor_a" : "motor_b");
      EXPECT_EQ(keya.drive().moves(motor), mode == 4 && value != 0 ? 1U : 0U);
      EXPECT_TRUE(mode == 4 || keya.drive().at(motor).value() == value);
    }
  });
  EXPECT_EQ(controls, GetParam().controls);
  EXPECT_EQ(queries, 10);
}

TEST_P(KeyaSerialSheet, every_reply_is_reproduced) {
  int replies = 0;
  each_vector(keya_sheet, GetParam().protocol, "response", [&](const nlohmann::json& vector) {
    const auto& decoded = vector.at("decoded");
    const Bytes expected = bytes_in(vector);
    ++replies;
    if (vector.at("id") == "rs232-heartbeat-derived") {
      KeyaOptions options = a_keya();
      options.heartbeat = milliseconds(100);
      KeyaBench bench(GetParam().wiring, {options});
      hold(bench.line.drive(0), decoded);
      bench.pass(milliseconds(100));
      EXPECT_EQ(bench.received, expected);
      return;
    }
    // The control state of the sheet is that of an analog drive, which answers queries all the same.
    std::map<int, std::int64_t> parameters;
    if (decoded.contains("control_mode")) parameters[19] = decoded.at("control_mode").get<std::int64_t>();
    Keya keya(a_keya(parameters), GetParam().wiring);
    hold(keya.drive(), decoded);
    if (decoded.contains("speed_a_rpm")) keya.run_up();
    KeyaFrame request{};
    std::copy_n(expected.begin(), 2 + shift(), request.begin());
    if (shift() != 0) request = seal_keya(request);
    EXPECT_EQ(keya.ask({request.begin(), request.end()}), expected);
  });
  EXPECT_EQ(replies, shift() != 0 ? 8 : 9);
}

INSTANTIATE_TEST_SUITE_P(wirings, KeyaSerialSheet,
                         testing::Values(Serial{KeyaWiring::rs232, "keya-rs232", 23},
                                         Serial{KeyaWiring::rs485, "keya-rs485", 27}),
                         [](const auto& it) { return it.param.wiring == KeyaWiring::rs232 ? "rs232" : "rs485"; });

std::uint8_t node_in(const nlohmann::json& vector, std::uint32_t base) {
  return static_cast<std::uint8_t>(hex_number(vector.at("can_id")) - base);
}

TEST(keya_canopen_sheet, every_request_is_answered) {
  int answered = 0;
  each_vector(keya_sheet, "canopen-sdo", "request", [&](const nlohmann::json& vector) {
    const Bytes request = bytes_in(vector);
    const std::uint8_t node = node_in(vector, cob::sdo_request);
    CanBench bench({KeyaCanopenDrive{a_keya({}, node)}});
    const Bytes reply = bench.sdo(request, node);
    ASSERT_EQ(reply.size(), 8U);
    EXPECT_EQ(Bytes(reply.begin() + 1, reply.begin() + 4), Bytes(request.begin() + 1, request.begin() + 4));
    EXPECT_THAT(reply[0], request[0] == 0x40 ? testing::AnyOf(0x43, 0x4B, 0x4F) : testing::AnyOf(0x60, 0x60, 0x60));
    const std::string meaning = vector.at("decoded").value("meaning", "");
    EXPECT_EQ(bench.line.keya(0)->enabled(motor_a), meaning.starts_with("enable motor A"));
    EXPECT_EQ(bench.line.keya(0)->enabled(motor_b), meaning.starts_with("enable motor B"));
    ++answered;
  });
  EXPECT_EQ(answered, 30);
}

TEST(keya_canopen_sheet, every_reply_is_reproduced) {
  int replies = 0;
  each_vector(keya_sheet, "canopen-sdo", "response", [&](const nlohmann::json& vector) {
    const Bytes expected = bytes_in(vector);
    const std::uint8_t node = node_in(vector, cob::sdo_reply);
    CanBench bench({KeyaCanopenDrive{a_keya({}, node)}});
    Bytes request{0x40, expected[1], expected[2], expected[3], 0, 0, 0, 0};
    const ObjectKey key{static_cast<std::uint16_t>(expected[1] | expected[2] << 8), expected[3]};
    const std::uint32_t told = little_endian(CanView(expected).subspan(4));
    if (expected[0] == 0x80) {
      bench.line.faults(0).abort_code = told;
      bench.line.faults(0).next(DriveFault::exception);
    } else if (expected[0] == 0x60) {
      const auto held = bench.line.node(0).peek(key, bench.now);
      ASSERT_TRUE(held.has_value());
      request = sdo_request(sdo_write(held->size()), key, little_endian(*held));
    } else if (key.index == 0x2011) {
      bench.line.keya(0)->inject_fault(motor_a, 0x0800);
    } else if (key.index == 0x2012) {  // 150 rpm: 10 % of rated
      bench.sdo(sdo_request(0x23, {0x607A, 0}, 0x030D2001), node);
      bench.sdo(sdo_request(0x23, {0x6081, 0}, 1000), node);
      bench.pass(milliseconds(900));
    } else {
      ASSERT_EQ(bench.line.node(0).poke(key, told, bench.now), 0U);
    }
    EXPECT_EQ(bench.sdo(request, node), expected);
    ++replies;
  });
  EXPECT_EQ(replies, 18);
}

}  // namespace
}  // namespace axisgate::simulated
