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
      text_ = stream_.next(told_.picture(), feed_, at(after_start));
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
  Picture nothing;
  Stream stream({}, nothing, kStarted);
  Feed feed;
  EXPECT_EQ(stream.next(nothing, feed, at(999 * kMillisecond)), "");
  EXPECT_EQ(stream.next(nothing, feed, at(kSecond)), ":\n\n");
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
