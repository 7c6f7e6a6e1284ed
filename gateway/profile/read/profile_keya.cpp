// SPDX-License-Identifier: Apache-2.0
// Keya's own protocols in a profile: queries by their number, and what a byte of an answer is in the words of an
// exchange. Everything that the adapters take for granted is checked here.
#include <algorithm>
#include <array>

#include "gateway/profile/read/profile_reading.hpp"

namespace axisgate::profile {

namespace {

// Where ObjectAddress says these objects are.
constexpr std::uint16_t kQuery = 0x2100, kOn = 0x200D, kValue = 0x2000, kHeartbeat = 0x7000;
constexpr std::int64_t kValueSize = 4;
/// First byte and size of what keya-can's heartbeat holds.
constexpr std::array<std::pair<std::int64_t, std::uint8_t>, 5> kHeartbeatFields{
    {{0, 2}, {2, 2}, {4, 2}, {6, 1}, {7, 1}}};
constexpr std::size_t kMotors = 2;

/// What the frames of one protocol hold.
struct Layout {
  std::string_view protocol;
  bool by_index = false;  ///< objects have index and sub-index, and the drive sends a heartbeat; else queries by number
  std::int64_t first = 4;  ///< byte with which data begins
  std::int64_t end = 8;    ///< and the byte after its last one
};
constexpr std::array<Layout, 3> kLayouts{{
    {"keya-can", true, 4, 8},
    {"keya-rs232", false, 2, 12},
    {"keya-rs485", false, 3, 11},
}};
constexpr std::int64_t kLastQuery = 0xFF;
constexpr const char* kPlaceOnALine =
    "give a query and its byte, {\"query\": 2, \"byte\": 2}, or, of the control frame, \"on\" or \"value\"";

const Layout& layout_of(std::string_view protocol) { return *std::ranges::find(kLayouts, protocol, &Layout::protocol); }

/// Where one object is, on one protocol.
class PlaceInFrame {
 public:
  PlaceInFrame(Reading& reading, const Object& object, const JsonNode& node)
      : reading_(reading), layout_(layout_of(node.key())), object_(object), node_(node) {}

  std::optional<Place> read(Place out) {
    type_ = object_.type_at(out);
    byte_ = node_.whole("byte", layout_.first);
    return layout_.by_index ? on_can(std::move(out)) : on_a_line(std::move(out));
  }

 private:
  std::nullopt_t refuse(std::string why) {
    reading_.fault(node_.pointer(), std::move(why));
    return std::nullopt;
  }
  std::nullopt_t refuse_bytes(std::int64_t first, std::int64_t end) {
    return refuse(fmt::format("does not lie within bytes {} to {}, which hold the data", first, end - 1));
  }
  [[nodiscard]] bool fits(std::int64_t first, std::int64_t end) const {
    return byte_ >= first && byte_ + type_.size <= end;
  }
  /// "on", or {"address": "on"}.
  [[nodiscard]] bool is_called(std::string_view name) const {
    return node_.text() == name || node_.text("address") == name;
  }

  std::optional<Place> on_can(Place out) {
    if (node_.has("query")) return refuse("keya-can has index and sub-index: \"2103.01\"");
    if (node_.has("heartbeat") && node_.has("byte"))
      return refuse("\"heartbeat\" is the byte already: leave out \"byte\"");
    if (node_.has("heartbeat")) return in_heartbeat(node_.whole("heartbeat", 0), std::move(out));
    const std::uint16_t page = out.address.index & 0xFF00U;
    if (page == (kQuery & 0xFF00U)) return in_query(std::move(out), out.address.index, out.address.sub);
    if (page != (kValue & 0xFF00U)) return refuse("keya-can has commands, 20xx, and queries, 21xx");
    if (byte_ != layout_.first || type_.size != kValueSize)
      return refuse("a command carries one number of 4 bytes: no \"byte\", and type i32 or u32");
    return command(std::move(out), out.address.index, out.address.sub);
  }

  std::optional<Place> on_a_line(Place out) {
    if (is_called("on")) return enable_bit(std::move(out));
    if (is_called("value")) return value(std::move(out));
    if (!node_.has("query") || node_.has("heartbeat")) return refuse(kPlaceOnALine);
    const std::optional<std::int64_t> query = node_["query"].whole();
    if (!query || *query < 0 || *query > kLastQuery)
      return refuse(fmt::format("a query has a number from 0 to {}", kLastQuery));
    if (!node_.has("byte")) return refuse("give the \"byte\" of the answer with which the value begins");
    return in_query(std::move(out), static_cast<std::uint16_t>(kQuery + *query), 0);
  }

  std::optional<Place> in_query(Place out, std::uint16_t index, std::uint8_t sub) {
    if (object_.writable) return refuse("is a query: \"access\" can only be ro");
    if (!fits(layout_.first, layout_.end)) return refuse_bytes(layout_.first, layout_.end);
    out.address = {index, sub, static_cast<std::uint8_t>(byte_ - layout_.first)};
    return out;
  }

  std::optional<Place> in_heartbeat(std::int64_t byte, Place out) {
    if (object_.writable) return refuse("is sent by the drive: \"access\" can only be ro");
    const auto here = [&](const auto& field) { return field.first == byte && field.second == type_.size; };
    if (std::ranges::none_of(kHeartbeatFields, here))
      return refuse("a heartbeat holds two bytes each from bytes 0, 2 and 4 on, and one at 6 and at 7");
    out.address = {kHeartbeat, 0, static_cast<std::uint8_t>(byte)};
    out.unsolicited = true;
    return out;
  }

  /// The control frame is laid out by the adapter: a bit and a value for each motor.
  std::optional<Place> enable_bit(Place out) {
    if (type_.size != 1) return refuse("an enable bit is of type u8");
    out.turns_on = true;
    return in_control_frame(std::move(out), kOn);
  }

  std::optional<Place> value(Place out) {
    if (type_ != DataType{kValueSize, true}) return refuse("a motor's value in the control frame is of type i32");
    return in_control_frame(std::move(out), kValue);
  }

  std::optional<Place> in_control_frame(Place out, std::uint16_t index) {
    if (object_.slot >= kMotors)
      return refuse(
          "the control frame has an enable bit and a value of motors 1 and 2: name the object \"A.\" or \"B.\"");
    out.composed = true;
    return command(std::move(out), index, static_cast<std::uint8_t>(object_.slot + 1));
  }

  std::optional<Place> command(Place out, std::uint16_t index, std::uint8_t sub) {
    if (!object_.writable) return refuse("is a command: \"access\" must be wo or rw");
    if (object_.slot != kNoAxis && object_.slot + 1 != sub)
      return refuse(fmt::format("is motor {}'s place, and object \"{}\" belongs to another", sub, object_.name));
    out.address = {index, sub, 0};
    out.write_only = true;
    return out;
  }

  Reading& reading_;
  const Layout& layout_;
  const Object& object_;
  const JsonNode& node_;
  DataType type_;
  std::int64_t byte_ = 0;
};

}  // namespace

bool is_keya(std::string_view protocol) {
  return std::ranges::find(kLayouts, protocol, &Layout::protocol) != kLayouts.end();
}

std::optional<Place> place_in_frame(Reading& reading, const Object& object, const JsonNode& node, Place place) {
  return PlaceInFrame(reading, object, node).read(std::move(place));
}

/// The control frame is written whole: what nobody can say of a motor would be sent as 0.
void check_control_frame(Reading& reading, const std::string& protocol, const std::string& pointer) {
  std::vector<ObjectAddress> fields;
  for (const Object& object : reading.profile.objects)
    if (const Place* place = object.place(protocol); place != nullptr && place->composed)
      fields.push_back(place->address);
  if (fields.empty()) return;
  for (const auto& [index, what] : {std::pair(kOn, "enable bit"), std::pair(kValue, "value")})
    for (std::uint8_t motor = 1; motor <= kMotors; ++motor)
      if (std::ranges::find(fields, ObjectAddress{index, motor, 0}) == fields.end())
        reading.fault(pointer, "no object is the {} of motor {} in the control frame", what, motor);
}

}  // namespace axisgate::profile
