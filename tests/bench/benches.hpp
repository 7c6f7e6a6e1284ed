// SPDX-License-Identifier: Apache-2.0
// All benches, and what each of them is told: which gateway, where to put its files, and where its figures go.
// Promises a folder that exists. Never says how long a bench measures: each bench knows that itself.
#pragma once

#include <chrono>
#include <string>

#include "tests/bench/line_protocol.hpp"
#include "tests/bench/report.hpp"

namespace axisgate::bench {

struct BenchOptions {
  Report& report;
  std::string program;  ///< the gateway: `axisgate`
  std::string folder;   ///< for configuration, log and ports
  bool quick = false;   ///< fractions of a second: figures appear, but mean nothing

  [[nodiscard]] std::chrono::milliseconds lasting(std::chrono::milliseconds full) const {
    return quick ? std::chrono::milliseconds(200) : full;
  }
  [[nodiscard]] int times(int full) const { return quick ? 1 : full; }
};

/// P2: exchanges with a drive that answers at once; beside a loop of write, poll and read (on Modbus RTU libmodbus with
/// the standard's 1.75 ms between frames). A write through Modbus counts as two exchanges: itself, and the statusword
/// read that its reply waits for. Goal: 150 us more at the median.
void immediate_drive(const BenchOptions& options, LineProtocol protocol);
/// P2: exchanges per second with a drive that takes its time, beside the same loop. Goal: 0.95.
void delayed_drive(const BenchOptions& options, LineProtocol protocol);
/// P3: parameter writes to a live drive, beside those when it is alone on the line. Goals: median 1.1, p95 2.0.
void dead_neighbour(const BenchOptions& options, LineProtocol protocol);
/// P4: quick stops behind 32 busy clients. Goal: the one exchange on the wire goes before.
void stop_latency(const BenchOptions& options, LineProtocol protocol);
/// P5: FC 3 reads per second, beside a bare Asio echo server with the same sizes. Goal: 0.9.
void modbus_reads(const BenchOptions& options);
/// What clients who are not slow wait for a read among 1,000 that ask 10 times a second, 200 of them slow; and
/// connections made per second: both beside a bare Asio echo server.
void crowd(const BenchOptions& options);
/// P6: exchanges on the bus with reading clients, beside those without. Goal: 1.
void shared_polling(const BenchOptions& options, LineProtocol protocol);
/// P8: memory and processor time of the gateway.
void footprint(const BenchOptions& options);
/// From a TPDO with another position to the reply that shows it to a client that reads without a pause; beside one
/// such read.
void change_latency(const BenchOptions& options, LineProtocol protocol);
/// SDO requests while drives are online, disabled and stand, polled as by default at 500 kbit/s.
void idle_can(const BenchOptions& options);
/// Both motors of a Keya run: the gaps between the commands that keep them alive. Each is due a command every 300 ms
/// and gets one at half of that where the line is free; the bound is 500 ms, and after 1000 ms the drive trips.
void keepalive(const BenchOptions& options);
/// A client dies while its motor runs: from its last request to the first frame on the wire that stops the motor,
/// beside the lease. Goal: 1.1.
void lease_expiry(const BenchOptions& options);
/// Two CAN buses: what writes on the first take while a node of the second babbles, beside those while it does not.
void babbling_bus(const BenchOptions& options);

}  // namespace axisgate::bench
