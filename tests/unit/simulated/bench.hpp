// SPDX-License-Identifier: Apache-2.0
// A simulated line for tests: send, let time pass, see everything that came back.
// Promises that time only moves when a test says so, or as far as an answer takes.
// Never checks anything by itself.
#pragma once

#include <gmock/gmock.h>

#include "tests/axisgate_sim/control.hpp"
#include "tests/simulated/lawicel_line.hpp"
#include "tests/simulated/socket_can_line.hpp"

namespace axisgate::simulated {

using Bytes = std::vector<std::uint8_t>;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

inline constexpr KeyaMotorName motor_a = KeyaMotorName::a, motor_b = KeyaMotorName::b;

Bytes from_hex(std::string_view text);
std::string to_hex(std::span<const std::uint8_t> bytes);
Bytes part(std::span<const std::uint8_t> bytes, std::size_t from, std::size_t to);

// What counts in most tests is what the drives do, not the line's timing.
LineTimings untimed();

// As `--line` has it, without the path: "jd", "rtu:jd@1,id286pro@2", "can:ld2+ack". A drive without a number is number
// 1. "~stops" behind it: a Kinco's axis ends at 60000 on either side, and has an index pulse at 2000.
LineSpec spec_of(std::string text);

class Bench {
 public:
  explicit Bench(const LineSpec& spec, const LineTimings& timings = untimed(), std::uint64_t seed = 1);
  explicit Bench(const std::string& spec, const LineTimings& timings = untimed(), std::uint64_t seed = 1)
      : Bench(spec_of(spec), timings, seed) {}
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  // What came back to these bytes at once.
  Bytes exchange(std::span<const std::uint8_t> request);
  void send(const BusFrame& frame) { line().from_host(socket_frame_of(frame), now); }
  // The SDO reply to these bytes, or nothing.
  Bytes sdo(const Bytes& request, std::uint8_t node = 1);
  // The reply to these bytes in Keya's own CAN protocol, or nothing.
  Bytes keya_can(const Bytes& request);
  // The newest frame of this identifier since the last request; empty: there is none.
  Bytes heard(std::uint32_t id) const;
  void pass(Time time) { line().advance(now += time); }

  // What the control socket says of the first drive, without its "ok ". Throws where it says "error".
  std::string tell(ControlWords words);

  Bytes received() const;
  std::vector<BusFrame> frames() const;

  DriveLine& line() { return *port.line; }
  DriveFaults& faults() { return line().faults(0); }
  CanLine& bus() { return port.can->bus(); }
  // The first drive, or nothing where it is of another kind.
  KincoDrive* kinco();
  KeyaDrive* keya();
  Id286pro* id286pro() { return port.rtu == nullptr ? nullptr : port.rtu->id286pro(0); }

  struct Arrival {
    Time at;
    std::uint64_t tag;
    ByteOrigin origin;
    Bytes bytes;
    bool operator==(const Arrival&) const = default;
  };
  Time now{};
  std::vector<Arrival> arrivals;
  PortLine port;
};

Bytes sdo_request(std::uint8_t command, ObjectKey key, std::uint32_t data = 0);
// Its command byte for so many bytes.
inline std::uint8_t sdo_write(std::size_t width) { return static_cast<std::uint8_t>(0x23 | (4 - width) << 2); }
Bytes ten_bytes(FrameCommand command, ObjectKey key, std::uint32_t data = 0, std::uint8_t station = 1);

}  // namespace axisgate::simulated
