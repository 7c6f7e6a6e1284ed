// SPDX-License-Identifier: Apache-2.0
// A pseudo-terminal with a link to its slave under a name of the user's choice: the simulated serial port.
// Promises: the link is there exactly as long as the object; a gateway that closes the port is no end of file; what it
// had claimed (TIOCEXCL) and left unread goes when it closes, as at a real port's last close. Never blocks: bytes that
// nobody takes are lost, as on a wire.
#pragma once

#include "tests/axisgate_sim/descriptor.hpp"
#include "tests/axisgate_sim/port.hpp"

namespace axisgate::simulated {

class Pty final : public Port {
 public:
  // `terminals`: the folder of a devpts to make it in, such as containers share; empty: the system's.
  // Throws std::runtime_error that names the path and what to change.
  explicit Pty(const std::string& link, const std::string& terminals = {});
  ~Pty() override;

  const std::string& far_end() const override { return slave_name_; }
  int readable() const override { return master_.get(); }
  int closings() const override { return watch_.get(); }
  void user_closed() override;
  std::vector<std::uint8_t> read() override;
  void write(std::span<const std::uint8_t> bytes) override;

 private:
  std::string link_;
  std::string slave_name_;
  Descriptor master_;
  Descriptor slave_;  // kept open: without it the master would see a hang-up whenever the gateway closes
  Descriptor watch_;
};

}  // namespace axisgate::simulated
