// SPDX-License-Identifier: Apache-2.0
// One RS485 line with simulated drives of several kinds that speak Modbus RTU.
// Promises: a frame ends with 3.5 characters of silence; a wrong CRC and a foreign unit meet silence; a broadcast is
// obeyed without an answer; a drive answers in order and leaves a gap between its answers. Never reads a clock and
// never delivers a byte outside from_host() and advance().
#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "tests/simulated/byte_line.hpp"
#include "tests/simulated/direct_data.hpp"
#include "tests/simulated/em2rs.hpp"
#include "tests/simulated/id286pro.hpp"
#include "tests/simulated/inverter.hpp"
#include "tests/simulated/journal.hpp"
#include "tests/simulated/kinco_rtu.hpp"
#include "tests/simulated/rtu_receiver.hpp"
#include "tests/simulated/zlac8015d.hpp"

namespace axisgate::simulated {

struct RtuLineOptions {
  std::uint32_t baud = 19200;       // of all drives as delivered; 0: bytes take no time
  Time frame_gap{};                 // the silence that ends a frame; 0: 3.5 characters at `baud`
  std::optional<Time> reply_delay;  // of every drive, instead of its own
  std::size_t journal_capacity = 1000;
};

using RtuDriveOptions =
    std::variant<KincoRtuDrive, Id286proOptions, Em2rsOptions, ZlacOptions, InverterOptions, DirectDataOptions>;

std::string describe(const RtuDriveOptions& options);  // "jd@1", "id286pro@3"
std::uint8_t unit_of(const RtuDriveOptions& options);

class RtuLine final : public ByteLine {
 public:
  RtuLine(const RtuLineOptions& options, Random random, ToHostSink sink);

  // Throws std::invalid_argument for a drive that cannot have this address.
  RtuSlave& add(const RtuDriveOptions& options);
  RtuSlave& slave(std::size_t position) { return *slots_.at(position).slave; }
  // Nothing where another kind of drive stands there.
  KincoDrive* kinco(std::size_t position);
  Id286pro* id286pro(std::size_t position);
  Em2rs* em2rs(std::size_t position);
  Zlac8015d* zlac8015d(std::size_t position);
  bool has(DriveFault fault) const override {
    return fault != DriveFault::emergencies && fault != DriveFault::heartbeat_twice;
  }
  void set_reply_delay(Time delay) override { options_.reply_delay = delay; }
  void restart(std::size_t position, Time now) override;

  std::optional<Time> next_event() const override;
  void cut() override;
  std::uint64_t requests_heard() const override { return journal_.recorded(); }

  Time frame_gap() const { return gap_; }
  const RtuJournal& journal() const { return journal_; }

 private:
  struct Slot {
    std::unique_ptr<RtuSlave> slave;
    RtuReceiver receiver;
    RtuBytes last_reply;  // as it should have been
    Time free_at{};       // its newest answer and the gap behind it are over
  };
  void drive_advances(std::size_t position, Time now) override { slots_[position].slave->advance(now); }
  void byte_arrives(std::uint8_t byte, Time at) override;
  void own_accord(Time at) override;
  std::vector<std::uint8_t> babbled(std::size_t position) override;
  void frame_ends(Time at);
  void request_arrives(std::size_t position, const RtuFrame& request, Time at);
  void reply(std::size_t position, RtuBytes pdu, Time at, RtuExchange& exchange);
  RtuBytes distort_frame(std::size_t position, std::uint8_t unit, RtuBytes pdu);
  RtuBytes distort_bytes(std::size_t position, RtuBytes bytes);
  void send(std::size_t position, std::uint64_t tag, Time ready, const RtuBytes& bytes);

  RtuLineOptions options_;
  Time gap_;
  RtuJournal journal_;
  std::vector<Slot> slots_;
  std::optional<Time> frame_end_;  // if nothing more comes
  Time last_byte_{};
};

}  // namespace axisgate::simulated
