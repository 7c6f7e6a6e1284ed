// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/metrics/gateway_metrics.hpp"

#include <array>
#include <string>

#include "gateway/core/words.hpp"
#include "gateway/image/events.hpp"
#include "gateway/image/process_image.hpp"

namespace axisgate::web {
namespace {

constexpr unsigned kGatewayAlarms = static_cast<unsigned>(GatewayAlarm::listener_down) + 1;
/// Places in BusStatistics::counters.
constexpr std::size_t kReplies = 1, kTimeouts = 2, kLateReplies = 4, kReconnects = 9;
constexpr double kUsPerSecond = 1e6;

void add_modbus(Families& to, const StatisticsRecord& told) {
  to.add(Metric::clients, {}, told.modbus_clients);
  to.add(Metric::clients_refused, {}, told.modbus_refused);
  to.add(Metric::modbus_requests, {}, static_cast<double>(told.modbus_requests));
  for (std::size_t code = 1; code < told.modbus_exceptions.size(); ++code)
    if (const auto number = static_cast<std::uint32_t>(code); find_word(WordKind::exception, number) != nullptr)
      to.add(Metric::modbus_exceptions, {{"exception", word_label(WordKind::exception, number)}},
             static_cast<double>(told.modbus_exceptions[code]));
  to.add(Metric::modbus_request_duration, {}, told.modbus_took);
}

void add_counts(Families& to, const Families::Labels& bus, const BusCounts& counts) {
  to.add(Metric::bus_busy, bus, static_cast<double>(counts.busy_us) / kUsPerSecond);
  TimeCounts all;
  for (std::size_t i = 0; i < kExchangeClasses; ++i) {
    all += counts.times[i];
    to.add(Metric::bus_wait, {bus[0], {"class", std::string(kExchangeClassNames[i])}}, counts.waits[i]);
  }
  to.add(Metric::bus_exchange_duration, bus, all);
}

}  // namespace

void add_gateway(Families& to, const Picture& picture) {
  const HelloRecord& hello = picture.hello();
  const StatisticsRecord& told = picture.statistics();
  to.add(Metric::build_info, {{"version", hello.version}, {"gateway", hello.gateway}}, 1);
  if (told.at == 0) return;
  for (unsigned alarm = 0; alarm < kGatewayAlarms; ++alarm)
    to.add(Metric::alarm, {{"alarm", word_label(WordKind::gateway_alarm, alarm)}}, told.alarms >> alarm & 1U);
  to.add(Metric::loop_delay, {}, told.loop_late);
  for (const ProgramStatistics& each : told.programs)
    to.add(Metric::process_restarts, {{"process", each.name}}, each.restarts);
  add_modbus(to, told);
  if (told.has_dds) {
    to.add(Metric::dds_samples, {{"direction", "sent"}}, static_cast<double>(told.dds_sent));
    to.add(Metric::dds_samples, {{"direction", "received"}}, static_cast<double>(told.dds_received));
  }
  for (std::size_t kind = 0; kind < told.events.size(); ++kind)
    to.add(Metric::events, {{"kind", std::string(text(static_cast<EventKind>(kind)))}},
           static_cast<double>(told.events[kind]));
  to.add(Metric::events_lost, {}, told.events_lost);
}

void add_buses(Families& to, const Picture& picture) {
  for (const auto& [place, bus] : picture.buses()) {
    const Families::Labels name{{"bus", bus.info.name}};
    if (bus.newest) {
      const auto& counters = bus.newest->counters;
      to.add(Metric::bus_up, name, bus.newest->link != 0 ? 1 : 0);
      to.add(Metric::bus_reconnects, name, counters[kReconnects]);
      to.add(Metric::bus_exchanges, {name[0], {"result", "answered"}}, counters[kReplies]);
      to.add(Metric::bus_exchanges, {name[0], {"result", "timed_out"}}, counters[kTimeouts]);
      to.add(Metric::bus_late_replies, name, counters[kLateReplies]);
      to.add(Metric::bus_queue_jobs, name, bus.newest->queue_depth);
    }
    if (bus.counts) add_counts(to, name, *bus.counts);
  }
}

void add_web(Families& to, const Picture& picture, const Served& served) {
  to.add(Metric::web_connections, {}, static_cast<double>(served.connections));
  to.add(Metric::web_streams, {}, static_cast<double>(served.streams));
  to.add(Metric::web_requests, {}, static_cast<double>(served.requests));
  for (std::size_t i = 0; i < kRefusals; ++i) {
    const auto refusal = static_cast<Refusal>(i);
    to.add(Metric::web_refused, {{"reason", std::string(name_of(refusal))}},
           static_cast<double>(served.refused.of(refusal)));
  }
  to.add(Metric::web_gaps, {}, picture.gaps());
  to.add(Metric::web_confined, {}, served.confined ? 1 : 0);
}

}  // namespace axisgate::web
