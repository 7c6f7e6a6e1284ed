// SPDX-License-Identifier: Apache-2.0
// A drive that is looked at and left as it is: its model without anything that bring-up would write, and wires on which
// nothing else than reads leaves (CAN), as long as the guard says so. Promises that a drive which is only looked at is
// asked for its objects and nothing else. Never opens a device before its bus starts it.
#pragma once

#include <boost/asio/io_context.hpp>

#include "gateway/commands/try/guarded_link.hpp"
#include "gateway/compose/gateway.hpp"

namespace axisgate::commands {

/// What would be written at bring-up is left out.
[[nodiscard]] model::DriveModel only_read(model::DriveModel model);
/// Everything passed by reference must outlive the wires that are made.
[[nodiscard]] compose::MakeWire guarded_wires(boost::asio::io_context& io, Runtime& runtime, const Log& log,
                                              const LinkGuard& guard);

}  // namespace axisgate::commands
