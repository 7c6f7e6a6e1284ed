// SPDX-License-Identifier: Apache-2.0
// An object of a drive: where it is, how wide it is, and what a write of it may do. Promises that raw
// bytes become a number by it alone. Never holds what the drive holds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/core/numbers.hpp"
#include "gateway/core/object_address.hpp"
#include "gateway/image/quantity.hpp"

namespace axisgate::model {

/// Position in DriveModel::objects.
using ObjectId = std::uint16_t;
inline constexpr ObjectId kNoObject = 0xFFFF;
inline constexpr std::size_t kMaxObjects = 1024;

/// Whether a write wears out the drive's memory (profile key "nvm").
enum class Nvm : std::uint8_t { no, unknown, yes };

/// Bits of another object, the whole, that stand for an object of their own.
struct PartOf {
  ObjectId whole = kNoObject;  ///< kNoObject: it is no part
  std::uint8_t from = 0, count = 0;
  /// All of the whole is a magnitude, and this object says which way: `positive` or `negative`; of another number the
  /// way is what it was. kNoObject: the bits are the number. A write never leaves a magnitude with the wrong way.
  ObjectId sign = kNoObject;
  std::int64_t positive = 0, negative = 0;
};

/// "u8", "i16", "f32", as profiles have it.
[[nodiscard]] inline std::string type_name(std::uint8_t size, bool is_signed, bool is_real) {
  return (is_real ? 'f' : is_signed ? 'i' : 'u') + std::to_string(8 * size);
}

struct ObjectDef {
  std::string name;         ///< "statusword", "A.velocity"
  AxisSlot slot = kNoAxis;  ///< whose it is; kNoAxis: the whole drive's
  ObjectAddress address;    ///< of a part its whole's
  std::uint8_t size = 2;    ///< bytes: 1, 2 or 4
  bool is_signed = false;
  bool is_real = false;  ///< REAL32: its number is real32.hpp's, in the same order
  PartOf part{};
  Range printed{INT64_MIN, INT64_MAX};  ///< what its maker's sheet says that it takes
  bool readable = true;
  bool writable = false;
  bool trigger = false;  ///< the write itself starts something: never skipped as unchanged, never repeated
  /// Nobody has printed its width: read with Exchange::size 0 it is as wide as the drive answers, `size` at most.
  bool any_width = false;
  /// Another name of a speed, an enable or a motion: no client writes it past the limits, the latch and the owner.
  bool mailbox_reads_only = false;
  bool emulated = false;  ///< not in the drive: statusword, controlword and mode of a virtual axis (virtual_axis.hpp)
  /// Objects at the same place in the drive: what is written to one is in all of them.
  std::vector<ObjectId> aliases{};
  /// Keya's serial control frame: written with all other objects of DriveModel::composed, never alone.
  bool composed = false;
  /// Of those: says that motor `slot` is to be on. Sent as 1 only for an axis that shows enabled, but by the write that
  /// enables it: a motor that has tripped must not come back by a frame meant for its neighbour.
  bool turns_on = false;
  Nvm nvm = Nvm::no;
  /// The low `size` bytes, or `part.count` bits, as the number they stand for.
  [[nodiscard]] std::int64_t number(std::uint32_t raw) const;
  /// What goes on the wire for a number, in the low `size` bytes.
  [[nodiscard]] std::uint32_t raw(std::int64_t number) const;
  /// Smallest and largest number of this width and sign.
  [[nodiscard]] Range range() const;
  [[nodiscard]] bool is_part() const { return part.whole != kNoObject; }
  /// A magnitude and its direction, which stand in two objects.
  [[nodiscard]] bool is_directed() const { return part.sign != kNoObject; }
  /// Its address, and of a part which one: two parts of one whole are two places.
  [[nodiscard]] ObjectAddress place() const {
    return {address.index, address.sub, is_part() ? part.from : address.byte};
  }
  /// The bits of a part within its whole; 0: all, it is no part, or its whole's magnitude.
  [[nodiscard]] std::uint32_t mask() const;
};

}  // namespace axisgate::model
