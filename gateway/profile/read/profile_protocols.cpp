// SPDX-License-Identifier: Apache-2.0
// Section "protocols", once objects and setup are known; of canopen its mapping, its error control and what the drive
// must hold for them (CiA 301).
#include <algorithm>
#include <set>

#include "gateway/core/name_table.hpp"
#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

constexpr Duration kDefaultTimeout = std::chrono::milliseconds(100);
constexpr std::int64_t kDefaultInhibitUnitUs = 100;  // CiA 301 section 7.5.2.37
constexpr std::int64_t kLargestU16 = 0xFFFF;
constexpr std::size_t kPdoBytes = 8;
constexpr std::int64_t kLastSynchronousType = 240;
constexpr std::int64_t kFirstEventType = 254;
constexpr ObjectAddress kProducerHeartbeat{0x1017, 0};
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
  out.answer = std::chrono::milliseconds(node.whole("answer_ms", 0));
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
  out.after = std::chrono::milliseconds(loss.whole("after_ms", 0));
  out.value = out.by == heartbeat_consumer
                  ? std::int64_t{model::kOwnNode} << 16 | out.after / std::chrono::milliseconds(1)
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
    const std::int64_t own = registers_of(*place);
    if (count < own) reading.fault(pointer, "reads only half of object \"{}\"", object->name);
    if (count > own && !within_a_run(rtu, place->address.index, count))
      reading.fault(pointer, "{} registers from {} on do not lie within one of the runs", count, place->address.index);
  }
}

void check_registers(Reading& reading, const model::RtuProperties& rtu, const JsonNode& node) {
  const auto too_wide = [&](const Object& object) {
    const Place* place = object.place("modbus-rtu");
    return place != nullptr && registers_of(*place) > rtu.max_registers;
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

void read_inhibit(Reading& reading, const JsonNode& node, model::TpdoProperties& out) {
  if (!node.has("inhibit_us")) return;
  const std::int64_t unit = std::max<std::int64_t>(node.whole("inhibit_unit_us", kDefaultInhibitUnitUs), 1);
  const std::int64_t time = node.whole("inhibit_us", 0);
  // Rounded up: a drive is never asked to send more often than the profile says.
  const std::int64_t raw = time / unit + (time % unit == 0 ? 0 : 1);
  if (raw > kLargestU16)
    reading.fault(node.pointer("inhibit_us"), "is more than {} times inhibit_unit_us, which is all that fits",
                  kLargestU16);
  else
    out.inhibit = static_cast<std::uint16_t>(raw);
  out.inhibit_time = std::chrono::microseconds(raw * unit);
}

/// What can be in a map, and that nothing stands in two.
void read_map(Reading& reading, const JsonNode& node, std::set<std::string>& mapped,
              std::vector<model::ObjectId>& out) {
  std::size_t bytes = 0;
  const std::string at = node.pointer("map");
  for (const std::string& name : node.names("map")) {
    const Object* object = reading.profile.find(name, kNoAxis);
    if (object == nullptr) {
      reading.fault(at, "unknown object \"{}\": not under /objects", name);
      continue;
    }
    out.push_back(static_cast<model::ObjectId>(object - reading.profile.objects.data()));
    if (object->is_part()) reading.fault(at, "object \"{}\" is a part: map \"{}\"", name, object->whole);
    const Place* place = object->place("canopen");
    bytes += place == nullptr ? object->size : place->size;
    if (reading.needs_address(*object, "canopen", at) && reading.needs_readable(*object, at, ": no TPDO carries it") &&
        object->any_width)
      reading.fault(at, "object \"{}\" has no known width: an entry of a map needs one", name);
    if (!mapped.insert(name).second) reading.fault(at, "object \"{}\" is mapped already", name);
  }
  if (bytes > kPdoBytes) reading.fault(at, "maps {} bytes; a PDO holds 8", bytes);
}

void read_tpdos(Reading& reading, const JsonNode& protocol, model::CanopenProperties& out) {
  std::set<std::int64_t> numbers;
  std::set<std::string> mapped;
  for (const JsonNode& node : protocol["tpdo"].elements()) {
    model::TpdoProperties& tpdo = out.tpdos.emplace_back();
    if (!numbers.insert(node.whole("n", 0)).second) reading.fault(node.pointer(), "this TPDO is given twice");
    tpdo.number = static_cast<std::uint8_t>(node.whole("n", 0));
    const std::int64_t type = node.whole("type", tpdo.type);
    tpdo.type = static_cast<std::uint8_t>(type);
    if (type > kLastSynchronousType && type < kFirstEventType)
      reading.fault(node.pointer("type"), "{} is reserved, or sent on a remote frame only: use 0 to 240, 254 or 255",
                    type);
    else if (type <= kLastSynchronousType && out.sync == Duration{})
      reading.fault(node.pointer("type"), "type {} is sent on SYNC: give \"sync_ms\"", type);
    read_inhibit(reading, node, tpdo);
    if (const auto event = node.integer("event_ms")) tpdo.event_ms = static_cast<std::uint16_t>(*event);
    read_map(reading, node, mapped, tpdo.map);
  }
  for (const JsonNode& node : protocol["unused_tpdos"].elements()) {
    const std::int64_t number = node.whole().value_or(0);
    if (!numbers.insert(number).second) reading.fault(node.pointer(), "this TPDO is given already");
    out.unused_tpdos.push_back(static_cast<std::uint8_t>(number));
  }
}

/// What setup writes to the object at this address, where it is one number for all.
std::optional<std::int64_t> set_up(const Profile& profile, ObjectAddress address) {
  for (const JsonNode& write : profile.section("setup").elements()) {
    if (!is_on(write, "canopen")) continue;
    const Object* object = profile.find(write.text("write"), 0);
    const Place* place = object == nullptr ? nullptr : object->place("canopen");
    if (place == nullptr || object->is_part() || place->address != address) continue;
    if (const auto literal = of_axis(write["value"], profile.axes.front()).whole()) return literal;
  }
  return std::nullopt;
}

void check_heartbeat(Reading& reading, const model::CanopenProperties& canopen, const JsonNode& node) {
  const auto produced = set_up(reading.profile, kProducerHeartbeat);
  if (canopen.heartbeat == Duration{}) {
    if (produced.value_or(0) != 0)
      reading.fault(node.pointer(),
                    "setup has the drive send a heartbeat each {} ms (1017h): give it as \"heartbeat_ms\" too",
                    *produced);
    return;
  }
  if (canopen.guard_time != Duration{})
    reading.fault(node.pointer("guard"), "a node sends heartbeats or is guarded, not both (CiA 301)");
  if (produced != canopen.heartbeat / std::chrono::milliseconds(1))
    reading.fault(node.pointer("heartbeat_ms"),
                  "needs a setup write of 1017h with the same number: else the drive may send none");
}

/// An object that is written so that the drive stops by itself: it must be there, take the value, and tell what it
/// holds.
void check_written(Reading& reading, const std::string& name, std::int64_t value, const std::string& at) {
  if (name.empty()) return;
  reading.each_named(name, at, [&](const Object& object) {
    reading.needs_address(object, "canopen", at);
    if (!object.writable || !object.readable)
      reading.fault(at, "object \"{}\" must be readable and writable", object.name);
    if (!object.numbers().holds(value))
      reading.fault(at, "object \"{}\" does not take {}: it takes {}", object.name, value,
                    range_text(object.numbers()));
  });
}

void check_consumer(Reading& reading, const LossSpec& loss, const JsonNode& node) {
  const std::int64_t after = loss.after / std::chrono::milliseconds(1);
  if (loss.object.empty()) reading.fault(node.pointer(), "needs \"object\": a sub-index of 1016h");
  // A third of it is the gateway's own period: two heartbeats may be lost.
  if (after < 3 || after > kLargestU16)
    reading.fault(node.pointer("after_ms"),
                  "must be 3 to 65535: it goes into 1016h, and a third of it is the gateway's own heartbeat");
}

void read_canopen(Reading& reading, const JsonNode& node, ProtocolSpec& protocol) {
  model::CanopenProperties& out = protocol.canopen;
  const JsonNode guard = node["guard"], loss = node["loss"];
  out.heartbeat = node.milliseconds("heartbeat_ms", {});
  out.guard_time = guard.milliseconds("time_ms", {});
  out.life_factor = static_cast<std::uint8_t>(guard.whole("life_factor", out.life_factor));
  out.sync = node.milliseconds("sync_ms", {});
  out.boot = node.milliseconds("boot_ms", {});
  out.confirm = node.milliseconds("confirm_ms", out.confirm);
  out.sdo_block = node.flag("sdo_block", false);
  read_tpdos(reading, node, out);
  check_heartbeat(reading, out, node);
  check_written(reading, guard.text("time_object"), out.guard_time / std::chrono::milliseconds(1),
                guard.pointer("time_object"));
  check_written(reading, guard.text("factor_object"), out.life_factor, guard.pointer("factor_object"));
  const bool consumer = protocol.loss.by == LossSpec::By::heartbeat_consumer;
  const bool guarded = protocol.loss.by == LossSpec::By::life_guarding;
  if (consumer) check_consumer(reading, protocol.loss, loss);
  if (guarded && !(guard.has("time_ms") && guard.has("time_object") && guard.has("factor_object")))
    reading.fault(loss.pointer(), "life_guarding needs \"guard\" with time_ms, time_object and factor_object");
  if (consumer || guarded) check_written(reading, protocol.loss.object, protocol.loss.value, loss.pointer("object"));
}

}  // namespace

void read_protocols(Reading& reading) {
  for (auto& [name, out] : reading.profile.protocols) {
    const JsonNode node = reading.document["protocols"][name];
    out.timeout = node.milliseconds("timeout_ms", kDefaultTimeout);
    out.worst_reply = node.milliseconds("worst_reply_ms", {});
    if (out.worst_reply < out.timeout)
      reading.fault(node.pointer("worst_reply_ms"),
                    "must be at least timeout_ms: it is how long a lost reply may still come");
    out.loss = read_loss(reading, node);
    if (is_keya(name) && name != "keya-can" && node.has("heartbeat_ms"))
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
