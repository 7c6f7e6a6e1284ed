// SPDX-License-Identifier: Apache-2.0
// Section "protocols", once objects and setup are known.
#include <algorithm>
#include <set>

#include "gateway/core/name_table.hpp"
#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

constexpr std::int64_t kDefaultTimeoutMs = 100;
constexpr std::int64_t kFirstErrorFunction = 0x80, kLastErrorFunction = 0xFF;  // bit 7 is what makes it one

/// Ranges of registers without holes, in their order.
void read_runs(Reading& reading, const JsonNode& runs, model::RtuProperties& out) {
  std::int64_t before = -1;
  for (const JsonNode& run : runs.elements()) {
    const std::vector<JsonNode> ends = run.elements();
    if (ends.size() != 2) continue;
    const std::int64_t first = ends[0].whole().value_or(-1);
    const std::int64_t last = ends[1].whole().value_or(-1);
    if (first < 0 || last > kLastRegister || first > last) {
      reading.fault(run.pointer(), "must be two registers from 0 to {}, the first not above the last", kLastRegister);
      continue;
    }
    if (first <= before)
      reading.fault(run.pointer(), "begins before the run before it ends: runs are listed in ascending order");
    before = std::max(before, last);
    out.runs.emplace_back(static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(last));
  }
}

void read_rtu(Reading& reading, const JsonNode& node, Duration timeout, model::RtuProperties& out) {
  out.low_word_first = node.text("word_order") != "high-first";
  out.max_registers = static_cast<std::uint8_t>(node.whole("max_registers", out.max_registers));
  if (const auto all = node.integer("broadcast")) out.broadcast = static_cast<std::uint8_t>(*all);
  out.answer = milliseconds(node.whole("answer_ms", 0));
  if (timeout <= out.answer)
    reading.fault(node.pointer("answer_ms"), "must be below timeout_ms: no reply could ever come in time");
  for (const JsonNode& entry : node["accept_error_functions"].elements()) {
    const std::int64_t function = entry.whole().value_or(0);
    if (function < kFirstErrorFunction || function > kLastErrorFunction)
      reading.fault(entry.pointer(), "is no error function: they are 0x80 to 0xFF");
    else
      out.error_functions.push_back(static_cast<std::uint8_t>(function));
  }
  read_runs(reading, node["runs"], out);
}

std::string object_of(const JsonNode& read) { return read.is_string() ? read.text() : read.text("object"); }

LossSpec read_loss(Reading& reading, const JsonNode& node) {
  using enum LossSpec::By;
  static constexpr auto kWays = names_of<LossSpec::By>({{heartbeat_consumer, "heartbeat_consumer"},
                                                        {life_guarding, "life_guarding"},
                                                        {command_watchdog, "command_watchdog"}});
  const JsonNode loss = node["loss"];
  LossSpec out;
  out.by = kWays.named(loss.text("by")).value_or(nothing);
  out.object = loss.text("object");
  out.after = milliseconds(loss.whole("after_ms", 0));
  out.value = out.by == heartbeat_consumer ? std::int64_t{model::kOwnNode} << 16 | out.after / milliseconds(1)
                                           : loss.whole("value", 0);
  out.stops = loss.text("reaction") != "not stated";
  out.text = loss.text("text");
  if (out.object.empty()) return out;
  const std::string at = loss.pointer("object");
  reading.each_named(out.object, at, [&](const Object& object) {
    reading.needs_address(object, node.key(), at);
    reading.needs_writable(object, at);
  });
  return out;
}

std::int64_t registers_of(const Object& object, const Place& place) { return object.type_at(place).size > 2 ? 2 : 1; }

/// A resynchronisation read longer than its object must lie where nothing is missing, so far as the profile says where
/// that is.
bool within_a_run(const model::RtuProperties& rtu, std::int64_t first, std::int64_t count) {
  return rtu.runs.empty() || std::ranges::any_of(rtu.runs, [&](const auto& run) {
           return first >= run.first && first + count - 1 <= run.second;
         });
}

void check_counts(Reading& reading, const model::RtuProperties& rtu, const JsonNode& read) {
  const std::string pointer = read.pointer("counts");
  const Object* object = reading.profile.find(object_of(read), 0);
  const Place* place = object == nullptr ? nullptr : object->place("modbus-rtu");
  if (place != nullptr && place->address.sub != 0)
    reading.fault(pointer, "object \"{}\" is no holding register, and no resynchronisation read", object->name);
  for (const std::int64_t count : read.wholes("counts")) {
    if (count > rtu.max_registers)
      reading.fault(pointer, "reads {} registers, more than max_registers, {}", count, rtu.max_registers);
    if (place == nullptr) continue;  // told by check_resync()
    const std::int64_t own = profile::registers_of(*object, *place);
    if (count < own) reading.fault(pointer, "reads only half of object \"{}\"", object->name);
    if (count > own && !within_a_run(rtu, place->address.index, count))
      reading.fault(pointer, "{} registers from {} on do not lie within one of the runs", count, place->address.index);
  }
}

void check_registers(Reading& reading, const model::RtuProperties& rtu, const JsonNode& node) {
  const auto too_wide = [&](const Object& object) {
    const Place* place = object.place("modbus-rtu");
    return place != nullptr && profile::registers_of(object, *place) > rtu.max_registers;
  };
  if (const auto object = std::ranges::find_if(reading.profile.objects, too_wide);
      object != reading.profile.objects.end())
    reading.fault(node.pointer("max_registers"), "must be at least 2: object \"{}\" takes two", object->name);
  const JsonNode list = node["resynchronisation"];
  std::set<std::int64_t> lengths;
  for (const JsonNode& read : list.elements()) {
    check_counts(reading, rtu, read);
    for (const std::int64_t count : read.wholes("counts")) lengths.insert(count);
  }
  if (lengths.size() < 2)
    reading.fault(list.pointer(),
                  "needs at least two different counts: the reply of a read tells its length and nothing else");
}

/// Values of one answer are no two reads.
ObjectAddress asked_for(ObjectAddress address) { return {address.index, address.sub, 0}; }

void check_resync(Reading& reading, const JsonNode& node) {
  std::set<ObjectAddress> addresses;
  for (const JsonNode& read : node["resynchronisation"].elements()) {
    const std::string at = read.pointer(), wanted = object_of(read);
    if (!reading.names_object(wanted, at)) continue;
    const Object& object = *reading.profile.find(wanted, 0);
    const Place* place = object.place(node.key());
    if (!reading.needs_address(object, node.key(), at)) continue;
    if (!object.readable)
      reading.fault(at, "object \"{}\" cannot be read, so it is no resynchronisation read", wanted);
    else if (place->unsolicited)
      reading.fault(at, "object \"{}\" comes unasked, so it is no resynchronisation read", wanted);
    else if (node.key() != "modbus-rtu" && !addresses.insert(asked_for(place->address)).second)
      reading.fault(at, "the same address stands in this list already");
  }
}

}  // namespace

void read_protocols(Reading& reading) {
  for (auto& [name, out] : reading.profile.protocols) {
    const JsonNode node = reading.document["protocols"][name];
    out.timeout = milliseconds(node.whole("timeout_ms", kDefaultTimeoutMs));
    out.worst_reply = milliseconds(node.whole("worst_reply_ms", 0));
    if (out.worst_reply < out.timeout)
      reading.fault(node.pointer("worst_reply_ms"),
                    "must be at least timeout_ms: it is how long a lost reply may still come");
    out.loss = read_loss(reading, node);
    if (name == "keya-can")
      out.heartbeat = node.milliseconds("heartbeat_ms", {});
    else if (is_keya(name) && node.has("heartbeat_ms"))
      reading.fault(node.pointer("heartbeat_ms"),
                    "belongs to keya-can: what {} sends by itself is let pass, and all it tells can be asked for",
                    name);
    if (name == "canopen") read_canopen(reading, node, out);
    if (name == "modbus-rtu") read_rtu(reading, node, out.timeout, out.rtu);
    check_resync(reading, node);
    if (name == "modbus-rtu") check_registers(reading, out.rtu, node);
    if (is_keya(name)) check_control_frame(reading, name, node.pointer());
  }
}

}  // namespace axisgate::profile
