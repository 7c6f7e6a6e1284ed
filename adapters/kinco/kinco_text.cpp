// SPDX-License-Identifier: Apache-2.0
#include "adapters/kinco/kinco_text.hpp"

#include <fmt/format.h>

namespace axisgate::kinco {

namespace {

/// As many digits as the width has.
std::string value_text(std::uint32_t data, int size) {
  const std::uint32_t value = size == 4 ? data : data & ((std::uint32_t{1} << (8 * size)) - 1);
  return fmt::format("0x{:0{}X}", value, 2 * size);
}

}  // namespace

std::string describe(const Frame& frame) {
  const std::string object = fmt::format("{:04X}.{:02X}", frame.object.index, frame.object.sub);
  const auto with_value = [&](const char* verb, int size) {
    return fmt::format("{} {} = {}", verb, object, value_text(frame.data, size));
  };
  switch (frame.command) {
    case Command::write_4:
      return with_value("write", 4);
    case Command::write_2:
      return with_value("write", 2);
    case Command::write_1:
      return with_value("write", 1);
    case Command::read:
      return "read " + object;
    case Command::written:
      return "written " + object;
    case Command::value_4:
    case Command::value_2:
    case Command::value_1:
      return with_value("value", value_size(frame.command));
    case Command::error:
      return "error " + object + ": " + value_text(frame.data, 4);
  }
  return object;
}

}  // namespace axisgate::kinco
