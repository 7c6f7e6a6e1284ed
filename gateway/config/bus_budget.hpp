// SPDX-License-Identifier: Apache-2.0
// The budget of one bus: what its polls will take of the line, and how long a command or a stop may have to wait.
// Promises plain arithmetic over the same poll items that the gateway reads, and to name each assumption.
// Never measures: the load that a running gateway has is in its bus registers.
#pragma once

#include <array>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "gateway/config/config.hpp"
#include "gateway/core/clock.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::config {

/// What a drive is taken to need for its answer, beside the time on the wire, where its profile states no longer time.
/// The drives' own limit is the bus's timeout.
inline constexpr Duration kAssumedAnswer = std::chrono::milliseconds(5);
/// The same for an SDO server.
inline constexpr Duration kAssumedSdoAnswer = std::chrono::milliseconds(1);
[[nodiscard]] Duration answer_of(const model::DriveModel& model);
/// Above this share of the line the polls leave commands little room; suggested periods stay below it.
inline constexpr int kComfortablePermille = 800;
/// What nodes send by themselves goes before every request on CAN: it may take this share of the line.
inline constexpr int kUnsolicitedPermille = 400;
/// And reading what comes by TPDO all the same, this one.
inline constexpr int kConfirmPermille = 300;
/// Keya: how often a drive is taken to send its heartbeat where nobody has stated it.
inline constexpr Duration kAssumedHeartbeat = std::chrono::milliseconds(100);

struct BusTiming {
  Duration on_wire;  ///< of one exchange, without the drive's own time; modbus-rtu: of a write of 32 bits
  Duration min_gap;
  Duration settle;
  Duration timeout;
  std::array<Duration, 3> poll;   ///< periods of the classes fast, normal, slow
  std::uint32_t rtu_baud = 0;     ///< modbus-rtu, where each exchange has a length of its own; else 0
  int parity_bits = 0;            ///< of modbus-rtu: 0 or 1
  std::uint32_t can_bitrate = 0;  ///< canopen; else 0
  Duration begun{};               ///< on CAN: a frame of another node that has just begun; else 0
  Duration unsolicited{};         ///< keya-can, keya-rs232: a heartbeat of the drive; else 0
  Duration control{};             ///< Keya's serial protocols: a control frame, which nobody answers; else 0
};

[[nodiscard]] BusTiming timing_of(const BusConfig& bus);
/// A CAN frame of 11-bit identifier with so many data bytes, stuffed as badly as can be, and the space after it
/// (ISO 11898-1).
[[nodiscard]] constexpr Duration can_frame_time(std::uint32_t bitrate, int data_bytes) {
  const int bits = 47 + 8 * data_bytes + (33 + 8 * data_bytes) / 4;
  return Duration(std::chrono::seconds(1)) * bits / bitrate;
}
/// The same with a 29-bit identifier.
[[nodiscard]] constexpr Duration extended_frame_time(std::uint32_t bitrate, int data_bytes) {
  const int bits = 67 + 8 * data_bytes + (53 + 8 * data_bytes) / 4;
  return Duration(std::chrono::seconds(1)) * bits / bitrate;
}
/// Characters of a serial port without parity: a start bit, eight of data, a stop bit.
[[nodiscard]] constexpr Duration characters_time(std::uint32_t baud, int count) {
  return Duration(std::chrono::seconds(1)) * (count * 10) / baud;
}
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
  Polled confirmed;       ///< canopen: comes by TPDO, and is read where it was silent for so long
  Polled kept_alive;      ///< writes that keep drives enabled, with every axis enabled
  int load_on_wire = 0;   ///< 0.1 %, drives that answer at once
  int load_answered = 0;  ///< 0.1 %, drives that answer after answer_of()
  int load_unmapped = 0;  ///< canopen: load_answered where the drives map nothing; else load_answered
  /// 0.1 %, unsolicited frames. canopen: TPDOs as often as they may, heartbeats, guarding, SYNC; Keya: heartbeats.
  int load_unsolicited = 0;
  Duration exchange{};  ///< the longest request, with the slowest answer_of()
  Duration cycle{};     ///< in which each fast value is read once; longer than its period where the bus is over 100 %
  Duration command_wait{};               ///< the exchange on the wire, and one poll whose turn it is
  Duration stop_wait{};                  ///< the exchange on the wire
  Duration command_wait_unresponsive{};  ///< the same while a drive is unresponsive
  Duration stop_wait_unresponsive{};

  [[nodiscard]] int load_confirmed() const;  ///< of load_answered, what `confirmed` takes
  [[nodiscard]] int load_fixed() const;      ///< and `kept_alive` with it: no poll period changes it
  [[nodiscard]] bool overloaded() const { return load_answered > 1000 || load_on_wire + load_unsolicited > 1000; }
};

[[nodiscard]] BusBudget plan_bus(const BusTiming& timing, const std::vector<model::DriveModel>& drives);

/// Periods that bring this bus down to kComfortablePermille, in whole 10 ms; those in force where it is there already.
[[nodiscard]] std::array<Duration, 3> comfortable_periods(const BusBudget& budget);

}  // namespace axisgate::config
