// SPDX-License-Identifier: Apache-2.0
// A CAN bus behind a port that carries bytes: the drives of a CanLine, reached through an adapter of some kind.
// Promises whole frames in order, each as the adapter of that kind puts it. Never acts on a frame itself.
#pragma once

#include "tests/simulated/can_line.hpp"
#include "tests/simulated/drive_line.hpp"

namespace axisgate::simulated {

class CanPortLine : public DriveLine {
 public:
  CanPortLine(const CanLineOptions& options, Random random, ToHostSink sink)
      : sink_(std::move(sink)), bus_(options, random, [this](const CanToHost& frame) { to_host(frame); }) {}

  CanLine& bus() { return bus_; }
  std::size_t size() const override { return bus_.size(); }
  DriveFaults& faults(std::size_t position) override { return bus_.faults(position); }
  bool has(DriveFault fault) const override { return bus_.has(fault); }
  void set_reply_delay(Time delay) override { bus_.set_reply_delay(delay); }
  void restart(std::size_t position, Time now) override { bus_.restart(position, now); }
  void advance(Time now) override { bus_.advance(now); }
  std::optional<Time> next_event() const override { return bus_.next_event(); }
  void cut() override { bus_.cut(); }
  std::uint64_t requests_heard() const override { return bus_.requests_heard(); }

  // The host's controller: what a world does to it, and what its adapter then tells.
  virtual void set_bus_off(bool off, Time now) = 0;
  virtual void miss_acknowledge(Time now) = 0;  // nobody has acknowledged a frame of the host

 protected:
  virtual void to_host(const CanToHost& frame) = 0;
  void give(Time at, std::uint64_t tag, std::span<const std::uint8_t> bytes) {
    sink_({at, tag, tag == 0 ? ByteOrigin::noise : ByteOrigin::reply, bytes});
  }

 private:
  ToHostSink sink_;
  CanLine bus_;
};

}  // namespace axisgate::simulated
