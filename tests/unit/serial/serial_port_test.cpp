// SPDX-License-Identifier: Apache-2.0
// What the driver is told, read back from the other side of a pty. <termios.h> must stay out of this file.
#include "adapters/serial/serial_port.hpp"

#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/ioctl.h>

#include "tests/unit/serial/pty.hpp"

namespace axisgate::serial {
namespace {

using test::Pty;
using testing::HasSubstr;
using testing::IsEmpty;

class SerialPort : public testing::Test {
 protected:
  ~SerialPort() override {
    if (port.descriptor >= 0) ::close(port.descriptor);
  }
  void open(SerialSettings settings) {
    settings.device = pty.device();
    port = open_port(settings);
    EXPECT_EQ(port.error, "");
  }
  [[nodiscard]] termios2 mode() const {
    termios2 mode{};
    EXPECT_EQ(::ioctl(port.descriptor, TCGETS2, &mode), 0);
    return mode;
  }
  Pty pty;
  OpenedPort port;
};

TEST_F(SerialPort, is_raw_with_eight_bits_and_no_parity_at_any_baud_rate_non_blocking_and_not_inherited) {
  open({.device = "", .baud = 250'000});
  EXPECT_EQ(mode().c_ospeed, 250'000u);
  EXPECT_EQ(mode().c_ispeed, 250'000u);
  EXPECT_NE(::fcntl(port.descriptor, F_GETFL) & O_NONBLOCK, 0);
  EXPECT_NE(::fcntl(port.descriptor, F_GETFD) & FD_CLOEXEC, 0);
  EXPECT_EQ(mode().c_lflag, 0u) << "no echo, no lines, no signals";
  EXPECT_EQ(mode().c_oflag, 0u);
  EXPECT_EQ(mode().c_iflag, 0u);
  EXPECT_EQ(mode().c_cflag & (CSIZE | PARENB | CSTOPB | CRTSCTS), static_cast<tcflag_t>(CS8));
  EXPECT_THAT(port.notes, IsEmpty());
}

TEST_F(SerialPort, a_pty_that_refuses_parity_is_used_all_the_same) {
  for (const Parity parity : {Parity::even, Parity::odd, Parity::even}) {
    open({.device = "", .parity = parity});
    ASSERT_GE(port.descriptor, 0);
    ::close(std::exchange(port.descriptor, -1));
  }
}

TEST_F(SerialPort, forgets_what_came_before_it_was_opened) {
  pty.write("old");
  open({});
  std::array<char, 8> buffer{};
  EXPECT_EQ(::read(port.descriptor, buffer.data(), buffer.size()), -1);
}

TEST_F(SerialPort, says_that_direction_control_is_not_offered) {
  open({.device = "", .rs485 = Rs485::automatic});
  EXPECT_THAT(port.notes, testing::ElementsAre(HasSubstr("RS485 direction control is not offered")));
}

TEST_F(SerialPort, leaves_a_port_alone_that_another_has) {
  open({});
  const OpenedPort second = open_port({.device = pty.device(), .baud = 9600});
  EXPECT_EQ(second.descriptor, -1);
  EXPECT_EQ(second.error, pty.device() + ": another process is using it");
  EXPECT_EQ(mode().c_ospeed, 38'400u);
}

TEST(SerialPortErrors, name_the_device_and_the_reason) {
  EXPECT_EQ(open_port({.device = "/nonexistent/tty"}).error, "/nonexistent/tty: No such file or directory");
  EXPECT_THAT(open_port({.device = "/dev/null"}).error, HasSubstr("/dev/null: it is no serial port"));
  EXPECT_THAT(open_port({.device = "/tmp"}).error, HasSubstr("/tmp: "));
}

}  // namespace
}  // namespace axisgate::serial
