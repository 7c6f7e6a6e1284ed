// SPDX-License-Identifier: Apache-2.0
// What axisgate-web is sent, and when.
#include "gateway/upstream/web/web_session.hpp"

#include <gmock/gmock.h>

#include "gateway/image/command.hpp"

namespace axisgate::web {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;
using testing::SizeIs;

constexpr Instant kStart = kLongAgo + std::chrono::hours(1);

class Pages : public testing::Test {
 protected:
  void configure(AxisNumber axes) {
    facts = {};
    for (AxisNumber number = 1; number <= axes; ++number) {
      if (image.find(number) == nullptr) add(number);
      facts.axes.push_back({number, "Kinco JD", "kinco-jd", number});
    }
    facts.buses = {{0, "lift", "canopen", "can0, 500 kbit/s", 120, 8}};
    facts.fault_words = {{"kinco-jd", 0, 3, false, 0, 0x3210, "DC voltage too high", "see the manual"}};
  }
  void start(AxisNumber axes = 3) {
    configure(axes);
    session.take({}, facts, now);
    session.on_link_up(now);
  }
  void add(AxisNumber number) {
    AxisImage& axis = image.add_axis(number, "axis " + std::to_string(number), 0);
    axis.link_state = LinkState::online;
    axis.supported = bit(Quantity::position_actual) | bit(Quantity::velocity_actual);
    axis.writable = bit(Quantity::position_actual);
    sample(number, Quantity::velocity_actual, 0);
    sample(number, Quantity::position_actual, number);
  }
  void sample(AxisNumber number, Quantity quantity, std::int64_t value) {
    AxisImage& axis = *image.find(number);
    const bool changes = axis[quantity].value != value;
    axis[quantity] = {value, true, true, now};
    if (!changes) return;
    ++axis.sequence;
    image.changes.mark(number);
  }
  void move(AxisNumber number, std::int64_t position) { sample(number, Quantity::position_actual, position); }

  /// All that is sent now.
  std::vector<Record> read() {
    std::vector<Record> out;
    while (auto record = session.next(now)) out.push_back(std::move(*record));
    return out;
  }
  template <typename R>
  std::vector<R> read() {
    std::vector<R> out;
    for (Record& record : read())
      if (auto* const each = std::get_if<R>(&record)) out.push_back(std::move(*each));
    return out;
  }
  /// The axes that are sent now, in one list.
  std::vector<AxisSample> axes() {
    std::vector<AxisSample> out;
    for (SamplesRecord& record : read<SamplesRecord>())
      for (AxisSample& each : record.axes) out.push_back(std::move(each));
    return out;
  }
  std::vector<std::uint16_t> numbers() {
    std::vector<std::uint16_t> out;
    for (const AxisSample& each : axes()) out.push_back(each.axis);
    return out;
  }

  Instant now = kStart;
  int woken = 0;
  ProcessImage image;
  EventRing ring{[this](const Event&) { image.changes.mark(0); }};
  WebFacts facts;
  ProcessFigures figures{1500us, 2, 3, {{"axisgate-web", true, 1}}};
  WebSession session{{"0.3", 77, kStart}, image, ring, [this] { return figures; }, [this] { ++woken; }};
};

TEST_F(Pages, FirstGetWhatIsFixedThenEventsThenAllAxesThenStatistics) {
  ring.add(now, 0, EventKind::boot, 0, "started");
  start(2);
  std::vector<std::size_t> kinds;
  for (const Record& record : read()) kinds.push_back(record.index());
  EXPECT_THAT(kinds, ElementsAre(0, 1, 1, 2, 3, 5, 4, 6, 7));
}

TEST_F(Pages, AreToldOfWhichStartOfWhichGatewayTheyAre) {
  configure(2);
  WebSettings settings;
  settings.gateway = "cell_7";
  facts.low_word_first = true;
  session.take(settings, facts, now);
  session.on_link_up(now);
  const auto hello = read<HelloRecord>();
  ASSERT_THAT(hello, SizeIs(1));
  EXPECT_EQ(hello[0], (HelloRecord{"cell_7", "0.3", 77, kStart.time_since_epoch().count(), 2, 1, true, false}));
}

TEST_F(Pages, GetTheNewestOfAnAxisAtEachTickAndNotBefore) {
  start();
  static_cast<void>(read());
  now += 1ms;
  move(1, 100);
  move(1, 101);
  EXPECT_EQ(woken, 1) << "one wake-up for all that changes";
  EXPECT_THAT(numbers(), IsEmpty());
  EXPECT_EQ(session.wake_at(), kStart + 10ms);
  now += 4ms;
  move(1, 102);
  move(3, 7);
  EXPECT_EQ(woken, 1) << "until the tick";
  image.changes.mark(0);
  EXPECT_EQ(woken, 2) << "an event does not wait for it";
  now = kStart + 10ms;
  const auto got = axes();
  ASSERT_THAT(got, SizeIs(2));
  EXPECT_EQ(got[0].axis, 1);
  ASSERT_THAT(got[0].values, SizeIs(1)) << "what is not new is not sent again";
  EXPECT_EQ(got[0].values[0], (Value{2, 102, 5000}));
  EXPECT_EQ(got[1].axis, 3);
}

TEST_F(Pages, GetWhatWasConfirmedWithTheNextSampleOfItsAxis) {
  start(1);
  static_cast<void>(read());
  now += 20ms;
  sample(1, Quantity::velocity_actual, 0);
  move(1, 5);
  now += 1ms;
  const auto got = axes();
  ASSERT_THAT(got, SizeIs(1));
  EXPECT_THAT(got[0].values, ElementsAre(Value{2, 5, 1000}, Value{3, 0, 1000}));
}

TEST_F(Pages, HearOfEachAxisAlsoWhereNothingHappens) {
  start(3);
  static_cast<void>(read());
  now += 249ms;
  EXPECT_THAT(numbers(), IsEmpty());
  EXPECT_EQ(session.wake_at(), kStart + 250ms);
  now += 1ms;
  EXPECT_THAT(numbers(), ElementsAre(1, 2, 3));
  EXPECT_EQ(woken, 0);
}

TEST_F(Pages, GetAllAxesThatThereCanBeAtOneTickInAsManyPacketsAsItTakes) {
  configure(kMaxAxisNumber);
  for (AxisNumber number = 1; number <= kMaxAxisNumber; ++number) {
    AxisImage& axis = *image.find(number);
    axis.supported = ~0U;
    for (std::size_t i = 0; i < kQuantityCount; ++i) sample(number, static_cast<Quantity>(i), 40 + number);
    const auto owner = std::make_shared<ClientLife>();
    owner->name = std::string(200, 'x');
    axis.lease.owner = owner;
  }
  session.take({}, facts, now);
  session.on_link_up(now);
  std::set<std::uint16_t> seen;
  std::size_t packets = 0;
  for (const Record& record : read()) {
    const auto packet = encode(record);
    ASSERT_LE(packet.size(), kMaxPacket);
    const Decoded decoded = decode(packet);
    ASSERT_EQ(decoded.error, link::DecodeError::none);
    const auto* const samples = std::get_if<SamplesRecord>(&decoded.record);
    if (samples == nullptr) continue;
    ++packets;
    EXPECT_EQ(samples->gaps, 0U);
    for (const AxisSample& each : samples->axes) {
      seen.insert(each.axis);
      EXPECT_THAT(each.values, SizeIs(kQuantityCount));
    }
  }
  EXPECT_THAT(seen, SizeIs(kMaxAxisNumber));
  EXPECT_GT(packets, 1U);
}

TEST_F(Pages, OfASlowProgramCountWhatWasLeftOutAndGetTheNewest) {
  start(3);
  static_cast<void>(read());
  now += 10ms;
  move(1, 10);
  EXPECT_THAT(numbers(), ElementsAre(1));
  session.on_no_room();
  for (int tick = 0; tick < 5; ++tick) {
    now += 10ms;
    move(1, 20 + tick);
    move(2, 20 + tick);
  }
  const auto records = read<SamplesRecord>();
  ASSERT_THAT(records, SizeIs(1));
  EXPECT_EQ(records[0].gaps, 2U);
  EXPECT_EQ(records[0].axes[0].values[0].value, 24);
  EXPECT_EQ(session.gaps(), 2U);
}

TEST_F(Pages, CountNothingWhereTheProgramWasSlowForLessThanATick) {
  start(1);
  static_cast<void>(read());
  session.on_no_room();
  now += 10ms;
  move(1, 10);
  EXPECT_THAT(numbers(), ElementsAre(1));
  now += 500ms;
  move(1, 11);
  EXPECT_THAT(numbers(), ElementsAre(1));
  EXPECT_EQ(session.gaps(), 0U) << "an axis that stands has no gaps";
}

TEST_F(Pages, GetEventsInTheirOrderAndHowManyWereLost) {
  start(1);
  static_cast<void>(read());
  for (int i = 0; i < 1200; ++i) ring.add(now, 1, EventKind::fault, 0x3210, "event " + std::to_string(i + 1));
  const auto events = read<EventRecord>();
  ASSERT_THAT(events, SizeIs(kMaxEvents));
  EXPECT_EQ(events.back(), (EventRecord{1200, now.time_since_epoch().count(), 1, 0, 0x3210, "event 1200"}));
  now += 1s;
  const auto statistics = read<StatisticsRecord>();
  ASSERT_THAT(statistics, SizeIs(1));
  EXPECT_EQ(statistics[0].events_lost, 200U);
}

TEST_F(Pages, GetTheFiguresOfTheGatewayAndItsBusesOnceASecond) {
  image.buses.resize(1);
  image.buses[0].link = 1;
  image.buses[0].echoes = 9;
  image.buses[0].times[2].counts[3] = 5;
  image.buses[0].busy = 2500us;
  image.refresh = [this] { image.gateway.axes_online = 2; };
  start(2);
  image.find(2)->counts->faults = 4;
  std::vector<StatisticsRecord> statistics;
  std::vector<CountsRecord> counts;
  for (Record& record : read()) {
    if (auto* const each = std::get_if<StatisticsRecord>(&record)) statistics.push_back(*each);
    if (auto* const each = std::get_if<CountsRecord>(&record)) counts.push_back(*each);
  }
  ASSERT_THAT(statistics, SizeIs(1));
  EXPECT_EQ(statistics[0].axes_online, 2);
  EXPECT_EQ(statistics[0].worst_turn_us, 1500U);
  EXPECT_EQ(statistics[0].modbus_refused, 3U);
  EXPECT_THAT(statistics[0].programs, ElementsAre(ProgramStatistics{"axisgate-web", true, 1}));
  ASSERT_THAT(statistics[0].buses, SizeIs(1));
  EXPECT_EQ(statistics[0].buses[0].counters[10], 9U);
  ASSERT_THAT(counts, SizeIs(1));
  ASSERT_THAT(counts[0].buses, SizeIs(1));
  EXPECT_EQ(counts[0].buses[0].times[2].counts[3], 5U);
  EXPECT_EQ(counts[0].buses[0].busy_us, 2500U);
  ASSERT_THAT(counts[0].axes, SizeIs(2));
  EXPECT_EQ(counts[0].axes[1].faults, 4U);
  now += 999ms;
  EXPECT_THAT(read<StatisticsRecord>(), IsEmpty());
  now += 1ms;
  EXPECT_THAT(read<StatisticsRecord>(), SizeIs(1));
}

TEST_F(Pages, GetTheCountsOfAnAxisAgainWhenTheyAreOthers) {
  start(3);
  static_cast<void>(read());
  image.find(2)->counts->commands[{Command::enable, CommandResult::done}] = 7;
  now += 1s;
  const auto counts = read<CountsRecord>();
  ASSERT_THAT(counts, SizeIs(1));
  ASSERT_THAT(counts[0].axes, SizeIs(1)) << "an axis that does nothing costs nothing";
  EXPECT_EQ(counts[0].axes[0].axis, 2);
  EXPECT_THAT(counts[0].axes[0].commands, ElementsAre(CommandCount{1, 2, 7}));
}

TEST_F(Pages, GetTheCountsOfAllThatThereCanBeInAsManyPacketsAsItTakes) {
  image.buses.resize(kMaxBuses);
  configure(kMaxAxisNumber);
  for (const auto& axis : image.axes())
    for (std::uint8_t command = 0; command < 20; ++command)
      for (std::uint8_t result = 0; result < 12; ++result)
        axis->counts->commands[{static_cast<Command>(command), static_cast<CommandResult>(result)}] = 1;
  session.take({}, facts, now);
  session.on_link_up(now);
  std::size_t buses = 0, axes = 0;
  for (const Record& record : read()) {
    const auto packet = encode(record);
    ASSERT_LE(packet.size(), kMaxPacket);
    const Decoded decoded = decode(packet);
    ASSERT_EQ(decoded.error, link::DecodeError::none);
    const auto* const counts = std::get_if<CountsRecord>(&decoded.record);
    if (counts == nullptr) continue;
    buses += counts->buses.size();
    axes += counts->axes.size();
    for (const AxisCountsRow& each : counts->axes) EXPECT_THAT(each.commands, SizeIs(240));
  }
  EXPECT_EQ(buses, kMaxBuses);
  EXPECT_EQ(axes, kMaxAxisNumber);
}

TEST_F(Pages, GetFiguresAlsoWhereSamplesAreAlwaysDue) {
  start(2);
  static_cast<void>(read());
  now += 2s;
  const auto first = session.next(now);
  ASSERT_TRUE(first);
  EXPECT_TRUE(std::holds_alternative<StatisticsRecord>(*first));
}

TEST_F(Pages, BeginFromScratchWithAnotherConfiguration) {
  start(3);
  static_cast<void>(read());
  image.remove_axis(2);
  now += 10ms;
  EXPECT_THAT(numbers(), IsEmpty()) << "what is gone is not sent while its facts are still those of before";
  facts.axes.erase(facts.axes.begin() + 1);
  session.take({}, facts, now);
  const auto records = read();
  const auto* const hello = std::get_if<HelloRecord>(&records.front());
  ASSERT_NE(hello, nullptr);
  EXPECT_EQ(hello->axes, 2);
  std::vector<std::uint16_t> known;
  for (const Record& record : records)
    if (const auto* const info = std::get_if<AxisInfoRecord>(&record)) known.push_back(info->axis);
  EXPECT_THAT(known, ElementsAre(1, 3));
}

TEST_F(Pages, HearThatADriveHasOtherLimitsOnceItHasSaidSo) {
  start(2);
  static_cast<void>(read());
  image.find(2)->limits[static_cast<std::size_t>(Quantity::position_actual)] = {-5, 5};
  now += 1s;
  const auto info = read<AxisInfoRecord>();
  ASSERT_THAT(info, SizeIs(1));
  EXPECT_EQ(info[0].axis, 2);
  EXPECT_THAT(info[0].limits, ElementsAre(LimitRow{2, -5, 5}));
  now += 1s;
  EXPECT_THAT(read<AxisInfoRecord>(), IsEmpty());
}

TEST_F(Pages, CostNothingWhileTheProgramIsNotThere) {
  configure(3);
  session.take({}, facts, now);
  move(1, 5);
  EXPECT_EQ(woken, 0);
  EXPECT_EQ(session.next(now), std::nullopt);
  EXPECT_EQ(session.wake_at(), kNever);
  session.on_link_up(now);
  static_cast<void>(read());
  session.on_link_down();
  move(1, 6);
  EXPECT_EQ(woken, 0);
  EXPECT_EQ(session.next(now), std::nullopt);
  session.on_link_up(now);
  EXPECT_THAT(read<HelloRecord>(), SizeIs(1)) << "the next one knows nothing";
}

}  // namespace
}  // namespace axisgate::web
