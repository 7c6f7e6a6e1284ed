// SPDX-License-Identifier: Apache-2.0
// How records travel between the gateway and a program of its own (design 7, point 8): one a packet, its version and
// kind in front, little-endian. Promises that a packet of another version, an unknown kind or a wrong length is refused
// whole, and that a list or text beyond its bound is cut when sent and refused when received. Never knows what a record
// means, a socket or a clock: each program has records and a version of its own.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "gateway/core/bytes.hpp"

namespace axisgate::link {

/// No record is longer; a socket pair takes as much at once.
inline constexpr std::size_t kMaxPacket = 64 * 1024;

/// On the steady clock, in nanoseconds: it is the same one in both processes. 0: unknown.
using SteadyNs = std::int64_t;
inline constexpr SteadyNs kMillisecond = 1'000'000;
inline constexpr SteadyNs kSecond = 1000 * kMillisecond;

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
    std::array<Byte, sizeof(T)> bytes{};
    for (std::size_t i = 0; i < sizeof(T); ++i, bits >>= 8) bytes[i] = static_cast<Byte>(bits & 0xFF);
    put(bytes);
  }
  template <typename T>
  requires std::is_enum_v<T>
  void put(T value) { put(static_cast<std::underlying_type_t<T>>(value)); }
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  template <std::size_t Size>
  void put(const std::array<Byte, Size>& bytes) {
    to_.insert(to_.end(), bytes.begin(), bytes.end());
  }

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
  /// An enumeration says which its last value is: `constexpr E last_of(E)`, beside it.
  template <typename T>
  requires std::is_enum_v<T>
  void take(T& value) {
    std::underlying_type_t<T> number{};
    take(number);
    failed_ = failed_ || number > static_cast<std::underlying_type_t<T>>(last_of(T{}));
    value = static_cast<T>(number);
  }
  void take(double& value) {
    std::uint64_t bits = 0;
    take(bits);
    value = std::bit_cast<double>(bits);
  }
  template <std::size_t Size>
  void take(std::array<Byte, Size>& into) {
    const Bytes bytes = next(Size);
    std::copy(bytes.begin(), bytes.end(), into.begin());
  }

  Bytes from_;
  bool failed_ = false;
};

enum class DecodeError : std::uint8_t { none, too_short, version, kind, length };
/// @param program its name: "axisgate-dds"
[[nodiscard]] std::string text(DecodeError error, std::string_view program);
/// Why one of the two does not understand the other.
[[nodiscard]] std::string not_of_one_installation(std::string_view program);

/// @param members called as members(coder, record): each member once, in the order they have on the wire
template <typename Record, typename Members>
[[nodiscard]] std::vector<Byte> encode(const Record& record, std::uint8_t version, Members&& members) {
  std::vector<Byte> packet;
  packet.reserve(256);
  packet.push_back(version);
  packet.push_back(static_cast<Byte>(record.index()));
  Encoder encoder(packet);
  std::visit([&](const auto& each) { members(encoder, each); }, record);
  return packet;
}

template <typename Record>
struct Decoded {
  Record record{};
  DecodeError error = DecodeError::none;
};

template <typename Record, typename Members>
[[nodiscard]] Decoded<Record> decode(Bytes packet, std::uint8_t version, Members&& members) {
  constexpr std::size_t kHeader = 2;  // version, kind
  if (packet.size() < kHeader) return {{}, DecodeError::too_short};
  if (packet[0] != version) return {{}, DecodeError::version};
  if (packet[1] >= std::variant_size_v<Record>) return {{}, DecodeError::kind};
  Decoded<Record> out;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    ((I == packet[1] ? static_cast<void>(out.record.template emplace<I>()) : static_cast<void>(0)), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Record>>{});
  Decoder decoder(packet.subspan(kHeader));
  std::visit([&](auto& each) { members(decoder, each); }, out.record);
  if (!decoder.complete()) out.error = DecodeError::length;
  return out;
}

}  // namespace axisgate::link
