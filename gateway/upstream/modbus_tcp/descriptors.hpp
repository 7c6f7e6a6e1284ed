// The descriptor rule: libmodbus waits for serial ports with select(), which breaks on descriptors of 1024 and more.
// Promises that client sockets leave the numbers below 1024 to serial ports, or, where the system's limit forbids that,
// that there are never so many clients that a port could be pushed above. Never closes anything but what it has just
// moved.
#pragma once

#include <cstdint>

namespace axisgate::modbus_tcp {

inline constexpr std::uint64_t kSelectLimit = 1024;  ///< FD_SETSIZE of the libmodbus we link
inline constexpr std::uint64_t kOwnDescriptors =
    128;  ///< ports, listeners, timers, log, the DDS link: kept free of clients

struct DescriptorRule {
  bool move_up = false;           ///< client sockets go to 1024 and above
  std::uint32_t max_clients = 0;  ///< of all listeners together
};
/// Pure: what follows from the process's soft limit. Of the two ways the one with room for more clients.
[[nodiscard]] DescriptorRule descriptor_rule(std::uint64_t soft_limit);

/// Raises the soft limit to the hard one, as far as the system lets us; the limit then in force. Once, at start-up.
std::uint64_t raise_descriptor_limit();
[[nodiscard]] std::uint64_t descriptor_limit();

/// Moves an accepted socket to the lowest free number from 1024 up and closes the old one. -1: none free (errno says
/// why), and `descriptor` is closed all the same.
[[nodiscard]] int moved_up(int descriptor);

}  // namespace axisgate::modbus_tcp
