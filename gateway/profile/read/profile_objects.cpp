// SPDX-License-Identifier: Apache-2.0
// Section "objects": the only place with addresses.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

using nlohmann::json;

namespace {

std::optional<ObjectAddress> index_and_sub(const json& node) {
  if (!node.is_string()) return std::nullopt;
  const std::string& text = node.get_ref<const std::string&>();
  if (text.size() != 7 || text[4] != '.') return std::nullopt;
  const std::optional<std::int64_t> index = whole(json("0x" + text.substr(0, 4)));
  const std::optional<std::int64_t> sub = whole(json("0x" + text.substr(5)));
  if (!index || !sub) return std::nullopt;
  return ObjectAddress{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*sub)};
}

std::optional<ObjectAddress> register_number(const json& node) {
  const std::optional<std::int64_t> number = whole(node);
  if (!number || *number < 0 || *number > 0xFFFF) return std::nullopt;
  return ObjectAddress{static_cast<std::uint16_t>(*number), 0};
}

class PlaceReader {
 public:
  PlaceReader(Reading& reading, const Object& object, std::string protocol, std::string pointer)
      : reading_(reading), object_(object), protocol_(std::move(protocol)), pointer_(std::move(pointer)) {}

  std::optional<Place> read(const json& node) {
    const bool detailed = node.is_object();
    const json* address = detailed ? member(node, "address") : &node;
    Place out;
    out.derived = flag_in(node, "derived", false);
    out.type = type_named(text_in(node, "type"));
    const bool keya = is_keya(protocol_);
    for (const char* key : {"query", "byte", "heartbeat"})
      if (!keya && member(node, key) != nullptr)
        reading_.fault(pointer_, "\"" + std::string(key) + "\" belongs to the keya protocols; " + expected());
    if (keya && (protocol_ != "keya-can" || member(node, "heartbeat") != nullptr || member(node, "query") != nullptr))
      return place_in_frame(reading_, protocol_, object_, node, pointer_, std::move(out));
    const std::optional<ObjectAddress> found = address == nullptr          ? std::nullopt
                                               : protocol_ == "modbus-rtu" ? register_number(*address)
                                                                           : index_and_sub(*address);
    if (!found) {
      reading_.fault(
          pointer_,
          (address == nullptr ? "no address" : address->dump() + " is no address of " + protocol_) + "; " + expected());
      return std::nullopt;
    }
    out.address = *found;
    return keya ? place_in_frame(reading_, protocol_, object_, node, pointer_, std::move(out)) : std::optional(out);
  }

 private:
  [[nodiscard]] std::string expected() const {
    if (protocol_ == "modbus-rtu") return "give a register, 302 or \"0x3100\"";
    if (protocol_ == "keya-can")
      return "give index and sub-index, \"200D.01\", or a byte of the heartbeat, {\"heartbeat\": 7}";
    return "give index and sub-index in hexadecimal, \"6041.00\"";
  }

  Reading& reading_;
  const Object& object_;
  std::string protocol_;
  std::string pointer_;
};

void read_access(const json& node, Object& out) {
  const std::string access = text_in(node, "access");
  out.readable = access != "wo";
  out.writable = access == "wo" || access == "rw";
}

void read_range(Reading& reading, const json& node, Object& out) {
  const json* range = member(node, "range");
  if (range == nullptr || !range->is_array() || range->size() != 2) return;
  const std::string pointer = pointer_to(out.pointer, "range");
  const Range type = Object(out).numbers();
  const Range given{whole((*range)[0]).value_or(type.min), whole((*range)[1]).value_or(type.max)};
  if (given.min > given.max)
    reading.fault(pointer, "the first limit is above the second");
  else if (!type.holds(given.min) || !type.holds(given.max))
    reading.fault(pointer, "is wider than the object's type, which takes " + range_text(type));
  else
    out.range = given;
}

void read_slot(Reading& reading, Object& out) {
  const std::size_t dot = out.name.find('.');
  if (dot == std::string::npos) return;
  const std::vector<std::string>& axes = reading.profile.axes;
  const auto axis = std::find(axes.begin(), axes.end(), out.name.substr(0, dot));
  if (axis == axes.end())
    reading.fault(out.pointer, "\"" + out.name.substr(0, dot) + "\" is no axis of this drive: not under /axes");
  else
    out.slot = static_cast<AxisSlot>(axis - axes.begin());
}

void read_object(Reading& reading, const std::string& name, const json& node) {
  Object out;
  out.name = name;
  out.pointer = pointer_to("/objects", name);
  read_slot(reading, out);
  out.type = type_named(text_in(node, "type")).value_or(DataType{});
  read_access(node, out);
  out.trigger = flag_in(node, "trigger", false);
  out.any_width = flag_in(node, "any_width", false);
  out.mailbox_reads_only = text_in(node, "mailbox") == "read";
  const std::string nvm = text_in(node, "nvm");
  out.nvm = nvm.empty() ? reading.profile.nvm : nvm_named(nvm);
  out.unit = text_in(node, "unit");
  if (!out.unit.empty() && !reading.profile.units.contains(out.unit))
    reading.fault(pointer_to(out.pointer, "unit"), "unknown unit \"" + out.unit + "\": not under /units" +
                                                       did_you_mean(out.unit, keys_in(reading.profile.units)));
  out.alias_of = text_in(node, "alias_of");
  read_range(reading, node, out);
  if (out.trigger && !out.writable)
    reading.fault(pointer_to(out.pointer, "trigger"), "only a writable object can be a trigger");
  if (const json* places = member(node, "at"); places != nullptr && places->is_object()) {
    for (const auto& [protocol, place] : places->items()) {
      const std::string at = pointer_to(pointer_to(out.pointer, "at"), protocol);
      if (!reading.profile.protocols.contains(protocol)) {
        reading.fault(at, "protocol \"" + protocol + "\" is not under /protocols" +
                              did_you_mean(protocol, keys_in(reading.profile.protocols)));
        continue;
      }
      if (std::optional<Place> found = PlaceReader(reading, out, protocol, at).read(place))
        out.places.emplace(protocol, std::move(*found));
    }
  }
  reading.profile.objects.push_back(std::move(out));
}

/// The bits an object takes where it lies: two objects must not take the same ones.
struct Extent {
  std::string where;
  std::int64_t from = 0, to = 0;
};

Extent extent(const std::string& protocol, const Object& object, const Place& place) {
  const std::int64_t size = object.type_at(place).size * 8;
  if (protocol == "modbus-rtu")
    return {"", place.address.index * 16, place.address.index * 16 + std::max<std::int64_t>(size, 16)};
  const std::int64_t from = place.address.byte * 8;
  return {std::to_string(place.address.index) + "." + std::to_string(place.address.sub), from, from + size};
}

void check_addresses(Reading& reading) {
  const std::vector<Object>& objects = reading.profile.objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (const auto& [protocol, place] : objects[i].places) {
      const Extent mine = extent(protocol, objects[i], place);
      if (protocol == "modbus-rtu" && mine.to > kLastRegister * 16 + 16)
        reading.fault(pointer_to(pointer_to(objects[i].pointer, "at"), protocol),
                      "is wider than one register, and there is none after " + std::to_string(kLastRegister));
      for (std::size_t j = 0; j < i; ++j) {
        const auto other = objects[j].places.find(protocol);
        if (other == objects[j].places.end() || are_aliases(objects[i], objects[j])) continue;
        const Extent theirs = extent(protocol, objects[j], other->second);
        if (mine.where == theirs.where && mine.from < theirs.to && theirs.from < mine.to)
          reading.fault(
              pointer_to(pointer_to(objects[i].pointer, "at"), protocol),
              "object \"" + objects[j].name + "\" has this address already; if that is meant, say \"alias_of\"");
      }
    }
  }
}

void check_alias(Reading& reading, const Object& object) {
  if (object.alias_of.empty()) return;
  const std::vector<Object>& objects = reading.profile.objects;
  const auto named =
      std::find_if(objects.begin(), objects.end(), [&](const Object& o) { return o.name == object.alias_of; });
  if (named == objects.end())
    reading.fault(pointer_to(object.pointer, "alias_of"),
                  "unknown object \"" + object.alias_of + "\": not under /objects");
}

}  // namespace

bool are_aliases(const Object& a, const Object& b) {
  return a.alias_of == b.name || b.alias_of == a.name || (!a.alias_of.empty() && a.alias_of == b.alias_of);
}

void read_objects(Reading& reading) {
  const json* section = member(reading.document, "objects");
  if (section == nullptr || !section->is_object()) return;
  for (const auto& [name, node] : section->items()) read_object(reading, name, node);
  if (reading.profile.objects.size() > model::kMaxObjects)
    reading.fault("/objects", "more than " + std::to_string(model::kMaxObjects) + " objects");
  for (const Object& object : reading.profile.objects) {
    check_alias(reading, object);
    if (object.slot == kNoAxis) continue;
    const std::string shared = object.name.substr(object.name.find('.') + 1);
    if (std::any_of(reading.profile.objects.begin(), reading.profile.objects.end(),
                    [&](const Object& o) { return o.name == shared; }))
      reading.fault(object.pointer, "both \"" + shared + "\" and \"" + object.name +
                                        "\" exist: a name without axis would be ambiguous");
  }
  check_addresses(reading);
}

}  // namespace axisgate::profile
