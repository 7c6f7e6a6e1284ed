// SPDX-License-Identifier: Apache-2.0
// What Prometheus reads, against what the gateway has told: every metric with something that makes it move.
#include "gateway/upstream/web_process/metrics/metrics.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <regex>
#include <set>

#include "gateway/core/error.hpp"
#include "gateway/image/command.hpp"
#include "gateway/upstream/web_process/metrics/families.hpp"
#include "tests/places.hpp"
#include "tests/unit/web_process/told.hpp"

namespace axisgate::web {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using namespace std::chrono_literals;

/// Each sample by its name and labels.
using Lines = std::map<std::string, double>;

Lines lines_of(const std::string& text) {
  Lines out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    const std::size_t space = line.rfind(' ');
    EXPECT_TRUE(out.emplace(line.substr(0, space), std::stod(line.substr(space + 1))).second) << "twice: " << line;
  }
  return out;
}

/// All that a gateway tells, and what axisgate-web counts itself.
struct Plant {
  HelloRecord hello{"lift", "0.3.0", 42, kStarted - 10 * kSecond, 1, 1, false, false};
  BusInfoRecord bus{};
  AxisInfoRecord info{};
  AxisSample sample = standing(1);
  std::uint32_t gaps = 0;
  StatisticsRecord statistics = web::statistics();
  CountsRecord counts{kStarted, {BusCounts{}}, {AxisCountsRow{1, 0, 0, 0, 0, {}}}};
  Served served{};
  SteadyNs asked = 0;

  Plant() {
    bus.name = "serial";
    info.axis = 1;
    info.name = "hoist";
    info.supported_commands = 0b1111110;
    set(sample, Quantity::torque_actual, 300);
    set(sample, Quantity::current_actual, 250);
    set(sample, Quantity::drive_temperature, 415);
    set(sample, Quantity::motor_temperature, 900);
  }
  [[nodiscard]] Picture picture() const {
    Picture out;
    for (const Record& each : {Record(hello), Record(bus), Record(info),
                               Record(SamplesRecord{kStarted, gaps, {sample}}), Record(statistics), Record(counts)})
      EXPECT_TRUE(out.take(each, kStarted));
    return out;
  }
  [[nodiscard]] std::string text() const { return metrics_text(picture(), served, kStarted + asked); }
  [[nodiscard]] Lines lines() const { return lines_of(text()); }
};

struct Move {
  Metric metric;
  std::string line;
  std::optional<double> before, after;  ///< none: there is no such line
  void (*makes)(Plant&);
};

constexpr std::uint8_t kEnable = 1, kRefused = 3;

const std::vector<Move>& moves() {
  static const std::vector<Move> kMoves{
      {Metric::up, "axisgate_up", 1, 0, [](Plant& p) { p.asked = 3 * kSecond; }},
      {Metric::build_info,
       R"(axisgate_build_info{version="0.4.0",gateway="lift"})",
       {},
       1,
       [](Plant& p) { p.hello.version = "0.4.0"; }},
      {Metric::alarm, R"(axisgate_alarm{alarm="bus_down"})", 0, 1, [](Plant& p) { p.statistics.alarms = 2; }},
      {Metric::loop_delay, R"(axisgate_loop_delay_seconds_bucket{le="0.0128"})", 0, 1,
       [](Plant& p) { p.statistics.loop_late.add(10ms); }},
      {Metric::process_restarts, R"(axisgate_process_restarts_total{process="axisgate-dds"})", 2, 3,
       [](Plant& p) { ++p.statistics.programs[0].restarts; }},
      {Metric::clients, "axisgate_clients", 0, 4, [](Plant& p) { p.statistics.modbus_clients = 4; }},
      {Metric::clients_refused, "axisgate_clients_refused_total", 0, 5,
       [](Plant& p) { p.statistics.modbus_refused = 5; }},
      {Metric::modbus_requests, "axisgate_modbus_requests_total", 0, 5e9,
       [](Plant& p) { p.statistics.modbus_requests = 5'000'000'000; }},
      {Metric::modbus_exceptions, R"(axisgate_modbus_exceptions_total{exception="server_device_failure"})", 0, 6,
       [](Plant& p) { p.statistics.modbus_exceptions[4] = 6; }},
      {Metric::modbus_request_duration, "axisgate_modbus_request_duration_seconds_sum", 0, 0.25,
       [](Plant& p) { p.statistics.modbus_took.add(250ms); }},
      {Metric::dds_samples,
       R"(axisgate_dds_samples_total{direction="received"})",
       {},
       7,
       [](Plant& p) {
         p.statistics.has_dds = true;
         p.statistics.dds_received = 7;
       }},
      {Metric::events, R"(axisgate_events_total{kind="lease"})", 0, 8, [](Plant& p) { p.statistics.events[3] = 8; }},
      {Metric::events_lost, "axisgate_events_lost_total", 0, 9, [](Plant& p) { p.statistics.events_lost = 9; }},
      {Metric::bus_up, R"(axisgate_bus_up{bus="serial"})", 1, 0, [](Plant& p) { p.statistics.buses[0].link = 0; }},
      {Metric::bus_reconnects, R"(axisgate_bus_reconnects_total{bus="serial"})", 0, 1,
       [](Plant& p) { p.statistics.buses[0].counters[9] = 1; }},
      {Metric::bus_busy, R"(axisgate_bus_busy_seconds_total{bus="serial"})", 0, 1.5,
       [](Plant& p) { p.counts.buses[0].busy_us = 1'500'000; }},
      {Metric::bus_exchanges, R"(axisgate_bus_exchanges_total{bus="serial",result="timed_out"})", 0, 2,
       [](Plant& p) { p.statistics.buses[0].counters[2] = 2; }},
      {Metric::bus_exchange_duration, R"(axisgate_bus_exchange_duration_seconds_count{bus="serial"})", 0, 2,
       [](Plant& p) {
         p.counts.buses[0].times[0].add(2ms);
         p.counts.buses[0].times[5].add(3ms);
       }},
      {Metric::bus_wait, R"(axisgate_bus_wait_seconds_bucket{bus="serial",class="stop",le="0.0008"})", 0, 1,
       [](Plant& p) { p.counts.buses[0].waits[0].add(500us); }},
      {Metric::bus_late_replies, R"(axisgate_bus_late_replies_total{bus="serial"})", 0, 3,
       [](Plant& p) { p.statistics.buses[0].counters[4] = 3; }},
      {Metric::bus_queue_jobs, R"(axisgate_bus_queue_jobs{bus="serial"})", 0, 4,
       [](Plant& p) { p.statistics.buses[0].queue_depth = 4; }},
      {Metric::axis_info,
       R"(axisgate_axis_info{axis="1",name="lift",bus="serial",drive="Kinco JD",profile="kinco-jd",node="5"})",
       {},
       1,
       [](Plant& p) {
         p.info.name = "lift";
         p.info.drive = "Kinco JD";
         p.info.profile = "kinco-jd";
         p.info.node = 5;
       }},
      {Metric::axis_link_state, R"(axisgate_axis_link_state{axis="1",state="offline"})", 0, 1,
       [](Plant& p) { p.sample.link_state = 4; }},
      {Metric::axis_state, R"(axisgate_axis_state{axis="1",state="error_stop"})", 0, 1,
       [](Plant& p) { p.sample.axis_state = 6; }},
      {Metric::axis_alarm, R"(axisgate_axis_alarm{axis="1",alarm="unexpected_motion"})", 0, 1,
       [](Plant& p) { p.sample.alarms = bit(AxisAlarm::unexpected_motion); }},
      {Metric::axis_age, R"(axisgate_axis_age_seconds{axis="1"})", 0.012, 1.012, [](Plant& p) { p.asked = kSecond; }},
      {Metric::axis_position, R"(axisgate_axis_position_revolutions{axis="1"})", 1.5, -2,
       [](Plant& p) { set(p.sample, Quantity::position_actual, -20000); }},
      {Metric::axis_velocity, R"(axisgate_axis_velocity_revolutions_per_second{axis="1"})", 0, -1,
       [](Plant& p) { set(p.sample, Quantity::velocity_actual, -60000); }},
      {Metric::axis_torque,
       R"(axisgate_axis_torque_ratio{axis="1"})",
       0.3,
       {},
       [](Plant& p) { p.sample.valid &= ~bit(Quantity::torque_actual); }},
      {Metric::axis_current, R"(axisgate_axis_current_amperes{axis="1"})", 2.5, -0.01,
       [](Plant& p) { set(p.sample, Quantity::current_actual, -1); }},
      {Metric::axis_temperature,
       R"(axisgate_axis_temperature_celsius{axis="1",sensor="motor"})",
       {},
       90,
       [](Plant& p) { p.sample.valid = p.sample.supported = ~0U; }},
      {Metric::axis_faults, R"(axisgate_axis_faults_total{axis="1"})", 0, 2,
       [](Plant& p) { p.counts.axes[0].faults = 2; }},
      {Metric::axis_lease_expiries, R"(axisgate_axis_lease_expiries_total{axis="1"})", 0, 3,
       [](Plant& p) { p.counts.axes[0].lease_expiries = 3; }},
      {Metric::axis_commands, R"(axisgate_axis_commands_total{axis="1",command="enable",result="done"})", 0, 4,
       [](Plant& p) {
         p.counts.axes[0].commands = {{kEnable, 2, 4}, {kEnable, kRefused, 1}};
       }},
      {Metric::axis_enabled, R"(axisgate_axis_enabled_seconds_total{axis="1"})", 0, 3.5,
       [](Plant& p) { p.counts.axes[0].enabled_ms = 3500; }},
      {Metric::axis_travel, R"(axisgate_axis_travel_revolutions_total{axis="1"})", 0, 12.25,
       [](Plant& p) { p.counts.axes[0].travel_microturns = 12'250'000; }},
      {Metric::web_connections, "axisgate_web_connections", 0, 2, [](Plant& p) { p.served.connections = 2; }},
      {Metric::web_streams, "axisgate_web_streams", 0, 1, [](Plant& p) { p.served.streams = 1; }},
      {Metric::web_requests, "axisgate_web_requests_total", 0, 9, [](Plant& p) { p.served.requests = 9; }},
      {Metric::web_refused, R"(axisgate_web_refused_total{reason="host"})", 0, 1,
       [](Plant& p) { p.served.refused.count(Refusal::host); }},
      {Metric::web_gaps, "axisgate_web_gaps_total", 0, 3, [](Plant& p) { p.gaps = 3; }},
      {Metric::web_confined, "axisgate_web_confined", 0, 1, [](Plant& p) { p.served.confined = true; }},
  };
  return kMoves;
}

std::optional<double> value_of(const Lines& lines, const std::string& line) {
  const auto found = lines.find(line);
  return found == lines.end() ? std::nullopt : std::optional(found->second);
}

void expect_near(const std::optional<double>& seen, const std::optional<double>& wanted, const std::string& line) {
  ASSERT_EQ(seen.has_value(), wanted.has_value()) << line;
  EXPECT_NEAR(seen.value_or(0), wanted.value_or(0), 1e-9) << line;
}

TEST(Metrics, EachMovesByWhatItIsOf) {
  const Lines before = Plant().lines();
  for (const Move& move : moves()) {
    Plant plant;
    move.makes(plant);
    EXPECT_TRUE(move.line.starts_with(row(move.metric).name)) << move.line;
    expect_near(value_of(before, move.line), move.before, move.line + " before");
    expect_near(value_of(plant.lines(), move.line), move.after, move.line + " after");
  }
}

TEST(Metrics, EachOfTheTableHasItsTest) {
  std::set<Metric> moved;
  for (const Move& move : moves()) moved.insert(move.metric);
  EXPECT_EQ(moved.size(), kMetrics);
}

TEST(Metrics, HaveNamesAndKindsThatFit) {
  std::set<std::string_view> names;
  for (const MetricRow& each : metric_rows()) {
    EXPECT_TRUE(names.insert(each.name).second) << each.name;
    EXPECT_EQ(each.name.ends_with("_total"), each.kind == MetricKind::counter) << each.name;
    EXPECT_TRUE(each.kind != MetricKind::histogram || each.name.ends_with("_seconds")) << each.name;
    EXPECT_FALSE(each.help.empty() || each.help.ends_with('.')) << each.name;
  }
}

TEST(Metrics, HaveOfAGatewayThatIsNotHeardNothingButThat) {
  Plant plant;
  plant.asked = 3 * kSecond;
  for (const auto& [line, value] : plant.lines())
    EXPECT_TRUE(line == "axisgate_up" || line.starts_with("axisgate_web_")) << line;
}

TEST(Metrics, HaveNoCounterOfABusOrAnAxisBeforeItWasTold) {
  Plant plant;
  plant.counts = {};
  plant.statistics = {};
  plant.sample.age_ms = UINT32_MAX;
  const Lines lines = plant.lines();
  for (const auto& [line, value] : lines) {
    EXPECT_EQ(line.find("axisgate_bus_"), std::string::npos) << line;
    EXPECT_EQ(line.find("axisgate_axis_faults"), std::string::npos) << line;
    EXPECT_EQ(line.find("axisgate_axis_age"), std::string::npos) << line;
    EXPECT_EQ(line.find("axisgate_clients"), std::string::npos) << line;
  }
  EXPECT_EQ(lines.at("axisgate_up"), 1);
}

TEST(Metrics, HaveOneStateAtATime) {
  for (std::uint8_t state = 0; state < 8; ++state) {
    Plant plant;
    plant.sample.axis_state = state;
    plant.sample.link_state = state % 6;
    double states = 0, links = 0;
    std::size_t series = 0;
    for (const auto& [line, value] : plant.lines()) {
      if (line.starts_with("axisgate_axis_state{")) states += value, ++series;
      if (line.starts_with("axisgate_axis_link_state{")) links += value, ++series;
    }
    EXPECT_EQ(states, 1);
    EXPECT_EQ(links, 1);
    EXPECT_EQ(series, 15U) << "each state has a series, whichever it is";
  }
  Plant latched;
  latched.sample.axis_state = static_cast<std::uint8_t>(AxisState::stopping);
  latched.sample.alarms = bit(AxisAlarm::stop_latched);
  set(latched.sample, Quantity::velocity_actual, 0);
  EXPECT_EQ(latched.lines().at(R"(axisgate_axis_state{axis="1",state="latched"})"), 1) << "as the page says";
}

TEST(Metrics, HaveHistogramsWhoseBucketsRiseToTheirCount) {
  Families families;
  TimeCounts times;
  for (const Duration took : {Duration(0), Duration(99us), Duration(100us), Duration(1s), Duration(1h)})
    times.add(took);
  families.add(Metric::loop_delay, {}, times);
  const Lines lines = lines_of(std::move(families).text());
  double before = 0;
  std::size_t buckets = 0;
  double end = 0.0001;
  for (; buckets < TimeCounts::kBuckets - 1; ++buckets, end *= 2) {
    const double here = lines.at(fmt::format("axisgate_loop_delay_seconds_bucket{{le=\"{:.5g}\"}}", end));
    EXPECT_GE(here, before);
    before = here;
  }
  EXPECT_EQ(lines.at(R"(axisgate_loop_delay_seconds_bucket{le="0.0001"})"), 2);
  EXPECT_EQ(lines.at(R"(axisgate_loop_delay_seconds_bucket{le="0.0002"})"), 3);
  EXPECT_EQ(before, 4);
  EXPECT_EQ(lines.at(R"(axisgate_loop_delay_seconds_bucket{le="+Inf"})"), 5);
  EXPECT_EQ(lines.at("axisgate_loop_delay_seconds_count"), 5);
  EXPECT_NEAR(lines.at("axisgate_loop_delay_seconds_sum"), 3601.000199, 1e-9);
}

TEST(Metrics, EscapeWhateverAnAxisIsCalled) {
  Plant plant;
  plant.info.name = "Hub \"A\\B\"\nlinks \xC3\xBC";
  EXPECT_THAT(plant.text(), HasSubstr("name=\"Hub \\\"A\\\\B\\\"\\nlinks \xC3\xBC\","));
}

TEST(Metrics, AreTheNumbersOfTheApi) {
  Plant plant;
  plant.info.units_numerator = 10000;
  plant.info.units_denominator = 3;
  set(plant.sample, Quantity::velocity_actual, 12345);
  Told told;
  told.tell(plant.hello);
  told.tell(plant.bus);
  told.tell(plant.info);
  told.tell(plant.sample);
  const Json values = told.axis(1)["values"];
  const Lines lines = plant.lines();
  EXPECT_NEAR(lines.at(R"(axisgate_axis_position_revolutions{axis="1"})"), values["position_rev"].get<double>(), 1e-9);
  EXPECT_NEAR(60 * lines.at(R"(axisgate_axis_velocity_revolutions_per_second{axis="1"})"),
              values["velocity_rpm"].get<double>(), 1e-9);
  EXPECT_NEAR(100 * lines.at(R"(axisgate_axis_torque_ratio{axis="1"})"), values["torque_percent"].get<double>(), 1e-9);
  EXPECT_NEAR(lines.at(R"(axisgate_axis_current_amperes{axis="1"})"), values["current_a"].get<double>(), 1e-9);
}

/// A plant of so many axes on so many buses, with all that each can have: as many commands as are usual, and then some.
std::string text_of(std::uint16_t axes, std::uint8_t buses) {
  Picture picture;
  Plant plant;
  plant.hello.axes = axes;
  plant.hello.buses = buses;
  EXPECT_TRUE(picture.take(plant.hello, kStarted));
  plant.statistics.buses.resize(buses, plant.statistics.buses[0]);
  plant.statistics.has_dds = true;
  plant.counts = {};
  SamplesRecord samples;
  samples.at = kStarted;
  for (std::uint8_t place = 0; place < buses; ++place) {
    BusInfoRecord bus;
    bus.bus = place;
    bus.name = fmt::format("line-{}", place);
    EXPECT_TRUE(picture.take(bus, kStarted));
    plant.counts.buses.push_back({place, 1, {}, {}});
  }
  plant.info.supported_commands = 0b111111111111110;
  plant.sample.valid = plant.sample.supported = ~0U;
  for (std::uint16_t number = 1; number <= axes; ++number) {
    plant.info.axis = plant.sample.axis = number;
    plant.info.name = std::string(kMaxName, '"');
    EXPECT_TRUE(picture.take(plant.info, kStarted));
    samples.axes.push_back(plant.sample);
    plant.counts.axes.push_back({number, 1, 1, 1, 1, {{1, 9, 1}, {6, 11, 1}, {3, 4, 1}}});
  }
  for (const Record& each : {Record(samples), Record(plant.statistics), Record(plant.counts)})
    EXPECT_TRUE(picture.take(each, kStarted));
  return metrics_text(picture, {}, kStarted);
}

TEST(Metrics, AreFewerThan6000SeriesAt64Axes) { EXPECT_LT(lines_of(text_of(64, 8)).size(), 6000U); }

TEST(Metrics, OfAllAxesThatThereCanBeAreWithinTheirBound) {
  EXPECT_LT(text_of(kMaxAxisNumber, kMaxBuses).size(), kMaxMetrics / 2);
}

TEST(Metrics, AreAnsweredAsPrometheusAsksForThemAndToNothingElse) {
  Told told;
  const Answer answer = asked(told, "/metrics");
  EXPECT_EQ(status_of(answer), 200U);
  const auto& response = std::get<Response>(answer.what);
  EXPECT_EQ(response.type, "text/plain; version=0.0.4; charset=utf-8");
  EXPECT_THAT(std::string(response.body()), HasSubstr("# TYPE axisgate_up gauge\naxisgate_up 1\n"));
  EXPECT_EQ(status_of(asked(told, "/metrics?collect[]=x")), 400U);
  EXPECT_EQ(status_of(asked(told, "/metrics/")), 404U);
}

// --- What goes by these names --------------------------------------------------------------------------------------

std::string read_file(std::string_view path) {
  std::ifstream in(test::source_path(path));
  EXPECT_TRUE(in) << path;
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Names of ours in a text, without what a histogram adds to its own.
std::set<std::string> names_in(const std::string& text) {
  static const std::regex kName("axisgate_[a-z0-9_]+"), kPart("_(bucket|sum|count)$");
  std::set<std::string> out;
  for (std::sregex_iterator each(text.begin(), text.end(), kName), end; each != end; ++each)
    out.insert(std::regex_replace(each->str(), kPart, ""));
  return out;
}

TEST(Monitoring, UsesNoMetricThatThereIsNot) {
  std::set<std::string> known;
  for (const MetricRow& each : metric_rows()) known.emplace(each.name);
  for (const std::string_view path : {"deploy/monitoring/rules.yml", "deploy/monitoring/dashboard.json"}) {
    const std::set<std::string> used = names_in(read_file(path));
    EXPECT_GT(used.size(), 10U) << path;
    for (const std::string& name : used) EXPECT_TRUE(known.contains(name)) << path << ": " << name;
  }
}

TEST(Monitoring, HasAPageWithEachMetric) {
  const std::string page = read_file("docs/monitoring.md");
  EXPECT_THAT(page, HasSubstr(metrics_table_page())) << "the table of the page is:\n" << metrics_table_page();
}

}  // namespace
}  // namespace axisgate::web
