// SPDX-License-Identifier: Apache-2.0
// Function 43/13, after the codec: who may, which axis, what is asked of its drive, and what is answered (design 3.1).
// Promises that parts of a long object that is read belong to one fetch of it, and that a long object is written whole
// or not at all. Several may be under way at once: "busy" (0x06) is the mailbox's alone, which has one set of
// registers. Never asks anything of an axis itself: ObjectRun carries the plan out.
#pragma once

#include <optional>

#include "gateway/upstream/modbus_tcp/read/row_values.hpp"
#include "gateway/upstream/modbus_tcp/read/unit_view.hpp"
#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"

namespace axisgate::modbus_tcp {

struct ReferencePlan {
  Errc refused = Errc::ok;  ///< role_forbidden, no_path (no such axis here) or bad_value (parts that do not fit)
  AxisNumber axis = 0;
  /// None: nothing is asked of the drive. It is a part of a write, or a read of what was fetched before.
  std::optional<WriteBatch> batch{};
};

/// On arrival. `request.reference` is set; parts of a write are kept with the client.
[[nodiscard]] ReferencePlan plan_reference(const Request& request, const UnitView& view, const Onlooker& onlooker,
                                           Client& client);
/// At the request's turn to be answered, so that what it reads in parts is what its own connection fetched before it.
/// `result`: of the write batch, where the plan had one.
[[nodiscard]] Pdu answer_reference(const Request& request, AxisNumber axis, const std::optional<BatchResult>& result,
                                   Client& client, Instant now);

}  // namespace axisgate::modbus_tcp
