// SPDX-License-Identifier: Apache-2.0
// Section "protocols": "canopen". Its mapping, its error control and what the drive must hold for them (CiA 301).
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

using nlohmann::json;

namespace {

constexpr std::int64_t kDefaultConfirmMs = 1000;
constexpr std::int64_t kDefaultInhibitUnitUs = 100;  // CiA 301 section 7.5.2.37
constexpr std::int64_t kLargestU16 = 0xFFFF;
constexpr std::size_t kPdoBytes = 8;
constexpr std::int64_t kLastSynchronousType = 240;
constexpr std::int64_t kFirstEventType = 254;
constexpr ObjectAddress kProducerHeartbeat{0x1017, 0};

void read_guard(const json& node, CanopenSpec& out) {
  const json* guard = member(node, "guard");
  if (guard == nullptr) return;
  out.guard_time = milliseconds(whole_in(*guard, "time_ms", 0));
  out.life_factor = static_cast<std::uint8_t>(whole_in(*guard, "life_factor", out.life_factor));
  out.guard_time_object = text_in(*guard, "time_object");
  out.life_factor_object = text_in(*guard, "factor_object");
}

void read_inhibit(Reading& reading, const json& node, const std::string& pointer, CanopenSpec::Tpdo& out) {
  if (member(node, "inhibit_us") == nullptr) return;
  const std::int64_t unit = std::max<std::int64_t>(whole_in(node, "inhibit_unit_us", kDefaultInhibitUnitUs), 1);
  const std::int64_t time = whole_in(node, "inhibit_us", 0);
  // Rounded up: a drive is never asked to send more often than the profile says.
  const std::int64_t raw = time / unit + (time % unit == 0 ? 0 : 1);
  if (raw > kLargestU16)
    reading.fault(pointer_to(pointer, "inhibit_us"),
                  "is more than " + std::to_string(kLargestU16) + " times inhibit_unit_us, which is all that fits");
  else
    out.inhibit = static_cast<std::uint16_t>(raw);
  out.inhibit_time = std::chrono::microseconds(raw * unit);
}

void read_tpdo(Reading& reading, const json& node, const std::string& pointer, CanopenSpec& out) {
  CanopenSpec::Tpdo tpdo;
  tpdo.number = static_cast<std::uint8_t>(whole_in(node, "n", 0));
  tpdo.map = names_in(node, "map");
  const std::int64_t type = whole_in(node, "type", tpdo.type);
  tpdo.type = static_cast<std::uint8_t>(type);
  const std::string at = pointer_to(pointer, "type");
  if (type > kLastSynchronousType && type < kFirstEventType)
    reading.fault(at, std::to_string(type) + " is reserved, or sent on a remote frame only: use 0 to 240, 254 or 255");
  else if (type <= kLastSynchronousType && out.sync == Duration{})
    reading.fault(at, "type " + std::to_string(type) + " is sent on SYNC: give \"sync_ms\"");
  read_inhibit(reading, node, pointer, tpdo);
  if (const std::int64_t event = whole_in(node, "event_ms", 0); event != 0)
    tpdo.event_ms = static_cast<std::uint16_t>(event);
  out.tpdos.push_back(std::move(tpdo));
}

void check_numbers(Reading& reading, const CanopenSpec& canopen, const std::string& pointer) {
  std::set<std::uint8_t> numbers;
  for (std::size_t i = 0; i < canopen.tpdos.size(); ++i)
    if (!numbers.insert(canopen.tpdos[i].number).second)
      reading.fault(pointer_to(pointer_to(pointer, "tpdo"), i), "this TPDO is given twice");
  for (std::size_t i = 0; i < canopen.unused_tpdos.size(); ++i)
    if (!numbers.insert(canopen.unused_tpdos[i]).second)
      reading.fault(pointer_to(pointer_to(pointer, "unused_tpdos"), i), "this TPDO is given already");
}

/// One map: what can be in it, and that nothing stands in two.
void check_map(Reading& reading, const CanopenSpec::Tpdo& tpdo, std::set<std::string>& mapped, const std::string& at) {
  std::size_t bytes = 0;
  for (const std::string& name : tpdo.map) {
    const auto& objects = reading.profile.objects;
    const auto object = std::find_if(objects.begin(), objects.end(), [&](const Object& o) { return o.name == name; });
    if (object == objects.end()) {
      reading.fault(at, "unknown object \"" + name + "\": not under /objects");
      continue;
    }
    const auto place = object->places.find("canopen");
    bytes += (place == object->places.end() ? std::nullopt : place->second.type).value_or(object->type).size;
    if (place == object->places.end())
      reading.fault(at, "object \"" + name + "\" has no address on canopen");
    else if (!object->readable)
      reading.fault(at, "object \"" + name + "\" cannot be read: no TPDO carries it");
    else if (object->any_width)
      reading.fault(at, "object \"" + name + "\" has no known width: an entry of a map needs one");
    if (!mapped.insert(name).second) reading.fault(at, "object \"" + name + "\" is mapped already");
  }
  if (bytes > kPdoBytes) reading.fault(at, "maps " + std::to_string(bytes) + " bytes; a PDO holds 8");
}

/// What setup writes to the object at this address, where it is one number for all.
std::optional<std::int64_t> set_up(const Profile& profile, ObjectAddress address) {
  for (const WriteSpec& write : profile.setup) {
    if (!write.on.empty() && std::find(write.on.begin(), write.on.end(), "canopen") == write.on.end()) continue;
    const Object* object = profile.find(write.object, 0);
    if (object == nullptr) continue;
    const auto place = object->places.find("canopen");
    if (place == object->places.end() || place->second.address != address) continue;
    if (const auto* literal = write.values.empty() ? nullptr : std::get_if<std::int64_t>(&write.values.front()))
      return *literal;
  }
  return std::nullopt;
}

void check_heartbeat(Reading& reading, const CanopenSpec& canopen, const std::string& pointer) {
  const auto produced = set_up(reading.profile, kProducerHeartbeat);
  if (canopen.heartbeat == Duration{}) {
    if (produced.value_or(0) != 0)
      reading.fault(pointer, "setup has the drive send a heartbeat each " + std::to_string(*produced) +
                                 " ms (1017h): give it as \"heartbeat_ms\" too");
    return;
  }
  if (canopen.guard_time != Duration{})
    reading.fault(pointer_to(pointer, "guard"), "a node sends heartbeats or is guarded, not both (CiA 301)");
  if (produced != canopen.heartbeat / milliseconds(1))
    reading.fault(pointer_to(pointer, "heartbeat_ms"),
                  "needs a setup write of 1017h with the same number: else the drive may send none");
}

/// An object that is written so that the drive stops by itself: it must be there, take the value, and tell what it
/// holds.
void check_written(Reading& reading, const std::string& name, std::int64_t value, const std::string& at) {
  if (name.empty() || !reading.names_object(name, at)) return;
  reading.each_meaning(name, [&](const Object& object) {
    if (!object.places.contains("canopen"))
      reading.fault(at, "object \"" + object.name + "\" has no address on canopen");
    if (!object.writable || !object.readable)
      reading.fault(at, "object \"" + object.name + "\" must be readable and writable");
    if (!object.numbers().holds(value))
      reading.fault(at, "object \"" + object.name + "\" does not take " + std::to_string(value) + ": it takes " +
                            range_text(object.numbers()));
  });
}

void check_guard(Reading& reading, const CanopenSpec& canopen, const std::string& pointer) {
  const std::string at = pointer_to(pointer, "guard");
  check_written(reading, canopen.guard_time_object, canopen.guard_time / milliseconds(1),
                pointer_to(at, "time_object"));
  check_written(reading, canopen.life_factor_object, canopen.life_factor, pointer_to(at, "factor_object"));
}

void check_consumer(Reading& reading, const LossSpec& loss, const std::string& pointer) {
  const std::int64_t after = loss.after / milliseconds(1);
  if (loss.object.empty()) reading.fault(pointer, "needs \"object\": a sub-index of 1016h");
  // A third of it is the gateway's own period: two heartbeats may be lost.
  if (after < 3 || after > kLargestU16)
    reading.fault(pointer_to(pointer, "after_ms"),
                  "must be 3 to 65535: it goes into 1016h, and a third of it is the gateway's own heartbeat");
  check_written(reading, loss.object, std::int64_t{model::kOwnNode} << 16 | after, pointer_to(pointer, "object"));
}

void check_life_guarding(Reading& reading, const ProtocolSpec& protocol, const std::string& pointer) {
  const CanopenSpec& canopen = protocol.canopen;
  if (canopen.guard_time == Duration{} || canopen.guard_time_object.empty() || canopen.life_factor_object.empty())
    reading.fault(pointer, "life_guarding needs \"guard\" with time_ms, time_object and factor_object");
  check_written(reading, protocol.loss.object, protocol.loss.value, pointer_to(pointer, "object"));
}

}  // namespace

void read_canopen(Reading& reading, const json& node, const std::string& pointer, CanopenSpec& out) {
  out.heartbeat = milliseconds(whole_in(node, "heartbeat_ms", 0));
  read_guard(node, out);
  out.sync = milliseconds(whole_in(node, "sync_ms", 0));
  out.boot = milliseconds(whole_in(node, "boot_ms", 0));
  out.confirm = milliseconds(whole_in(node, "confirm_ms", kDefaultConfirmMs));
  out.sdo_block = flag_in(node, "sdo_block", false);
  if (const json* tpdos = member(node, "tpdo"); tpdos != nullptr && tpdos->is_array())
    for (std::size_t i = 0; i < tpdos->size(); ++i)
      read_tpdo(reading, (*tpdos)[i], pointer_to(pointer_to(pointer, "tpdo"), i), out);
  if (const json* unused = member(node, "unused_tpdos"); unused != nullptr && unused->is_array())
    for (const json& number : *unused) out.unused_tpdos.push_back(static_cast<std::uint8_t>(whole(number).value_or(0)));
}

void check_canopen(Reading& reading, const ProtocolSpec& protocol, const std::string& pointer) {
  check_numbers(reading, protocol.canopen, pointer);
  std::set<std::string> mapped;
  for (std::size_t i = 0; i < protocol.canopen.tpdos.size(); ++i)
    check_map(reading, protocol.canopen.tpdos[i], mapped,
              pointer_to(pointer_to(pointer_to(pointer, "tpdo"), i), "map"));
  check_heartbeat(reading, protocol.canopen, pointer);
  check_guard(reading, protocol.canopen, pointer);
  if (protocol.loss.by == LossSpec::By::heartbeat_consumer)
    check_consumer(reading, protocol.loss, pointer_to(pointer, "loss"));
  if (protocol.loss.by == LossSpec::By::life_guarding)
    check_life_guarding(reading, protocol, pointer_to(pointer, "loss"));
}

}  // namespace axisgate::profile
