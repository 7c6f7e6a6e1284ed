// SPDX-License-Identifier: Apache-2.0
#include "gateway/compose/web_facts.hpp"

#include <algorithm>
#include <set>

#include "gateway/compose/start_lines.hpp"
#include "gateway/config/bus_budget.hpp"

namespace axisgate::compose {
namespace {

std::uint16_t in_u16(std::int64_t number) {
  return static_cast<std::uint16_t>(std::clamp<std::int64_t>(number, 0, UINT16_MAX));
}

web::BusInfoRecord bus_info(const config::BusConfig& bus, const std::vector<model::DriveModel>& drives,
                            std::size_t place) {
  const config::BusBudget budget = config::plan_bus(config::timing_of(bus), drives);
  return {static_cast<std::uint8_t>(place),
          bus.name,
          bus.adapter,
          wire_text(bus),
          in_u16(budget.load_answered),
          in_u16(budget.cycle / std::chrono::milliseconds(1))};
}

void add_fault_words(const model::DriveModel& model, std::vector<web::FaultWordRecord>& words) {
  for (const model::AlarmRow& row : model.alarms)
    words.push_back({model.profile, row.word, row.bit, row.value.has_value(), row.value.value_or(0), row.code, row.text,
                     row.remedy});
}

}  // namespace

web::WebFacts web_facts(const config::LoadedConfig& loaded) {
  const config::Config& config = loaded.config;
  web::WebFacts facts;
  facts.low_word_first = config.modbus_tcp.front().low_word_first;
  facts.float_numbers = config.modbus_tcp.front().float_numbers;
  std::set<std::string> profiles;
  for (std::size_t b = 0; b < config.buses.size(); ++b) {
    facts.buses.push_back(bus_info(config.buses[b], loaded.models[b], b));
    for (const model::DriveModel& model : loaded.models[b]) {
      for (const model::AxisModel& axis : model.axes)
        facts.axes.push_back({axis.number, model.title, model.profile, model.node});
      if (profiles.insert(model.profile).second) add_fault_words(model, facts.fault_words);
    }
  }
  return facts;
}

}  // namespace axisgate::compose
