// SPDX-License-Identifier: Apache-2.0
// What a journal can be asked for: each line has its axis and its bus, and what kind of event it is.
#include <gmock/gmock.h>

#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Field;

/// As a journal is asked: by a word of each field.
auto line_with(const std::string& words, AxisNumber axis, const std::string& bus, std::string_view event) {
  return AllOf(Field("words", &LogSource::words, words), Field("axis", &LogSource::axis, axis),
               Field("bus", &LogSource::bus, bus), Field("event", &LogSource::event, event));
}

TEST(LogSources, ALineHasItsAxisItsBusAndItsEvent) {
  std::vector<GatewayStage::Line> lines{line_of(simulated::KincoType::jd, 1), line_of(simulated::KincoType::jd, 2)};
  lines[0].name = "lift";
  lines[1].name = "feeder";
  for (GatewayStage::Line& line : lines) line.options.baud = 38400;
  GatewayStage stage(std::move(lines));
  ASSERT_TRUE(stage.come_online());
  stage.gateway().report(EventKind::boot, "read anew", true);
  EXPECT_THAT(stage.log_sources(), Contains(line_with("bus lift", 0, "lift", "")));
  EXPECT_THAT(stage.log_sources(), Contains(line_with("axis 1", 1, "lift", "link")));
  EXPECT_THAT(stage.log_sources(), Contains(line_with("axis 2", 2, "feeder", "link")));
  EXPECT_THAT(stage.log_sources(), Contains(line_with("axis 2", 2, "feeder", "boot")));
  EXPECT_THAT(stage.log_sources(), Contains(line_with("gateway", 0, "", "boot")));
}

}  // namespace
}  // namespace axisgate::test
