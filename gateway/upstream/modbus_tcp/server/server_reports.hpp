// SPDX-License-Identifier: Apache-2.0
// What is reported to the gateway of the Modbus-TCP server: what to show as an event, and whether an address is
// missing. Promises that who leaves them empty gets no report, and is served all the same. Never carries what a client
// asked.
#pragma once

#include <functional>
#include <string>

#include "gateway/image/events.hpp"

namespace axisgate::modbus_tcp {

struct ServerReports {
  std::function<void(EventKind, std::string)> event{};
  std::function<void(bool down)> listener_down{};  ///< gateway alarm of that name
};

}  // namespace axisgate::modbus_tcp
