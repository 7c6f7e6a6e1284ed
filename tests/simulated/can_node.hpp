// A simulated node on a CAN bus, as a bus of them and the tests see it. Pure: frames and times in, frames out.
// Behaviour comes from the fact sheets and vectors, never from axisgate's own profiles or codecs.
// Promises that the same frames at the same times give the same answers.
#pragma once

#include <array>
#include <cstdint>
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

}  // namespace axisgate::simulated
