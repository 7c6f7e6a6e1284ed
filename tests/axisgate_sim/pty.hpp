// A pseudo-terminal with a link to its slave under a name of the user's choice: the simulated serial port.
// Promises: the link is there exactly as long as the object; a gateway that closes the port is no end of file; what it
// had claimed (TIOCEXCL) and left unread goes when it closes, as at a real port's last close. Never blocks: bytes that
// nobody takes are lost, as on a wire.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/axisgate_sim/descriptor.hpp"

namespace axisgate::simulated {

class Pty {
 public:
  // Throws std::runtime_error that names the path and what to change.
  explicit Pty(const std::string& link);
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  const std::string& slave_name() const { return slave_name_; }
  int readable() const { return master_.get(); }
  int closings() const { return watch_.get(); }  // readable when a user of the port closed it

  std::vector<std::uint8_t> read();
  void write(std::span<const std::uint8_t> bytes);
  void user_closed();  // call when closings() is readable

 private:
  std::string link_;
  std::string slave_name_;
  Descriptor master_;
  Descriptor slave_;  // kept open: without it the master would see a hang-up whenever the gateway closes
  Descriptor watch_;
};

}  // namespace axisgate::simulated
