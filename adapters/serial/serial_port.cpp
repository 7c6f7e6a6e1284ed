// SPDX-License-Identifier: Apache-2.0
#include "adapters/serial/serial_port.hpp"

// termios2 lives in the kernel's header alone, which does not go together with <termios.h>: hence this file without
// Asio.
#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "adapters/serial/device_rights.hpp"

namespace axisgate::serial {

namespace {

/// A receiver samples in the middle of the last bit: beyond 3 % off, bytes start to break.
constexpr std::uint32_t kTolerablePercent = 3;

std::string reason(int error) { return std::strerror(error); }

/// A pty's slave side: its settings outlive the closing of it as long as the master side is open.
bool is_pty(int descriptor) {
  constexpr unsigned kFirstMajor = 136;  // Documentation/admin-guide/devices.txt: 136 to 143, Unix98 PTY slaves
  constexpr unsigned kLastMajor = 143;
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && major(status.st_rdev) >= kFirstMajor &&
         major(status.st_rdev) <= kLastMajor;
}

/// Exclusive two ways: the lock tells other careful programs, TIOCEXCL keeps careless ones out. A pty would keep the
/// latter after a crash of ours, so that nobody but root could ever open it again.
std::string claim(int descriptor) {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    return errno == EWOULDBLOCK ? "another process is using it" : "it cannot be locked: " + reason(errno);
  }
  if (!is_pty(descriptor) && ::ioctl(descriptor, TIOCEXCL) != 0) {
    return errno == ENOTTY ? "it is no serial port" : reason(errno);
  }
  return {};
}

void make_raw(termios2& mode, const SerialSettings& settings) {
  mode.c_iflag = settings.parity == Parity::none ? 0 : INPCK;
  mode.c_oflag = 0;
  mode.c_lflag = 0;
  mode.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | (BOTHER << IBSHIFT);
  if (settings.parity != Parity::none) mode.c_cflag |= PARENB;
  if (settings.parity == Parity::odd) mode.c_cflag |= PARODD;
  mode.c_cc[VMIN] = 1;
  mode.c_cc[VTIME] = 0;
  mode.c_ispeed = mode.c_ospeed = settings.baud;
}

std::string set_line(int descriptor, const SerialSettings& settings, std::vector<std::string>& notes) {
  termios2 mode{};
  if (::ioctl(descriptor, TCGETS2, &mode) != 0) return "it is no serial port: " + reason(errno);
  make_raw(mode, settings);
  if (::ioctl(descriptor, TCSETS2, &mode) != 0) {
    // A pty refuses parity and does all the rest.
    if (errno != EINVAL || settings.parity == Parity::none) return "its settings are refused: " + reason(errno);
    notes.emplace_back("parity is not offered by this driver");
  }
  if (::ioctl(descriptor, TCGETS2, &mode) != 0) return reason(errno);
  const std::uint32_t off =
      mode.c_ospeed > settings.baud ? mode.c_ospeed - settings.baud : settings.baud - mode.c_ospeed;
  if (std::uint64_t{off} * 100 > std::uint64_t{settings.baud} * kTolerablePercent) {
    notes.push_back(fmt::format("{} baud asked, {} set by the driver", settings.baud, mode.c_ospeed));
  }
  if (::ioctl(descriptor, TCFLSH, TCIOFLUSH) != 0) return reason(errno);
  return {};
}

void set_low_latency(int descriptor) {
  serial_struct serial{};
  if (::ioctl(descriptor, TIOCGSERIAL, &serial) != 0) return;  // not offered: a pty, many USB adapters
  serial.flags |= static_cast<int>(ASYNC_LOW_LATENCY);
  (void)::ioctl(descriptor, TIOCSSERIAL, &serial);  // a convenience: without it the port is slower, not wrong
}

void set_direction_control(int descriptor, std::vector<std::string>& notes) {
  serial_rs485 rs485{};
  if (::ioctl(descriptor, TIOCGRS485, &rs485) == 0) {
    if ((rs485.flags & SER_RS485_ENABLED) != 0) return;  // the board's own setting knows its polarity best
    rs485.flags |= SER_RS485_ENABLED | SER_RS485_RTS_ON_SEND;
    rs485.flags &= ~static_cast<std::uint32_t>(SER_RS485_RTS_AFTER_SEND | SER_RS485_RX_DURING_TX);
    if (::ioctl(descriptor, TIOCSRS485, &rs485) == 0) return;
  }
  notes.push_back("RS485 direction control is not offered by this driver (" + reason(errno) +
                  "): the adapter must turn the line by itself");
}

std::string configure(int descriptor, const SerialSettings& settings, std::vector<std::string>& notes) {
  if (std::string error = claim(descriptor); !error.empty()) return error;
  if (std::string error = set_line(descriptor, settings, notes); !error.empty()) return error;
  set_low_latency(descriptor);
  if (settings.rs485 == Rs485::automatic) set_direction_control(descriptor, notes);
  return {};
}

}  // namespace

OpenedPort open_port(const SerialSettings& settings) {
  OpenedPort port;
  port.descriptor = ::open(settings.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (port.descriptor < 0) {
    const int error = errno;
    // EBUSY: another process has claimed it by TIOCEXCL.
    port.error = settings.device + ": " + (error == EBUSY ? "another process is using it" : reason(error));
    if (error == EACCES) port.error += rights_remedy_of(settings.device);
    return port;
  }
  if (const std::string error = configure(port.descriptor, settings, port.notes); !error.empty()) {
    port.error = settings.device + ": " + error;
    ::close(port.descriptor);
    port.descriptor = -1;
  }
  return port;
}

}  // namespace axisgate::serial
