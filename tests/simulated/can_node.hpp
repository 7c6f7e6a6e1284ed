// SPDX-License-Identifier: Apache-2.0
// A simulated node on a CAN bus, as a bus of them and the tests see it. Pure: frames and times in, frames out.
// Behaviour comes from the sheets and vectors (docs/drive_sources.md), never from axisgate's own profiles or codecs.
// Promises that the same frames at the same times give the same answers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

/// A frame on the simulated bus; its own type, so that the product's codec is not tested against itself.
struct BusFrame {
  std::uint32_t id = 0;
  bool extended = false;
  bool remote = false;
  std::uint8_t size = 0;
  std::array<std::uint8_t, 8> data{};
  friend bool operator==(const BusFrame&, const BusFrame&) = default;
};

struct TimedFrame {
  Time at{};
  BusFrame frame;
};

struct CanOutput {
  std::uint64_t tag;  // of the frame it answers; 0: it sends by itself
  bool answer;        // of a request: takes the drive's time
  BusFrame frame;
};

class CanNode {
 public:
  CanNode() = default;
  CanNode(const CanNode&) = delete;
  CanNode& operator=(const CanNode&) = delete;
  virtual ~CanNode() = default;

  // What the bus does to it; what it sends then is in take_output().
  virtual void hear(const BusFrame& frame, std::uint64_t tag, Time now) = 0;
  virtual void advance(Time now) = 0;
  virtual std::vector<CanOutput> take_output() = 0;
  virtual std::optional<Time> next_event() const = 0;

  // What a world does to it.
  virtual void restart(Time now) = 0;
  virtual void announce_emergency(std::uint16_t code, Time now) = 0;  // as if it had happened

  virtual std::uint8_t node() const = 0;
  virtual std::string describe() const = 0;
  virtual bool is_request(const BusFrame& frame) const = 0;      // to this node: a line keeps a record of them
  virtual bool wants_answer(const BusFrame& request) const = 0;  // faults may strike it
  // Could it refuse this one instead of acting on it, and what would it say then? Asked in this order.
  virtual bool may_refuse(const BusFrame& request) const = 0;
  virtual BusFrame refuse(const BusFrame& request, std::uint32_t code) = 0;
  // A frame as it says by itself that it lives.
  virtual BusFrame life_sign(std::span<const std::uint8_t> bytes) const = 0;
};

}  // namespace axisgate::simulated
