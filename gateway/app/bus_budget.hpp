// The budget of one bus: what its polls will take of the line, and how long a command or a stop may have to wait.
// Promises plain arithmetic over the same poll items that the gateway reads, and to name each assumption.
// Never measures: the load that a running gateway has is in its bus registers.
#pragma once

#include <array>
#include <vector>

#include "gateway/app/config.hpp"
#include "gateway/core/clock.hpp"
#include "gateway/drive/model.hpp"

namespace axisgate::app {

/// What a drive is taken to need for its answer, beside the time on the wire, where its profile states no longer time.
/// The drives' own limit is the bus's timeout.
inline constexpr Duration kAssumedAnswer = std::chrono::milliseconds(5);
[[nodiscard]] Duration answer_of(const drive::DriveModel& model);
/// Above this share of the line the polls leave commands little room; suggested periods stay below it.
inline constexpr int kComfortablePermille = 800;

struct BusTiming {
  Duration on_wire;  ///< of one exchange, without the drive's own time; modbus-rtu: of a write of 32 bits
  Duration min_gap;
  Duration settle;
  Duration timeout;
  std::array<Duration, 3> poll;  ///< periods of the classes fast, normal, slow
  std::uint32_t rtu_baud = 0;    ///< modbus-rtu, where each exchange has a length of its own; else 0
  int parity_bits = 0;           ///< of modbus-rtu: 0 or 1
};

[[nodiscard]] BusTiming timing_of(const BusConfig& bus);
/// Of one exchange, without the drive's own time.
[[nodiscard]] Duration wire_time_of(const BusTiming& timing, const bus::Exchange& exchange);

struct BusBudget {
  struct Polled {
    int reads = 0;  ///< requests of this class over all drives of the bus
    Duration period{};
    Duration on_wire{};   ///< of all of them together
    Duration answered{};  ///< and with the time that the drives need
  };
  std::array<Polled, 3> classes;
  int load_on_wire = 0;   ///< 0.1 %, drives that answer at once
  int load_answered = 0;  ///< 0.1 %, drives that answer after answer_of()
  Duration exchange{};    ///< the longest request, with the slowest answer_of()
  Duration cycle{};       ///< in which each fast value is read once; longer than its period where the bus is over 100 %
  Duration command_wait{};       ///< the exchange on the wire, and one poll whose turn it is
  Duration stop_wait{};          ///< the exchange on the wire
  Duration command_wait_mute{};  ///< the same while a drive is mute
  Duration stop_wait_mute{};

  [[nodiscard]] bool overloaded() const { return load_answered > 1000; }
};

[[nodiscard]] BusBudget plan_bus(const BusTiming& timing, const std::vector<drive::DriveModel>& drives);

/// Periods that bring this bus down to kComfortablePermille, in whole 10 ms; those in force where it is there already.
[[nodiscard]] std::array<Duration, 3> comfortable_periods(const BusBudget& budget);

}  // namespace axisgate::app
