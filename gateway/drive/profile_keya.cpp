// Keya's own protocols in a profile: named frames, and what a byte of one is in the words of an exchange. Everything
// that the adapters take for granted is checked here.
#include <algorithm>
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>

#include "gateway/drive/profile_reading.hpp"

namespace axisgate::drive {

using nlohmann::json;

namespace {

// Where bus::ObjectAddress says these objects are.
constexpr std::uint16_t kQuery = 0x2100, kOn = 0x200D, kValue = 0x2000, kHeartbeat = 0x7000;
constexpr std::int64_t kValueSize = 4;
/// First byte and size of what keya-can's heartbeat holds.
constexpr std::array<std::pair<std::int64_t, std::uint8_t>, 5> kHeartbeatFields{
    {{0, 2}, {2, 2}, {4, 2}, {6, 1}, {7, 1}}};
constexpr std::size_t kMotors = 2;

/// How the frames of one protocol are laid out.
struct Layout {
  std::string_view protocol;
  std::string_view control;    ///< how a control frame begins; empty: there are none with names
  std::string_view query;      ///< how a query begins, its code left out
  std::string_view unasked;    ///< how a frame that the drive sends by itself begins; empty: by nothing of its own
  bool sends_unasked = false;  ///< there are such
  std::int64_t length = 12;    ///< of every frame
  std::int64_t first = 4;      ///< byte with which data begins
  std::int64_t end = 8;        ///< and the byte after its last one
  std::int64_t on = 0;         ///< byte of the enable bits
  std::array<std::int64_t, kMotors> value{};  ///< bytes of the motors' values
};
constexpr std::array<Layout, 3> kLayouts{{
    {"keya-can", "", "", "", true, 8, 4, 8, 0, {}},
    {"keya-rs232", "E0", "ED ", "EE", true, 12, 2, 12, 1, {4, 8}},
    {"keya-rs485", "E0 ID", "ED ID ", "", false, 12, 3, 11, 2, {3, 7}},
}};

const Layout& layout_of(std::string_view protocol) {
  return *std::find_if(kLayouts.begin(), kLayouts.end(), [&](const Layout& l) { return l.protocol == protocol; });
}

std::optional<std::uint8_t> code_in(std::string_view text, const Layout& layout) {
  if (!text.starts_with(layout.query) || text.size() != layout.query.size() + 2) return std::nullopt;
  std::uint8_t code = 0;
  const auto [end, error] = std::from_chars(text.data() + layout.query.size(), text.data() + text.size(), code, 16);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(code) : std::nullopt;
}

std::string in_quotes(std::string_view text) { return "\"" + std::string(text) + "\""; }

/// Frames of one protocol, by name.
class FrameReader {
 public:
  FrameReader(Reading& reading, std::string_view protocol, std::string pointer, ProtocolSpec& out)
      : reading_(reading), layout_(layout_of(protocol)), pointer_(std::move(pointer)), out_(out) {}

  void read(const json& node) {
    each(node, "requests", [this](const json& frame, const std::string& at) { return request(frame, at); });
    each(node, "unsolicited", [this](const json& frame, const std::string& at) { return unasked(frame, at); });
    const json* requests = member(node, "requests");
    if (requests == nullptr || !requests->is_object()) return;
    for (const auto& [name, frame] : requests->items())
      acknowledgement(name, frame, pointer_to(pointer_to(pointer_, "requests"), name));
  }

 private:
  template <class Read>
  void each(const json& node, const char* section, Read read_frame) {
    const json* frames = member(node, section);
    if (frames == nullptr || !frames->is_object()) return;
    for (const auto& [name, frame] : frames->items()) {
      const std::string at = pointer_to(pointer_to(pointer_, section), name);
      FrameSpec found = read_frame(frame, at);
      length(frame, at);
      const auto same = [&](const auto& known) {
        return found.kind != FrameSpec::Kind::wrong && known.second.kind == found.kind &&
               known.second.code == found.code;
      };
      const auto twin = std::find_if(out_.frames.begin(), out_.frames.end(), same);
      if (out_.frames.contains(name))
        reading_.fault(at, "a request has this name already");
      else if (twin != out_.frames.end())
        reading_.fault(at, "is the same frame as " + in_quotes(twin->first));
      out_.frames.emplace(name, found);
    }
  }

  void length(const json& frame, const std::string& at) {
    if (whole_in(frame, "length", layout_.length) != layout_.length)
      reading_.fault(pointer_to(at, "length"),
                     "every frame of " + std::string(layout_.protocol) + " has " + std::to_string(layout_.length));
  }

  FrameSpec request(const json& frame, const std::string& at) {
    FrameSpec out;
    out.kind = FrameSpec::Kind::wrong;
    if (layout_.control.empty()) {
      reading_.fault(at, "keya-can has no named requests: give objects index and sub-index, \"2103.01\"");
      return out;
    }
    const std::string send = text_in(frame, "send");
    const std::optional<std::uint8_t> code = code_in(send, layout_);
    if (!code && send != layout_.control) {
      reading_.fault(pointer_to(at, "send"), std::string(layout_.protocol) + " has control frames, " +
                                                 in_quotes(layout_.control) + ", and queries with their code, " +
                                                 in_quotes(std::string(layout_.query) + "02"));
      return out;
    }
    out.kind = code ? FrameSpec::Kind::query : FrameSpec::Kind::control;
    out.code = code.value_or(0);
    const std::string match = text_in(frame, "match");
    if (match.empty()) return out;
    if (!code)
      reading_.fault(pointer_to(at, "match"), "no answer to a control frame is documented");
    else if (match != send)
      reading_.fault(pointer_to(at, "match"), "the answer to a query begins as the query does, " + in_quotes(send));
    return out;
  }

  FrameSpec unasked(const json& frame, const std::string& at) {
    FrameSpec out;
    out.kind = FrameSpec::Kind::unasked;
    out.every = std::chrono::milliseconds(whole_in(frame, "every_ms", 0));
    if (!layout_.sends_unasked)
      reading_.fault(at, std::string(layout_.protocol) + " has no frames that the drive sends by itself");
    else if (text_in(frame, "match") != layout_.unasked)
      reading_.fault(at, layout_.unasked.empty() ? "is known by its CAN identifier: \"match\" has no meaning here"
                                                 : "the drive's own frame begins with " + in_quotes(layout_.unasked));
    return out;
  }

  void acknowledgement(const std::string& name, const json& frame, const std::string& at) {
    if (out_.frames.find(name)->second.kind == FrameSpec::Kind::wrong) return;
    const std::string confirm = text_in(frame, "confirm");
    const bool silent = text_in(frame, "ack") == "none";
    const auto known = out_.frames.find(confirm);
    if (!confirm.empty() && (known == out_.frames.end() || (known->second.kind != FrameSpec::Kind::query &&
                                                            known->second.kind != FrameSpec::Kind::wrong)))
      reading_.fault(pointer_to(at, "confirm"),
                     "unknown request \"" + confirm + "\"" + did_you_mean(confirm, queries()));
    if (silent && confirm.empty())
      reading_.fault(at, "a request without an answer needs \"confirm\": what else would decide its outcome?");
    const bool control = out_.frames.find(name)->second.kind == FrameSpec::Kind::control;
    if (control != silent)
      reading_.fault(at, control ? "no answer to a control frame is documented: say \"ack\": \"none\""
                                 : "a query is answered: leave out \"ack\"");
  }

  [[nodiscard]] std::vector<std::string> queries() const {
    std::vector<std::string> names;
    for (const auto& [name, frame] : out_.frames)
      if (frame.kind == FrameSpec::Kind::query) names.push_back(name);
    return names;
  }

  Reading& reading_;
  const Layout& layout_;
  std::string pointer_;
  ProtocolSpec& out_;
};

/// Where one object is, on one protocol.
class PlaceInFrame {
 public:
  PlaceInFrame(Reading& reading, std::string_view protocol, const Object& object, std::string pointer)
      : reading_(reading), layout_(layout_of(protocol)), object_(object), pointer_(std::move(pointer)) {}

  std::optional<Place> read(const json& node, Place out) {
    type_ = object_.type_at(out);
    byte_ = whole_in(node, "byte", layout_.first);
    if (member(node, "bit") != nullptr) bit_ = whole_in(node, "bit", 0);
    if (out.request.empty()) return by_index(std::move(out));
    const auto& frames = reading_.profile.protocols.find(layout_.protocol)->second.frames;
    const auto frame = frames.find(out.request);
    if (frame == frames.end()) {
      reading_.fault(pointer_to(pointer_, "request"), "unknown request \"" + out.request + "\": not under /protocols/" +
                                                          std::string(layout_.protocol) +
                                                          did_you_mean(out.request, keys_in(frames)));
      return std::nullopt;
    }
    if (member(node, "byte") == nullptr) return refuse("give the \"byte\" of the frame with which the value begins");
    switch (frame->second.kind) {
      case FrameSpec::Kind::query:
        return in_query(std::move(out), static_cast<std::uint16_t>(kQuery + frame->second.code), 0);
      case FrameSpec::Kind::control:
        return bit_ ? enable_bit(std::move(out)) : value(std::move(out));
      case FrameSpec::Kind::unasked:
        return in_heartbeat(std::move(out));
      case FrameSpec::Kind::wrong:
        break;
    }
    return std::nullopt;
  }

 private:
  std::nullopt_t refuse(const std::string& why) {
    reading_.fault(pointer_, why);
    return std::nullopt;
  }
  std::nullopt_t refuse_bytes(std::int64_t first, std::int64_t end) {
    return refuse("does not lie within bytes " + std::to_string(first) + " to " + std::to_string(end - 1) +
                  ", which hold the data");
  }
  [[nodiscard]] bool fits(std::int64_t first, std::int64_t end) const {
    return byte_ >= first && byte_ + type_.size <= end;
  }

  std::optional<Place> by_index(Place out) {
    const std::uint16_t page = out.address.index & 0xFF00U;
    if (page == (kQuery & 0xFF00U)) return in_query(std::move(out), out.address.index, out.address.sub);
    if (page != (kValue & 0xFF00U)) return refuse("keya-can has commands, 20xx, and queries, 21xx");
    if (bit_ || byte_ != layout_.first || type_.size != kValueSize)
      return refuse("a command carries one number of 4 bytes: no \"byte\" or \"bit\", and type i32 or u32");
    return command(std::move(out), out.address.index, out.address.sub);
  }

  std::optional<Place> in_query(Place out, std::uint16_t index, std::uint8_t sub) {
    if (object_.writable) return refuse("is a query: \"access\" can only be ro");
    if (bit_) return refuse("\"bit\" belongs to the enable bits of a control frame: look at bits by a \"mask\"");
    if (!fits(layout_.first, layout_.end)) return refuse_bytes(layout_.first, layout_.end);
    out.address = {index, sub, static_cast<std::uint8_t>(byte_ - layout_.first)};
    return out;
  }

  std::optional<Place> in_heartbeat(Place out) {
    if (layout_.protocol != "keya-can")
      return refuse("what the drive sends by itself is looked at on keya-can alone: ask for it by a query");
    if (object_.writable) return refuse("is sent by the drive: \"access\" can only be ro");
    if (bit_) return refuse("\"bit\" belongs to the enable bits of a control frame: look at bits by a \"mask\"");
    const auto here = [&](const auto& field) { return field.first == byte_ && field.second == type_.size; };
    if (std::none_of(kHeartbeatFields.begin(), kHeartbeatFields.end(), here))
      return refuse("a heartbeat holds two bytes each from bytes 0, 2 and 4 on, and one at 6 and at 7");
    out.address = {kHeartbeat, 0, static_cast<std::uint8_t>(byte_)};
    out.unasked = true;
    return out;
  }

  std::optional<Place> enable_bit(Place out) {
    if (byte_ != layout_.on || *bit_ >= static_cast<std::int64_t>(kMotors) || type_.size != 1)
      return refuse("the enable bits are bits 0 and 1 of byte " + std::to_string(layout_.on) + ", of type u8");
    out.composed = out.turns_on = true;
    return command(std::move(out), kOn, static_cast<std::uint8_t>(*bit_ + 1));
  }

  std::optional<Place> value(Place out) {
    const auto motor = std::find(layout_.value.begin(), layout_.value.end(), byte_);
    if (motor == layout_.value.end() || type_ != DataType{kValueSize, true})
      return refuse("the motors' values begin at bytes " + std::to_string(layout_.value[0]) + " and " +
                    std::to_string(layout_.value[1]) + " of a control frame, of type i32");
    out.composed = true;
    return command(std::move(out), kValue, static_cast<std::uint8_t>(motor - layout_.value.begin() + 1));
  }

  std::optional<Place> command(Place out, std::uint16_t index, std::uint8_t sub) {
    if (!object_.writable) return refuse("is a command: \"access\" must be wo or rw");
    if (object_.slot != bus::kNoAxis && object_.slot + 1 != sub)
      return refuse("is motor " + std::to_string(sub) + "'s place, and object \"" + object_.name +
                    "\" belongs to another");
    out.address = {index, sub, 0};
    out.write_only = true;
    return out;
  }

  Reading& reading_;
  const Layout& layout_;
  const Object& object_;
  std::string pointer_;
  DataType type_;
  std::int64_t byte_ = 0;
  std::optional<std::int64_t> bit_;
};

}  // namespace

bool is_keya(std::string_view protocol) {
  return std::any_of(kLayouts.begin(), kLayouts.end(), [&](const Layout& l) { return l.protocol == protocol; });
}

void read_frames(Reading& reading, std::string_view protocol, const json& node, const std::string& pointer,
                 ProtocolSpec& out) {
  FrameReader(reading, protocol, pointer, out).read(node);
}

std::optional<Place> place_in_frame(Reading& reading, std::string_view protocol, const Object& object, const json& node,
                                    const std::string& pointer, Place place) {
  return PlaceInFrame(reading, protocol, object, pointer).read(node, std::move(place));
}

/// The control frame is written whole: what nobody can say of a motor would be sent as 0.
void check_control_frame(Reading& reading, const std::string& protocol, const std::string& pointer) {
  std::vector<bus::ObjectAddress> fields;
  for (const Object& object : reading.profile.objects)
    if (const auto place = object.places.find(protocol); place != object.places.end() && place->second.composed)
      fields.push_back(place->second.address);
  if (fields.empty()) return;
  for (const auto& [index, what] : {std::pair(kOn, "enable bit"), std::pair(kValue, "value")})
    for (std::uint8_t motor = 1; motor <= kMotors; ++motor)
      if (std::find(fields.begin(), fields.end(), bus::ObjectAddress{index, motor, 0}) == fields.end())
        reading.fault(pointer_to(pointer, "requests"), "no object is the " + std::string(what) + " of motor " +
                                                           std::to_string(motor) + " in the control frame");
}

}  // namespace axisgate::drive
