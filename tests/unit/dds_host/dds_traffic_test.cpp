// SPDX-License-Identifier: Apache-2.0
// What goes between the gateway and axisgate-dds: the newest state for a slow reader, a reply for every request, and
// never more than its share of the loop.
#include <boost/asio/post.hpp>
#include <csignal>

#include "tests/unit/dds_host/hosted.hpp"

namespace axisgate::dds {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Le;
using ::testing::Not;

TEST_F(Hosted, GivesASlowReaderTheNewestState) {
  for (AxisNumber number = 1; number <= 499; ++number) image.add_axis(number, "axis", 0);
  start("reads late");
  ASSERT_TRUE(run_until_ready());
  // More states than the socket holds, and axis 499 changes while its turn has not come.
  const auto change = [&](std::uint32_t sequence) {
    image.find(499)->sequence = sequence;
    image.changes.mark(499);
    io.restart();
    io.run_for(std::chrono::milliseconds(20));
  };
  for (std::uint32_t sequence = 1; sequence <= 5; ++sequence) change(sequence);
  ASSERT_EQ(kill(server->keeper().pid().value(), SIGUSR1), 0);
  ASSERT_TRUE(run_until_said("499 is at 5"));
  EXPECT_THAT(lines, Not(Contains("499 is at 3"))) << "states that were no longer true were kept for it";
}

TEST_F(Hosted, TakesNoMoreThanItsShareOfTheLoop) {
  image.add_axis(1, "axis", 0);
  settings.commands = true;
  start("asks much");
  int most = 0;
  int last = 0;
  const std::function<void()> look = [&] {
    most = std::max(most, axes.submitted - last);
    last = axes.submitted;
    boost::asio::post(io, look);
  };
  look();
  ASSERT_TRUE(run_until_said("1000 replies, one each"));
  EXPECT_THAT(most, Le(host::kMaxReadATurn)) << "somebody else's turn had to wait";
}

TEST_F(Hosted, LetsItFillNeitherTheLogNorALine) {
  start("chatters");
  ASSERT_TRUE(run_until_said("last"));
  EXPECT_THAT(lines.size(), Le(30U));
  EXPECT_EQ(lines.front(), "line 0 with another line");
  EXPECT_THAT(lines, Contains(HasSubstr("lines of axisgate-dds are left out here")));
}

}  // namespace
}  // namespace axisgate::dds
