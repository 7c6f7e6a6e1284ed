// SPDX-License-Identifier: Apache-2.0
// What was: the same as a list of all samples would say, in a hundredth of its room; gaps; and how old things go.
#include "gateway/upstream/web_process/history/history.hpp"

#include <gmock/gmock.h>

#include <random>

#include "gateway/upstream/web/web_settings.hpp"
#include "gateway/upstream/web_process/history/slices.hpp"
#include "tests/unit/web_process/told.hpp"

namespace axisgate::web {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::size_t kRoom = std::size_t{4} << 20;
constexpr SteadyNs kTick = 10 * kMillisecond;
constexpr Series kVelocity{1, static_cast<std::uint8_t>(Quantity::velocity_actual)};
constexpr Series kPosition{1, static_cast<std::uint8_t>(Quantity::position_actual)};

static_assert(sizeof(Chunk) <= kHistoryBytes * Chunk::kRuns, "what check reckons with");

AxisInfoRecord axis_info(std::uint16_t axis) {
  AxisInfoRecord out;
  out.axis = axis;
  out.name = "axis " + std::to_string(axis);
  return out;
}

/// A gateway that tells a history, with axes 1 to `axes`.
class Past {
 public:
  explicit Past(std::size_t bytes = kRoom, std::uint16_t axes = 1) : history(bytes) {
    hello(1);
    for (std::uint16_t axis = 1; axis <= axes; ++axis) history.take(axis_info(axis));
  }
  void hello(std::uint64_t boot) {
    HelloRecord record;
    record.boot = boot;
    history.take(record);
  }
  /// The next packet, of these.
  void tell(std::vector<AxisSample> samples, SteadyNs at) {
    SamplesRecord record;
    record.at = kStarted + at;
    record.gaps = gaps;
    record.axes = std::move(samples);
    history.take(record);
  }
  /// Of axis 1, this one value; everything is valid.
  void tell(Quantity quantity, std::int32_t value, SteadyNs at, std::uint32_t age_us = 0) {
    tell({sample(1, quantity, value, age_us)}, at);
  }
  static AxisSample sample(std::uint16_t axis, Quantity quantity, std::int32_t value, std::uint32_t age_us = 0) {
    AxisSample out;
    out.axis = axis;
    out.supported = out.valid = UINT32_MAX;
    set(out, quantity, value, age_us);
    return out;
  }
  [[nodiscard]] std::vector<Point> points(Series series, SteadyNs from, SteadyNs to) const {
    std::vector<Point> out;
    history.each(series, kStarted + from, kStarted + to, [&](Point point) {
      point.at -= kStarted;
      out.push_back(point);
      return true;
    });
    return out;
  }
  History history;
  std::uint32_t gaps = 0;
};

Point value(SteadyNs at, std::int64_t number) { return {at, number, true}; }
Point gap(SteadyNs at) { return {at, 0, false}; }

TEST(History, HasTheInstantAtWhichAValueWasRight) {
  Past past;
  past.tell(Quantity::velocity_actual, 5, 20 * kMillisecond, 1500);
  past.tell(Quantity::velocity_actual, -7, 30 * kMillisecond, 250);
  EXPECT_THAT(past.points(kVelocity, 0, kSecond), ElementsAre(value(18'500'000, 5), value(29'750'000, -7)));
  EXPECT_THAT(past.points(kVelocity, 20 * kMillisecond, kSecond),
              ElementsAre(value(20'000'000, 5), value(29'750'000, -7)))
      << "at first what holds";
  EXPECT_THAT(past.points(kVelocity, 0, 10 * kMillisecond), IsEmpty());
  EXPECT_THAT(past.points({9, 3}, 0, kSecond), IsEmpty()) << "there is no such axis";
}

TEST(History, KeepsFirstAndLastSampleOfWhatStands) {
  Past past;
  for (SteadyNs at = 0; at <= kSecond; at += kTick) past.tell(Quantity::velocity_actual, 0, at);
  past.tell(Quantity::velocity_actual, 9, kSecond + kTick);
  EXPECT_THAT(past.points(kVelocity, 0, 2 * kSecond),
              ElementsAre(value(0, 0), value(kSecond, 0), value(kSecond + kTick, 9)));
  EXPECT_THAT(past.points(kVelocity, 0, kSecond / 2), ElementsAre(value(0, 0), value(kSecond / 2, 0)));
}

TEST(History, HasStatesAndBitsAsTheyAre) {
  Past past;
  AxisSample sample = Past::sample(1, Quantity::vendor_error, -1);
  sample.alarms = 0x80000001;
  sample.axis_state = 5;
  past.tell({sample}, 0);
  EXPECT_THAT(past.points(*parse_series("1.vendor_error"), 0, kTick), ElementsAre(value(0, 0xFFFFFFFF)));
  EXPECT_THAT(past.points(*parse_series("1.alarms"), 0, kTick), ElementsAre(value(0, 0x80000001)));
  EXPECT_THAT(past.points(*parse_series("1.axis_state"), 0, kTick), ElementsAre(value(0, 5)));
}

TEST(History, HasAGapWhereAValueIsNotValid) {
  Past past;
  past.tell(Quantity::velocity_actual, 5, 0);
  AxisSample mute = Past::sample(1, Quantity::velocity_actual, 6);
  mute.valid &= ~bit(Quantity::velocity_actual);
  past.tell({mute}, kTick);
  past.tell({mute}, 2 * kTick);
  past.tell(Quantity::position_actual, 1, 3 * kTick);
  past.tell(Quantity::velocity_actual, 7, 4 * kTick);
  EXPECT_THAT(past.points(kVelocity, 0, kSecond),
              ElementsAre(value(0, 5), gap(kTick), value(3 * kTick, 5), value(4 * kTick, 7)))
      << "valid again without another sample, it is what it was";
  EXPECT_THAT(past.points(kVelocity, 2 * kTick, kSecond).front(), gap(2 * kTick));
}

TEST(History, HasAGapWhereAnAxisIsNotHeard) {
  Past past;
  past.tell(Quantity::velocity_actual, 5, 0);
  past.tell(Quantity::position_actual, 1, 500 * kMillisecond);
  EXPECT_THAT(past.points(kVelocity, 0, kSecond), ElementsAre(value(0, 5))) << "it was heard";
  const SteadyNs silent = 500 * kMillisecond + 1000;
  EXPECT_THAT(past.points(kVelocity, 0, 3 * kSecond), ElementsAre(value(0, 5), gap(silent)));
  EXPECT_THAT(past.points(kVelocity, 2 * kSecond, 3 * kSecond), ElementsAre(gap(2 * kSecond)));
  past.tell(Quantity::velocity_actual, 5, 3 * kSecond);
  EXPECT_THAT(past.points(kVelocity, 0, 3 * kSecond), ElementsAre(value(0, 5), gap(silent), value(3 * kSecond, 5)));
}

TEST(History, HasAGapWhereSamplesHadNoRoom) {
  Past past;
  past.tell(Quantity::velocity_actual, 5, 0);
  past.tell(Quantity::position_actual, 1, kTick);
  past.gaps = 3;
  past.tell(Quantity::velocity_actual, 5, 2 * kTick);
  past.tell(Quantity::velocity_actual, 5, 3 * kTick);
  EXPECT_THAT(past.points(kVelocity, 0, kSecond),
              ElementsAre(value(0, 5), gap(1000), value(2 * kTick, 5), value(3 * kTick, 5)));
  EXPECT_THAT(past.points(kPosition, 0, kSecond), ElementsAre(value(kTick, 1))) << "nothing of it was lost";
}

TEST(History, KeepsWhatAReloadKeeps) {
  Past past(kRoom, 2);
  past.tell({Past::sample(1, Quantity::velocity_actual, 5), Past::sample(2, Quantity::velocity_actual, 6)}, 0);
  past.hello(1);
  past.history.take(axis_info(1));
  AxisInfoRecord other = axis_info(2);
  other.units_numerator = 65536;
  past.history.take(other);
  EXPECT_THAT(past.points(kVelocity, 0, kTick), ElementsAre(value(0, 5)));
  EXPECT_THAT(past.points({2, kVelocity.name}, 0, kTick), IsEmpty()) << "another axis under the same number";
  past.hello(2);
  EXPECT_THAT(past.points(kVelocity, 0, kTick), IsEmpty()) << "another start of the gateway";
  EXPECT_EQ(past.history.oldest(), 0);
  EXPECT_EQ(past.history.bytes(), 0U);
}

/// All samples, as they came: what a history must not differ from.
class Naive {
 public:
  void add(Point point) {
    if (points_.empty() || point.known || points_.back().known) points_.push_back(point);
  }
  /// What held then; none: nothing was known yet.
  [[nodiscard]] std::optional<Point> at(SteadyNs instant) const {
    const auto next = std::ranges::upper_bound(points_, instant, {}, &Point::at);
    return next == points_.begin() ? std::nullopt : std::optional(*std::prev(next));
  }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }

 private:
  std::vector<Point> points_;
};

/// What held then, of points that are only those that there must be.
std::optional<Point> held_at(const std::vector<Point>& points, SteadyNs instant) {
  const auto next = std::ranges::upper_bound(points, instant, {}, &Point::at);
  return next == points.begin() ? std::nullopt : std::optional(*std::prev(next));
}

TEST(History, SaysWhatAListOfAllSamplesSays) {
  std::mt19937 random(42);
  const auto one_of = [&](int many) { return static_cast<int>(random() % static_cast<unsigned>(many)); };
  Past past;
  Naive naive;
  SteadyNs now = 0;
  bool valid = true;
  std::int32_t number = 0;
  for (int i = 0; i < 5000; ++i) {
    now += kTick;
    if (one_of(40) == 0) valid = !valid;
    if (one_of(3) == 0) number = one_of(5) - 2;
    const auto age = static_cast<std::uint32_t>(one_of(9000));
    AxisSample sample = Past::sample(1, Quantity::velocity_actual, number, age);
    if (!valid) sample.valid = 0;
    past.tell({sample}, now);
    naive.add(valid ? value(now - age * SteadyNs{1000}, number) : gap(now));
  }
  for (int i = 0; i < 1000; ++i) {
    const SteadyNs from = one_of(5000) * kTick + one_of(10) * kMillisecond;
    const auto to = std::min(now, from + one_of(300) * kTick);
    const std::vector<Point> said = past.points(kVelocity, from, to);
    // At each instant at which anything was told, in the middle between two, and at both ends.
    std::vector<SteadyNs> instants{from, to};
    for (const Point& point : naive.points())
      if (point.at > from && point.at < to) instants.insert(instants.end(), {point.at, point.at - 500});
    for (const SteadyNs instant : instants) {
      const auto expected = naive.at(instant), is = held_at(said, instant);
      ASSERT_EQ(is.has_value() && is->known, expected.has_value() && expected->known) << from << " " << instant;
      if (expected && expected->known) {
        ASSERT_EQ(is->value, expected->value) << from << " " << instant;
      }
    }
    for (std::size_t k = 1; k < said.size(); ++k) ASSERT_LT(said[k - 1].at, said[k].at);
  }
  EXPECT_LT(past.history.bytes(), naive.points().size() * sizeof(web::Run));
}

TEST(History, HoldsADayWithinItsBound) {
  Past past;
  constexpr SteadyNs kDay = 24 * 3600 * kSecond;
  // It moves for three seconds of each minute, at 100 Hz; else it is told four times a second that it stands.
  SteadyNs now = 0;
  std::int32_t turns = 0;
  while (now < kDay) {
    for (int i = 0; i < 300; ++i) past.tell(Quantity::position_actual, ++turns, now += kTick);
    for (int i = 0; i < 4 * 57; ++i) past.tell(Quantity::velocity_actual, 0, now += 250 * kMillisecond);
  }
  EXPECT_LE(past.history.bytes(), kRoom);
  const SteadyNs held = past.history.newest() - past.history.oldest();
  EXPECT_GT(held, kDay / 10) << "what stands takes no room";
  EXPECT_THAT(past.points(*parse_series("1.axis_state"), 0, now).front().value, 0);
}

TEST(History, ForgetsTheOldestOfAllFirst) {
  Past past(std::size_t{64} << 10, 3);
  SteadyNs now = 0;
  // One moves fast, one ten times more slowly; one was told once and stands since.
  past.tell({Past::sample(3, Quantity::position_actual, 77)}, now);
  for (std::int32_t i = 1; i < 20000; ++i) {
    std::vector<AxisSample> samples{Past::sample(1, Quantity::position_actual, i)};
    if (i % 10 == 0) samples.push_back(Past::sample(2, Quantity::position_actual, i));
    if (i % 25 == 0) samples.push_back(Past::sample(3, Quantity::velocity_actual, 0));
    past.tell(std::move(samples), now += kTick);
  }
  EXPECT_LE(past.history.bytes(), std::size_t{64} << 10);
  const SteadyNs oldest = past.history.oldest() - kStarted;
  EXPECT_GT(oldest, 0);
  for (const std::uint16_t axis : {std::uint16_t{1}, std::uint16_t{2}}) {
    const auto points = past.points({axis, kPosition.name}, 0, now);
    ASSERT_FALSE(points.empty());
    EXPECT_GE(points.front().at, oldest - 32 * 10 * kTick) << axis;
    EXPECT_LE(points.front().at, oldest + 10 * kTick) << axis << ": all reach back equally far";
  }
  EXPECT_THAT(past.points({3, kPosition.name}, oldest, now), testing::Contains(testing::Field(&Point::value, 77)))
      << "what it is stays, however long ago it was told";
}

TEST(History, SeriesHaveTheNamesOfTheApi) {
  for (std::uint8_t name = 0; name < kSeriesNames; ++name) {
    const Series series{499, name};
    EXPECT_EQ(parse_series(series_text(series)), series);
  }
  EXPECT_EQ(series_text(kVelocity), "1.velocity_rpm");
  for (const char* const none : {"", "1", "1.", ".velocity_rpm", "x.velocity_rpm", "1.speed", "-1.velocity_rpm",
                                 "1 .velocity_rpm", "70000.velocity_rpm", "1.velocity_rpm "})
    EXPECT_EQ(parse_series(none), std::nullopt) << none;
}

// --- Slices ----------------------------------------------------------------------------------------------------------

std::vector<Slice> sliced(const std::vector<Point>& points, SteadyNs from, SteadyNs to, std::size_t count) {
  const EachPoint each = [&](Series, SteadyNs, SteadyNs, const Visit& visit) {
    for (const Point& point : points)
      if (!visit(point)) return;
  };
  return slices(each, kVelocity, from, to, count);
}

TEST(Slices, LoseNoSpikeHoweverFewTheyAre) {
  Past past;
  for (SteadyNs at = 0; at <= 60 * kSecond; at += kTick)
    past.tell(Quantity::velocity_actual, at == 31 * kSecond ? 900 : static_cast<std::int32_t>(at / kTick % 7), at);
  const EachPoint each = [&](Series series, SteadyNs from, SteadyNs to, const Visit& visit) {
    past.history.each(series, from, to, visit);
  };
  for (const std::size_t count : {16U, 17U, 100U, 999U, 4000U}) {
    const auto all = slices(each, kVelocity, kStarted, kStarted + 60 * kSecond, count);
    EXPECT_LE(all.size(), count);
    std::int64_t low = 900, high = 0;
    for (const Slice& slice : all) low = std::min(low, slice.low), high = std::max(high, slice.high);
    EXPECT_EQ(high, 900) << count;
    EXPECT_EQ(low, 0) << count;
  }
}

TEST(Slices, KeepGapsApart) {
  using S = Slice;
  EXPECT_THAT(sliced({}, 0, 160, 16), ElementsAre(S{0, 0, 0, false}));
  EXPECT_THAT(sliced({value(55, 3)}, 0, 160, 16), ElementsAre(S{0, 0, 0, false}, S{50, 3, 3, true}));
  EXPECT_THAT(
      sliced({value(0, 3), gap(12), value(57, 4), gap(58), value(160, 5)}, 0, 160, 16),
      ElementsAre(S{0, 3, 3, true}, S{10, 0, 0, false}, S{50, 4, 4, true}, S{50, 0, 0, false}, S{150, 5, 5, true}));
  EXPECT_THAT(sliced({value(0, 3), value(11, 4), gap(12), value(13, 2), gap(14)}, 0, 160, 16),
              ElementsAre(S{0, 3, 3, true}, S{10, 2, 4, true}, S{10, 0, 0, false}));
}

}  // namespace
}  // namespace axisgate::web
