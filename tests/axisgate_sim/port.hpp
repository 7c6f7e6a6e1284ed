// SPDX-License-Identifier: Apache-2.0
// What a simulated line is plugged into on this machine: a pseudo-terminal or a CAN interface.
// Promises whole reads and writes without waiting.
// Never interprets what it carries.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace axisgate::simulated {

class Port {
 public:
  Port() = default;
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;
  virtual ~Port() = default;

  virtual const std::string& far_end() const = 0;  // what a user opens
  virtual int readable() const = 0;                // to be watched for input
  virtual int closings() const { return -1; }      // readable when a user has closed the port; -1: cannot be seen
  virtual void user_closed() {}
  virtual std::vector<std::uint8_t> read() = 0;
  virtual void write(std::span<const std::uint8_t> bytes) = 0;
};

}  // namespace axisgate::simulated
