// SPDX-License-Identifier: Apache-2.0
// What pages show of a configuration: the same as `axisgate check` says of it.
#include "gateway/compose/web_facts.hpp"

#include <gmock/gmock.h>

#include "tests/unit/config/one_bus.hpp"

namespace axisgate::compose {
namespace {

using testing::SizeIs;

TEST(WebFacts, NameTheDriveOfEachAxisAndWhatIsReckonedOfItsBus) {
  const auto loaded = config::load_one_bus(
      R"("name": "cart", "adapter": "keya-rs232", "device": "/dev/ttyUSB1")",
      R"({"profile": "keya-kydas4860-2e", "node": 1, "axes": [{"axis": 1, "motor": "A"}, {"axis": 2, "motor": "B"}]})");
  const web::WebFacts facts = web_facts(loaded);
  ASSERT_THAT(facts.axes, SizeIs(2));
  EXPECT_EQ(facts.axes[1].axis, 2);
  EXPECT_EQ(facts.axes[1].drive, loaded.models[0][0].title);
  EXPECT_EQ(facts.axes[1].profile, "keya-kydas4860-2e");
  EXPECT_EQ(facts.axes[1].node, 1);
  ASSERT_THAT(facts.buses, SizeIs(1));
  EXPECT_EQ(facts.buses[0].name, "cart");
  EXPECT_EQ(facts.buses[0].protocol, "keya-rs232");
  EXPECT_EQ(facts.buses[0].endpoint, "/dev/ttyUSB1, 115200 baud 8N1");
  EXPECT_EQ(facts.buses[0].planned_load_permille, config::plan_of(loaded).load_answered);
}

TEST(WebFacts, HaveTheFaultWordsOfEachProfileOnce) {
  const auto loaded = config::load_one_bus(
      R"("name": "line", "adapter": "modbus-rtu", "device": "/dev/ttyUSB0")",
      R"({"profile": "id286pro", "node": 1, "axes": [{"axis": 1}]}, {"profile": "id286pro", "node": 2, "axes": [{"axis": 2}]})");
  const web::WebFacts facts = web_facts(loaded);
  const auto& alarms = loaded.models[0][0].alarms;
  ASSERT_FALSE(alarms.empty());
  ASSERT_THAT(facts.fault_words, SizeIs(alarms.size()));
  EXPECT_EQ(facts.fault_words[0].text, alarms[0].text);
  EXPECT_EQ(facts.fault_words[0].error_code, alarms[0].code);
  EXPECT_EQ(facts.fault_words[0].whole, alarms[0].value.has_value());
}

}  // namespace
}  // namespace axisgate::compose
