// SPDX-License-Identifier: Apache-2.0
#include "gateway/config/config_fault.hpp"

#include <gmock/gmock.h>

namespace axisgate::config {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

TEST(ConfigFaults, KnowWhatIsWrongAtOrBelowAPlace) {
  ConfigFaults faults("a.json");
  faults.add("/buses/1/drives/0", "x");
  EXPECT_TRUE(faults.within("/buses/1"));
  EXPECT_TRUE(faults.within("/buses/1/drives/0"));
  EXPECT_TRUE(faults.within(""));
  EXPECT_FALSE(faults.within("/buses/1/drives/0/node"));
  EXPECT_FALSE(faults.within("/buses/1/drives/00"));
  EXPECT_FALSE(faults.within("/buses/10"));
  EXPECT_FALSE(faults.within("/buses/1/drives/0/"));
  faults.add("/buses/20", "x");
  EXPECT_FALSE(faults.within("/buses/2"));
}

TEST(ConfigFaults, DoNotMistakeAFaultOfAProfileForOneOfThisFile) {
  ConfigFaults faults("a.json");
  faults.add(ConfigFault{"kinco-jd.json", "/objects/mode", "x"});
  EXPECT_FALSE(faults.within("/objects"));
}

TEST(ConfigFaults, TellTheSameMistakeOnce) {
  ConfigFaults faults("a.json");
  faults.add(ConfigFault{"kinco-jd.json", "/objects/mode", "x"});
  faults.add(ConfigFault{"kinco-jd.json", "/objects/mode", "x"});
  EXPECT_THAT(faults.faults(), SizeIs(1));
}

TEST(ConfigFaults, KeepWarningsApart) {
  ConfigFaults faults("a.json");
  faults.warn("/modbus_tcp/0/listen", "everybody may read");
  EXPECT_THAT(faults.faults(), SizeIs(0));
  EXPECT_THAT(faults.warnings(), ElementsAre(ConfigFault{"a.json", "/modbus_tcp/0/listen", "everybody may read"}));
  faults.add("/buses", "x");
  faults.locate({{"a.json", "{\"modbus_tcp\": [{\n\"listen\": 1}]}"}});
  EXPECT_EQ(text(faults.warnings().at(0)), "a.json:2:1: /modbus_tcp/0/listen: everybody may read");
  EXPECT_EQ(text(faults.faults().at(0)), "a.json: /buses: x") << "it is not there";
}

}  // namespace
}  // namespace axisgate::config
