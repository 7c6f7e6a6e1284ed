// SPDX-License-Identifier: Apache-2.0
// What a recording asks for, and how the answers become one file.
#include <gmock/gmock.h>

#include <map>

#include "gateway/commands/record/plan/pieces.hpp"
#include "gateway/commands/record/plan/request.hpp"

namespace axisgate::commands::record {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr UtcNs kBegin = 1'795'898'400'123'456'000;  // 2026-11-28T20:40:00.123456Z
constexpr UtcNs kMicrosecond = 1'000;
constexpr std::string_view kColumns = "time,1.velocity_rpm,event\r\n";

TEST(RecordPieces, FollowOneAnotherToTheEnd) {
  EXPECT_THAT(pieces_of(0, 12 * kSecond),
              ElementsAre(Piece{0, 5 * kSecond, false}, Piece{5 * kSecond, 10 * kSecond, false},
                          Piece{10 * kSecond, 12 * kSecond, true}));
  EXPECT_THAT(pieces_of(0, 5 * kSecond), ElementsAre(Piece{0, 5 * kSecond, true}));
}

/// A page's history, and how it answers: what holds at the begin, what has changed, and what holds at the end. Its
/// steady clock may count between two microseconds of UTC: then the begin is shown one too early.
struct Page {
  std::map<UtcNs, std::string> values;  ///< empty: a gap begins
  std::map<UtcNs, std::string> events;
  UtcNs early = 0;

  [[nodiscard]] std::string held(UtcNs at) const {
    const auto next = values.upper_bound(at);
    return next == values.begin() ? std::string() : std::prev(next)->second;
  }
  [[nodiscard]] std::string csv(UtcNs from, UtcNs to) const {
    from -= early;
    std::map<UtcNs, std::string> rows{{from, ""}, {to, ""}};
    for (const auto& [at, value] : values)
      if (at >= from && at <= to) rows[at];
    for (const auto& [at, event] : events)
      if (at >= from && at <= to) rows[at] = event;
    std::string out(kColumns);
    for (const auto& [at, event] : rows) out += utc_text(at) + "," + held(at) + "," + event + "\r\n";
    return out;
  }
  [[nodiscard]] std::string joined(UtcNs from, UtcNs to) const {
    Joiner joiner;
    std::string out;
    for (const Piece& piece : pieces_of(from, to))
      out += joiner.take(csv(piece.from, piece.asked_to()), piece).value_or("refused");
    return out;
  }
};

// Before the seam between two pieces, on it, behind it, at the very end: any of them.
TEST(RecordPieces, TogetherAreWhatOneAnswerWouldHaveBeen) {
  const UtcNs seam = kBegin + kLongestPiece;
  const UtcNs end = kBegin + 2 * kLongestPiece;
  for (unsigned chosen = 0; chosen < 1U << 7U; ++chosen) {
    Page page{{{kBegin - kSecond, "1"}}, {}};
    if ((chosen & 1U) != 0) page.values[seam - kMicrosecond] = "2";
    if ((chosen & 2U) != 0) page.values[seam] = "";
    if ((chosen & 4U) != 0) page.values[seam + kMicrosecond] = "3";
    if ((chosen & 8U) != 0) page.events[seam] = "\"fault, cause\r\nand \"\"remedy\"\"\"";
    if ((chosen & 16U) != 0) page.events[seam - kMicrosecond] = "link: online";
    if ((chosen & 32U) != 0) page.values[end] = "4";
    if ((chosen & 64U) != 0) page.early = kMicrosecond;
    EXPECT_EQ(page.joined(kBegin, end), page.csv(kBegin, end)) << chosen;
  }
}

TEST(RecordPieces, OfAnotherKindAreRefused) {
  const std::vector<Piece> pieces = pieces_of(kBegin, kBegin + 2 * kLongestPiece);
  Joiner joiner;
  EXPECT_EQ(joiner.take("<!doctype html>\n", pieces[0]), std::nullopt);
  EXPECT_EQ(joiner.take("", pieces[0]), std::nullopt);
  EXPECT_EQ(joiner.take(kColumns, pieces[0]), kColumns);
  EXPECT_EQ(joiner.take("time,2.velocity_rpm,event\r\n", pieces[1]), std::nullopt) << "a reload took the axis away";
}

TEST(RecordRequest, AnAddressIsThatOfABrowserOrAHostAndPort) {
  const auto authority = [](std::string_view text) {
    const auto place = parse_page_url(text);
    return place ? authority_of(*place) : "none";
  };
  EXPECT_EQ(authority("http://127.0.0.1:8080/"), "127.0.0.1:8080");
  EXPECT_EQ(authority("http://[::1]:8080"), "[::1]:8080");
  EXPECT_EQ(authority("gateway.local:8080"), "gateway.local:8080");
  EXPECT_EQ(authority("http://gateway.local/"), "gateway.local:80");
  for (const char* const none :
       {"gateway.local", "https://127.0.0.1:8080/", "http://127.0.0.1:8080/#/scope", "http://", "http://a:0/", ""}) {
    EXPECT_EQ(authority(none), "none") << none;
    EXPECT_THAT(page_url_mistake(none), HasSubstr("write http://127.0.0.1:8080/"));
  }
}

TEST(RecordRequest, AsksForWhatWasNamedOrForWhatThereIsRoomFor) {
  EXPECT_EQ(series_of({1, 3}, "velocity_rpm,statusword"), "1.velocity_rpm,1.statusword,3.velocity_rpm,3.statusword");
  EXPECT_EQ(series_of({7}, ""), "7.position_rev,7.velocity_rpm,7.torque_percent,7.current_a,7.axis_state");
  EXPECT_EQ(count_of(series_of({1, 2, 3, 4}, "")), kMostSeries);
  EXPECT_EQ(count_of(series_of(std::vector<std::uint16_t>(16, 1), "")), kMostSeries);
  EXPECT_GT(count_of(series_of(std::vector<std::uint16_t>(17, 1), "")), kMostSeries);
  EXPECT_EQ(
      csv_target("1.velocity_rpm", {kBegin, kBegin + kSecond, true}),
      "/api/v1/history.csv?series=1.velocity_rpm&from=2026-11-28T20:40:00.123456Z&to=2026-11-28T20:40:01.123456Z");
  EXPECT_EQ(series_mistake("velocity_rpm,axis_state"), "");
  for (const char* const none : {"1.velocity_rpm", "velocity_rpm,", "velocity_rpm, axis_state", "a&to=b"})
    EXPECT_THAT(series_mistake(none), HasSubstr("is no name of a value")) << none;
}

TEST(RecordRequest, BelievesAnAnswerOfThePageAlone) {
  const auto state = page_state(R"({"at":"2026-11-28T20:40:00.123456Z","joined":true,"name":"cell"})");
  ASSERT_TRUE(state);
  EXPECT_EQ(state->at, kBegin);
  EXPECT_TRUE(state->joined);
  for (const char* const other :
       {"", "null", "[]", "hello", R"({"at":"2026-11-28T20:40:00.123456Z"})", R"({"at":5,"joined":true})",
        R"({"at":"2026-11-28T20:40:00.123456Z","joined":"yes"})"})
    EXPECT_FALSE(page_state(other)) << other;
  EXPECT_EQ(oldest_of(R"({"oldest":"2026-11-28T20:40:00.123456Z"})"), kBegin);
  EXPECT_EQ(oldest_of(R"({"oldest":null})"), std::nullopt);
  EXPECT_EQ(detail_of(R"({"status":400,"detail":"axis: there is no axis 77"})"), "axis: there is no axis 77");
  EXPECT_EQ(detail_of("<html>"), "");
}

}  // namespace
}  // namespace axisgate::commands::record
