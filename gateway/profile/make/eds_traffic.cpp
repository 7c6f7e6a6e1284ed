// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/make/eds_traffic.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "gateway/profile/make/eds_objects.hpp"
#include "gateway/profile/make/take_out.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

constexpr std::uint16_t kFirstParameters = 0x1800, kFirstMapping = 0x1A00;
constexpr std::uint8_t kInhibit = 3, kEventTimer = 5;
constexpr ObjectAddress kGuardTime{0x100C, 0}, kLifeFactor{0x100D, 0}, kProducerHeartbeat{0x1017, 0};
constexpr std::size_t kPdoBytes = 8;
constexpr std::int64_t kConsumed = 0x007F0001;  // the least that 1016h holds: the gateway's node-ID and a time
constexpr int kEventMs = 500;                   // below the second after which a silent value is read

/// What is mapped together: a thing that changes all the time is bounded more tightly than one that rarely does.
struct Plan {
  std::vector<std::string_view> quantities;
  int inhibit_us;
  bool always_changing;
};

const std::array<Plan, 3>& plans() {
  static const std::array<Plan, 3> kPlans{{{{"statusword", "position_actual"}, 5000, true},
                                           {{"mode_display", "error_code", "digital_inputs"}, 20000, false},
                                           {{"velocity_actual", "torque_actual"}, 20000, true}}};
  return kPlans;
}

/// The object that a quantity is read from; empty: none, or several.
std::string object_of(const json& wanted, std::string_view quantity) {
  if (!wanted["quantities"].contains(quantity)) return {};
  const json object = wanted["quantities"][quantity].value("object", json());
  if (object.is_string()) return object.get<std::string>();
  const std::string name(quantity);  // digital_inputs of bits
  return wanted["objects"].contains(name) ? name : std::string();
}

const EdsObject* known(const Eds& eds, const json& wanted, const std::string& object) {
  if (!wanted["objects"].contains(object)) return nullptr;
  const auto address = canopen_address(wanted["objects"][object]);
  return address ? eds.find(*address) : nullptr;
}

/// How many entries the mapping can take; 8 where the EDS does not say.
std::size_t entries_of(const Eds& eds, std::uint16_t mapping) {
  std::size_t entries = 0;
  for (std::uint8_t sub = 1; sub <= kPdoBytes; ++sub)
    if (eds.find({mapping, sub}) != nullptr) entries = sub;
  return entries == 0 ? kPdoBytes : entries;
}

bool has_tpdo(const Eds& eds, int number) {
  return eds.has_index(static_cast<std::uint16_t>(kFirstParameters + number - 1)) &&
         eds.has_index(static_cast<std::uint16_t>(kFirstMapping + number - 1));
}

json map_of(const Eds& eds, const json& wanted, const Plan& plan, int number) {
  json map = json::array();
  std::size_t bytes = 0;
  for (const std::string_view quantity : plan.quantities) {
    const std::string object = object_of(wanted, quantity);
    const EdsObject* const entry = known(eds, wanted, object);
    if (entry == nullptr || !entry->mappable || entry->access == "rww" || !eds_reads(*entry)) continue;
    const std::size_t size = width_of(entry->type)->size;
    if (bytes + size > kPdoBytes ||
        map.size() >= entries_of(eds, static_cast<std::uint16_t>(kFirstMapping + number - 1)))
      continue;
    bytes += size;
    map.push_back(object);
  }
  return map;
}

void map_tpdos(const Eds& eds, json& wanted, std::vector<std::string>& notes) {
  json tpdos = json::array();
  json unused = json::array();
  std::vector<std::string> polled;
  for (int number = 1; number <= 4; ++number) {
    if (!has_tpdo(eds, number)) continue;
    const auto parameters = static_cast<std::uint16_t>(kFirstParameters + number - 1);
    const bool inhibits = eds.find({parameters, kInhibit}) != nullptr;
    const std::size_t at = static_cast<std::size_t>(number) - 1;
    const json map = at < plans().size() ? map_of(eds, wanted, plans()[at], number) : json::array();
    if (map.empty() || (plans()[at].always_changing && !inhibits)) {
      if (!map.empty()) polled.push_back(fmt::format("{}", number));
      unused.push_back(number);
      continue;
    }
    json tpdo = {{"n", number}, {"map", map}};
    if (inhibits) tpdo["inhibit_us"] = plans()[at].inhibit_us;
    if (eds.find({parameters, kEventTimer}) != nullptr) tpdo["event_ms"] = kEventMs;
    tpdos.push_back(std::move(tpdo));
  }
  json& canopen = wanted["protocols"]["canopen"];
  canopen.erase("tpdo");
  canopen.erase("unused_tpdos");
  if (!tpdos.empty()) canopen["tpdo"] = std::move(tpdos);
  if (!unused.empty()) canopen["unused_tpdos"] = std::move(unused);
  if (!polled.empty())
    notes.push_back(
        fmt::format("TPDO {} is not used: without an inhibit time (sub-index 3) nothing bounds how often it comes",
                    fmt::join(polled, ", ")));
}

bool can_be_set(const EdsObject* object, std::int64_t value) {
  return object != nullptr && why_not_usable(*object).empty() && eds_reads(*object) && eds_writes(*object) &&
         value >= object->low.value_or(value) && value <= object->high.value_or(value);
}

/// Writes of an object that is at this address.
void drop_setup(json& wanted, ObjectAddress address) {
  if (!wanted.contains("setup")) return;
  json kept = json::array();
  for (const json& write : wanted["setup"]) {
    const std::string object = write.value("write", "");
    const bool it = wanted["objects"].contains(object) && canopen_address(wanted["objects"][object]) == address;
    if (!it) kept.push_back(write);
  }
  wanted["setup"] = std::move(kept);
  if (wanted["setup"].empty()) wanted.erase("setup");
}

void end_heartbeat(json& wanted) {
  wanted["protocols"]["canopen"]["heartbeat_ms"] = nullptr;
  drop_setup(wanted, kProducerHeartbeat);
}

void guard(const Eds& eds, json& wanted, std::vector<std::string>& notes) {
  constexpr int kTimeMs = 500, kFactor = 3;
  json& canopen = wanted["protocols"]["canopen"];
  const EdsObject* const time = eds.find(kGuardTime);
  const EdsObject* const factor = eds.find(kLifeFactor);
  if (!can_be_set(time, kTimeMs) || !can_be_set(factor, kFactor)) {
    notes.emplace_back(
        "the drive has neither 1016h nor 100Ch and 100Dh that can be set: it does not notice a dead gateway");
    return;
  }
  const auto object = [](const char* at, const EdsObject& entry) {
    const EdsWidth width = *width_of(entry.type);
    return json{{"type", fmt::format("{}{}", width.is_signed ? 'i' : 'u', 8 * width.size)},
                {"access", "rw"},
                {"at", {{"canopen", at}}}};
  };
  wanted["objects"]["guard_time"] = object("100C.00", *time);
  wanted["objects"]["life_time_factor"] = object("100D.00", *factor);
  canopen["guard"] = {{"time_ms", kTimeMs},
                      {"life_factor", kFactor},
                      {"time_object", "guard_time"},
                      {"factor_object", "life_time_factor"}};
  canopen["loss"] = {{"by", "life_guarding"}, {"reaction", "not stated"}};
  end_heartbeat(wanted);
  notes.emplace_back("1016h is not in the EDS: the drive is guarded by 100Ch and 100Dh instead of heartbeats");
}

void watch_each_other(const Eds& eds, json& wanted, std::vector<std::string>& notes) {
  json& canopen = wanted["protocols"]["canopen"];
  const json period = canopen.value("heartbeat_ms", json());
  const bool beats = period.is_number_integer() && can_be_set(eds.find(kProducerHeartbeat), period.get<std::int64_t>());
  if (!beats && period.is_number()) {
    end_heartbeat(wanted);
    notes.emplace_back("1017h cannot be set: the drive sends no heartbeat");
  }
  const json loss = canopen.value("loss", json());
  const std::string consumer = loss.is_object() ? loss.value("object", "") : "";
  if (!consumer.empty() && !can_be_set(known(eds, wanted, consumer), kConsumed)) take_out_object(wanted, consumer);
  if (canopen.value("loss", json()).is_null()) {
    canopen["loss"] = nullptr;
    guard(eds, wanted, notes);
  }
}

/// At least two, of what every such drive has.
void complete_reads(json& wanted) {
  json& canopen = wanted["protocols"]["canopen"];
  json reads = canopen.value("resynchronisation", json::array());
  for (const char* const quantity : {"statusword", "position_actual", "mode_display", "mode", "velocity_actual"}) {
    const std::string object = object_of(wanted, quantity);
    if (reads.size() >= 2 || object.empty() || wanted["objects"][object].value("access", "ro") == "wo") continue;
    if (std::ranges::find(reads, json(object)) == reads.end()) reads.push_back(object);
  }
  canopen["resynchronisation"] = std::move(reads);
}

}  // namespace

void fit_traffic(const Eds& eds, json& wanted, std::vector<std::string>& notes) {
  watch_each_other(eds, wanted, notes);
  map_tpdos(eds, wanted, notes);
  complete_reads(wanted);
}

}  // namespace axisgate::profile
