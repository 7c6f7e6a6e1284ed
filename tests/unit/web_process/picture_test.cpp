// SPDX-License-Identifier: Apache-2.0
// The newest of everything: joined or not, what a hello makes void, exchange times of the last minute.
#include "gateway/upstream/web_process/picture/picture.hpp"

#include <gmock/gmock.h>

#include "tests/unit/web_process/told.hpp"

namespace axisgate::web {
namespace {

TEST(Picture, IsJoinedWhileSomethingIsHeardEachTwoSeconds) {
  Told told;
  EXPECT_TRUE(told.picture().joined(kStarted));
  EXPECT_TRUE(told.picture().joined(kStarted + 2 * kSecond));
  EXPECT_FALSE(told.picture().joined(kStarted + 2 * kSecond + 1));
  told.tell(standing(1), 5 * kSecond);
  EXPECT_TRUE(told.picture().joined(kStarted + 5 * kSecond));
}

TEST(Picture, IsNotJoinedBeforeAllThatWasAnnouncedIsThere) {
  Picture picture;
  HelloRecord hello;
  hello.axes = 1;
  ASSERT_TRUE(picture.take(hello, kStarted));
  EXPECT_FALSE(picture.joined(kStarted));
  AxisInfoRecord info;
  info.axis = 1;
  ASSERT_TRUE(picture.take(info, kStarted));
  EXPECT_TRUE(picture.joined(kStarted));
}

TEST(Picture, IsNotJoinedOnceTheSocketIsClosed) {
  Told told;
  told.picture().close();
  EXPECT_FALSE(told.picture().joined(kStarted));
}

TEST(Picture, IsAliveWhileStatisticsCome) {
  Told told;
  EXPECT_FALSE(told.picture().alive(kStarted));
  told.tell(statistics());
  told.tell(standing(1), 4 * kSecond);
  EXPECT_TRUE(told.picture().alive(kStarted + kSecond));
  EXPECT_FALSE(told.picture().alive(kStarted + 4 * kSecond));
}

TEST(Picture, BeginsFromScratchWithEachHello) {
  Told told;
  told.tell(standing(1));
  told.tell(event(5));
  HelloRecord hello = told.picture().hello();
  hello.axes = hello.buses = 0;
  told.tell(hello);
  EXPECT_TRUE(told.picture().axes().empty());
  EXPECT_TRUE(told.picture().fault_words().empty());
  EXPECT_EQ(told.picture().newest_event(), 5U) << "a reload forgets no event";
  hello.boot = 43;
  told.tell(hello);
  EXPECT_EQ(told.picture().newest_event(), 0U);
}

TEST(Picture, KeepsTheNewest1000EventsOnce) {
  Told told;
  for (std::uint64_t number = 1; number <= 1500; ++number) told.tell(event(number));
  told.tell(event(1500));
  EXPECT_EQ(told.picture().events().size(), 1000U);
  EXPECT_EQ(told.picture().events().front().number, 501U);
}

TEST(Picture, TakesNoRecordOfItsOwn) {
  Picture picture;
  EXPECT_FALSE(picture.take(ReadyRecord{}, kStarted));
  EXPECT_FALSE(picture.take(LogRecord{}, kStarted));
}

TEST(Picture, LeavesAnAxisAloneThatWasNotAnnounced) {
  Told told;
  told.tell(standing(7));
  EXPECT_EQ(told.picture().find(7), nullptr);
}

ExchangeTimes::Counts counts(std::size_t exchange_class, std::size_t bucket, std::uint32_t count) {
  ExchangeTimes::Counts out{};
  out[exchange_class].counts[bucket] = count;
  return out;
}

TEST(ExchangeTimes, AreThoseOfTheLastMinute) {
  ExchangeTimes times;
  times.add(counts(5, 10, 1000), 0);
  EXPECT_FALSE(times.of(5)) << "what was before is not of the last minute";
  auto later = counts(5, 10, 1000);
  later[5].counts[3] = 90;  // 0.4 to 0.8 ms
  later[5].counts[6] = 10;  // 3.2 to 6.4 ms
  times.add(later, kSecond);
  const auto of = times.of(5);
  ASSERT_TRUE(of);
  EXPECT_EQ(of->count, 100U);
  EXPECT_NEAR(of->p50, 0.4 + 0.4 * 50 / 90, 1e-9);
  EXPECT_NEAR(of->p95, 3.2 + 3.2 * 5 / 10, 1e-9);
  EXPECT_NEAR(of->p99, 3.2 + 3.2 * 9 / 10, 1e-9);
  EXPECT_FALSE(times.of(0)) << "no exchange of that class";
  for (SteadyNs second = 2; second <= 61; ++second) times.add(later, second * kSecond);
  EXPECT_FALSE(times.of(5));
}

}  // namespace
}  // namespace axisgate::web
