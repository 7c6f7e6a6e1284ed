// SPDX-License-Identifier: Apache-2.0
#include "adapters/can/link/make_can_link.hpp"

#include <cassert>
#include <utility>

#include "adapters/can/can_device.hpp"
#include "adapters/can/link/slcan_link.hpp"
#include "adapters/can/link/socketcan_link.hpp"
#include "adapters/serial/serial_link.hpp"

namespace axisgate::can {

std::unique_ptr<CanLink> make_can_link(std::string_view device, std::uint32_t bitrate, std::string name,
                                       boost::asio::io_context& context, Runtime& runtime, const Log& log) {
  assert(can_device_mistake(device, bitrate).empty());
  CanDevice parsed = parse_can_device(device);
  if (!parsed.lawicel) {
    return std::make_unique<SocketCanLink>(std::move(name), std::move(parsed.path), bitrate, context, runtime, log);
  }
  serial::SerialSettings settings;
  settings.device = parsed.path;
  settings.baud = parsed.baud;
  auto port = std::make_unique<serial::SerialLink>(name, std::move(settings), context, runtime, log);
  return std::make_unique<SlcanLink>(std::move(name), std::move(parsed), bitrate, std::move(port), runtime, log);
}

}  // namespace axisgate::can
