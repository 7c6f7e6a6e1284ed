// SPDX-License-Identifier: Apache-2.0
// Section "protocols", and what of it only makes sense once objects are known.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

using nlohmann::json;

namespace {

constexpr std::int64_t kDefaultTimeoutMs = 100;
constexpr std::int64_t kFirstErrorFunction = 0x80, kLastErrorFunction = 0xFF;  // bit 7 is what makes it one

/// Ranges of registers without holes, in their order.
void read_runs(Reading& reading, const json& node, const std::string& pointer, model::RtuProperties& out) {
  const json* runs = member(node, "runs");
  if (runs == nullptr || !runs->is_array()) return;
  std::int64_t before = -1;
  for (std::size_t i = 0; i < runs->size(); ++i) {
    const json& run = (*runs)[i];
    if (!run.is_array() || run.size() != 2) continue;
    const std::int64_t first = whole(run[0]).value_or(-1);
    const std::int64_t last = whole(run[1]).value_or(-1);
    const std::string at = pointer_to(pointer_to(pointer, "runs"), i);
    if (first < 0 || last > kLastRegister || first > last) {
      reading.fault(
          at, "must be two registers from 0 to " + std::to_string(kLastRegister) + ", the first not above the last");
      continue;
    }
    if (first <= before) reading.fault(at, "begins before the run before it ends: runs are listed in ascending order");
    before = std::max(before, last);
    out.runs.emplace_back(static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(last));
  }
}

void read_rtu(Reading& reading, const json& node, const std::string& pointer, ProtocolSpec& out) {
  out.rtu.low_word_first = text_in(node, "word_order") != "high-first";
  out.rtu.max_registers = static_cast<std::uint8_t>(whole_in(node, "max_registers", out.rtu.max_registers));
  if (const json* broadcast = member(node, "broadcast"); broadcast != nullptr && !broadcast->is_null())
    out.rtu.broadcast = static_cast<std::uint8_t>(whole(*broadcast).value_or(0));
  out.rtu.answer = milliseconds(whole_in(node, "answer_ms", 0));
  if (out.timeout <= out.rtu.answer)
    reading.fault(pointer_to(pointer, "answer_ms"), "must be below timeout_ms: no reply could ever come in time");
  if (const json* functions = member(node, "accept_error_functions"); functions != nullptr && functions->is_array()) {
    for (std::size_t i = 0; i < functions->size(); ++i) {
      const std::int64_t function = whole((*functions)[i]).value_or(0);
      if (function < kFirstErrorFunction || function > kLastErrorFunction)
        reading.fault(pointer_to(pointer_to(pointer, "accept_error_functions"), i),
                      "is no error function: they are 0x80 to 0xFF");
      else
        out.rtu.error_functions.push_back(static_cast<std::uint8_t>(function));
    }
  }
  read_runs(reading, node, pointer, out.rtu);
}

std::vector<ResyncSpec> resync_in(const json& node) {
  std::vector<ResyncSpec> out;
  const json* resync = member(node, "resynchronisation");
  if (resync == nullptr || !resync->is_array()) return out;
  for (const json& entry : *resync) {
    ResyncSpec read;
    read.name = entry.is_string() ? entry.get<std::string>() : text_in(entry, "object");
    if (const json* counts = member(entry, "counts"); counts != nullptr && counts->is_array())
      for (const json& count : *counts)
        if (const auto number = whole(count)) read.counts.push_back(static_cast<std::uint8_t>(*number));
    out.push_back(std::move(read));
  }
  return out;
}

LossSpec loss_in(const json& node) {
  static constexpr std::array<std::pair<std::string_view, LossSpec::By>, 3> kWays{{
      {"heartbeat_consumer", LossSpec::By::heartbeat_consumer},
      {"life_guarding", LossSpec::By::life_guarding},
      {"command_watchdog", LossSpec::By::command_watchdog},
  }};
  LossSpec out;
  const json* loss = member(node, "loss");
  if (loss == nullptr || loss->is_null()) return out;
  const std::string by = text_in(*loss, "by");
  for (const auto& [name, way] : kWays)
    if (name == by) out.by = way;
  out.object = text_in(*loss, "object");
  out.value = whole_in(*loss, "value", 0);
  out.after = milliseconds(whole_in(*loss, "after_ms", 0));
  out.stops = text_in(*loss, "reaction") != "not stated";
  out.text = text_in(*loss, "text");
  return out;
}

/// What must be written to have the drive stop by itself.
void check_loss(Reading& reading, const std::string& protocol, const LossSpec& loss, const std::string& pointer) {
  if (loss.object.empty()) return;
  const std::string at = pointer_to(pointer_to(pointer, "loss"), "object");
  if (!reading.names_object(loss.object, at)) return;
  reading.each_meaning(loss.object, [&](const Object& object) {
    if (!object.places.contains(protocol))
      reading.fault(at, "object \"" + object.name + "\" has no address on " + protocol);
    if (!object.writable) reading.fault(at, "object \"" + object.name + "\" is read-only");
  });
}

const Place* place_on(const Object& object, std::string_view protocol) {
  const auto at = object.places.find(protocol);
  return at == object.places.end() ? nullptr : &at->second;
}

std::int64_t registers_of(const Object& object, const Place& place) {
  return place.type.value_or(object.type).size > 2 ? 2 : 1;
}

/// A resynchronisation read longer than its object must lie where nothing is missing, so far as the profile says where
/// that is.
bool within_a_run(const model::RtuProperties& rtu, std::int64_t first, std::int64_t count) {
  return rtu.runs.empty() || std::any_of(rtu.runs.begin(), rtu.runs.end(), [&](const auto& run) {
           return first >= run.first && first + count - 1 <= run.second;
         });
}

void check_counts(Reading& reading, const model::RtuProperties& rtu, const ResyncSpec& resync,
                  const std::string& pointer) {
  const Object* object = reading.profile.find(resync.name, 0);
  const Place* place = object == nullptr ? nullptr : place_on(*object, "modbus-rtu");
  for (const std::int64_t count : resync.counts) {
    if (count > rtu.max_registers)
      reading.fault(pointer, "reads " + std::to_string(count) + " registers, more than max_registers, " +
                                 std::to_string(rtu.max_registers));
    if (place == nullptr) continue;  // told by check_resync()
    const std::int64_t own = profile::registers_of(*object, *place);
    if (count < own) reading.fault(pointer, "reads only half of object \"" + object->name + "\"");
    if (count > own && !within_a_run(rtu, place->address.index, count))
      reading.fault(pointer, std::to_string(count) + " registers from " + std::to_string(place->address.index) +
                                 " on do not lie within one of the runs");
  }
}

void check_registers(Reading& reading, const ProtocolSpec& protocol, const std::string& pointer) {
  for (const Object& object : reading.profile.objects) {
    const Place* place = place_on(object, "modbus-rtu");
    if (place == nullptr || profile::registers_of(object, *place) <= protocol.rtu.max_registers) continue;
    reading.fault(pointer_to(pointer, "max_registers"), "must be at least 2: object \"" + object.name + "\" takes two");
    break;
  }
  std::set<int> lengths;
  for (std::size_t i = 0; i < protocol.resync.size(); ++i) {
    check_counts(reading, protocol.rtu, protocol.resync[i],
                 pointer_to(pointer_to(pointer_to(pointer, "resynchronisation"), i), "counts"));
    lengths.insert(protocol.resync[i].counts.begin(), protocol.resync[i].counts.end());
  }
  if (lengths.size() < 2)
    reading.fault(pointer_to(pointer, "resynchronisation"),
                  "needs at least two different counts: the reply of a read tells its length and nothing else");
}

/// Values of one answer are no two reads.
ObjectAddress asked_for(ObjectAddress address) { return {address.index, address.sub, 0}; }

void check_resync(Reading& reading, const std::string& name, const ProtocolSpec& protocol, const std::string& pointer) {
  std::set<ObjectAddress> addresses;
  for (std::size_t i = 0; i < protocol.resync.size(); ++i) {
    const std::string at = pointer_to(pointer_to(pointer, "resynchronisation"), i);
    const std::string& wanted = protocol.resync[i].name;
    if (!reading.names_object(wanted, at)) continue;
    const Object& object = *reading.profile.find(wanted, 0);
    const auto place = object.places.find(name);
    if (place == object.places.end())
      reading.fault(at, "object \"" + wanted + "\" has no address on " + name);
    else if (!object.readable)
      reading.fault(at, "object \"" + wanted + "\" cannot be read, so it is no resynchronisation read");
    else if (place->second.unsolicited)
      reading.fault(at, "object \"" + wanted + "\" comes unasked, so it is no resynchronisation read");
    else if (name != "modbus-rtu" && !addresses.insert(asked_for(place->second.address)).second)
      reading.fault(at, "the same address stands in this list already");
  }
}

}  // namespace

void read_protocols(Reading& reading) {
  const json* section = member(reading.document, "protocols");
  if (section == nullptr || !section->is_object()) return;
  for (const auto& [name, node] : section->items()) {
    ProtocolSpec out;
    out.timeout = milliseconds(whole_in(node, "timeout_ms", kDefaultTimeoutMs));
    out.worst_reply = milliseconds(whole_in(node, "worst_reply_ms", 0));
    out.loss = loss_in(node);
    out.resync = resync_in(node);
    const std::string pointer = pointer_to("/protocols", name);
    if (name == "keya-can")
      out.heartbeat = milliseconds(whole_in(node, "heartbeat_ms", 0));
    else if (is_keya(name) && member(node, "heartbeat_ms") != nullptr)
      reading.fault(
          pointer_to(pointer, "heartbeat_ms"),
          "belongs to keya-can: what " + name + " sends by itself is let pass, and all it tells can be asked for");
    if (name == "modbus-rtu") read_rtu(reading, node, pointer, out);
    if (name == "canopen") read_canopen(reading, node, pointer, out.canopen);
    if (out.worst_reply < out.timeout)
      reading.fault(pointer_to(pointer, "worst_reply_ms"),
                    "must be at least timeout_ms: it is how long a lost reply may still come");
    reading.profile.protocols.emplace(name, std::move(out));
  }
}

void check_protocols(Reading& reading) {
  for (const auto& [name, protocol] : reading.profile.protocols) {
    const std::string pointer = pointer_to("/protocols", name);
    check_loss(reading, name, protocol.loss, pointer);
    if (name == "canopen") check_canopen(reading, protocol, pointer);
    check_resync(reading, name, protocol, pointer);
    if (name == "modbus-rtu") check_registers(reading, protocol, pointer);
    if (is_keya(name)) check_control_frame(reading, name, pointer);
  }
}

}  // namespace axisgate::profile
