// SPDX-License-Identifier: Apache-2.0
// Section "objects": the only place with addresses.
#include <algorithm>
#include <span>

#include "gateway/core/name_table.hpp"
#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

std::optional<ObjectAddress> index_and_sub(const JsonNode& node) {
  const std::string text = node.text();
  if (text.size() != 7 || text[4] != '.') return std::nullopt;
  const std::optional<std::int64_t> index = whole_number("0x" + text.substr(0, 4));
  const std::optional<std::int64_t> sub = whole_number("0x" + text.substr(5));
  if (!index || !sub) return std::nullopt;
  return ObjectAddress{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*sub)};
}

std::optional<ObjectAddress> register_number(const JsonNode& node) {
  const std::optional<std::int64_t> number = node.whole();
  if (!number || *number < 0 || *number > kLastRegister) return std::nullopt;
  return ObjectAddress{static_cast<std::uint16_t>(*number), 0};
}

std::string_view expected_on(std::string_view protocol) {
  if (protocol == "modbus-rtu") return "give a register, 302 or \"0x3100\"";
  if (protocol == "keya-can")
    return "give index and sub-index, \"200D.01\", or a byte of the heartbeat, {\"heartbeat\": 7}";
  return "give index and sub-index in hexadecimal, \"6041.00\"";
}

bool is_bit(const ObjectAddress& address) {
  return address.sub == static_cast<std::uint8_t>(ModbusTable::coil) ||
         address.sub == static_cast<std::uint8_t>(ModbusTable::discrete);
}

/// modbus-rtu: which table the number is of.
std::uint8_t read_table(Reading& reading, const Object& object, const JsonNode& node) {
  static constexpr auto kTables = names_of<ModbusTable>({{ModbusTable::holding, "holding"},
                                                         {ModbusTable::input, "input"},
                                                         {ModbusTable::coil, "coil"},
                                                         {ModbusTable::discrete, "discrete"}});
  const std::string name = node.text("table");
  const ModbusTable table = kTables.named(name).value_or(ModbusTable::holding);
  const auto sub = static_cast<std::uint8_t>(table);
  if (object.writable && (table == ModbusTable::input || table == ModbusTable::discrete))
    reading.fault(node.pointer("table"), "\"{}\" can only be read, and object \"{}\" is written", name, object.name);
  if (is_bit({0, sub}) && (object.size != 1 || object.is_signed))
    reading.fault(node.pointer("table"), "\"{}\" holds one bit: object \"{}\" has to be a u8", name, object.name);
  return sub;
}

std::optional<Place> read_place(Reading& reading, const Object& object, const JsonNode& node) {
  const std::string protocol = node.key();
  const JsonNode address = node.is_object() ? node["address"] : node;
  Place out{object, false, node.flag("derived", false)};
  take_type(out, node.text("type"));
  const bool keya = is_keya(protocol);
  for (const char* key : {"query", "byte", "heartbeat"})
    if (!keya && node.has(key))
      reading.fault(node.pointer(), "\"{}\" belongs to the keya protocols; {}", key, expected_on(protocol));
  if (keya && (protocol != "keya-can" || node.has("heartbeat") || node.has("query")))
    return place_in_frame(reading, object, node, std::move(out));
  const std::optional<ObjectAddress> found =
      protocol == "modbus-rtu" ? register_number(address) : index_and_sub(address);
  if (!found) {
    const std::string wrong = address ? address.dump() + " is no address of " + protocol : "no address";
    reading.fault(node.pointer(), "{}; {}", wrong, expected_on(protocol));
    return std::nullopt;
  }
  out.address = *found;
  if (protocol == "modbus-rtu")
    out.address.sub = read_table(reading, object, node);
  else if (node.has("table"))
    reading.fault(node.pointer("table"), "belongs to modbus-rtu; {}", expected_on(protocol));
  return keya ? place_in_frame(reading, object, node, std::move(out)) : std::optional(out);
}

void read_range(Reading& reading, const JsonNode& node, Object& out) {
  const std::vector<JsonNode> ends = node.elements();
  if (ends.size() != 2) return;
  const Range type = out.range();
  const Range given{ends[0].whole().value_or(type.min), ends[1].whole().value_or(type.max)};
  if (given.min > given.max)
    reading.fault(node.pointer(), "the first limit is above the second");
  else if (!type.holds(given.min) || !type.holds(given.max))
    reading.fault(node.pointer(), "is wider than the object's type, which takes {}", range_text(type));
  else
    out.printed = given;
}

void read_slot(Reading& reading, Object& out) {
  const std::size_t dot = out.name.find('.');
  if (dot == std::string::npos) return;
  const std::vector<std::string>& axes = reading.profile.axes;
  const auto axis = std::ranges::find(axes, out.name.substr(0, dot));
  if (axis == axes.end())
    reading.fault(out.pointer, "\"{}\" is no axis of this drive: not under /axes", out.name.substr(0, dot));
  else
    out.slot = static_cast<AxisSlot>(axis - axes.begin());
}

void read_part(Reading& reading, const JsonNode& node, Object& out) {
  const auto bits = static_cast<std::int64_t>(8 * out.size);
  const std::int64_t count = node.whole("count", bits);
  if (count > bits) reading.fault(node.pointer("count"), "is more than the {} bits of its type", bits);
  out.whole = node.text("of");
  out.part.whole = 0;  // which objects these are, place_parts() finds
  out.part.from = static_cast<std::uint8_t>(node.whole("from", 0));
  out.part.count = static_cast<std::uint8_t>(std::min(count, bits));
  const JsonNode sign = node["sign"];
  out.sign = sign.text("object");
  if (sign) out.part.sign = 0;
  out.part.positive = sign.whole("positive", 0);
  out.part.negative = sign.whole("negative", 0);
  if (sign && out.part.positive == out.part.negative)
    reading.fault(sign.pointer(), "\"positive\" and \"negative\" must differ");
  if (sign && (node.has("from") || node.has("count")))
    reading.fault(node.pointer(),
                  "with a \"sign\" all of the whole is the magnitude: leave \"from\" and \"count\" out");
  if (sign && !out.is_signed)
    reading.fault(pointer_to(out.pointer, "type"), "a number with a direction needs a type with a sign: i16 or i32");
  if (out.trigger) reading.fault(out.pointer, "a part starts nothing: it is written with the rest of the whole");
}

void read_object(Reading& reading, const JsonNode& node) {
  Object out;
  out.name = node.key();
  out.pointer = node.pointer();
  read_slot(reading, out);
  take_type(out, node.text("type"));
  const std::string access = node.text("access");
  out.readable = access != "wo";
  out.writable = access == "wo" || access == "rw";
  out.trigger = node.flag("trigger", false);
  out.any_width = node.flag("any_width", false);
  out.mailbox_reads_only = node.text("mailbox") == "read";
  const std::string nvm = node.text("nvm");
  out.nvm = nvm.empty() ? reading.profile.nvm : nvm_named(nvm);
  out.unit = node.text("unit");
  if (!out.unit.empty()) reading.names_unit(out.unit, node.pointer("unit"));
  out.alias_of = node.text("alias_of");
  if (node.has("part")) read_part(reading, node["part"], out);
  if (node.has("part") == node.has("at"))
    reading.fault(out.pointer, "an object has an address, \"at\", or is a \"part\" of one: give one of them");
  for (const char* key : {"part", "range", "any_width"})
    if (out.is_real && node.has(key))
      reading.fault(node.pointer(key), "object \"{}\" is an f32, which has none", out.name);
  read_range(reading, node["range"], out);
  if (out.trigger && !out.writable) reading.fault(node.pointer("trigger"), "only a writable object can be a trigger");
  for (const JsonNode& place : node["at"].members()) {
    if (!reading.names_protocol(place.key(), place.pointer())) continue;
    if (std::optional<Place> found = read_place(reading, out, place))
      out.places.emplace(place.key(), std::move(*found));
  }
  if (const Place* rtu = out.place("modbus-rtu");
      rtu != nullptr && is_bit(rtu->address) && out.size == 1 && !node.has("range"))
    out.printed = {0, 1};
  reading.profile.objects.push_back(std::move(out));
}

/// The bits an object takes where it lies: two objects must not take the same ones.
struct Extent {
  ObjectAddress where;
  std::int64_t from = 0, to = 0;
};

Extent extent(const std::string& protocol, const Place& place) {
  const ObjectAddress& at = place.address;
  const std::int64_t bits = place.size * 8;
  if (protocol == "modbus-rtu") return {{0, at.sub}, at.index * 16, at.index * 16 + std::max<std::int64_t>(bits, 16)};
  return {{at.index, at.sub}, at.byte * 8, at.byte * 8 + bits};
}

/// `object` at its place on one protocol, against all `before` it.
void check_address(Reading& reading, const Object& object, const std::string& protocol,
                   std::span<const Object> before) {
  if (object.is_part()) return;
  const std::string at = pointer_to(pointer_to(object.pointer, "at"), protocol);
  const Extent mine = extent(protocol, *object.place(protocol));
  if (protocol == "modbus-rtu" && mine.to > kLastRegister * 16 + 16)
    reading.fault(at, "is wider than one register, and there is none after {}", kLastRegister);
  for (const Object& other : before) {
    const Place* place = other.place(protocol);
    if (place == nullptr || other.is_part() || are_aliases(object, other)) continue;
    const Extent theirs = extent(protocol, *place);
    if (mine.where == theirs.where && mine.from < theirs.to && theirs.from < mine.to)
      reading.fault(at, "object \"{}\" has this address already; if that is meant, say \"alias_of\"", other.name);
  }
}

/// What is written of a whole is the part's alone: it must be readable before, and nothing may start by being written.
void check_whole(Reading& reading, const Object& whole, const Object& part) {
  const std::string at = pointer_to(part.pointer, "part");
  if (whole.is_part()) return reading.fault(at, "object \"{}\" is a part itself: name the whole", whole.name);
  if (whole.slot != kNoAxis && whole.slot != part.slot)
    reading.fault(at, "object \"{}\" belongs to another axis", whole.name);
  if (whole.any_width) reading.fault(at, "object \"{}\" has any width: which bits these are nobody knows", whole.name);
  if (part.readable) reading.needs_readable(whole, at);
  reading.needs_whole(whole, at);
  if (part.writable && !(whole.readable && whole.writable && !whole.trigger))
    reading.fault(at, "object \"{}\" must be readable, writable and no trigger, for its part to be written",
                  whole.name);
  for (const auto& [protocol, place] : whole.places) {
    if (is_keya(protocol)) reading.fault(at, "{} has no parts: name a byte of the frame", protocol);
    const int bits = 8 * place.size;
    if (part.part.from + part.part.count > bits)
      reading.fault(at, "reaches beyond the {} bits of object \"{}\"", bits, whole.name);
  }
}

bool share_bits(const model::PartOf& a, const model::PartOf& b) {
  return a.from < b.from + b.count && b.from < a.from + a.count;
}

/// It is written just before its magnitude, and read beside it.
void check_sign(Reading& reading, const Object& whole, Object& part) {
  const Profile& profile = reading.profile;
  const std::string at = pointer_to(pointer_to(part.pointer, "part"), "sign");
  if (whole.is_signed) reading.fault(at, "object \"{}\" has a sign of its own", whole.name);
  part.printed = model::intersection(part.numbers(), {-whole.numbers().max, whole.numbers().max});
  if (!reading.names_object(part.sign, at)) return;
  const Object* way = profile.find(part.sign, kNoAxis);
  if (way == nullptr) return reading.fault(at, "name the object of one axis: \"A.{}\"", part.sign);
  if (way->is_directed()) return reading.fault(at, "object \"{}\" has a direction itself", way->name);
  if (way->slot != kNoAxis && way->slot != part.slot)
    reading.fault(at, "object \"{}\" belongs to another axis", way->name);
  if (part.readable) reading.needs_readable(*way, at);
  if (part.writable) reading.needs_writable(*way, at);
  for (const std::int64_t number : {part.part.positive, part.part.negative}) reading.needs_number(*way, number, at);
  if (const Object* placed = way->is_part() ? profile.find(way->whole, kNoAxis) : way; placed != nullptr)
    for (const auto& [protocol, place] : whole.places) reading.needs_address(*placed, protocol, at);
}

/// A part is where its whole is.
void place_parts(Reading& reading) {
  std::vector<Object>& objects = reading.profile.objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    Object& part = objects[i];
    if (!part.is_part()) continue;
    const auto whole = std::ranges::find(objects, part.whole, &Object::name);
    if (whole == objects.end()) {
      reading.fault(pointer_to(part.pointer, "part"), "unknown object \"{}\": not under /objects", part.whole);
      continue;
    }
    part.part.whole = static_cast<model::ObjectId>(whole - objects.begin());
    if (part.is_directed()) part.part.count = static_cast<std::uint8_t>(8 * whole->size);
    check_whole(reading, *whole, part);
    if (part.is_directed()) check_sign(reading, *whole, part);
    for (const auto& [protocol, place] : whole->places)
      part.places.emplace(protocol, Place{part, false, false}).first->second.address = place.address;
    for (const Object& other : std::span(objects).first(i))
      if (other.whole == part.whole && (other.writable || part.writable) && share_bits(other.part, part.part))
        reading.fault(pointer_to(part.pointer, "part"), "object \"{}\" has some of these bits already", other.name);
  }
}

}  // namespace

bool are_aliases(const Object& a, const Object& b) {
  return a.alias_of == b.name || b.alias_of == a.name || (!a.alias_of.empty() && a.alias_of == b.alias_of);
}

void read_objects(Reading& reading) {
  for (const JsonNode& node : reading.document["objects"].members()) read_object(reading, node);
  place_parts(reading);
  const std::vector<Object>& objects = reading.profile.objects;
  for (const Object& object : objects) {
    if (!object.alias_of.empty() && reading.profile.find(object.alias_of, kNoAxis) == nullptr)
      reading.fault(pointer_to(object.pointer, "alias_of"), "unknown object \"{}\": not under /objects",
                    object.alias_of);
    if (object.slot == kNoAxis) continue;
    const std::string shared = object.name.substr(object.name.find('.') + 1);
    if (reading.profile.find(shared, kNoAxis) != nullptr)
      reading.fault(object.pointer, "both \"{}\" and \"{}\" exist: a name without axis would be ambiguous", shared,
                    object.name);
  }
  for (std::size_t i = 0; i < objects.size(); ++i)
    for (const auto& [protocol, place] : objects[i].places)
      check_address(reading, objects[i], protocol, std::span(objects).first(i));
}

}  // namespace axisgate::profile
