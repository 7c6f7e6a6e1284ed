// SPDX-License-Identifier: Apache-2.0
// How the product makes a CAN link: SocketCAN or a Lawicel adapter, by the device of the configuration.
// Promises a link that picks its device up whenever it appears.
// Never opens anything before the link is started.
#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>
#include <string_view>

#include "adapters/can/can_link.hpp"
#include "gateway/core/log.hpp"

namespace axisgate::can {

/// `device` and `bitrate`: such that can_device_mistake() finds nothing (can_device.hpp). `name` is the bus's, for the
/// log. `context`, `runtime` and `log` must outlive the link.
[[nodiscard]] std::unique_ptr<CanLink> make_can_link(std::string_view device, std::uint32_t bitrate, std::string name,
                                                     boost::asio::io_context& context, Runtime& runtime,
                                                     const Log& log);

}  // namespace axisgate::can
