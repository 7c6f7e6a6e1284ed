// SPDX-License-Identifier: Apache-2.0
// What is read of a drive before anything is written to it: each object of its profile once, and what its answer says
// of the profile. Pure: answers go in. Promises that an answer which cannot be right beside this profile is named with
// its object: another width, a needed object that is refused, a value that is only possible in the other word order.
// Never takes a value as wrong because it is unusual.
#pragma once

#include <vector>

#include "gateway/commands/try/plan/try_report.hpp"
#include "gateway/image/command.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::commands {

/// "position_actual (6064.00)", "speed (register 12)".
[[nodiscard]] std::string address_text(const model::DriveModel& model, const model::ObjectDef& object);
/// The two 16-bit halves of a 32-bit number change places.
[[nodiscard]] constexpr std::uint32_t other_order(std::uint32_t raw) { return raw << 16U | raw >> 16U; }

/// In the profile's order: what can be read, and is in the drive.
[[nodiscard]] std::vector<model::ObjectId> objects_to_read(const model::DriveModel& model);
/// With a width wherever the protocol has none.
[[nodiscard]] ObjectRequest read_request(const model::DriveModel& model, model::ObjectId object);
[[nodiscard]] ObjectRow row_of(const model::DriveModel& model, model::ObjectId object, const BatchResult& answer);
/// "statusword           6041.00         u16  561 (0x231)  remark"
[[nodiscard]] std::string line_of(const ObjectRow& row);

/// Of the setup list: what the drive holds beside what bring-up writes, a line each; `holds` is false where it differs.
struct SetupRow {
  std::string text;
  bool holds = true;
};
[[nodiscard]] SetupRow setup_row(const model::DriveModel& model, const model::ObjectWrite& write,
                                 const BatchResult& answer);

}  // namespace axisgate::commands
