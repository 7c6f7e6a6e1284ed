// SPDX-License-Identifier: Apache-2.0
// How the product makes the wire of a bus: the adapter named in the configuration over its device.
// Promises a wire that picks its device up whenever it appears.
// Never opens a device before the bus starts it.
#pragma once

#include <boost/asio/io_context.hpp>

#include "gateway/compose/gateway.hpp"

namespace axisgate::process {

/// Everything passed by reference must outlive the wires that are made.
[[nodiscard]] compose::MakeWire device_wires(boost::asio::io_context& io, Runtime& runtime, const Log& log);

}  // namespace axisgate::process
