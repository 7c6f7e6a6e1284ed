// SPDX-License-Identifier: Apache-2.0
// A raw SocketCAN socket of the simulator: the drives' end of a CAN interface.
// Promises whole frames of 16 bytes and that other programs on the interface see what the drives send.
// Never waits: a frame that the interface does not take is lost, as on a bus that nobody acknowledges.
#pragma once

#include "tests/axisgate_sim/descriptor.hpp"
#include "tests/axisgate_sim/port.hpp"

namespace axisgate::simulated {

class CanSocket final : public Port {
 public:
  // Throws std::runtime_error with what to do about it.
  explicit CanSocket(const std::string& interface);

  const std::string& far_end() const override { return interface_; }
  int readable() const override { return socket_.get(); }
  std::vector<std::uint8_t> read() override;
  void write(std::span<const std::uint8_t> bytes) override;

 private:
  std::string interface_;
  Descriptor socket_;
};

}  // namespace axisgate::simulated
