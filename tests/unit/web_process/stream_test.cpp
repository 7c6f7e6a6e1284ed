// SPDX-License-Identifier: Apache-2.0
// What a page is told: whole at first, then what changed; a slow one less often and never what is old.
#include "gateway/upstream/web_process/stream/stream.hpp"

#include <gmock/gmock.h>

#include "gateway/upstream/web_process/stream/taken_watch.hpp"
#include "tests/unit/web_process/told.hpp"

namespace axisgate::web {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Frame {
  std::string event;
  std::string id;
  Json data;
};

std::vector<Frame> frames_of(const std::string& text) {
  std::vector<Frame> out;
  Frame frame;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("event: ")) frame.event = line.substr(7);
    if (line.starts_with("id: ")) frame.id = line.substr(4);
    if (line.starts_with("data: ")) frame.data = Json::parse(line.substr(6));
    if (line.empty() && !frame.event.empty()) out.push_back(std::exchange(frame, {}));
  }
  return out;
}

/// A page at a stream, and what it shows: what it was told, put together.
class Page {
 public:
  explicit Page(Told& told, StreamRequest request = {})
      : told_(told), stream_(std::move(request), told.picture(), kStarted) {}

  /// All that is due; the events of the frames.
  std::vector<std::string> read(SteadyNs after_start) {
    feed_.update(told_.picture(), served_, at(after_start));
    std::vector<std::string> events;
    for (;;) {
      text_ = stream_.next(told_.stores(), feed_, at(after_start));
      if (text_.empty()) return events;
      bytes_ += text_.size();
      longest_ = std::max(longest_, text_.size());
      for (Frame& frame : frames_of(text_)) {
        events.push_back(frame.event);
        if (frame.event == "axes") take_axes(frame.data);
        last_ = std::move(frame);
      }
      if (text_ == ":\n\n") events.emplace_back("comment");
    }
  }
  [[nodiscard]] const Json& axis(const std::string& number) { return axes_[number]; }
  [[nodiscard]] std::size_t axes() const { return axes_.size(); }
  [[nodiscard]] const Frame& last() const { return last_; }
  /// As it came in the last frame of axes.
  [[nodiscard]] const Json& changed() const { return changed_; }
  [[nodiscard]] std::size_t longest() const { return longest_; }

 private:
  void take_axes(const Json& data) {
    changed_ = data["axes"];
    for (const Json& each : data["axes"]) {
      Json& into = axes_[each["axis"].dump()];
      for (const auto& [name, value] : each.items()) {
        if (name != "values" && name != "last" && name != "limits") into[name] = value;
        if (name != "values" && name != "last" && name != "limits") continue;
        if (!into.contains(name)) into[name] = Json::object();
        for (const auto& [inside, of_it] : value.items()) {
          if (name == "last" && of_it.is_null())
            into[name].erase(inside);
          else
            into[name][inside] = of_it;
        }
      }
    }
  }
  Told& told_;
  Served served_{};
  Feed feed_;
  Stream stream_;
  std::string text_;
  Frame last_;
  Json changed_;
  std::map<std::string, Json> axes_;
  std::size_t bytes_ = 0;
  std::size_t longest_ = 0;
};

/// Whatever the order of its members.
nlohmann::json unordered(const Json& json) { return nlohmann::json::parse(json.dump()); }

TEST(Stream, BeginsWithHelloAndEverythingWhole) {
  Told told;
  told.tell(standing(1));
  told.tell(standing(3));
  told.tell(statistics());
  Page page(told);
  EXPECT_THAT(page.read(0), ElementsAre("hello", "axes", "buses", "gateway"));
  EXPECT_EQ(unordered(page.axis("1")), unordered(told.axis(1)));
  EXPECT_EQ(unordered(page.axis("3")), unordered(told.axis(3)));
}

TEST(Stream, SaysAfterwardsWhatChangedAlone) {
  Told told;
  told.tell(standing(1));
  told.tell(standing(3));
  Page page(told);
  page.read(0);
  AxisSample sample = standing(1);
  set(sample, Quantity::velocity_actual, 5000);
  told.tell(sample, 100 * kMillisecond);
  EXPECT_THAT(page.read(100 * kMillisecond), ElementsAre("axes"));
  EXPECT_EQ(page.changed().dump(), R"([{"axis":1,"values":{"velocity_rpm":5.0}}])");
  EXPECT_EQ(unordered(page.axis("1")), unordered(told.axis(1, 100 * kMillisecond)));
}

TEST(Stream, MergesForASlowPageAndTellsItNothingOld) {
  Told told;
  told.tell(standing(1));
  Page page(told);
  page.read(0);
  for (int i = 1; i <= 50; ++i) {
    AxisSample sample = standing(1);
    set(sample, Quantity::velocity_actual, i * 1000);
    set(sample, Quantity::torque_actual, i == 10 ? 55 : 0);
    told.tell(sample, i * 10 * kMillisecond);
  }
  // It could not be sent anything meanwhile.
  EXPECT_THAT(page.read(500 * kMillisecond), ElementsAre("axes"));
  EXPECT_EQ(page.axis("1")["values"]["velocity_rpm"], 50.0);
  EXPECT_EQ(page.axis("1")["values"]["torque_percent"], 0.0);
}

TEST(Stream, KeepsItsPeriod) {
  Told told;
  StreamRequest request;
  request.period_ms = 500;
  Page page(told, request);
  page.read(0);
  int frames = 0;
  for (SteadyNs now = 50; now < 2000; now += 50) {
    AxisSample sample = standing(1);
    set(sample, Quantity::velocity_actual, static_cast<std::int32_t>(now));
    told.tell(sample, now * kMillisecond);
    for (const std::string& each : page.read(now * kMillisecond)) frames += each == "axes" ? 1 : 0;
  }
  EXPECT_EQ(frames, 3);
}

TEST(Stream, TellsTheAxesAskedForAlone) {
  Told told;
  StreamRequest request;
  request.axes = {3};
  Page page(told, request);
  page.read(0);
  EXPECT_EQ(page.axes(), 1U);
  EXPECT_EQ(page.axis("3")["name"], "turn");
}

TEST(Stream, SaysThatTheGatewayIsNotSeen) {
  Told told;
  told.tell(standing(1));
  Page page(told);
  page.read(0);
  page.read(2500 * kMillisecond);
  EXPECT_EQ(page.axis("1")["joined"], false);
  EXPECT_TRUE(page.axis("1")["values"]["position_rev"].is_null());
  EXPECT_EQ(page.axis("1")["last"]["position_rev"]["value"], 1.5);
  told.tell(standing(1), 3 * kSecond);
  page.read(3 * kSecond);
  EXPECT_EQ(page.axis("1")["values"]["position_rev"], 1.5);
  EXPECT_TRUE(page.axis("1")["last"].empty()) << "what is good again stands in `last` no more";
}

TEST(Stream, BeginsWithEventsFromNow) {
  Told told;
  told.tell(event(1));
  Page page(told);
  EXPECT_THAT(page.read(0), testing::Not(testing::Contains("event")));
  told.tell(event(2), kMillisecond);
  EXPECT_THAT(page.read(kMillisecond), ElementsAre("event"));
  EXPECT_EQ(page.last().id, "42.2");
}

TEST(Stream, GoesOnBehindTheLastEventThatAPageHas) {
  Told told;
  for (std::uint64_t number = 1; number <= 5; ++number) told.tell(event(number));
  StreamRequest request;
  request.after = 3;
  Page page(told, request);
  const auto read = page.read(0);
  EXPECT_EQ(std::ranges::count(read, "event"), 2);
}

TEST(Stream, BeginsFromScratchAfterAReload) {
  Told told;
  told.tell(standing(1));
  Page page(told);
  page.read(0);
  HelloRecord hello = told.picture().hello();
  hello.axes = 1;
  told.tell(hello, kSecond);
  EXPECT_THAT(page.read(kSecond), ElementsAre("comment")) << "what is announced is not there yet";
  BusInfoRecord bus;
  told.tell(bus, kSecond);
  AxisInfoRecord info;
  info.axis = 9;
  told.tell(info, kSecond);
  EXPECT_THAT(page.read(1100 * kMillisecond), ElementsAre("hello", "axes", "buses", "gateway"));
  EXPECT_EQ(page.changed()[0]["axis"], 9);
}

TEST(Stream, SendsManyAxesInSeveralFrames) {
  Told told;
  HelloRecord hello = told.picture().hello();
  hello.axes = 300;
  told.tell(hello);
  for (std::uint16_t axis = 1; axis <= 300; ++axis) {
    AxisInfoRecord info;
    info.axis = axis;
    told.tell(info);
  }
  told.tell(BusInfoRecord{});
  Page page(told);
  const auto events = page.read(0);
  EXPECT_GT(std::ranges::count(events, "axes"), 3);
  EXPECT_EQ(page.axes(), 300U);
  EXPECT_LT(page.longest(), 80U * 1024U);
}

TEST(Stream, SaysEachSecondThatItLives) {
  Told told;
  Page page(told);
  page.read(0);
  EXPECT_THAT(page.read(20 * kMillisecond), IsEmpty());
  const Stores nothing(1024);
  Stream stream({}, nothing.picture, kStarted);
  Feed feed;
  EXPECT_EQ(stream.next(nothing, feed, at(999 * kMillisecond)), "");
  EXPECT_EQ(stream.next(nothing, feed, at(kSecond)), ":\n\n");
}

/// What a page with one line has been sent of it.
struct Drawn {
  explicit Drawn(Told& told, std::vector<Series> series = {{1, static_cast<std::uint8_t>(Quantity::velocity_actual)}})
      : told_of(told), scope(std::move(series), kStarted) {}
  /// How many samples came; -1: no event.
  int read(SteadyNs after_start) {
    const std::string text = scope.next(told_of.stores(), at(after_start));
    if (text.empty()) return -1;
    last = Json::parse(text);
    longest = std::max(longest, text.size());
    int out = 0;
    for (const auto& [name, samples] : last["series"].items()) {
      if (name == "1.velocity_rpm")
        for (const Json& each : samples) all.push_back(each[1].is_null() ? -1.0 : each[1].get<double>());
      out += static_cast<int>(samples.size());
    }
    return out;
  }
  Told& told_of;
  Scope scope;
  Json last;
  std::vector<double> all;
  std::size_t longest = 0;
};

void tell_velocity(Told& told, std::int32_t velocity, SteadyNs after_start, std::uint32_t age_us = 0) {
  AxisSample sample = standing(1);
  sample.values.clear();
  set(sample, Quantity::velocity_actual, velocity, age_us);
  told.tell(sample, after_start);
}

TEST(Scope, SendsEachSampleOnce) {
  Told told;
  Drawn drawn(told);
  EXPECT_EQ(drawn.read(0), -1);
  tell_velocity(told, 1000, 10 * kMillisecond, 500);
  tell_velocity(told, 2000, 20 * kMillisecond, 500);
  EXPECT_EQ(drawn.read(20 * kMillisecond), 2);
  EXPECT_EQ(drawn.last.dump(),
            R"({"from":"2026-11-28T20:40:00.009500Z","series":{"1.velocity_rpm":[[0,1.0],[10,2.0]]}})");
  EXPECT_EQ(drawn.read(25 * kMillisecond), -1);
  // One that was right before the event was made, and came afterwards.
  tell_velocity(told, 3000, 30 * kMillisecond, 8000);
  EXPECT_EQ(drawn.read(30 * kMillisecond), 1);
  for (int i = 4; i < 100; ++i) tell_velocity(told, i * 1000, i * 10 * kMillisecond);
  EXPECT_EQ(drawn.read(kSecond), 96) << "a slow page is sent all of it, later";
  ASSERT_EQ(drawn.all.size(), 99U);
  for (std::size_t i = 0; i < drawn.all.size(); ++i) EXPECT_EQ(drawn.all[i], static_cast<double>(i + 1));
}

TEST(Scope, BeginsAGapWithNull) {
  Told told;
  Drawn drawn(told);
  tell_velocity(told, 1000, 10 * kMillisecond);
  AxisSample mute = standing(1);
  mute.valid = 0;
  told.tell(mute, 20 * kMillisecond);
  drawn.read(30 * kMillisecond);
  tell_velocity(told, 2000, 40 * kMillisecond);
  drawn.read(40 * kMillisecond);
  EXPECT_THAT(drawn.all, ElementsAre(1.0, -1.0, 2.0));
}

TEST(Scope, LosesNoSpikeWhereMoreCameThanAFrameTakes) {
  Told told;
  std::vector<Series> series;
  for (std::uint8_t name = 0; name < 16; ++name) series.push_back({1, name});
  Drawn drawn(told, series);
  for (int i = 1; i <= 1000; ++i) {
    AxisSample sample = standing(1);
    sample.values.clear();
    for (std::uint8_t name = 0; name < 16; ++name)
      sample.values.push_back({name, name == 3 && i == 777 ? 123456 : i % 50 * 1000, 0});
    told.tell(sample, i * 10 * kMillisecond);
  }
  EXPECT_LE(drawn.read(10 * kSecond), static_cast<int>(Scope::kMostPoints));
  EXPECT_LT(drawn.longest, kFrame);
  EXPECT_EQ(std::ranges::count(drawn.all, 123.456), 1);
  EXPECT_GT(drawn.all.size(), 40U);
}

TEST(Scope, KeepsGapsOfWhatIsThinnedOut) {
  std::vector<Point> points;
  for (SteadyNs at = 0; at < 1000; ++at) points.push_back({at, at % 7, at % 100 != 50});
  const auto left = thinned(points, 100);
  EXPECT_LE(left.size(), 100U);
  for (SteadyNs gap = 50; gap < 1000; gap += 100) {
    const auto behind = std::ranges::upper_bound(left, gap, {}, &Point::at);
    ASSERT_NE(behind, left.begin());
    EXPECT_FALSE(std::prev(behind)->known) << "between what was before " << gap << " and what is behind it";
  }
  EXPECT_EQ(thinned(points, 1000), points);
}

TEST(Stream, BringsLinesAtItsPeriodFromOnePeriodAgo) {
  Told told;
  for (int i = 0; i < 50; ++i) tell_velocity(told, i * 1000, (i - 49) * 10 * kMillisecond);
  StreamRequest request;
  request.period_ms = 200;
  request.series = {{1, static_cast<std::uint8_t>(Quantity::velocity_actual)}};
  Page page(told, request);
  EXPECT_THAT(page.read(0), ElementsAre("hello", "axes", "scope", "buses", "gateway"));
  tell_velocity(told, 60000, 100 * kMillisecond);
  EXPECT_THAT(page.read(150 * kMillisecond), IsEmpty());
  EXPECT_THAT(page.read(200 * kMillisecond), ElementsAre("axes", "scope"));
  EXPECT_EQ(page.last().data["series"]["1.velocity_rpm"].dump(), "[[0,60.0]]");
}

TEST(Stream, SaysWhyItEnds) {
  EXPECT_EQ(Stream::bye("the gateway has ended"), "event: bye\ndata: {\"why\":\"the gateway has ended\"}\n\n");
}

TEST(TakenWatch, EndsAPageThatHasAcknowledgedNothingFor10Seconds) {
  TakenWatch watch(0);
  watch.sent(1000);
  EXPECT_FALSE(watch.stuck(1000, true, 9 * kSecond));
  EXPECT_TRUE(watch.stuck(1000, true, 10 * kSecond));
}

TEST(TakenWatch, LeavesASlowPageAlone) {
  TakenWatch watch(0);
  watch.sent(1000);
  for (int i = 1; i <= 9; ++i) EXPECT_FALSE(watch.stuck(static_cast<std::size_t>(1000 - i), true, i * 9 * kSecond));
}

TEST(TakenWatch, LeavesAPageAloneThatHasTakenEverything) {
  TakenWatch watch(0);
  watch.sent(10);
  EXPECT_FALSE(watch.stuck(0, false, 100 * kSecond));
  EXPECT_FALSE(watch.stuck(0, false, 200 * kSecond));
}

}  // namespace
}  // namespace axisgate::web
