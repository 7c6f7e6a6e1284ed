// SPDX-License-Identifier: Apache-2.0
// What one client has of objects that are longer than a request or a reply: those it reads in parts, and the one it
// writes in parts (function 43/13). Promises that parts read belong to one moment of the object, that parts written
// have no gap, and that neither outlives kObjectKept. Never asks a drive.
#pragma once

#include <boost/container/static_vector.hpp>
#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/core/bytes.hpp"
#include "gateway/core/clock.hpp"
#include "gateway/image/axis_image.hpp"

namespace axisgate::modbus_tcp {

/// An object that was read, from the moment it was; parts that were written, from the last of them.
inline constexpr Duration kObjectKept = std::chrono::seconds(5);
/// Objects that one client reads in parts at a time, of at most kMaxObjectBytes each; the oldest gives way.
inline constexpr std::size_t kMaxKeptObjects = 4;

/// One object of one drive.
struct ObjectKey {
  AxisNumber axis = 0;
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;
  friend auto operator<=>(const ObjectKey&, const ObjectKey&) = default;
};

class ObjectBuffers {
 public:
  // Read in parts.
  /// Replaces what was kept of it.
  void keep(const ObjectKey& key, ObjectBytes content, Instant now);
  void forget(const ObjectKey& key);
  /// nullptr: nothing is kept of it, or not any longer.
  [[nodiscard]] ObjectBytes kept(const ObjectKey& key, Instant now) const;

  // Written in parts. Each gives false where the part does not fit what came before, or makes it too long: all is
  // dropped then.
  /// `start` 0 begins from scratch, whatever was there.
  [[nodiscard]] bool add_part(const ObjectKey& key, std::size_t start, Bytes part, Instant now);
  /// The last one. With `start` 0 it is the only one: parts of other objects stay.
  [[nodiscard]] std::optional<std::vector<Byte>> add_last(const ObjectKey& key, std::size_t start, Bytes part,
                                                          Instant now);

 private:
  struct Kept {
    ObjectKey key;
    ObjectBytes content;
    Instant at = kLongAgo;
  };
  struct Written {
    ObjectKey key;
    std::vector<Byte> bytes;
    Instant at = kLongAgo;
  };

  boost::container::static_vector<Kept, kMaxKeptObjects> kept_;  // oldest first
  std::optional<Written> written_;
};

}  // namespace axisgate::modbus_tcp
