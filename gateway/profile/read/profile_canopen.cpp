// SPDX-License-Identifier: Apache-2.0
// Section "protocols": "canopen". Its mapping, its error control and what the drive must hold for them (CiA 301).
#include <algorithm>
#include <set>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

constexpr std::int64_t kDefaultConfirmMs = 1000;
constexpr std::int64_t kDefaultInhibitUnitUs = 100;  // CiA 301 section 7.5.2.37
constexpr std::int64_t kLargestU16 = 0xFFFF;
constexpr std::size_t kPdoBytes = 8;
constexpr std::int64_t kLastSynchronousType = 240;
constexpr std::int64_t kFirstEventType = 254;
constexpr ObjectAddress kProducerHeartbeat{0x1017, 0};

void read_guard(const JsonNode& guard, CanopenSpec& out) {
  out.guard_time = milliseconds(guard.whole("time_ms", 0));
  out.life_factor = static_cast<std::uint8_t>(guard.whole("life_factor", out.life_factor));
  out.guard_time_object = guard.text("time_object");
  out.life_factor_object = guard.text("factor_object");
}

void read_inhibit(Reading& reading, const JsonNode& node, CanopenSpec::Tpdo& out) {
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

void read_tpdo(Reading& reading, const JsonNode& node, CanopenSpec& out) {
  CanopenSpec::Tpdo tpdo;
  tpdo.number = static_cast<std::uint8_t>(node.whole("n", 0));
  tpdo.map = node.names("map");
  const std::int64_t type = node.whole("type", tpdo.type);
  tpdo.type = static_cast<std::uint8_t>(type);
  if (type > kLastSynchronousType && type < kFirstEventType)
    reading.fault(node.pointer("type"), "{} is reserved, or sent on a remote frame only: use 0 to 240, 254 or 255",
                  type);
  else if (type <= kLastSynchronousType && out.sync == Duration{})
    reading.fault(node.pointer("type"), "type {} is sent on SYNC: give \"sync_ms\"", type);
  read_inhibit(reading, node, tpdo);
  if (const std::int64_t event = node.whole("event_ms", 0); event != 0)
    tpdo.event_ms = static_cast<std::uint16_t>(event);
  out.tpdos.push_back(std::move(tpdo));
}

void check_numbers(Reading& reading, const CanopenSpec& canopen, const JsonNode& node) {
  std::set<std::uint8_t> numbers;
  for (std::size_t i = 0; i < canopen.tpdos.size(); ++i)
    if (!numbers.insert(canopen.tpdos[i].number).second)
      reading.fault(node["tpdo"][i].pointer(), "this TPDO is given twice");
  for (std::size_t i = 0; i < canopen.unused_tpdos.size(); ++i)
    if (!numbers.insert(canopen.unused_tpdos[i]).second)
      reading.fault(node["unused_tpdos"][i].pointer(), "this TPDO is given already");
}

/// One map: what can be in it, and that nothing stands in two.
void check_map(Reading& reading, const CanopenSpec::Tpdo& tpdo, std::set<std::string>& mapped, const std::string& at) {
  std::size_t bytes = 0;
  for (const std::string& name : tpdo.map) {
    const Object* object = reading.profile.named(name);
    if (object == nullptr) {
      reading.fault(at, "unknown object \"{}\": not under /objects", name);
      continue;
    }
    const Place* place = object->place("canopen");
    bytes += (place == nullptr ? object->type : object->type_at(*place)).size;
    if (reading.needs_address(*object, "canopen", at) && reading.needs_readable(*object, at, ": no TPDO carries it") &&
        object->any_width)
      reading.fault(at, "object \"{}\" has no known width: an entry of a map needs one", name);
    if (!mapped.insert(name).second) reading.fault(at, "object \"{}\" is mapped already", name);
  }
  if (bytes > kPdoBytes) reading.fault(at, "maps {} bytes; a PDO holds 8", bytes);
}

/// What setup writes to the object at this address, where it is one number for all.
std::optional<std::int64_t> set_up(const Profile& profile, ObjectAddress address) {
  for (const WriteSpec& write : profile.setup) {
    if (!write.is_on("canopen")) continue;
    const Object* object = profile.find(write.object, 0);
    const Place* place = object == nullptr ? nullptr : object->place("canopen");
    if (place == nullptr || place->address != address) continue;
    if (const auto* literal = write.values.empty() ? nullptr : std::get_if<std::int64_t>(&write.values.front()))
      return *literal;
  }
  return std::nullopt;
}

void check_heartbeat(Reading& reading, const CanopenSpec& canopen, const JsonNode& node) {
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

void check_guard(Reading& reading, const CanopenSpec& canopen, const JsonNode& guard) {
  check_written(reading, canopen.guard_time_object, canopen.guard_time / milliseconds(1), guard.pointer("time_object"));
  check_written(reading, canopen.life_factor_object, canopen.life_factor, guard.pointer("factor_object"));
}

void check_consumer(Reading& reading, const LossSpec& loss, const JsonNode& node) {
  const std::int64_t after = loss.after / milliseconds(1);
  if (loss.object.empty()) reading.fault(node.pointer(), "needs \"object\": a sub-index of 1016h");
  // A third of it is the gateway's own period: two heartbeats may be lost.
  if (after < 3 || after > kLargestU16)
    reading.fault(node.pointer("after_ms"),
                  "must be 3 to 65535: it goes into 1016h, and a third of it is the gateway's own heartbeat");
  check_written(reading, loss.object, std::int64_t{model::kOwnNode} << 16 | after, node.pointer("object"));
}

void check_life_guarding(Reading& reading, const ProtocolSpec& protocol, const JsonNode& node) {
  const CanopenSpec& canopen = protocol.canopen;
  if (canopen.guard_time == Duration{} || canopen.guard_time_object.empty() || canopen.life_factor_object.empty())
    reading.fault(node.pointer(), "life_guarding needs \"guard\" with time_ms, time_object and factor_object");
  check_written(reading, protocol.loss.object, protocol.loss.value, node.pointer("object"));
}

}  // namespace

void read_canopen(Reading& reading, const JsonNode& node, CanopenSpec& out) {
  out.heartbeat = milliseconds(node.whole("heartbeat_ms", 0));
  read_guard(node["guard"], out);
  out.sync = milliseconds(node.whole("sync_ms", 0));
  out.boot = milliseconds(node.whole("boot_ms", 0));
  out.confirm = milliseconds(node.whole("confirm_ms", kDefaultConfirmMs));
  out.sdo_block = node.flag("sdo_block", false);
  for (const JsonNode& tpdo : node["tpdo"].elements()) read_tpdo(reading, tpdo, out);
  for (const JsonNode& number : node["unused_tpdos"].elements())
    out.unused_tpdos.push_back(static_cast<std::uint8_t>(number.whole().value_or(0)));
}

void check_canopen(Reading& reading, const ProtocolSpec& protocol, const JsonNode& node) {
  check_numbers(reading, protocol.canopen, node);
  std::set<std::string> mapped;
  for (std::size_t i = 0; i < protocol.canopen.tpdos.size(); ++i)
    check_map(reading, protocol.canopen.tpdos[i], mapped, node["tpdo"][i].pointer("map"));
  check_heartbeat(reading, protocol.canopen, node);
  check_guard(reading, protocol.canopen, node["guard"]);
  if (protocol.loss.by == LossSpec::By::heartbeat_consumer) check_consumer(reading, protocol.loss, node["loss"]);
  if (protocol.loss.by == LossSpec::By::life_guarding) check_life_guarding(reading, protocol, node["loss"]);
}

}  // namespace axisgate::profile
