// SPDX-License-Identifier: Apache-2.0
// "Nothing that a browser or a scraper does costs a drive anything": the exchanges of the drives are the same with a
// page and without, counted.
#include <gmock/gmock.h>

#include "gateway/upstream/web/web_session.hpp"
#include "tests/stage/subject.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

/// What a run came to: the exchanges of each class with their times, and what the motor did.
struct Outcome {
  bus::Statistics statistics;
  bus::ExchangeTimes::ByClass times{};
  std::int64_t position = 0;
  std::size_t samples = 0;  ///< that a page got
};

Outcome run(Subject subject, bool page) {
  GatewayStage stage({line_with(subject, LeaseRules{.on = false})});
  ProcessImage& image = stage.gateway().image();
  web::WebSession session(
      {"0.3", 1, stage.runtime().now()}, image, stage.gateway().events(), [] { return web::ProcessFigures{}; }, [] {});
  web::WebFacts facts;
  for (const auto& axis : image.axes()) facts.axes.push_back({axis->number, "drive", "profile", 1});
  session.take({}, facts, stage.runtime().now());
  Outcome out;
  const auto step = [&] {
    stage.run(10ms);
    while (auto record = page ? session.next(stage.runtime().now()) : std::nullopt)
      if (const auto* const samples = std::get_if<web::SamplesRecord>(&*record)) out.samples += samples->axes.size();
  };
  if (page) session.on_link_up(stage.runtime().now());
  for (int i = 0; i < 500; ++i) step();
  WriteBatch enable;
  enable.command = Command::enable;
  const auto enabled = stage.begin(1, enable);
  for (int i = 0; i < 100; ++i) step();
  WriteBatch velocity;
  velocity.setpoints.push_back({Quantity::target_velocity, 60000});
  velocity.command = Command::run_velocity;
  const auto runs = stage.begin(1, velocity);
  for (int i = 0; i < 300; ++i) step();
  EXPECT_TRUE(*enabled && *runs);
  out.statistics = stage.gateway().bus(0).statistics();
  out.times = stage.gateway().bus(0).times().exchanges.by_class();
  out.position = truth(stage, subject).position;
  return out;
}

class BesideDrives : public testing::TestWithParam<Subject> {};

TEST_P(BesideDrives, APageCostsNoExchangeAndMovesNothing) {
  const Outcome without = run(GetParam(), false);
  const Outcome with = run(GetParam(), true);
  EXPECT_GT(with.samples, 30U);
  EXPECT_GT(without.statistics.requests, 100U);
  EXPECT_EQ(with.statistics, without.statistics);
  EXPECT_EQ(with.times, without.times);
  EXPECT_EQ(with.position, without.position);
}

TEST_P(BesideDrives, EachExchangeIsCountedOnceByItsClass) {
  const Outcome without = run(GetParam(), false);
  std::uint64_t counted = 0;
  for (const TimeCounts& of_class : without.times) counted += of_class.total();
  // One may be on the wire.
  EXPECT_GE(counted + 1, without.statistics.requests);
  EXPECT_LE(counted, without.statistics.requests);
  for (const bus::Priority priority : {bus::Priority::command, bus::Priority::setup, bus::Priority::poll}) {
    EXPECT_GT(without.times[static_cast<std::size_t>(priority)].total(), 0U) << static_cast<int>(priority);
  }
}

TEST(LatestResult, SaysWhoAskedForWhatAndSinceWhen) {
  GatewayStage stage({line_with(Subject::jd_serial, LeaseRules{.on = false})});
  ASSERT_TRUE(stage.come_online());
  const auto client = std::make_shared<ClientLife>();
  client->id = 7;
  client->role = Role::operator_;
  WriteBatch batch;
  batch.client = client->id;
  batch.role = client->role;
  batch.life = client;
  batch.command = Command::enable;
  const Instant asked = stage.runtime().now();
  EXPECT_EQ(stage.ask(1, batch).outcome.code, Errc::ok);
  const axisgate::LatestResult done = stage.axis(1).latest;
  EXPECT_EQ(done.by, client);
  EXPECT_EQ(done.what, "enable");
  EXPECT_GE(done.at, asked);
  EXPECT_LE(done.at, stage.runtime().now());
  stage.command(1, Command::disable);
  EXPECT_EQ(stage.axis(1).latest.by, nullptr) << "nobody's: the gateway's own";
}

INSTANTIATE_TEST_SUITE_P(All, BesideDrives,
                         testing::Values(Subject::jd_serial, Subject::md_rtu, Subject::leadshine,
                                         Subject::keya_can_speed),
                         named);

}  // namespace
}  // namespace axisgate::test
