// SPDX-License-Identifier: Apache-2.0
// One row of a drive's object dictionary as the sheet prints it: address, type, access, what keeps it, default, range.
// Promises that a row is plain data which can be compared with the sheet line by line.
// Never holds a value of a running drive.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace axisgate::simulated {

struct ObjectKey {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  bool operator==(const ObjectKey&) const = default;
  auto operator<=>(const ObjectKey& other) const { return number() <=> other.number(); }
  struct Hash {
    std::size_t operator()(const ObjectKey& key) const { return key.number(); }
  };

 private:
  std::uint32_t number() const { return std::uint32_t{index} << 8 | sub; }
};

enum class ObjectType : std::uint8_t { u8, i8, u16, i16, u32, i32 };
enum class Access : std::uint8_t { ro, rw };
// What brings a value back after a restart: nothing, 2FF0:01 (all but motor), 2FF0:03 (motor). JD 4.19, MD K.
enum class Keep : std::uint8_t { ram, eeprom, motor };

struct ObjectEntry {
  std::uint16_t index;
  std::uint8_t sub;
  ObjectType type;
  Access access;
  Keep keep;
  std::int64_t initial = 0;
  std::int64_t minimum = std::numeric_limits<std::int64_t>::min();
  std::int64_t maximum = std::numeric_limits<std::int64_t>::max();

  constexpr ObjectKey key() const { return {index, sub}; }
};

constexpr int bytes_of(ObjectType type) {
  if (type == ObjectType::u8 || type == ObjectType::i8) return 1;
  return type == ObjectType::u16 || type == ObjectType::i16 ? 2 : 4;
}

// What the low bytes of `raw` mean in this type.
constexpr std::int64_t value_in(ObjectType type, std::uint32_t raw) {
  switch (type) {
    case ObjectType::u8:
      return static_cast<std::uint8_t>(raw);
    case ObjectType::i8:
      return static_cast<std::int8_t>(raw);
    case ObjectType::u16:
      return static_cast<std::uint16_t>(raw);
    case ObjectType::i16:
      return static_cast<std::int16_t>(raw);
    case ObjectType::u32:
      return raw;
    case ObjectType::i32:
      return static_cast<std::int32_t>(raw);
  }
  return 0;
}

}  // namespace axisgate::simulated
