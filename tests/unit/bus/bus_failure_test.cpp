// One conversation of three exchanges, with each step failing in each way; afterwards the bus must serve the next
// order.
#include "tests/unit/bus/bus_stage.hpp"

namespace axisgate::test {
namespace {

using testing::SizeIs;

constexpr int kSteps = 3;

enum class Failure { none, refused, bad_reply, timeout, link_loss, stop, drive_offline };

struct Case {
  Failure failure;
  int step;
};
void PrintTo(const Case& c, std::ostream* out) {
  static constexpr std::array kNames{"none", "refused", "bad_reply", "timeout", "link_loss", "stop", "drive_offline"};
  *out << kNames.at(static_cast<std::size_t>(c.failure)) << " at step " << c.step;
}

class BusFailure : public BusStage, public testing::WithParamInterface<Case> {
 protected:
  /// The drive's side of the conversation: three exchanges, ended at once by a failure.
  void converse(OrderId order) {
    drives[0].result_hook = [this, order](const ExchangeResult& result) {
      if (gone) return;
      if (result.code != Errc::ok || ++done == kSteps) finish(order, result.code);
    };
    drives[0].ended_hook = [this, order](OrderId id, Errc code) {
      if (id != order) return;
      gone = true;
      endings.push_back(code);
    };
  }
  void finish(OrderId order, Errc code) {
    gone = true;
    endings.push_back(code);
    bus->finish(order);
  }
  void answer_step() {
    if (!wire->outstanding) pass_gap();
    ASSERT_TRUE(wire->outstanding);
    wire->reply();
  }
  void fail_step() {
    if (!wire->outstanding) pass_gap();
    ASSERT_TRUE(wire->outstanding);
    switch (GetParam().failure) {
      case Failure::none:
        break;
      case Failure::refused:
        wire->reply(ended_as(Errc::refused_by_drive));
        break;
      case Failure::bad_reply:
        wire->reply(ended_as(Errc::bad_reply));
        break;
      case Failure::timeout:
        runtime.advance_by(kTimeout);
        break;
      case Failure::link_loss:
        wire->down("gone");
        wire->up();
        break;
      case Failure::stop:
        stop = submit(0, Priority::stop);
        turn();
        wire->reply();
        break;
      case Failure::drive_offline:
        bus->end_drive(0, Errc::offline, Errc::timed_out);
        turn();
        wire->reply();
        break;
    }
  }
  [[nodiscard]] static Errc expected() {
    switch (GetParam().failure) {
      case Failure::none:
        return Errc::ok;
      case Failure::refused:
        return Errc::refused_by_drive;
      case Failure::bad_reply:
        return Errc::bad_reply;
      case Failure::timeout:
        return Errc::timed_out;
      case Failure::link_loss:
        return Errc::link_lost;
      case Failure::stop:
        return Errc::dropped_by_stop;
      case Failure::drive_offline:
        return Errc::timed_out;
    }
    return Errc::ok;
  }

  bool gone = false;
  int done = 0;
  OrderId stop = 0;
  std::vector<Errc> endings;
};

TEST_P(BusFailure, ends_the_order_once_and_serves_the_next) {
  link_up();
  converse(submit(0));
  turn();
  for (int step = 0; step < GetParam().step; ++step) answer_step();
  if (GetParam().step < kSteps) fail_step();
  EXPECT_THAT(endings, testing::ElementsAre(expected()));

  runtime.advance_by(kSettle + kGap);
  if (stop != 0) {
    EXPECT_EQ(drives[0].granted, stop);
    bus->finish(stop);
    wire->reply();
    pass_gap();
  }
  const OrderId next = submit(1);
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
  std::vector<Case> cases{{Failure::none, kSteps}};
  for (const Failure failure : {Failure::refused, Failure::bad_reply, Failure::timeout, Failure::link_loss,
                                Failure::stop, Failure::drive_offline}) {
    for (int step = 0; step < kSteps; ++step) cases.push_back({failure, step});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(EachStep, BusFailure, testing::ValuesIn(every_failure()));

}  // namespace
}  // namespace axisgate::test
