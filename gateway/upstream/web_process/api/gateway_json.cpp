// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/gateway_json.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gateway/core/words.hpp"
#include "gateway/upstream/web_process/api/words_json.hpp"

namespace axisgate::web {
namespace {

using GatewayJson = nlohmann::ordered_json;

constexpr double kPermillePerPercent = 10;

GatewayJson programs_json(const StatisticsRecord& told) {
  GatewayJson out = GatewayJson::array();
  for (const ProgramStatistics& each : told.programs)
    out.push_back({{"name", each.name}, {"running", each.running}, {"restarts", each.restarts}});
  return out;
}

GatewayJson served_json(const Served& served) {
  GatewayJson refused = GatewayJson::object();
  for (std::size_t i = 0; i < kRefusals; ++i) {
    const auto refusal = static_cast<Refusal>(i);
    refused[std::string(name_of(refusal))] = served.refused.of(refusal);
  }
  return {{"connections", served.connections},
          {"streams", served.streams},
          {"requests", served.requests},
          {"refused", std::move(refused)}};
}

/// Three places: what is below is an accident of buckets and clocks.
double rounded(double ms) {
  constexpr double kThousand = 1000;
  return std::round(ms * kThousand) / kThousand;
}

GatewayJson times_json(const ExchangeTimes& times) {
  GatewayJson out = GatewayJson::object();
  for (std::size_t i = 0; i < kExchangeClasses; ++i)
    if (const auto of = times.of(i))
      out[std::string(kExchangeClassNames[i])] = {
          {"count", of->count}, {"p50", rounded(of->p50)}, {"p95", rounded(of->p95)}, {"p99", rounded(of->p99)}};
  return out;
}

GatewayJson counters_json(const BusStatistics& told) {
  static constexpr std::array<const char*, kBusCounters> kNames{
      "requests", "replies",   "timeouts",   "bad_frames", "late_replies", "dropped_bytes",
      "refused",  "coalesced", "superseded", "reconnects", "echoes"};
  GatewayJson out;
  for (std::size_t i = 0; i < kBusCounters; ++i) out[kNames[i]] = told.counters[i];
  return out;
}

GatewayJson link_json(std::uint8_t link) {
  static constexpr std::array<std::string_view, 3> kLinks{"down", "up", "suspect"};
  return link < kLinks.size() ? GatewayJson(kLinks[link]) : GatewayJson();
}

}  // namespace

GatewayJson gateway_json(const Picture& picture, const Served& served, const Now& now) {
  const HelloRecord& hello = picture.hello();
  const StatisticsRecord& told = picture.statistics();
  const bool joined = picture.joined(now.at);
  constexpr double kUsPerMs = 1000;
  GatewayJson out;
  out["at"] = utc_text(now.at, now);
  out["name"] = hello.gateway;
  out["version"] = hello.version;
  out["boot"] = std::to_string(hello.boot);
  out["started"] = utc_text(hello.started, now);
  out["uptime_s"] = (now.at - hello.started) / kSecond;
  out["state"] = joined && told.at != 0 ? name_of(WordKind::gateway_state, told.state) : "unknown";
  out["axis_count"] = picture.axes().size();
  out["axes_online"] = joined ? told.axes_online : 0;
  out["joined"] = joined;
  out["seen"] = picture.heard() == 0 ? GatewayJson() : GatewayJson(utc_text(picture.heard(), now));
  out["insecure"] = served.insecure;
  out["confined"] = served.confined;
  out["alarms"] = alarms_json(WordKind::gateway_alarm, told.alarms, 0);
  out["programs"] = programs_json(told);
  out["clients"] = told.modbus_clients;
  out["clients_refused"] = told.modbus_refused;
  out["events_lost"] = told.events_lost;
  out["worst_turn_ms"] = told.worst_turn_us / kUsPerMs;
  out["gaps"] = picture.gaps();
  out["web"] = served_json(served);
  return out;
}

GatewayJson bus_json(const Picture& picture, const BusPicture& bus, SteadyNs now) {
  const BusInfoRecord& info = bus.info;
  const bool known = bus.newest && picture.joined(now);
  const BusStatistics told = bus.newest.value_or(BusStatistics{});
  GatewayJson axes = GatewayJson::array();
  for (const auto& [number, axis] : picture.axes())
    if (axis.info.bus == info.bus) axes.push_back(number);
  GatewayJson out;
  out["bus"] = info.bus;
  out["name"] = info.name;
  out["protocol"] = info.protocol;
  out["endpoint"] = info.endpoint;
  out["link"] = known ? link_json(told.link) : GatewayJson();
  out["load_percent"] = known ? GatewayJson(told.load_permille / kPermillePerPercent) : GatewayJson();
  out["cycle_ms"] = known ? GatewayJson(told.cycle_ms) : GatewayJson();
  out["queue_depth"] = known ? GatewayJson(told.queue_depth) : GatewayJson();
  out["planned"] = {{"load_percent", info.planned_load_permille / kPermillePerPercent},
                    {"cycle_ms", info.planned_cycle_ms}};
  out["counters"] = counters_json(told);
  out["exchange_ms"] = times_json(bus.times);
  out["axes"] = std::move(axes);
  return out;
}

GatewayJson buses_json(const Picture& picture, const Now& now) {
  GatewayJson out;
  out["at"] = utc_text(now.at, now);
  out["buses"] = GatewayJson::array();
  for (const auto& [place, bus] : picture.buses()) out["buses"].push_back(bus_json(picture, bus, now.at));
  return out;
}

const BusPicture* bus_named(const Picture& picture, const std::string& name) {
  for (const auto& [place, bus] : picture.buses())
    if (bus.info.name == name) return &bus;
  return nullptr;
}

}  // namespace axisgate::web
