// SPDX-License-Identifier: Apache-2.0
// What begins a capture, what it holds, and which captures stay.
#include <gmock/gmock.h>

#include "tests/unit/web_process/capture_stage.hpp"

namespace axisgate::web {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr SteadyNs kLong = 12 * kSecond;  ///< more than before_s
constexpr SteadyNs kOver = 6 * kSecond;   ///< more than after_s

/// Something that happens to axis 1.
struct Happening {
  Cause cause;
  std::function<void(CaptureStage&)> happen;
};

std::vector<Happening> happenings() {
  return {
      {Cause::fault, [](CaptureStage& stage) { stage.fault(1); }},
      {Cause::link_lost,
       [](CaptureStage& stage) { stage.axis(1).link_state = static_cast<std::uint8_t>(LinkState::offline); }},
      {Cause::lease_stop,
       [](CaptureStage& stage) { stage.event(1, EventKind::lease, 3, "the lease of plc has run out: quick stop"); }},
      {Cause::stranger_stop,
       [](CaptureStage& stage) {
         stage.event(1, EventKind::command, 3, "stopped by 10.0.0.9" + std::string(kByAnother) + ": quick_stop");
       }},
      {Cause::command_failed,
       [](CaptureStage& stage) {
         stage.axis(1).result = static_cast<std::uint8_t>(CommandResult::not_reached);
         stage.axis(1).result_what = "enable";
         // The same one is shown for as long as there is no newer one.
         constexpr std::uint32_t kShown = 50;
         for (std::uint32_t i = 0; i < kShown; ++i) {
           stage.axis(1).result_age_ms = 10 * i;
           stage.run(CaptureStage::kEach);
         }
         stage.axis(1).result = 0;
       }},
      {Cause::unexpected_motion, [](CaptureStage& stage) { stage.axis(1).alarms = bit(AxisAlarm::unexpected_motion); }},
      {Cause::units_disagree, [](CaptureStage& stage) { stage.axis(1).alarms = bit(AxisAlarm::units_disagree); }},
      {Cause::trigger, [](CaptureStage& stage) { stage.turn(1, 900'000); }},
  };
}

CaptureSettings with_a_trigger() {
  CaptureSettings out;
  out.triggers = {{"too fast", 1, Quantity::velocity_actual, TriggerIs::above, 800, 800, 0}};
  return out;
}

TEST(Captures, BeginByThemselvesAtEachCauseAndHoldTheMotionBefore) {
  for (const Happening& each : happenings()) {
    CaptureStage stage(with_a_trigger());
    stage.run(kLong);
    const SteadyNs before = stage.now;
    each.happen(stage);
    stage.run(kOver);
    ASSERT_THAT(stage.completed, SizeIs(1)) << text(each.cause);
    const Capture& capture = *stage.completed.front();
    EXPECT_EQ(capture.first().cause, each.cause) << text(capture.first().cause);
    EXPECT_EQ(capture.first().axis, 1U);
    EXPECT_LE(std::abs(capture.first().at - before), 2 * CaptureStage::kEach);
    EXPECT_EQ(capture.from, capture.first().at - 10 * kSecond);
    EXPECT_EQ(capture.to, capture.first().at + 5 * kSecond);
    EXPECT_TRUE(capture.complete);
    EXPECT_EQ(capture.times, 1U) << text(each.cause);
    const auto velocities = CaptureStage::points(capture, 1, Quantity::velocity_actual);
    ASSERT_GE(velocities.size(), 1000U) << "each sample";
    EXPECT_EQ(velocities.front().at, capture.from);
    const auto as_it_turned = [&](const Point& point) {
      return point.at >= before || (point.known && point.value >= 1000 && point.value < 1010);
    };
    EXPECT_TRUE(std::ranges::all_of(velocities, as_it_turned)) << text(each.cause);
    EXPECT_GT(velocities.back().at, capture.to - 2 * CaptureStage::kEach) << "until the end";
  }
}

TEST(Captures, DoNotBeginWithWhatIsSoAtFirst) {
  for (const Happening& each : happenings()) {
    if (each.cause == Cause::lease_stop || each.cause == Cause::stranger_stop) continue;  // they happen, and are not so
    CaptureStage stage(with_a_trigger());
    stage.greet();  // what is seen next is seen first
    each.happen(stage);
    stage.run(kOver);
    EXPECT_THAT(stage.captures(), IsEmpty()) << text(each.cause);
  }
}

TEST(Captures, KnowNothingOfADriveThatIsOutOfSight) {
  CaptureStage stage;
  stage.fault(1);
  stage.axis(1).link_state = static_cast<std::uint8_t>(LinkState::setup);
  stage.run(kSecond);
  EXPECT_THAT(stage.captures(), IsEmpty()) << "what it shows is not what its drive shows";
  // One that was never there is searched for.
  CaptureStage other;
  other.greet();
  for (int i = 0; i < 10; ++i)
    for (const LinkState link : {LinkState::setup, LinkState::offline}) {
      other.axis(1).link_state = static_cast<std::uint8_t>(link);
      other.run(kSecond);
    }
  EXPECT_THAT(other.captures(), IsEmpty());
}

TEST(Captures, HoldOtherAxesAtTenHertzWithTheirSpikes) {
  CaptureStage stage({}, 3);
  stage.run(kLong);
  stage.fault(1);
  stage.run(kSecond);
  stage.turn(2, 3'000'000);
  stage.run(CaptureStage::kEach);  // one sample of many
  const SteadyNs spike = stage.now;
  stage.turn(2, 2000);
  stage.run(kOver);
  const auto points = CaptureStage::points(*stage.captures().front(), 2, Quantity::velocity_actual);
  EXPECT_LE(points.size(), 3U * 151 + 4 * 6) << "three of each slice, and what holds where a copy ends";
  EXPECT_GE(points.size(), 150U);
  const auto top = std::ranges::max_element(points, {}, &Point::value);
  EXPECT_GE(top->value, 3'000'000);
  EXPECT_EQ(top->at, spike) << "at its own instant";
  EXPECT_LT(std::next(top)->value, 2010) << "and what came behind it";
}

TEST(Captures, HoldEventsOfTheirTime) {
  CaptureStage stage;
  stage.event(2, EventKind::homed, 0, "long before");
  stage.run(kLong);
  stage.event(2, EventKind::boot, 0, "before");
  stage.fault(1);
  stage.run(kSecond / 5);
  stage.event(1, EventKind::fault, 0x2310, "fault 0x2310: over-current");
  stage.run(kOver);
  stage.event(2, EventKind::boot, 0, "behind");
  const Capture& capture = *stage.captures().front();
  ASSERT_THAT(capture.events, SizeIs(2));
  EXPECT_EQ(capture.events[0].text, "before");
  EXPECT_EQ(capture.text(), "fault 0x2310: over-current") << "as soon as the drive has named it";
}

TEST(Captures, TakeFurtherCausesOfTheirAxisIn) {
  CaptureStage stage;
  stage.run(kLong);
  stage.fault(1);
  stage.run(kSecond);
  stage.axis(1).alarms = bit(AxisAlarm::unexpected_motion);
  stage.run(kOver);
  ASSERT_THAT(stage.captures(), SizeIs(1));
  const Capture& capture = *stage.captures().front();
  EXPECT_THAT(capture.causes, SizeIs(2));
  EXPECT_THAT(capture.text(), HasSubstr("; then unexpected_motion: "));
  EXPECT_EQ(capture.to, capture.causes[1].at + 5 * kSecond) << "with all that is behind the last one";
}

TEST(Captures, AreOfTheGravestCauseAndBecomeNoLongerThanAMinute) {
  CaptureStage stage(with_a_trigger());
  stage.run(kLong);
  stage.turn(1, 900'000);
  stage.run(3 * kSecond);
  // The event comes before the sample that shows the fault.
  stage.event(1, EventKind::fault, 0x2310, "over-current");
  stage.fault(1);
  stage.run(kSecond);
  ASSERT_THAT(stage.captures(), SizeIs(1));
  EXPECT_EQ(stage.captures().front()->gravest().cause, Cause::fault);
  EXPECT_EQ(stage.captures().front()->text(), "trigger: too fast; then over-current");
  for (int i = 0; i < 30; ++i) {
    stage.event(1, EventKind::lease, i % 2 == 0 ? 3 : 0, "of a lease");
    stage.axis(1).alarms = i % 4 == 0   ? bit(AxisAlarm::unexpected_motion)
                           : i % 4 == 2 ? bit(AxisAlarm::units_disagree)
                                        : 0;
    stage.run(4 * kSecond);
  }
  for (const Recorder::Kept& each : stage.captures()) EXPECT_LE(each->to, each->first().at + kLongest);
}

TEST(Captures, AreMadeOfFourAxesAtOnceAndTheFifthIsInOneOfThem) {
  CaptureStage stage({}, 6);
  stage.run(kLong);
  for (std::uint16_t axis = 1; axis <= 6; ++axis) stage.fault(axis);
  stage.run(kOver);
  ASSERT_THAT(stage.captures(), SizeIs(kMostRunning));
  const Capture& last = *stage.captures().front();
  EXPECT_EQ(last.first().axis, 4U);
  EXPECT_TRUE(last.has(Cause::fault, 5));
  EXPECT_TRUE(last.has(Cause::fault, 6));
  EXPECT_THAT(last.text(), HasSubstr("; then fault of axis 6: "));
}

TEST(Captures, OfAFaultThatFlickersIsOne) {
  CaptureStage stage;
  stage.run(kLong);
  for (int i = 0; i < 3000; ++i) {
    stage.fault(1, i % 2 == 0);
    stage.run(CaptureStage::kEach);
  }
  ASSERT_THAT(stage.captures(), SizeIs(1)) << "the one that shows how it began";
  EXPECT_EQ(stage.captures().front()->times, 1500U);
  stage.fault(1, false);
  stage.run(kLong);
  stage.fault(1);
  stage.run(kOver);
  EXPECT_THAT(stage.captures(), SizeIs(2)) << "once it was quiet";
}

TEST(Captures, OfADayOfFaultsStayInTheirBounds) {
  CaptureSettings settings;
  settings.keep = 5;
  CaptureStage stage(settings, 2, kCaptureBytes, std::size_t{1} << 20);
  // One that flickers, and one that comes each minute.
  constexpr int kADay = 24 * 60 * 2;
  for (int i = 0; i < kADay; ++i) {
    stage.fault(1, i % 2 == 0);
    for (int j = 0; j < 10; ++j) {
      stage.fault(2, j % 2 == 0);
      stage.run(3 * kSecond, kSecond);
    }
  }
  EXPECT_THAT(stage.captures(), SizeIs(5));
  EXPECT_EQ(stage.completed.size(), 1U + kADay / 2) << "one of the fault that flickers";
  EXPECT_EQ(stage.gone.size(), stage.completed.size() - 5);
  EXPECT_LE(stage.stores.recorder.changes().size(), kMostChanges);
}

TEST(Captures, StayAsManyAsTheyMayTheNewest) {
  CaptureSettings settings;
  settings.keep = 2;
  CaptureStage stage(settings, 4);
  for (std::uint16_t axis = 1; axis <= 3; ++axis) {
    stage.fault(axis);
    stage.run(kOver);
  }
  ASSERT_THAT(stage.completed, SizeIs(3));
  EXPECT_THAT(stage.ids(), ElementsAre(stage.completed[2]->id, stage.completed[1]->id));
  EXPECT_THAT(stage.gone, ElementsAre(stage.completed[0]->id));
  EXPECT_EQ(stage.stores.recorder.find(stage.completed[0]->id), nullptr);
}

TEST(Captures, OfManyAxesStayWithinTheirBytes) {
  constexpr std::size_t kBytes = 256 * 1024;
  CaptureStage stage({}, 200, kBytes);
  stage.run(kSecond);
  for (std::uint16_t axis = 1; axis <= 4; ++axis) {
    stage.fault(axis);
    stage.run(kOver, 50 * kMillisecond);
  }
  std::size_t bytes = 0;
  for (const Recorder::Kept& each : stage.captures()) {
    EXPECT_TRUE(each->cut);
    EXPECT_FALSE(CaptureStage::points(*each, each->first().axis, Quantity::velocity_actual).empty()) << "its own first";
    bytes += each->bytes();
  }
  EXPECT_LE(bytes, kBytes);
}

TEST(Captures, HoldWhatTheHistoryThrewAwayMeanwhile) {
  // Room for some four seconds.
  CaptureStage stage({}, 4, kCaptureBytes, 64 * 1024);
  stage.run(kLong);
  const SteadyNs oldest = stage.stores.history.oldest();
  ASSERT_GT(oldest, stage.now - 8 * kSecond) << "less than before_s";
  stage.fault(1);
  stage.run(kOver);
  const Capture& capture = *stage.captures().front();
  ASSERT_GT(stage.stores.history.oldest(), capture.first().at) << "it has nothing of before any more";
  EXPECT_LE(capture.from, oldest + kSecond) << "says from when on it holds all";
  EXPECT_LE(CaptureStage::points(capture, 1, Quantity::velocity_actual).front().at,
            capture.from + 2 * CaptureStage::kEach);
  const auto points = CaptureStage::points(capture, 1, Quantity::velocity_actual);
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_TRUE(points[i].known);
    EXPECT_LE(points[i].at - points[i - 1].at, 2 * CaptureStage::kEach) << "a hole";
  }
}

TEST(Captures, EndWithAReload) {
  CaptureStage stage;
  stage.run(kLong);
  stage.fault(1);
  stage.run(kSecond);
  stage.greet();
  stage.run(kSecond / 2);
  ASSERT_THAT(stage.completed, SizeIs(1));
  EXPECT_LT(stage.completed[0]->to, stage.completed[0]->first().at + 2 * kSecond);
}

TEST(Captures, AreNamedByTheFaultThatTheyAreOfWhileItStands) {
  CaptureStage stage;
  const auto named = [&] { return stage.stores.picture.find(1)->capture; };
  stage.run(kLong);
  stage.fault(1);
  stage.run(CaptureStage::kEach);
  EXPECT_EQ(named(), stage.ids().front()) << "while it is under way";
  stage.run(kOver);
  EXPECT_EQ(named(), stage.ids().front());
  stage.greet();
  stage.run(CaptureStage::kEach);
  EXPECT_EQ(named(), stage.ids().front()) << "after a reload";
  stage.fault(1, false);
  stage.run(CaptureStage::kEach);
  EXPECT_EQ(named(), "");
}

TEST(Captures, IgnoreEventsOfBeforeTheProgram) {
  CaptureStage stage;
  EventRecord old{1, kStarted - 100 * kSecond, 1, static_cast<std::uint8_t>(EventKind::lease), 3, "quick stop"};
  ASSERT_TRUE(stage.stores.take(old, {stage.now, kToUtc}));
  EXPECT_THAT(stage.captures(), IsEmpty());
  stage.event(1, EventKind::lease, 0, "a lease that ended while nothing moved");
  stage.event(1, EventKind::command, 3, "10.0.0.1: quick_stop");
  EXPECT_THAT(stage.captures(), IsEmpty());
}

TEST(Captures, HaveIdsThatNoLaterOneHas) {
  std::string before;
  {
    CaptureStage stage;
    stage.fault(1);
    stage.run(kSecond);
    before = stage.ids().front();
  }
  CaptureStage again;  // the program has started again, the gateway runs on
  again.now += 20 * kSecond;
  again.run(kSecond);
  again.fault(1);
  again.run(kSecond);
  EXPECT_NE(again.ids().front(), before);
  EXPECT_TRUE(is_capture_id(before)) << before;
}

// --- Triggers --------------------------------------------------------------------------------------------------------

struct TriggerRow {
  const char* what;
  Trigger trigger;
  std::vector<std::int64_t> values;
  std::vector<bool> fires;
};

Trigger trigger(TriggerIs is, double min = 0, double max = 0, unsigned bit = 0) {
  return {"t", 1, Quantity::digital_inputs, is, min, max, bit};
}

TEST(Triggers, FireWhereTheirConditionBecomesTrue) {
  const std::vector<TriggerRow> rows{
      {"above", trigger(TriggerIs::above, 5, 5), {5, 6, 7, 5, 6}, {false, true, false, false, true}},
      {"above at first", trigger(TriggerIs::above, 5, 5), {6, 6, 5, 6}, {false, false, false, true}},
      {"below", trigger(TriggerIs::below, -5, -5), {-5, -6, 0, -100}, {false, true, false, true}},
      {"outside", trigger(TriggerIs::outside, -5, 5), {0, 6, -6, 5, -6}, {false, true, false, false, true}},
      {"bit_set", trigger(TriggerIs::bit_set, 0, 0, 3), {0, 8, 12, 4, 8}, {false, true, false, false, true}},
      {"bit_set, the last", trigger(TriggerIs::bit_set, 0, 0, 31), {0, 0xFFFFFFFF}, {false, true}},
      {"bit_clear", trigger(TriggerIs::bit_clear, 0, 0, 0), {1, 2, 0, 3, 4}, {false, true, false, false, true}},
      {"changes", trigger(TriggerIs::changes), {7, 7, 8, 9, 9}, {false, false, true, true, false}},
  };
  for (const TriggerRow& row : rows) {
    TriggerWatch watch(row.trigger);
    for (std::size_t i = 0; i < row.values.size(); ++i)
      EXPECT_EQ(watch.sees(row.values[i], static_cast<double>(row.values[i])), row.fires[i]) << row.what << " " << i;
  }
}

TEST(Triggers, TakeAGapForNeither) {
  CaptureStage stage(with_a_trigger());
  const auto valid = [&](bool is) {
    const std::uint32_t velocity = bit(Quantity::velocity_actual);
    stage.axis(1).valid = is ? stage.axis(1).valid | velocity : stage.axis(1).valid & ~velocity;
    stage.run(kSecond);
  };
  stage.turn(1, 900'000);
  valid(false);
  EXPECT_THAT(stage.captures(), IsEmpty()) << "what is not valid is not looked at";
  valid(true);
  EXPECT_THAT(stage.captures(), SizeIs(1)) << "it was known to be false before";
  stage.run(20 * kSecond);
  valid(false);
  valid(true);
  EXPECT_THAT(stage.captures(), SizeIs(1)) << "it was true before";
}

TEST(Triggers, LookAtTheirOwnAxisInTheUnitOfTheName) {
  CaptureStage stage(with_a_trigger());
  stage.turn(2, 900'000);
  stage.turn(1, 799'990);
  stage.run(kSecond);
  EXPECT_THAT(stage.captures(), IsEmpty());
  stage.turn(1, 800'001);
  stage.run(kSecond);
  ASSERT_THAT(stage.captures(), SizeIs(1));
  EXPECT_EQ(stage.captures().front()->text(), "too fast");
}

}  // namespace
}  // namespace axisgate::web
