// SPDX-License-Identifier: Apache-2.0
// A bus job: what waits for a bus. It is a chain of one or more exchanges of one drive, its content known to the drive
// alone. Promises to the arbiter all it needs to decide whose exchange goes next, and nothing more. Never holds frames
// or values.
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>

#include "adapters/bus/exchange.hpp"
#include "gateway/core/numbers.hpp"

namespace axisgate::bus {

/// In the order in which the wire is given away (design 7, point 3).
/// `cause`: reads what names a fault that was just seen, before anything but stops.
enum class Priority : std::uint8_t { stop, cause, command, interactive, setup, poll };
inline constexpr std::size_t kPriorityCount = 6;

inline constexpr std::size_t kMaxJobsPerBus = 64;
inline constexpr std::size_t kMaxJobsPerAxis = 8;
/// Quantities one write batch can write: rows 41..53 and 60..77 of the map.
inline constexpr std::size_t kMaxWritesPerJob = 24;

/// 0 is no bus job (a poll).
using JobId = std::uint64_t;

/// What a plain read asks for. The same object in another width is another question: where replies carry no width
/// (Modbus RTU) it has another answer, and elsewhere the width asked for decides what its client is answered.
struct PlainRead {
  ObjectAddress object;
  std::uint8_t size = 0;  ///< bytes
  friend bool operator==(const PlainRead&, const PlainRead&) = default;
};

struct BusJob {
  Priority priority = Priority::command;
  DriveSlot drive = 0;
  AxisSlot axis = kNoAxis;
  Instant start_by = kNever;    ///< not granted by then: ends never_started; of joined reads: the latest of theirs
  bool setpoints_only = false;  ///< a newer bus job with the same `writes` may supersede it while it waits
  bool survives_stop = false;   ///< parameters alone: a stop of its axis does not drop it
  boost::container::static_vector<ObjectAddress, kMaxWritesPerJob> writes;  ///< sorted
  std::optional<PlainRead> read;  ///< a plain read: an identical one may join while it waits
};

}  // namespace axisgate::bus
