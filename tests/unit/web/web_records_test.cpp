// SPDX-License-Identifier: Apache-2.0
// What a page is told of one axis: what a register shows at the same moment.
#include <gmock/gmock.h>

#include "gateway/core/error.hpp"
#include "gateway/image/command.hpp"
#include "gateway/image/shown.hpp"
#include "gateway/upstream/web/axis_records.hpp"

namespace axisgate::web {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr Instant kNow = kLongAgo + std::chrono::hours(1);

AxisImage online() {
  AxisImage axis;
  axis.number = 3;
  axis.name = "lift";
  axis.link_state = LinkState::online;
  axis.supported = bit(Quantity::statusword) | bit(Quantity::vendor_error) | bit(Quantity::error_code);
  axis[Quantity::statusword] = {0x0237, true, true, kNow - 3ms};
  axis[Quantity::vendor_error] = {0xFFFFFFFE, true, true, kNow - 2h};
  return axis;
}

TEST(AxisSample, SaysEachValueWithItsAge) {
  SentValues sent;
  const AxisSample sample = axis_sample(online(), sent, kNow);
  EXPECT_THAT(sample.values, ElementsAre(Value{0, 0x0237, 3000}, Value{8, -2, UINT32_MAX}))
      << "bits; and an age's bound";
  EXPECT_EQ(sample.valid, online().valid_bits());
  EXPECT_EQ(sample.age_ms, UINT32_MAX) << "nothing cyclic was received";
}

TEST(AxisSample, SaysWhatRegistersShowOfAnAxisOutOfReach) {
  AxisImage axis = online();
  axis[Quantity::error_code] = {0, true, true, kNow};
  axis.inputs = bit(AxisInput::enabled) | bit(AxisInput::online);
  SentValues sent;
  static_cast<void>(axis_sample(axis, sent, kNow));
  axis.link_state = LinkState::offline;
  const AxisSample sample = axis_sample(axis, sent, kNow);
  EXPECT_EQ(sample.valid, 0U);
  EXPECT_EQ(sample.inputs, 0);
  EXPECT_THAT(sample.values, ElementsAre(Value{0, 0, 3000}, Value{7, kErrorCodeNoContact, 0}));
}

TEST(AxisSample, SaysWhoOwnsItAndForHowLong) {
  AxisImage axis = online();
  const auto owner = std::make_shared<ClientLife>();
  owner->name = "192.168.1.7:51234";
  SentValues sent;
  EXPECT_EQ(axis_sample(axis, sent, kNow).lease_ms, UINT32_MAX);
  axis.lease = {owner, true, false, kNow - 500ms, {}};
  const AxisSample sample = axis_sample(axis, sent, kNow);
  EXPECT_EQ(sample.owner, "192.168.1.7:51234");
  EXPECT_EQ(sample.lease_ms, 1500U);
}

TEST(AxisSample, SaysWhoAskedForWhatLastAndWhatBecameOfIt) {
  AxisImage axis = online();
  SentValues sent;
  EXPECT_EQ(axis_sample(axis, sent, kNow).result_age_ms, UINT32_MAX);
  const auto client = std::make_shared<ClientLife>();
  client->name = "10.0.0.2:1";
  axis.latest = {CommandResult::done, 7, 9, 0, client, "run_velocity", kNow - 20ms};
  const AxisSample sample = axis_sample(axis, sent, kNow);
  EXPECT_EQ(sample.result_who, "10.0.0.2:1");
  EXPECT_EQ(sample.result_what, "run_velocity");
  EXPECT_EQ(sample.result, static_cast<std::uint8_t>(CommandResult::done));
  EXPECT_EQ(sample.result_detail, 7U);
  EXPECT_EQ(sample.result_id, 9);
  EXPECT_EQ(sample.result_age_ms, 20U);
}

TEST(AxisSample, TakesNoMoreThanItsBoundHoweverFullItIs) {
  AxisImage axis = online();
  axis.supported = ~0U;
  for (auto& each : axis.samples) each = {1, true, true, kNow};
  const auto client = std::make_shared<ClientLife>();
  client->name = std::string(300, 'x');
  axis.lease.owner = client;
  axis.latest.by = client;
  SentValues sent;
  const AxisSample full = axis_sample(axis, sent, kNow);
  const std::size_t with = encode(SamplesRecord{0, 0, {full}}).size();
  const std::size_t without = encode(SamplesRecord{}).size();
  EXPECT_LE(with - without, size_bound(full));
}

TEST(AxisInfo, NamesTheDriveAndTheLimitsOfWhatCanBeWritten) {
  AxisImage axis = online();
  axis.supported |= bit(Quantity::target_velocity);
  axis.writable = bit(Quantity::target_velocity) | bit(Quantity::mode);
  axis.limits[static_cast<std::size_t>(Quantity::target_velocity)] = {-3000, 3000};
  axis.units_per_rev = Rational(10000, 3);
  const AxisInfoRecord info = axis_info(axis, {3, "Kinco JD", "kinco-jd", 5});
  EXPECT_EQ(info.name, "lift");
  EXPECT_EQ(info.drive, "Kinco JD");
  EXPECT_EQ(info.node, 5);
  EXPECT_EQ(info.units_denominator, 3);
  EXPECT_EQ(info.rated_speed, 0U) << "not known";
  EXPECT_THAT(info.limits, ElementsAre(LimitRow{17, -3000, 3000})) << "of what the drive has";
}

TEST(SubjectOf, NamesTheCommandBeforeAllElse) {
  WriteBatch batch;
  EXPECT_EQ(subject_of(batch), "");
  batch.jog_velocity = 5;
  EXPECT_EQ(subject_of(batch), "jog_velocity");
  batch.setpoints.push_back({Quantity::profile_velocity, 1});
  EXPECT_EQ(subject_of(batch), "profile_velocity");
  batch.mode = 3;
  EXPECT_EQ(subject_of(batch), "mode");
  batch.controlword = 15;
  EXPECT_EQ(subject_of(batch), "controlword");
  batch.command = Command::run_velocity;
  EXPECT_EQ(subject_of(batch), "run_velocity");
}

/// One of each kind, nothing of it at its default.
std::vector<Record> one_of_each() {
  AxisInfoRecord info{3, "lift", 1, "Kinco JD", "kinco-jd", 5, 60000, 37, 3000000, 0x41, 7, 9, {{17, -3000, 3000}}};
  AxisSample sample{3,
                    9,
                    2,
                    1,
                    1,
                    4,
                    5,
                    6,
                    7,
                    8,
                    9,
                    10,
                    11,
                    12,
                    "10.0.0.2:1",
                    13,
                    1,
                    14,
                    15,
                    "10.0.0.3:2",
                    "halt",
                    16,
                    {{2, -5, 17}}};
  BusStatistics bus{2, 100, 20, 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}};
  StatisticsRecord statistics;
  statistics.at = 1;
  statistics.state = 2;
  statistics.axes_online = 3;
  statistics.alarms = 4;
  statistics.events_lost = 5;
  statistics.worst_turn_us = 6;
  statistics.modbus_clients = 7;
  statistics.modbus_refused = 8;
  statistics.modbus_requests = 9;
  statistics.modbus_exceptions[11] = 10;
  statistics.modbus_took.add(11ms);
  statistics.loop_late.add(12ms);
  statistics.has_dds = true;
  statistics.dds_sent = 13;
  statistics.dds_received = 14;
  statistics.events[7] = 15;
  statistics.programs = {{"axisgate-web", true, 9}};
  statistics.buses = {bus};
  BusCounts counts{1, 2, {}, {}};
  counts.times[5].add(3s);
  counts.waits[0].add(4ms);
  return {HelloRecord{"cell_7", "0.3", 77, 5, 1, 1, true, true},
          info,
          BusInfoRecord{1, "lift", "canopen", "can0", 719, 50},
          FaultWordRecord{"kinco-jd", 1, 3, true, 0x80000000, 0x3210, "DC voltage too high", "see the manual"},
          SamplesRecord{5, 6, {sample}},
          EventRecord{1, 2, 3, 4, 5, "text"},
          statistics,
          CountsRecord{1, {counts}, {AxisCountsRow{3, 1, 2, 4, UINT64_MAX, {{1, 2, 3}}}}},
          ReadyRecord{"0.3", true},
          LogRecord{2, "line"}};
}

TEST(WebRecords, ComeBackAsTheyWent) {
  const auto records = one_of_each();
  EXPECT_EQ(records.size(), std::variant_size_v<Record>);
  for (std::size_t i = 0; i < records.size(); ++i) {
    ASSERT_EQ(records[i].index(), i);
    const Decoded decoded = decode(encode(records[i]));
    EXPECT_EQ(decoded.error, link::DecodeError::none) << i;
    EXPECT_EQ(decoded.record, records[i]) << i;
  }
}

TEST(WebRecords, AreRefusedWholeWhereAByteIsMissingOrTooMany) {
  for (const Record& record : one_of_each()) {
    auto packet = encode(record);
    packet.push_back(0);
    EXPECT_EQ(decode(packet).error, link::DecodeError::length) << record.index();
    packet.resize(packet.size() - 2);
    EXPECT_EQ(decode(packet).error, link::DecodeError::length) << record.index();
    packet[0] = kLinkVersion + 1;
    EXPECT_EQ(decode(packet).error, link::DecodeError::version);
  }
}

}  // namespace
}  // namespace axisgate::web
