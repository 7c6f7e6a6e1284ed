// SPDX-License-Identifier: Apache-2.0
// Captures as programs and pages get them: the list, one of them, its table, and the stream that says that one begins.
#include <gmock/gmock.h>

#include "gateway/upstream/web_process/stream/stream.hpp"
#include "tests/unit/web_process/capture_stage.hpp"

namespace axisgate::web {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class CaptureAnswers : public ::testing::Test {
 protected:
  CaptureAnswers() {
    stage.run(12 * kSecond);
    stage.event(1, EventKind::command, 3, "10.0.0.1: run_velocity");
    stage.fault(1);
  }
  Answer asked(const std::string& target) { return answer(get(target), stage.stores, Served{}, {stage.now, kToUtc}); }
  Json body(const std::string& target) { return body_of(asked(target)); }
  std::string refused(const std::string& target) { return body(target)["detail"].get<std::string>(); }
  std::string csv(const std::string& target) {
    const Answer given = asked(target);
    const auto& response = std::get<Response>(given.what);
    EXPECT_EQ(response.type, "text/csv; charset=utf-8");
    std::string out;
    for (std::string piece = response.pieces(); !piece.empty(); piece = response.pieces()) out += piece;
    return out;
  }
  /// Data of the events of this name.
  std::vector<Json> of_stream(Stream& stream, const std::string& name) {
    feed.update(stage.stores.picture, Served{}, {stage.now, kToUtc});
    std::istringstream in(stream.next(stage.stores, feed, {stage.now, kToUtc}));
    std::vector<Json> out;
    bool is_it = false;
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("event: ")) is_it = line == "event: " + name;
      if (is_it && line.starts_with("data: ")) out.push_back(Json::parse(line.substr(6)));
    }
    return out;
  }

  CaptureStage stage;
  Feed feed;
};

TEST_F(CaptureAnswers, ListThemTheNewestFirst) {
  EXPECT_THAT(body("/api/v1/captures")["captures"], IsEmpty());
  stage.run(kSecond);
  EXPECT_EQ(body("/api/v1/captures")["captures"][0]["complete"], false);
  stage.run(5 * kSecond);
  stage.fault(2);
  stage.run(6 * kSecond);
  const Json captures = body("/api/v1/captures")["captures"];
  ASSERT_THAT(captures, SizeIs(2));
  EXPECT_EQ(captures[0]["axis"], 2);
  EXPECT_EQ(captures[1]["cause"], "fault");
  EXPECT_EQ(captures[1]["name"], "axis 1");
  EXPECT_EQ(captures[1]["at"], "2026-11-28T20:40:12.030000Z");
  EXPECT_EQ(captures[1]["from"], "2026-11-28T20:40:02.030000Z");
  EXPECT_EQ(captures[1]["to"], "2026-11-28T20:40:17.030000Z");
  EXPECT_EQ(captures[1]["complete"], true);
  EXPECT_EQ(refused("/api/v1/captures?x=1"), "x: there are no parameters here");
}

TEST_F(CaptureAnswers, HaveOneWithItsLinesAndEvents) {
  stage.run(6 * kSecond);
  const std::string target = "/api/v1/captures/" + stage.ids().front();
  const Json whole = body(target);
  EXPECT_EQ(whole["id"], stage.ids().front());
  ASSERT_TRUE(whole["series"].contains("1.velocity_rpm"));
  EXPECT_FALSE(whole["series"].contains("2.velocity_rpm")) << "of its own axis, where nobody asks for others";
  const Json first = whole["series"]["1.velocity_rpm"][0];
  EXPECT_EQ(first[0], whole["from"]);
  EXPECT_NEAR(first[1].get<double>(), 1.0, 0.01);
  EXPECT_EQ(whole["events"][0]["text"], "10.0.0.1: run_velocity");
  EXPECT_EQ(whole["events"][0]["axis_name"], "axis 1");
  EXPECT_EQ(whole["axes"][1]["name"], "axis 2");
  const Json some = body(target + "?series=2.velocity_rpm,1.alarms&points=16");
  EXPECT_THAT(some["series"], SizeIs(2));
  EXPECT_LE(some["series"]["2.velocity_rpm"].size(), 3U * 16);
  EXPECT_THAT(refused(target + "?series=9.velocity_rpm"),
              HasSubstr("series: '9.velocity_rpm': axis 9 is not in this capture"));
  EXPECT_THAT(refused(target + "?series=1.alarms,1.alarms"), HasSubstr("'1.alarms' is given twice"));
  EXPECT_THAT(refused(target + "?series=1.speed"), HasSubstr("series: '1.speed' is none"));
  EXPECT_THAT(refused(target + "?points=15"), HasSubstr("points: "));
  EXPECT_EQ(refused(target + "?x"), "x: there is no such parameter; there are: points, series");
}

TEST_F(CaptureAnswers, NameWhatIsNotThere) {
  for (const char* id : {"42.9999", "42.9999.csv", "x", "../../etc/passwd", "42", ".csv"}) {
    const Answer answer = asked("/api/v1/captures/" + std::string(id));
    EXPECT_EQ(status_of(answer), 404U) << id;
    EXPECT_THAT(body_of(answer)["detail"].get<std::string>(), HasSubstr("/api/v1/captures lists")) << id;
  }
}

TEST_F(CaptureAnswers, HaveATableOfEachSample) {
  stage.run(6 * kSecond);
  const std::string target = "/api/v1/captures/" + stage.ids().front() + ".csv";
  std::istringstream in(csv(target + "?series=1.velocity_rpm,2.velocity_rpm&separator=;"));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "time;1.velocity_rpm;2.velocity_rpm;event\r");
  std::size_t rows = 0, events = 0;
  std::string last;
  for (; std::getline(in, line); ++rows) {
    EXPECT_EQ(std::ranges::count(line, ';'), 3) << line;
    EXPECT_GT(line, last) << "times rise";
    events += line.find("run_velocity") != std::string::npos ? 1U : 0U;
    last = line;
  }
  EXPECT_GE(rows, 1500U);
  EXPECT_EQ(events, 1U);
  EXPECT_TRUE(last.starts_with("2026-11-28T20:40:17.030000Z;")) << last;
  EXPECT_THAT(csv(target), HasSubstr("1.velocity_rpm"));
  EXPECT_THAT(refused(target + "?decimal=x"), HasSubstr("decimal: 'x' is none"));
}

TEST_F(CaptureAnswers, HoldAFewThousandEventsAndAreStillAnswered) {
  for (int i = 0; i < 3000; ++i) stage.event(1, EventKind::warning, 0, std::string(500, 'x'));
  stage.run(6 * kSecond);
  EXPECT_LE(stage.captures().front()->events.size(), kMostEvents);
  const Answer answer = asked("/api/v1/captures/" + stage.ids().front());
  EXPECT_TRUE(status_of(answer) == 200 || answer.refused == Refusal::large_answer);
}

TEST_F(CaptureAnswers, GoToStreamsAsTheyBeginAndEnd) {
  StreamRequest request;
  Stream stream(request, stage.stores.picture, stage.now);
  EXPECT_THAT(of_stream(stream, "capture"), IsEmpty());
  stage.run(kSecond);
  auto seen = of_stream(stream, "capture");
  ASSERT_THAT(seen, SizeIs(1));
  EXPECT_EQ(seen[0]["complete"], false);
  EXPECT_EQ(seen[0]["cause"], "fault");
  EXPECT_THAT(of_stream(stream, "capture"), IsEmpty());
  stage.run(6 * kSecond);
  seen = of_stream(stream, "capture");
  ASSERT_THAT(seen, SizeIs(1));
  EXPECT_EQ(seen[0]["complete"], true);
  EXPECT_EQ(seen[0]["id"], stage.ids().front());
  Stream late(request, stage.stores.picture, stage.now);
  EXPECT_THAT(of_stream(late, "capture"), IsEmpty()) << "the list has what was before";
}

TEST_F(CaptureAnswers, AreNamedByTheirAxis) {
  EXPECT_EQ(body("/api/v1/axes/1")["capture"], nullptr);
  stage.run(kSecond);
  EXPECT_EQ(body("/api/v1/axes/1")["capture"], stage.ids().front());
  EXPECT_EQ(body("/api/v1/axes/2")["capture"], nullptr);
}

}  // namespace
}  // namespace axisgate::web
