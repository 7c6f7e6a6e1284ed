// SPDX-License-Identifier: Apache-2.0
// A sample of object_request as a write batch for the command port, and its result as a sample of object_reply.
// Promises that a write needs the engineer and a read claims nothing, and that a value is written whole or not at all.
// Never knows what the object is: the axis does, and refuses what would go past its limits.
#pragma once

#include <variant>

#include "gateway/image/command.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds {

using PlannedObject = std::variant<WriteBatch, Errc>;

/// `from`: a write batch of this writer, with its deadlines, that asks for nothing yet.
[[nodiscard]] PlannedObject plan_object(const ObjectRequestRecord& record, const WriteBatch& from,
                                        const AxisImage* axis);

[[nodiscard]] ObjectReplyRecord object_reply(const ObjectRequestRecord& record, const BatchResult& result);

}  // namespace axisgate::dds
