// SPDX-License-Identifier: Apache-2.0
// Section "protocols": "canopen". Its mapping, its error control and what the drive must hold for them (CiA 301).
#include <algorithm>
#include <set>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

constexpr std::int64_t kDefaultInhibitUnitUs = 100;  // CiA 301 section 7.5.2.37
constexpr std::int64_t kLargestU16 = 0xFFFF;
constexpr std::size_t kPdoBytes = 8;
constexpr std::int64_t kLastSynchronousType = 240;
constexpr std::int64_t kFirstEventType = 254;
constexpr ObjectAddress kProducerHeartbeat{0x1017, 0};

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
    const Object* object = reading.profile.named(name);
    if (object == nullptr) {
      reading.fault(at, "unknown object \"{}\": not under /objects", name);
      continue;
    }
    out.push_back(static_cast<model::ObjectId>(object - reading.profile.objects.data()));
    if (object->part) reading.fault(at, "object \"{}\" is a part: map \"{}\"", name, object->part->of);
    const Place* place = object->place("canopen");
    bytes += (place == nullptr ? object->type : object->type_at(*place)).size;
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
    if (place == nullptr || object->part || place->address != address) continue;
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
  if (produced != canopen.heartbeat / milliseconds(1))
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
  const std::int64_t after = loss.after / milliseconds(1);
  if (loss.object.empty()) reading.fault(node.pointer(), "needs \"object\": a sub-index of 1016h");
  // A third of it is the gateway's own period: two heartbeats may be lost.
  if (after < 3 || after > kLargestU16)
    reading.fault(node.pointer("after_ms"),
                  "must be 3 to 65535: it goes into 1016h, and a third of it is the gateway's own heartbeat");
}

}  // namespace

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
  check_written(reading, guard.text("time_object"), out.guard_time / milliseconds(1), guard.pointer("time_object"));
  check_written(reading, guard.text("factor_object"), out.life_factor, guard.pointer("factor_object"));
  const bool consumer = protocol.loss.by == LossSpec::By::heartbeat_consumer;
  const bool guarded = protocol.loss.by == LossSpec::By::life_guarding;
  if (consumer) check_consumer(reading, protocol.loss, loss);
  if (guarded && !(guard.has("time_ms") && guard.has("time_object") && guard.has("factor_object")))
    reading.fault(loss.pointer(), "life_guarding needs \"guard\" with time_ms, time_object and factor_object");
  if (consumer || guarded) check_written(reading, protocol.loss.object, protocol.loss.value, loss.pointer("object"));
}

}  // namespace axisgate::profile
