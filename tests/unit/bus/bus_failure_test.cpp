// SPDX-License-Identifier: Apache-2.0
// One bus job of three exchanges, with each step failing in each way; afterwards the bus must serve the next bus
// job.
#include "tests/unit/bus/bus_stage.hpp"

namespace axisgate::test {
namespace {

using testing::SizeIs;

constexpr int kSteps = 3;

class BusFailure;
struct Failure {
  const char* name;
  Errc expected;
  void (*happen)(BusFailure&);
};
struct Case {
  Failure failure;
  int step;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.failure.name << " at step " << c.step; }

class BusFailure : public BusStage, public testing::WithParamInterface<Case> {
 public:
  /// The drive's side of the bus job: three exchanges, ended at once by a failure.
  void converse(JobId job) {
    drives[0].result_hook = [this, job](const ExchangeResult& result) {
      if (gone) return;
      if (result.code != Errc::ok || ++done == kSteps) {
        end(result.code);
        bus->finish(job);
      }
    };
    drives[0].ended_hook = [this, job](JobId id, Errc code) {
      if (id == job) end(code);
    };
  }
  void end(Errc code) {
    gone = true;
    endings.push_back(code);
  }
  /// The next exchange is on the wire.
  void await_step() {
    if (!wire->outstanding) pass_gap();
    ASSERT_TRUE(wire->outstanding);
  }
  void stop_axis() {
    stop = submit(0, Priority::stop);
    turn();
    wire->reply();
  }
  void drive_goes_offline() {
    bus->end_drive(0, Errc::offline, Errc::timed_out);
    turn();
    wire->reply();
  }
  void link_goes_and_returns() {
    wire->down("gone");
    wire->up();
  }

  using BusStage::kTimeout;
  using BusStage::runtime;
  using BusStage::wire;
  bool gone = false;
  int done = 0;
  JobId stop = 0;
  std::vector<Errc> endings;
};

const Failure kFailures[] = {
    {"refusal", Errc::refused_by_drive, [](BusFailure& on) { on.wire->reply(ended_as(Errc::refused_by_drive)); }},
    {"bad_reply", Errc::bad_reply, [](BusFailure& on) { on.wire->reply(ended_as(Errc::bad_reply)); }},
    {"timeout", Errc::timed_out, [](BusFailure& on) { on.runtime.advance_by(BusFailure::kTimeout); }},
    {"link_loss", Errc::link_lost, [](BusFailure& on) { on.link_goes_and_returns(); }},
    {"stop", Errc::dropped_by_stop, [](BusFailure& on) { on.stop_axis(); }},
    {"drive_offline", Errc::timed_out, [](BusFailure& on) { on.drive_goes_offline(); }},
};

TEST_P(BusFailure, ends_the_job_once_and_serves_the_next) {
  link_up();
  converse(submit(0));
  turn();
  for (int step = 0; step < GetParam().step; ++step) {
    await_step();
    wire->reply();
  }
  if (GetParam().step < kSteps) {
    await_step();
    GetParam().failure.happen(*this);
  }
  EXPECT_THAT(endings, testing::ElementsAre(GetParam().failure.expected));

  runtime.advance_by(kSettle + kGap);
  if (stop != 0) {
    EXPECT_EQ(drives[0].granted, stop);
    bus->finish(stop);
    wire->reply();
    pass_gap();
  }
  const JobId next = submit(1);
  turn();
  EXPECT_EQ(drives[1].granted, next);
  wire->reply();
  bus->finish(next);
  runtime.advance_by(1s);
  EXPECT_EQ(bus->queue_depth(), 0u);
  EXPECT_FALSE(wire->outstanding);
  EXPECT_THAT(endings, SizeIs(1));
}

std::vector<Case> every_failure() {
  std::vector<Case> cases{{{"nothing", Errc::ok, nullptr}, kSteps}};
  for (const Failure& failure : kFailures) {
    for (int step = 0; step < kSteps; ++step) cases.push_back({failure, step});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(EachStep, BusFailure, testing::ValuesIn(every_failure()));

}  // namespace
}  // namespace axisgate::test
