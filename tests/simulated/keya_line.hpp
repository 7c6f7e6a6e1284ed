// SPDX-License-Identifier: Apache-2.0
// One serial line with simulated Keya drives: RS232 with one of them, or RS485 with several.
// Promises that the heartbeat of RS232 comes between frames and never inside one, not even inside a reply that is
// split; that a drive answers in order. Never reads a clock and never delivers a byte outside from_host() and
// advance().
#pragma once

#include <memory>
#include <vector>

#include "tests/simulated/byte_line.hpp"
#include "tests/simulated/journal.hpp"
#include "tests/simulated/keya_serial.hpp"

namespace axisgate::simulated {

struct KeyaLineOptions {
  KeyaWiring wiring = KeyaWiring::rs232;
  std::uint32_t baud = 0;  // 10 bits per byte at this rate; 0: bytes take no time
  Time reply_delay{};      // between the request's last byte and the reply's first; none is stated
  std::size_t journal_capacity = 1000;
};

// Whole frames, controls too; `sent` is empty for those.
using KeyaExchange = ExchangeOf<std::vector<std::uint8_t>>;
using KeyaJournal = JournalOf<std::vector<std::uint8_t>>;

class KeyaLine final : public ByteLine {
 public:
  KeyaLine(const KeyaLineOptions& options, Random random, ToHostSink sink);

  // Throws std::invalid_argument for a second drive on RS232, or one with parameters that do not exist.
  KeyaDrive& add(const KeyaOptions& options);
  KeyaDrive& drive(std::size_t position) { return *slots_.at(position).drive; }
  bool has(DriveFault fault) const override;
  void set_reply_delay(Time delay) override { options_.reply_delay = delay; }
  void set_heartbeat(std::size_t position, Time period);  // 0: none
  void restart(std::size_t position, Time now) override;
  KeyaWiring wiring() const { return options_.wiring; }

  std::optional<Time> next_event() const override;
  void cut() override;
  std::uint64_t requests_heard() const override { return journal_.recorded(); }

  const KeyaJournal& journal() const { return journal_; }

 private:
  struct Slot {
    std::unique_ptr<KeyaDrive> drive;
    KeyaReceiver receiver;
    Time heartbeat{};
    Time next_heartbeat{};
    Time free_at{};     // its newest answer has left it: it answers in order
    Time split_from{};  // a reply in two pieces, which no heartbeat parts
    Time split_until{};
  };
  void drive_advances(std::size_t position, Time now) override { slots_[position].drive->advance(now); }
  void byte_arrives(std::uint8_t byte, Time at) override;
  void request_arrives(std::size_t position, const KeyaFrame& request, Time at);
  void reply(std::size_t position, const KeyaFrame& frame, Time at, KeyaExchange& exchange);
  std::vector<std::uint8_t> distort(std::size_t position, KeyaFrame reply);
  void send_reply(std::size_t position, std::uint64_t tag, const std::vector<std::uint8_t>& bytes);
  void own_accord(Time now) override;

  KeyaLineOptions options_;
  KeyaJournal journal_;
  std::vector<Slot> slots_;
};

}  // namespace axisgate::simulated
