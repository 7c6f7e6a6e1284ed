// SPDX-License-Identifier: Apache-2.0
// What every serial line with simulated drives has: bytes on their way from the host to the drives and back, each with
// its time, and drives that babble. Promises that nothing overtakes; of one time bytes at the host come first, then
// drives that begin to send, then bytes at the drives, then what the drives do by themselves. Never looks into a frame.
#pragma once

#include <deque>
#include <vector>

#include "tests/simulated/outgoing_wire.hpp"

namespace axisgate::simulated {

class ByteLine : public DriveLine {
 public:
  std::size_t size() const override { return drives_.size(); }
  DriveFaults& faults(std::size_t position) override { return drives_.at(position).faults; }
  void from_host(std::span<const std::uint8_t> bytes, Time now) override;
  void advance(Time now) override;
  std::optional<Time> next_event() const override;
  void cut() override;

  Time on_wire(std::size_t bytes) const { return byte_time(baud_, bytes); }

 protected:
  ByteLine(std::uint32_t baud, Random random, ToHostSink sink);

  void count_one_more() { drives_.emplace_back(); }

  // What a line adds: its drives know the time; a byte is there; nothing else happens at this time; noise, or more.
  virtual void drive_advances(std::size_t position, Time now) = 0;
  virtual void byte_arrives(std::uint8_t byte, Time at) = 0;
  virtual void own_accord(Time at);
  virtual std::vector<std::uint8_t> babbled(std::size_t position);

  // Its noise, where it is due.
  void babble(std::size_t position, Time now);
  // A reply with a wrong bit, or one that breaks off.
  void spoil(std::size_t position, std::vector<std::uint8_t>& bytes);
  void put_noise_around(std::size_t position, std::vector<std::uint8_t>& bytes);

  std::uint32_t baud_;
  Random random_;
  ToHostSink sink_;
  OutgoingWire outgoing_;
  struct IncomingByte {
    Time at;
    std::uint8_t byte;
  };
  std::deque<IncomingByte> incoming_;
  Time now_{};
  std::uint64_t tags_ = 0;

 private:
  struct Drive {
    DriveFaults faults;
    Time next_babble{};
  };
  std::vector<Drive> drives_;
  Time host_free_{};
};

}  // namespace axisgate::simulated
