// Mistakes in a copy of the shipped Keya profile: each is told with its place and what to change.
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>

#include "tests/profiles/keya.hpp"

namespace axisgate::drive {
namespace {

using nlohmann::json;
using Pointer = json::json_pointer;

/// The shipped profile with one thing changed.
class KeyaMistakes : public ::testing::Test {
 protected:
  KeyaMistakes() : folder_(std::filesystem::temp_directory_path() / ("keya-mistakes-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
    std::ifstream file(shipped("keya-kydas4860-2e"));
    shipped_ = json::parse(file);
  }
  ~KeyaMistakes() override { std::filesystem::remove_all(folder_); }

  /// What is told when `value` stands there; null: nothing stands there.
  std::string told(const std::string& at, const json& value) {
    json document = shipped_;
    const Pointer place(at);
    if (value.is_null())
      document[place.parent_pointer()].erase(place.back());
    else
      document[place] = value;
    return told(document);
  }
  std::string told(const json& document) {
    const std::filesystem::path path = folder_ / "keya-kydas4860-2e.json";
    std::ofstream(path) << document.dump();
    std::string out;
    for (const Fault& fault : load_profile(path.string()).faults) out += fault.pointer + ": " + fault.message + "\n";
    return out;
  }

  std::filesystem::path folder_;
  json shipped_;
};

TEST_F(KeyaMistakes, TheShippedFileHasNone) { EXPECT_EQ(told(shipped_), ""); }

TEST_F(KeyaMistakes, ACommandAndAQueryOfCanAreHeldApart) {
  const std::string current = "/objects/A.current/at/keya-can";
  EXPECT_EQ(told(current, {{"address", "2100.01"}, {"byte", 3}}),
            current + ": does not lie within bytes 4 to 7, which hold the data\n");
  EXPECT_EQ(told(current, {{"address", "2100.01"}, {"byte", 7}}),
            current + ": does not lie within bytes 4 to 7, which hold the data\n");
  EXPECT_EQ(told(current, "2200.01"), current + ": keya-can has commands, 20xx, and queries, 21xx\n");
  EXPECT_EQ(told(current, {{"address", "2100.01"}, {"byte", 4}, {"bit", 1}}),
            current + ": \"bit\" belongs to the enable bits of a control frame: look at bits by a \"mask\"\n");
  const std::string enable = "/objects/B.enable_command/at/keya-can";
  EXPECT_EQ(told(enable, "210D.02"), enable + ": is a query: \"access\" can only be ro\n");
  EXPECT_EQ(told(enable, {{"address", "200D.02"}, {"byte", 5}}),
            enable + ": a command carries one number of 4 bytes: no \"byte\" or \"bit\", and type i32 or u32\n");
  EXPECT_EQ(told(enable, "200D.03"),
            enable + ": is motor 3's place, and object \"B.enable_command\" belongs to another\n");
  EXPECT_EQ(told("/objects/A.current/at/keya-can/address", "2103.01"),
            "/objects/A.speed/at/keya-can: object \"A.current\" has this address already; if that is meant, say "
            "\"alias_of\"\n");
}

TEST_F(KeyaMistakes, AHeartbeatIsSentByTheDriveOfKeyaCanAlone) {
  const std::string mode = "/objects/A.work_mode/at/keya-can";
  EXPECT_EQ(told(mode, {{"request", "heartbeat"}, {"byte", 5}}),
            mode + ": a heartbeat holds two bytes each from bytes 0, 2 and 4 on, and one at 6 and at 7\n");
  EXPECT_EQ(told(mode, {{"request", "heartbeat"}}),
            mode + ": give the \"byte\" of the frame with which the value begins\n");
  const std::string serial = "/objects/A.work_mode/at/keya-rs232";
  EXPECT_EQ(told(serial, {{"request", "heartbeat"}, {"byte", 3}}),
            serial + ": what the drive sends by itself is looked at on keya-can alone: ask for it by a query\n");
  EXPECT_EQ(told("/protocols/keya-can/unsolicited/heartbeat/length", 12),
            "/protocols/keya-can/unsolicited/heartbeat/length: every frame of keya-can has 8\n");
  EXPECT_EQ(told("/protocols/keya-rs232/unsolicited/heartbeat/match", "ED"),
            "/protocols/keya-rs232/unsolicited/heartbeat: the drive's own frame begins with \"EE\"\n");
  EXPECT_EQ(told("/protocols/keya-rs485/unsolicited", {{"heartbeat", json::object()}}),
            "/protocols/keya-rs485/unsolicited/heartbeat: keya-rs485 has no frames that the drive sends by itself\n");
}

TEST_F(KeyaMistakes, ARequestIsWhatTheAdapterSends) {
  const std::string requests = "/protocols/keya-rs232/requests";
  EXPECT_EQ(
      told(requests + "/current/send", "ED ID 03"),
      requests + "/current/send: keya-rs232 has control frames, \"E0\", and queries with their code, \"ED 02\"\n");
  EXPECT_EQ(told(requests + "/current/match", "ED 04"),
            requests + "/current/match: the answer to a query begins as the query does, \"ED 03\"\n");
  EXPECT_EQ(told(requests + "/current/length", 13), requests + "/current/length: every frame of keya-rs232 has 12\n");
  EXPECT_EQ(told(requests + "/current/ack", "none"),
            requests +
                "/current: a request without an answer needs \"confirm\": what else would decide its outcome?\n" +
                requests + "/current: a query is answered: leave out \"ack\"\n");
  EXPECT_EQ(told(requests + "/control/ack", "reply"),
            requests + "/control: no answer to a control frame is documented: say \"ack\": \"none\"\n");
  EXPECT_EQ(told(requests + "/control/confirm", "fault"),
            requests + "/control/confirm: unknown request \"fault\"; did you mean \"faults\"?\n");
  EXPECT_EQ(told(requests + "/control/match", "E0"),
            requests + "/control/match: no answer to a control frame is documented\n");
  EXPECT_EQ(told(requests + "/again", {{"send", "ED 03"}}), requests + "/current: is the same frame as \"again\"\n");
  EXPECT_EQ(told("/protocols/keya-can/requests", {{"current", {{"send", "2103.01"}}}}),
            "/protocols/keya-can/requests/current: keya-can has no named requests: give objects index and sub-index, "
            "\"2103.01\"\n");
}

TEST_F(KeyaMistakes, AFieldOfAFrameLiesWhereTheAdapterPutsIt) {
  const std::string current = "/objects/A.current/at/keya-rs485";
  EXPECT_EQ(told(current, {{"request", "current"}, {"byte", 2}}),
            current + ": does not lie within bytes 3 to 10, which hold the data\n");
  EXPECT_EQ(told(current, {{"request", "current"}, {"byte", 10}}),
            current + ": does not lie within bytes 3 to 10, which hold the data\n");
  const std::string on = "/objects/B.on/at/keya-rs232";
  const std::string lacks = ": no object is the enable bit of motor 2 in the control frame\n";
  EXPECT_EQ(told(on, {{"request", "control"}, {"byte", 2}, {"bit", 1}}),
            on + ": the enable bits are bits 0 and 1 of byte 1, of type u8\n/protocols/keya-rs232/requests" + lacks);
  EXPECT_EQ(
      told(on, {{"request", "control"}, {"byte", 1}, {"bit", 0}}),
      on + ": is motor 1's place, and object \"B.on\" belongs to another\n/protocols/keya-rs232/requests" + lacks);
  const std::string value = "/objects/A.target_velocity/at/keya-rs485";
  EXPECT_EQ(told(value, {{"request", "control"}, {"byte", 4}}),
            value + ": the motors' values begin at bytes 3 and 7 of a control frame, of type i32\n");
  EXPECT_EQ(told(value, {{"request", "speed"}, {"byte", 3}}), value + ": is a query: \"access\" can only be ro\n");
  EXPECT_THAT(told("/objects/A.on/access", "ro"),
              testing::HasSubstr("/objects/A.on/at/keya-rs232: is a command: \"access\" must be wo or rw\n"));
}

TEST_F(KeyaMistakes, AFenceIsMadeOfQueriesThatDiffer) {
  EXPECT_EQ(told("/protocols/keya-rs232/fence", {"voltage", "control"}),
            "/protocols/keya-rs232/fence/1: \"control\" is no query, so nothing answers it\n");
  EXPECT_EQ(told("/protocols/keya-rs232/fence", {"voltage", "voltage"}),
            "/protocols/keya-rs232/fence/1: the same request stands in this fence already\n");
  EXPECT_EQ(told("/protocols/keya-can/fence", {"A.fault", "B.fault"}),
            "/protocols/keya-can/fence/1: the same address stands in this fence already\n");
  EXPECT_EQ(told("/protocols/keya-can/fence", {"voltage", "interface"}),
            "/protocols/keya-can/fence/1: object \"interface\" comes unasked, so it is no fence\n");
}

TEST_F(KeyaMistakes, ConfiguredModesAreModes) {
  EXPECT_EQ(told("/constants/control_mode_a/range", {1, 4}),
            "/constants/control_mode_a: may be 4, and the drive calls no mode under /modes so\n");
  EXPECT_EQ(told("/constants/control_mode_b/default", nullptr),
            "/constants/control_mode_b: decides the mode: the configuration gives it, so it needs \"default\" or "
            "\"required\"\n");
  EXPECT_EQ(told("/configured_mode/constant/B", "control_mode_c"),
            "/configured_mode/constant: unknown constant \"control_mode_c\": not under /constants; did you mean "
            "\"control_mode_a\"?\n");
  EXPECT_EQ(told("/configured_mode/constant/B", nullptr),
            "/configured_mode/constant: a constant for axis \"B\" is missing\n");
  EXPECT_EQ(told("/configured_mode/fixed_on/0", "keya-cam"),
            "/configured_mode/fixed_on: protocol \"keya-cam\" is not under /protocols; did you mean \"keya-can\"?\n");
  EXPECT_EQ(told("/configured_mode/only", {5}), "/configured_mode/only: mode 5 is not under /modes\n");
  EXPECT_EQ(told("/checks/0/not_equals/constant", "control_mode"),
            "/checks/0/not_equals: unknown constant \"control_mode\": not under /constants; did you mean "
            "\"control_mode_a\"?\n");
  EXPECT_EQ(told("/checks/0/not_equals/times", 256),
            "/checks/0/not_equals: 768 has bits outside the mask: this can never be\n");
}

TEST_F(KeyaMistakes, AKeepAliveRepeatsSetpointsOftenEnough) {
  const auto late = [](const std::string& protocol) {
    return "/keepalive/every_ms: is more than half of what " + protocol + " allows, /protocols/" + protocol +
           "/loss/after_ms: one late command would stop the motor\n";
  };
  EXPECT_EQ(told("/keepalive/every_ms", 501), late("canopen") + late("keya-can") + late("keya-rs232"));
  EXPECT_EQ(told("/keepalive/every_ms", 500), "");
  EXPECT_EQ(told("/keepalive/on", {"canopen", "keya-can", "keya-rs232", "keya-rs485"}),
            "/keepalive/on: nothing on keya-rs485 needs it: its \"loss\" is no command_watchdog\n");
  EXPECT_EQ(told("/keepalive/resend/3", "target_position"),
            "/keepalive/resend/3: must be the set-point of mode 3, an object of target_velocity\n");
  EXPECT_EQ(told("/keepalive/resend/6", "target_position"), "/keepalive/resend/6: mode 6 is not under /modes\n");
  EXPECT_THAT(told("/keepalive/resend", "last_setpoint"), testing::StartsWith("/keepalive/resend: "));
  EXPECT_THAT(told("/keepalive", nullptr),
              testing::HasSubstr("/protocols/keya-can/loss: a command watchdog would stop every motion: say in "
                                 "\"keepalive\" what is repeated\n"));
}

TEST_F(KeyaMistakes, AUnitForEachMotorIsForEach) {
  EXPECT_EQ(told("/quantities/torque_actual/unit/B", nullptr),
            "/quantities/torque_actual/unit: a unit for axis \"B\" is missing\n");
  EXPECT_EQ(
      told("/quantities/torque_actual/unit/B", "torque_c"),
      "/quantities/torque_actual/unit: unknown unit \"torque_c\": not under /units; did you mean \"torque_a\"?\n");
}

TEST_F(KeyaMistakes, OnlyARelativeMoveStandsForAnAbsoluteOne) {
  EXPECT_EQ(told("/commands/run_velocity/as", "move_absolute"),
            "/commands/run_velocity/as: stands for the steps of move_relative, and for no others\n");
  EXPECT_EQ(told("/commands/move_relative/steps", json::array()),
            "/commands/move_relative/as: stands for the steps of move_relative, and for no others\n");
}

}  // namespace
}  // namespace axisgate::drive
