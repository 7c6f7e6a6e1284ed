// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_link/records.hpp"

#include <algorithm>
#include <bit>
#include <string_view>
#include <type_traits>
#include <utility>

namespace axisgate::dds {
namespace {

// Each record's members, once, in the order they have on the wire; coder is an Encoder or a Decoder.
template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, StateRecord> {
  coder(r.axis, r.at, r.sequence, r.statusword, r.mode, r.position, r.velocity, r.torque, r.current, r.following_error,
        r.error_code, r.vendor_error, r.inputs, r.outputs, r.drive_temperature, r.motor_temperature, r.voltage,
        r.axis_state, r.motion_state, r.motion_id, r.alarms, r.link_state, r.supported, r.valid);
  coder.text(r.name, kMaxName);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, EventRecord> {
  coder(r.axis, r.at, r.number, r.kind, r.code);
  coder.text(r.text, kMaxText);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, BusRecord> {
  coder.text(r.name, kMaxName);
  coder(r.link, r.load_permille, r.cycle_ms, r.queue_depth);
  for (auto& counter : r.counters) coder(counter);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, GatewayRecord> {
  coder(r.state, r.axis_count, r.axes_online, r.uptime_s, r.alarms, r.events_lost);
  coder.list(r.buses, kMaxBusesShown, [&](auto& bus) { members(coder, bus); });
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, ReplyRecord> {
  coder(r.axis, r.request_id, r.writer, r.result, r.detail);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, ObjectReplyRecord> {
  coder(r.axis, r.request_id, r.writer, r.result, r.detail, r.value);
  coder.list(r.data, kMaxObjectBytes, [&](auto& byte) { coder(byte); });
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, ReadyRecord> {
  coder.text(r.version, kMaxText);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, LogRecord> {
  coder(r.level);
  coder.text(r.text, kMaxText);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, WriterRecord> {
  coder(r.writer, r.strength, r.gone, r.liveliness);
  coder.text(r.where, kMaxName);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, BeatRecord> {
  coder(r.said);
  coder.list(r.writers, kMaxBeats, [&](auto& writer) { coder(writer); });
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, CommandRecord> {
  coder(r.writer, r.strength, r.written, r.gateway.key);
  coder.text(r.gateway.name, kMaxName);
  coder(r.axis, r.request_id, r.command, r.mode, r.mask, r.target_position, r.target_velocity, r.target_torque,
        r.max_torque, r.profile_velocity, r.profile_acceleration, r.profile_deceleration, r.jog_velocity,
        r.set_position_value, r.homing_method, r.received);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, ObjectRequestRecord> {
  coder(r.writer, r.written, r.gateway.key);
  coder.text(r.gateway.name, kMaxName);
  coder(r.axis, r.request_id, r.write, r.index, r.subindex, r.size, r.value, r.received);
  coder.list(r.data, kMaxObjectBytes, [&](auto& byte) { coder(byte); });
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, JointCommandsRecord> {
  coder(r.writer, r.written, r.efforts, r.received);
  coder.list(r.names, kMaxJoints + 1, [&](auto& name) { coder.text(name, kMaxName); });
  coder.list(r.positions, kMaxJoints + 1, [&](auto& each) { coder(each); });
  coder.list(r.velocities, kMaxJoints + 1, [&](auto& each) { coder(each); });
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, RosActionRecord> {
  coder(r.writer, r.written, r.axis, r.action, r.received);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, IdentityRecord> {
  coder(r.number, r.guid);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, HeartbeatRecord> {
  coder(r.writer, r.client, r.counter, r.lease_ms, r.written, r.gone);
}

template <typename Coder, typename R>
void members(Coder& coder, R& r) requires std::is_same_v<std::remove_const_t<R>, NamesakeRecord> {
  coder(r.writer, r.axis, r.gone);
  coder.text(r.where, kMaxName);
}

class Encoder {
 public:
  explicit Encoder(std::vector<Byte>& to) : to_(to) {}

  template <typename... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }
  void text(const std::string& text, std::size_t most) {
    const std::string_view cut = std::string_view(text).substr(0, most);
    put(static_cast<std::uint16_t>(cut.size()));
    to_.insert(to_.end(), cut.begin(), cut.end());
  }
  template <typename T, typename Each>
  void list(const std::vector<T>& items, std::size_t most, Each&& each) {
    const std::size_t count = std::min(items.size(), most);
    put(static_cast<std::uint16_t>(count));
    for (std::size_t i = 0; i < count; ++i) each(items[i]);
  }

 private:
  template <typename T>
  requires std::is_integral_v<T>
  void put(T value) {
    auto bits = static_cast<std::uint64_t>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i, bits >>= 8) to_.push_back(static_cast<Byte>(bits & 0xFF));
  }
  void put(LivelinessKind value) { put(static_cast<std::uint8_t>(value)); }
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  void put(const Guid& guid) { to_.insert(to_.end(), guid.begin(), guid.end()); }

  std::vector<Byte>& to_;
};

class Decoder {
 public:
  explicit Decoder(Bytes from) : from_(from) {}

  template <typename... T>
  void operator()(T&... values) {
    (take(values), ...);
  }
  void text(std::string& text, std::size_t most) {
    std::uint16_t size = 0;
    take(size);
    const Bytes bytes = next(size <= most ? size : from_.size() + 1);
    text.assign(bytes.begin(), bytes.end());
  }
  template <typename T, typename Each>
  void list(std::vector<T>& items, std::size_t most, Each&& each) {
    std::uint16_t count = 0;
    take(count);
    // Each item is a byte at least: a count that cannot be true allocates nothing.
    if (count > most || count > from_.size()) failed_ = true;
    if (failed_) return;
    items.resize(count);
    for (T& item : items) each(item);
  }
  [[nodiscard]] bool complete() const { return !failed_ && from_.empty(); }

 private:
  Bytes next(std::size_t size) {
    failed_ = failed_ || size > from_.size();
    if (failed_) return {};
    const Bytes taken = from_.first(size);
    from_ = from_.subspan(size);
    return taken;
  }
  template <typename T>
  requires std::is_integral_v<T>
  void take(T& value) {
    std::uint64_t bits = 0;
    const Bytes bytes = next(sizeof(T));
    for (std::size_t i = bytes.size(); i-- > 0;) bits = (bits << 8) | bytes[i];
    value = static_cast<T>(bits);
  }
  void take(LivelinessKind& value) {
    std::uint8_t kind = 0;
    take(kind);
    failed_ = failed_ || kind > static_cast<std::uint8_t>(kLastLivelinessKind);
    value = static_cast<LivelinessKind>(kind);
  }
  void take(double& value) {
    std::uint64_t bits = 0;
    take(bits);
    value = std::bit_cast<double>(bits);
  }
  void take(Guid& guid) {
    const Bytes bytes = next(guid.size());
    std::copy(bytes.begin(), bytes.end(), guid.begin());
  }

  Bytes from_;
  bool failed_ = false;
};

constexpr std::size_t kHeader = 2;  // version, kind

template <std::size_t... I>
void make_kind(std::size_t kind, Record& record, std::index_sequence<I...>) {
  ((I == kind ? static_cast<void>(record.emplace<I>()) : static_cast<void>(0)), ...);
}

}  // namespace

std::vector<Byte> encode(const Record& record) {
  std::vector<Byte> packet;
  packet.reserve(256);
  packet.push_back(kLinkVersion);
  packet.push_back(static_cast<Byte>(record.index()));
  Encoder encoder(packet);
  std::visit([&](const auto& each) { members(encoder, each); }, record);
  return packet;
}

Decoded decode(Bytes packet) {
  Decoded out;
  if (packet.size() < kHeader) {
    out.error = DecodeError::too_short;
  } else if (packet[0] != kLinkVersion) {
    out.error = DecodeError::version;
  } else if (packet[1] >= std::variant_size_v<Record>) {
    out.error = DecodeError::kind;
  } else {
    make_kind(packet[1], out.record, std::make_index_sequence<std::variant_size_v<Record>>{});
    Decoder decoder(packet.subspan(kHeader));
    std::visit([&](auto& each) { members(decoder, each); }, out.record);
    if (!decoder.complete()) out.error = DecodeError::length;
  }
  return out;
}

std::string_view text(DecodeError error) {
  switch (error) {
    case DecodeError::none:
      return "good";
    case DecodeError::too_short:
      return "a packet without kind";
    case DecodeError::version:
      return "another version: axisgate and axisgate-dds are not of one installation";
    case DecodeError::kind:
      return "a kind of record that this version does not know";
    case DecodeError::length:
      return "a record of another length than its kind has";
  }
  return {};
}

}  // namespace axisgate::dds
