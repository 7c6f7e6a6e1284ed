// SPDX-License-Identifier: Apache-2.0
// What names a fault, and when it is read: the words that count, and their place before commands.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>

#include "gateway/drive/axis/publisher.hpp"
#include "gateway/drive/state/axis_core.hpp"
#include "gateway/image/shown.hpp"
#include "tests/stage_drive/rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kFaultWordOne = 0x2601, kFaultWordTwo = 0x2602;
constexpr std::uint16_t kSupplyTooHigh = 0x0020;
constexpr std::int64_t kGenericCode = 0x1000;

/// A Kinco JD whose samples the test gives, beside the models that its profile makes.
class NamedBy : public testing::Test {
 protected:
  NamedBy() : rig_(KincoType::jd) {
    store_.begin_exchange();
    image_.link_state = LinkState::online;
  }
  [[nodiscard]] const model::DriveModel& model() { return rig_.stage.gateway().drive_of(1)->axis(0).core().drive; }
  model::ObjectId object(std::uint16_t index) { return model().find({index, 0}); }
  void read(std::uint16_t index, std::int64_t number) {
    store_.begin_exchange();
    store_.read(object(index), number, turn_.now);
    look();
  }
  void pass(Duration time) {
    turn_.now += time;
    look();
  }
  void look() {
    core_.watch_fault();
    writer_.show_state();
  }
  [[nodiscard]] std::int64_t shown(Quantity quantity) { return shown_value(image_, quantity); }

  Rig rig_;
  drive::Turn turn_{.now = Instant{} + 1h, .link = LinkState::online};
  drive::ObjectStore store_{model().objects};
  AxisImage image_;
  drive::AxisCore core_{model(), model().axes[0], store_, turn_,
                        drive::Motion{model().axes[0].velocity_lag, image_.record}};
  drive::AxisWriter writer_{core_, image_};
};

constexpr std::int64_t kEnabledWord = 0x0637, kFaultWord = 0x0618;

// It warns of one thing, fails by another, and does not say which: the warning is not the cause.
TEST_F(NamedBy, AWordThatWasReadBeforeTheFaultNamesNoCauseOfIt) {
  read(kFaultWordOne, kSupplyTooHigh);
  read(kStatusword, kEnabledWord);
  read(kStatusword, kFaultWord);
  pass(drive::kCauseTime);
  ASSERT_TRUE(image_.has(AxisInput::fault));
  EXPECT_EQ(shown(Quantity::error_code), kGenericCode);
  EXPECT_EQ(drive::fault_text(core_), "the drive names no cause");
}

TEST_F(NamedBy, TheSameWordReadAfterTheFaultNamesIt) {
  read(kFaultWordOne, kSupplyTooHigh);
  read(kStatusword, kEnabledWord);
  read(kStatusword, kFaultWord);
  ASSERT_TRUE(image_.has(AxisInput::fault));
  read(kFaultWordOne, kSupplyTooHigh);
  pass(drive::kCauseTime);
  EXPECT_EQ(shown(Quantity::error_code), 0x3210);
}

TEST_F(NamedBy, WhatIsNotKnownYetHasNoNumber) {
  read(kFaultWordOne, kSupplyTooHigh);
  read(kFaultWordTwo, 0);
  read(kStatusword, kEnabledWord);
  ASSERT_EQ(shown(Quantity::error_code), 0x3210) << "it warns";
  read(kStatusword, kFaultWord);
  EXPECT_EQ(image_.axis_state, AxisState::error_stop);
  EXPECT_EQ(shown(Quantity::error_code), 0xFFFF);
  EXPECT_EQ(shown(Quantity::vendor_error), 0xFFFFFFFF);
  EXPECT_FALSE(image_[Quantity::error_code].valid || image_[Quantity::vendor_error].valid);
  core_.fault.emergency(0x3210, turn_.now, store_.exchange());
  look();
  EXPECT_EQ(shown(Quantity::error_code), 0x3210);
  EXPECT_TRUE(image_[Quantity::error_code].valid);
  EXPECT_FALSE(image_[Quantity::vendor_error].valid) << "its words were not read";
}

/// A client that never lets the line rest: it writes parameters and reads objects, and as soon as one is done it asks
/// anew. While a write waits for its statusword, a read goes.
class Busy {
 public:
  Busy(GatewayStage& stage, AxisNumber axis) : stage_(stage), axis_(axis) {}
  void go_on() {
    constexpr std::array kRows{Quantity::profile_velocity, Quantity::profile_acceleration,
                               Quantity::profile_deceleration};
    constexpr std::array<std::uint16_t, 3> kObjects{0x6081, 0x6083, 0x6084};
    for (std::size_t i = 0; i < kRows.size(); ++i) {
      ask(results_.at(i), setpoints({{kRows.at(i), 100'000 + 1000 * ++count_}}));
      WriteBatch read;
      read.object = ObjectRequest{.index = kObjects.at(i), .size = 4};
      ask(reads_.at(i), read);
    }
  }

 private:
  using Result = std::shared_ptr<std::optional<BatchResult>>;
  void ask(Result& result, const WriteBatch& batch) {
    if (!result || *result) result = stage_.begin(axis_, batch);
  }
  GatewayStage& stage_;
  AxisNumber axis_;
  std::int64_t count_ = 0;
  std::array<Result, 3> results_{}, reads_{};
};

// Whoever looks at a faulted axis must not wait for its neighbour's set-points to learn the cause.
TEST(CauseIsRead, RightBehindTheStatuswordThatShowsTheFaultHoweverManyCommandsWait) {
  // The replies take longer than the test looks away: the neighbour asks anew in time.
  GatewayStage stage({line_of_mds(2, 3ms)});
  ASSERT_TRUE(stage.come_online());
  Busy neighbour(stage, 2);
  const auto busy = [&](const auto& done) {
    return stage.run_until([&] {
      neighbour.go_on();
      return done();
    });
  };
  for (int i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    const Instant from = stage.runtime().now() + (300 + i * 7) * 1ms;
    ASSERT_TRUE(busy([&] { return stage.runtime().now() >= from; }));
    const std::size_t before = stage.link(0).sent.size();
    stage.drive(0).inject_fault(1, kSupplyTooHigh);
    stage.drive(0).clear_fault_cause(1, kSupplyTooHigh);
    ASSERT_TRUE(busy([&] { return stage.axis(1).has(AxisInput::fault); }));
    ASSERT_TRUE(busy([&] { return stage.axis(1)[Quantity::error_code].valid; }));
    // Whatever statusword it is asked for from now on shows the fault.
    const auto& sent = stage.link(0).sent;
    const auto is_read = [](const SimLink::Sent& frame, std::uint16_t index) {
      const WireRequest request = decoded(frame.at, frame.bytes);
      return frame.bytes[0] == 1 && !request.write && request.index == index;
    };
    const auto shows = std::find_if(sent.begin() + static_cast<std::ptrdiff_t>(before), sent.end(),
                                    [&](const SimLink::Sent& frame) { return is_read(frame, kStatusword); });
    ASSERT_NE(shows, sent.end());
    ASSERT_NE(shows + 1, sent.end());
    EXPECT_TRUE(is_read(*(shows + 1), kFaultWordOne)) << "something else went before it";
    ASSERT_EQ(stage.command(1, Command::fault_reset).outcome.code, Errc::ok);
    ASSERT_TRUE(busy([&] { return !stage.axis(1).has(AxisInput::fault); }));
  }
}

}  // namespace
}  // namespace axisgate::test
