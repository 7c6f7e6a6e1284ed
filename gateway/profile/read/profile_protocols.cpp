// SPDX-License-Identifier: Apache-2.0
// Section "protocols", and what of it only makes sense once objects are known.
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

void read_rtu(Reading& reading, const JsonNode& node, ProtocolSpec& out) {
  out.rtu.low_word_first = node.text("word_order") != "high-first";
  out.rtu.max_registers = static_cast<std::uint8_t>(node.whole("max_registers", out.rtu.max_registers));
  if (node.has("broadcast") && !node["broadcast"].is_null())
    out.rtu.broadcast = static_cast<std::uint8_t>(node.whole("broadcast", 0));
  out.rtu.answer = milliseconds(node.whole("answer_ms", 0));
  if (out.timeout <= out.rtu.answer)
    reading.fault(node.pointer("answer_ms"), "must be below timeout_ms: no reply could ever come in time");
  for (const JsonNode& entry : node["accept_error_functions"].elements()) {
    const std::int64_t function = entry.whole().value_or(0);
    if (function < kFirstErrorFunction || function > kLastErrorFunction)
      reading.fault(entry.pointer(), "is no error function: they are 0x80 to 0xFF");
    else
      out.rtu.error_functions.push_back(static_cast<std::uint8_t>(function));
  }
  read_runs(reading, node["runs"], out.rtu);
}

std::vector<ResyncSpec> resync_in(const JsonNode& node) {
  std::vector<ResyncSpec> out;
  for (const JsonNode& entry : node.elements()) {
    ResyncSpec& read = out.emplace_back();
    read.name = entry.is_string() ? entry.text() : entry.text("object");
    for (const std::int64_t count : numbers_in(entry["counts"]))
      read.counts.push_back(static_cast<std::uint8_t>(count));
  }
  return out;
}

LossSpec loss_in(const JsonNode& loss) {
  using enum LossSpec::By;
  static constexpr auto kWays = names_of<LossSpec::By>({{heartbeat_consumer, "heartbeat_consumer"},
                                                        {life_guarding, "life_guarding"},
                                                        {command_watchdog, "command_watchdog"}});
  LossSpec out;
  if (!loss || loss.is_null()) return out;
  out.by = kWays.named(loss.text("by")).value_or(nothing);
  out.object = loss.text("object");
  out.value = loss.whole("value", 0);
  out.after = milliseconds(loss.whole("after_ms", 0));
  out.stops = loss.text("reaction") != "not stated";
  out.text = loss.text("text");
  return out;
}

/// What must be written to have the drive stop by itself.
void check_loss(Reading& reading, const LossSpec& loss, const JsonNode& node) {
  if (loss.object.empty()) return;
  const std::string at = node["loss"].pointer("object");
  reading.each_named(loss.object, at, [&](const Object& object) {
    reading.needs_address(object, node.key(), at);
    reading.needs_writable(object, at);
  });
}

std::int64_t registers_of(const Object& object, const Place& place) { return object.type_at(place).size > 2 ? 2 : 1; }

/// A resynchronisation read longer than its object must lie where nothing is missing, so far as the profile says where
/// that is.
bool within_a_run(const model::RtuProperties& rtu, std::int64_t first, std::int64_t count) {
  return rtu.runs.empty() || std::ranges::any_of(rtu.runs, [&](const auto& run) {
           return first >= run.first && first + count - 1 <= run.second;
         });
}

void check_counts(Reading& reading, const model::RtuProperties& rtu, const ResyncSpec& resync,
                  const std::string& pointer) {
  const Object* object = reading.profile.find(resync.name, 0);
  const Place* place = object == nullptr ? nullptr : object->place("modbus-rtu");
  for (const std::int64_t count : resync.counts) {
    if (count > rtu.max_registers)
      reading.fault(pointer, "reads {} registers, more than max_registers, {}", count, rtu.max_registers);
    if (place == nullptr) continue;  // told by check_resync()
    const std::int64_t own = profile::registers_of(*object, *place);
    if (count < own) reading.fault(pointer, "reads only half of object \"{}\"", object->name);
    if (count > own && !within_a_run(rtu, place->address.index, count))
      reading.fault(pointer, "{} registers from {} on do not lie within one of the runs", count, place->address.index);
  }
}

void check_registers(Reading& reading, const ProtocolSpec& protocol, const JsonNode& node) {
  const auto too_wide = [&](const Object& object) {
    const Place* place = object.place("modbus-rtu");
    return place != nullptr && profile::registers_of(object, *place) > protocol.rtu.max_registers;
  };
  if (const auto object = std::ranges::find_if(reading.profile.objects, too_wide);
      object != reading.profile.objects.end())
    reading.fault(node.pointer("max_registers"), "must be at least 2: object \"{}\" takes two", object->name);
  const JsonNode list = node["resynchronisation"];
  std::set<int> lengths;
  for (std::size_t i = 0; i < protocol.resync.size(); ++i) {
    check_counts(reading, protocol.rtu, protocol.resync[i], list[i].pointer("counts"));
    lengths.insert(protocol.resync[i].counts.begin(), protocol.resync[i].counts.end());
  }
  if (lengths.size() < 2)
    reading.fault(list.pointer(),
                  "needs at least two different counts: the reply of a read tells its length and nothing else");
}

/// Values of one answer are no two reads.
ObjectAddress asked_for(ObjectAddress address) { return {address.index, address.sub, 0}; }

void check_resync(Reading& reading, const ProtocolSpec& protocol, const JsonNode& node) {
  std::set<ObjectAddress> addresses;
  for (std::size_t i = 0; i < protocol.resync.size(); ++i) {
    const std::string at = node["resynchronisation"][i].pointer();
    const std::string& wanted = protocol.resync[i].name;
    if (!reading.names_object(wanted, at)) continue;
    const Object& object = *reading.profile.find(wanted, 0);
    const Place* place = object.place(node.key());
    if (place == nullptr)
      reading.fault(at, "object \"{}\" has no address on {}", wanted, node.key());
    else if (!object.readable)
      reading.fault(at, "object \"{}\" cannot be read, so it is no resynchronisation read", wanted);
    else if (place->unsolicited)
      reading.fault(at, "object \"{}\" comes unasked, so it is no resynchronisation read", wanted);
    else if (node.key() != "modbus-rtu" && !addresses.insert(asked_for(place->address)).second)
      reading.fault(at, "the same address stands in this list already");
  }
}

}  // namespace

void read_protocols(Reading& reading) {
  for (const JsonNode& node : reading.document["protocols"].members()) {
    const std::string name = node.key();
    ProtocolSpec out;
    out.timeout = milliseconds(node.whole("timeout_ms", kDefaultTimeoutMs));
    out.worst_reply = milliseconds(node.whole("worst_reply_ms", 0));
    out.loss = loss_in(node["loss"]);
    out.resync = resync_in(node["resynchronisation"]);
    if (name == "keya-can")
      out.heartbeat = milliseconds(node.whole("heartbeat_ms", 0));
    else if (is_keya(name) && node.has("heartbeat_ms"))
      reading.fault(node.pointer("heartbeat_ms"),
                    "belongs to keya-can: what {} sends by itself is let pass, and all it tells can be asked for",
                    name);
    if (name == "modbus-rtu") read_rtu(reading, node, out);
    if (name == "canopen") read_canopen(reading, node, out.canopen);
    if (out.worst_reply < out.timeout)
      reading.fault(node.pointer("worst_reply_ms"),
                    "must be at least timeout_ms: it is how long a lost reply may still come");
    reading.profile.protocols.emplace(name, std::move(out));
  }
}

void check_protocols(Reading& reading) {
  for (const auto& [name, protocol] : reading.profile.protocols) {
    const JsonNode node = reading.document["protocols"][name];
    check_loss(reading, protocol.loss, node);
    if (name == "canopen") check_canopen(reading, protocol, node);
    check_resync(reading, protocol, node);
    if (name == "modbus-rtu") check_registers(reading, protocol, node);
    if (is_keya(name)) check_control_frame(reading, name, node.pointer());
  }
}

}  // namespace axisgate::profile
