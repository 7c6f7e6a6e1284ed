// SPDX-License-Identifier: Apache-2.0
// One serial line with Kinco drives that speak Kinco's own protocol.
// Promises: an RS232 chain gives the host's bytes back exactly when every drive in it has 6510:0B = 1 (JD 2.1); a drive
// answers in order. Never reads a clock and never delivers a byte outside from_host() and advance().
#pragma once

#include <memory>
#include <vector>

#include "tests/simulated/byte_line.hpp"
#include "tests/simulated/frame_receiver.hpp"
#include "tests/simulated/journal.hpp"
#include "tests/simulated/kinco_drive.hpp"

namespace axisgate::simulated {

// rs232: one drive, or a chain in which each hears what the one before it passes on. rs485: all hear the host.
enum class Wiring : std::uint8_t { rs232, rs485 };

struct LineOptions {
  Wiring wiring = Wiring::rs232;
  std::uint32_t baud = 0;   // 10 bits per byte at this rate; 0: bytes take no time
  bool check_baud = false;  // a drive whose 2FE0 says another rate than `baud` hears nothing
  Time reply_delay{};       // between the request's last byte and the reply's first; the sheets give none
  std::size_t journal_capacity = 1000;
};

class SerialLine final : public ByteLine {
 public:
  using Sink = ToHostSink;

  SerialLine(const LineOptions& options, Random random, Sink sink);

  // Drives in the order of the chain. Throws std::invalid_argument for one that cannot be on this line.
  KincoDrive& add(const DriveOptions& options);
  KincoDrive& drive(std::size_t position) { return *slots_.at(position).drive; }
  const KincoDrive& drive(std::size_t position) const { return *slots_.at(position).drive; }
  bool has(DriveFault fault) const override;
  void set_reply_delay(Time delay) override { options_.reply_delay = delay; }
  void restart(std::size_t position, Time now) override;

  std::uint64_t requests_heard() const override { return journal_.recorded(); }

  const Journal& journal() const { return journal_; }

 private:
  struct Slot {
    std::unique_ptr<KincoDrive> drive;
    FrameReceiver receiver;
    Time reply_ready{};  // of its newest reply: it answers in order
  };
  bool passes_on(const Slot& slot) const;
  bool hears(std::size_t position) const;
  bool reaches_host(std::size_t position) const;
  void drive_advances(std::size_t position, Time now) override { slots_[position].drive->advance(now); }
  void byte_arrives(std::uint8_t byte, Time at) override;
  void flush_echo(Time at);
  void request_arrives(std::size_t position, const TenByteFrame& request, Time at);
  std::vector<std::uint8_t> distort(std::size_t position, TenByteFrame reply);
  void send_reply(std::size_t position, std::uint64_t tag, Time ready, std::vector<std::uint8_t> bytes);

  LineOptions options_;
  Journal journal_;
  std::vector<Slot> slots_;
  std::vector<std::uint8_t> echo_;
};

}  // namespace axisgate::simulated
