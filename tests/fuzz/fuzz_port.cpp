// SPDX-License-Identifier: Apache-2.0
// The bytes of a line as libmodbus takes them, on a pseudo-terminal whose far end is the input.
#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include "adapters/modbus_rtu/link/libmodbus_port.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/targets.hpp"

namespace axisgate::fuzz {
namespace {

using axisgate::modbus_rtu::Heard;
using axisgate::modbus_rtu::LibmodbusPort;

constexpr int kMostTurns = 24;  // half a frame is waited for
constexpr std::size_t kLongestFrame = 256;

/// One for all inputs: a new one each time costs more than what is tried.
int far_end() {
  static const int kFar = [] {
    const int made = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    must(made >= 0 && ::grantpt(made) == 0 && ::unlockpt(made) == 0, "there is a pseudo-terminal");
    return made;
  }();
  return kFar;
}

void modbus_port(Input input) {
  const int far = far_end();
  LibmodbusPort port({.device = ::ptsname(far), .baud = 4'000'000}, Duration::zero());
  must(port.open().error.empty(), "a pseudo-terminal is opened");
  // Of all inputs: the kernel hands bytes on when it has the time, and the last ones of an input may come in the next.
  static std::size_t came = 0;
  static std::size_t heard = 0;
  const auto take = [](const Heard& what) {
    must(what.kind != Heard::Kind::lost, "what comes is no loss of the line");
    must(what.kind == Heard::Kind::frame || what.frame.empty(), "what is no frame has none");
    must(what.frame.size() < kLongestFrame, "a frame has its bound");
    heard += what.kind == Heard::Kind::frame ? what.frame.size() : what.bytes;
    must(heard <= came, "no more is heard than came");
  };
  for (int steps = 0; input.more() && steps < kMostTurns; ++steps) {
    switch (input.below(8)) {
      case 0: {
        const Bytes request = input.bytes(2 + input.below(8));
        if (request.size() < 2) break;
        static_cast<void>(port.transmit(request));  // there is room, or there is none
        std::array<Byte, 64> echo{};
        while (::read(far, echo.data(), echo.size()) > 0) {
        }
        break;
      }
      case 1:
        take(port.skip());
        break;
      default: {
        const Bytes bytes = input.bytes(1 + input.below(64));
        const auto taken = ::write(far, bytes.data(), bytes.size());
        came += taken > 0 ? static_cast<std::size_t>(taken) : 0;
        if (input.yes()) take(port.receive(input.yes()));
        if (port.unfinished() && input.below(4) == 0) heard += port.drop();
        break;
      }
    }
  }
  while (port.bytes_waiting() > 0) take(port.skip());
}

}  // namespace
}  // namespace axisgate::fuzz

int axisgate_fuzz_modbus_port(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::modbus_port(axisgate::fuzz::Input(data, size));
  return 0;
}
