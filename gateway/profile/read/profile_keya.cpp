// SPDX-License-Identifier: Apache-2.0
// Keya's own protocols in a profile: queries by their number, and what a byte of an answer is in the words of an
// exchange. Everything that the adapters take for granted is checked here.
#include <algorithm>
#include <array>
#include <set>

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

const Layout& layout_of(std::string_view protocol) { return *std::ranges::find(kLayouts, protocol, &Layout::protocol); }

/// Where one object is, on one protocol.
class PlaceInFrame {
 public:
  PlaceInFrame(Reading& reading, const Object& object, const JsonNode& node, Place place)
      : reading_(reading),
        layout_(layout_of(node.key())),
        object_(object),
        node_(node),
        byte_(node.whole("byte", layout_.first)),
        out_(std::move(place)) {}

  std::optional<Place> on_can() {
    if (node_.has("query")) return refuse("keya-can has index and sub-index: \"2103.01\"");
    if (node_.has("heartbeat") && node_.has("byte"))
      return refuse("\"heartbeat\" is the byte already: leave out \"byte\"");
    if (node_.has("heartbeat")) return in_heartbeat(node_.whole("heartbeat", 0));
    const std::uint16_t page = out_.address.index & 0xFF00U;
    if (page == (kQuery & 0xFF00U)) return in_query(out_.address.index, out_.address.sub);
    if (page != (kValue & 0xFF00U)) return refuse("keya-can has commands, 20xx, and queries, 21xx");
    if (byte_ != layout_.first || out_.size != kValueSize)
      return refuse("a command carries one number of 4 bytes: no \"byte\", and type i32 or u32");
    return command(out_.address.index, out_.address.sub);
  }

  std::optional<Place> on_a_line() {
    const std::string name = node_.is_string() ? node_.text() : node_.text("address");
    if (name == "on" || name == "value") return in_control_frame(name == "on");
    if (!node_.has("query") || node_.has("heartbeat"))
      return refuse(
          "give a query and its byte, {\"query\": 2, \"byte\": 2}, or, of the control frame, \"on\" or \"value\"");
    const std::optional<std::int64_t> query = node_["query"].whole();
    if (!query || *query < 0 || *query > kLastQuery)
      return refuse(fmt::format("a query has a number from 0 to {}", kLastQuery));
    if (!node_.has("byte")) return refuse("give the \"byte\" of the answer with which the value begins");
    return in_query(static_cast<std::uint16_t>(kQuery + *query), 0);
  }

 private:
  std::nullopt_t refuse(std::string why) {
    reading_.fault(node_.pointer(), std::move(why));
    return std::nullopt;
  }

  std::optional<Place> in_query(std::uint16_t index, std::uint8_t sub) {
    if (object_.writable) return refuse("is a query: \"access\" can only be ro");
    if (byte_ < layout_.first || byte_ + out_.size > layout_.end)
      return refuse(
          fmt::format("does not lie within bytes {} to {}, which hold the data", layout_.first, layout_.end - 1));
    return at(index, sub, byte_ - layout_.first);
  }

  std::optional<Place> in_heartbeat(std::int64_t byte) {
    if (object_.writable) return refuse("is sent by the drive: \"access\" can only be ro");
    const auto here = [&](const auto& field) { return field.first == byte && field.second == out_.size; };
    if (std::ranges::none_of(kHeartbeatFields, here))
      return refuse("a heartbeat holds two bytes each from bytes 0, 2 and 4 on, and one at 6 and at 7");
    out_.unsolicited = true;
    out_.readable = false;
    return at(kHeartbeat, 0, byte);
  }

  /// The control frame is laid out by the adapter: a bit and a value for each motor.
  std::optional<Place> in_control_frame(bool on) {
    if (on && out_.size != 1) return refuse("an enable bit is of type u8");
    if (!on && (out_.size != kValueSize || !out_.is_signed))
      return refuse("a motor's value in the control frame is of type i32");
    if (object_.slot >= kMotors)
      return refuse(
          "the control frame has an enable bit and a value of motors 1 and 2: name the object \"A.\" or \"B.\"");
    out_.turns_on = on;
    out_.composed = true;
    return command(on ? kOn : kValue, static_cast<std::uint8_t>(object_.slot + 1));
  }

  std::optional<Place> command(std::uint16_t index, std::uint8_t sub) {
    if (!object_.writable) return refuse("is a command: \"access\" must be wo or rw");
    if (object_.slot != kNoAxis && object_.slot + 1 != sub)
      return refuse(fmt::format("is motor {}'s place, and object \"{}\" belongs to another", sub, object_.name));
    out_.readable = false;
    return at(index, sub, 0);
  }

  std::optional<Place> at(std::uint16_t index, std::uint8_t sub, std::int64_t byte) {
    out_.address = {index, sub, static_cast<std::uint8_t>(byte)};
    return out_;
  }

  Reading& reading_;
  const Layout& layout_;
  const Object& object_;
  const JsonNode& node_;
  std::int64_t byte_ = 0;
  Place out_;
};

}  // namespace

bool is_keya(std::string_view protocol) {
  return std::ranges::find(kLayouts, protocol, &Layout::protocol) != kLayouts.end();
}

std::optional<Place> place_in_frame(Reading& reading, const Object& object, const JsonNode& node, Place place) {
  PlaceInFrame out(reading, object, node, std::move(place));
  return layout_of(node.key()).by_index ? out.on_can() : out.on_a_line();
}

/// The control frame is written whole: what nobody can say of a motor would be sent as 0.
void check_control_frame(Reading& reading, const std::string& protocol, const std::string& pointer) {
  std::set<ObjectAddress> fields;
  for (const Object& object : reading.profile.objects)
    if (const Place* place = object.place(protocol); place != nullptr && place->composed) fields.insert(place->address);
  if (fields.empty()) return;
  for (const auto& [index, what] : {std::pair(kOn, "enable bit"), std::pair(kValue, "value")})
    for (std::uint8_t motor = 1; motor <= kMotors; ++motor)
      if (!fields.contains({index, motor, 0}))
        reading.fault(pointer, "no object is the {} of motor {} in the control frame", what, motor);
}

}  // namespace axisgate::profile
