// SPDX-License-Identifier: Apache-2.0
// The first lines of a log: what was configured, in words that need no configuration file beside them.
#include "gateway/compose/start_lines.hpp"

#include <gmock/gmock.h>

#include "tests/unit/config/one_bus.hpp"

namespace axisgate::compose {
namespace {

using testing::HasSubstr;

std::vector<std::string> lines_of(const config::LoadedConfig& loaded) {
  std::vector<std::string> out;
  for (const StartLine& line : start_lines(loaded, "9.8.7")) out.push_back(line.source.words + ": " + line.text);
  return out;
}

TEST(StartLines, OneForTheGatewayEachBusEachAxisAndEachListener) {
  const auto lines = lines_of(config::load_one_bus(
      R"("name": "press", "adapter": "canopen", "device": "can0", "bitrate": 250000)",
      R"({"profile": "leadshine-ld2-can", "node": 3, "axes": [{"axis": 7, "name": "ram", "direction": "inverted",
          "lease": {"timeout_ms": 750, "on_expiry": "halt", "renew": "heartbeat"}}]},
         {"profile": "leadshine-ld2-can", "node": 4, "axes": [{"axis": 8, "lease": null}]})"));
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_THAT(lines[0], testing::StartsWith("gateway: axisgate 9.8.7, configuration "));
  EXPECT_THAT(lines[0], testing::EndsWith(".json: 1 bus, 2 axes"));
  EXPECT_THAT(lines[1], HasSubstr("bus press: canopen on can0, 250 kbit/s, 2 drives with 2 axes, timeout "));
  EXPECT_EQ(
      lines[2],
      "axis 7 ram: Leadshine LD2-CAN (leadshine-ld2-can) node 3 on bus press, 10000 units a turn, inverted, lease "
      "750 ms, renewed by the heartbeat, then halt");
  EXPECT_EQ(lines[3],
            "axis 8: Leadshine LD2-CAN (leadshine-ld2-can) node 4 on bus press, 10000 units a turn, no lease");
  EXPECT_EQ(lines[4], "modbus: listener 127.0.0.1:1502: a client is a connection, only this machine may command");
}

TEST(StartLines, ThePageIsNamedAsABrowserWantsIt) {
  auto loaded = config::load_one_bus(R"("name": "line", "adapter": "modbus-rtu", "device": "/dev/ttyUSB0")",
                                     R"({"profile": "id286pro", "node": 1, "axes": [{"axis": 1}]})");
  loaded.config.web.emplace();
  EXPECT_EQ(lines_of(loaded).back(), "web: page at http://127.0.0.1:8080/, may be looked at from 127.0.0.1/32");
}

TEST(StartLines, ASerialLineHasItsParityAndAKeyaItsMotors) {
  const auto serial = lines_of(config::load_one_bus(
      R"("name": "line", "adapter": "modbus-rtu", "device": "/dev/ttyUSB0", "baud": 115200, "parity": "even")",
      R"({"profile": "id286pro", "node": 1, "axes": [{"axis": 1}]})"));
  EXPECT_THAT(serial[1], HasSubstr("modbus-rtu on /dev/ttyUSB0, 115200 baud 8E1, 1 drive with 1 axis"));
  const auto keya = lines_of(config::load_one_bus(
      R"("name": "cart", "adapter": "keya-rs232", "device": "/dev/ttyUSB1")",
      R"({"profile": "keya-kydas4860-2e", "node": 1, "axes": [{"axis": 1, "name": "left", "motor": "A"}, {"axis": 2, "name": "right", "motor": "B"}]})"));
  EXPECT_THAT(keya[1], HasSubstr("keya-rs232 on /dev/ttyUSB1, 115200 baud 8N1, 1 drive with 2 axes"));
  EXPECT_THAT(keya[3], testing::StartsWith("axis 2 right: "));
  EXPECT_THAT(keya[3], HasSubstr(" motor B on bus cart"));
}

}  // namespace
}  // namespace axisgate::compose
