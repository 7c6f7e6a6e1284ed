// SPDX-License-Identifier: Apache-2.0
// What commissioning an axis comes to: the checks of its drive, what they found, one question for each finding that has
// a remedy, and whether a yes still counts when it comes. Pure: numbers that were read, words that were typed.
// Promises that a question names all that a yes writes, that only a whole "yes" is one, and that it counts only while
// everything is as the question showed it and no motor of the drive has torque. Never writes anything.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/drive/device/drive.hpp"

namespace axisgate::commands {

struct Finding {
  const model::Check* check = nullptr;
  bool known = false;  ///< the value was read from the drive
  bool bad = false;
  std::int64_t value = 0;
};

/// One per check that concerns the axis, in the profile's order.
[[nodiscard]] std::vector<Finding> findings(const model::DriveModel& model, const drive::ObjectStore& store,
                                            AxisSlot slot);
/// The checks that are asked about, in the same order: bad ones that have a remedy.
[[nodiscard]] std::vector<const model::Check*> to_ask(const std::vector<Finding>& found);
/// Something is bad that no write remedies.
[[nodiscard]] bool leaves_bad(const std::vector<Finding>& found);

/// What was read of the drive; an object that did not answer is absent.
using Numbers = std::map<model::ObjectId, std::int64_t>;

/// What is read before a question, after its yes and after its writes: the check's object, and those that the remedy
/// writes. Not a trigger: what it reads as says nothing.
[[nodiscard]] std::vector<model::ObjectId> objects_of(const model::DriveModel& model, const model::Check& check);
/// No value: the check's object did not answer.
[[nodiscard]] std::optional<bool> is_bad(const model::DriveModel& model, const model::Check& check,
                                         const Numbers& numbers);

/// An axis of the drive as it shows itself now.
struct AxisShown {
  AxisNumber number = 0;
  LinkState link = LinkState::unknown;
  bool state_known = false;  ///< the objects that hold its state could be read just now
  bool enabled = false;
};
/// Why nothing may be written to this drive now; empty: it may.
[[nodiscard]] std::string objection(const std::vector<AxisShown>& axes);
/// Why a yes to what was `shown` does not count for what is there `now`; empty: it counts.
[[nodiscard]] std::string objection(const model::DriveModel& model, const model::Check& check, const Numbers& shown,
                                    const Numbers& now);
/// "yes" and nothing else.
[[nodiscard]] bool means_yes(std::string_view line);

/// "name (2010.03) = 0  why"; of Modbus RTU "name (register 296) = 0  why".
[[nodiscard]] std::string text(const model::DriveModel& model, const model::ObjectWrite& write);
[[nodiscard]] std::string text(const model::DriveModel& model, const Finding& finding);
/// What is wrong, what it means, and each write of the remedy with what it takes the place of; lines.
[[nodiscard]] std::string question(const model::DriveModel& model, const model::Check& check, const Numbers& shown);

struct ReadBack {
  bool cured = false;
  std::string text;  ///< what each written object reads now, and whether the finding is gone; lines
};
/// By what was read back after the writes.
[[nodiscard]] ReadBack read_back(const model::DriveModel& model, const model::Check& check, const Numbers& after);

}  // namespace axisgate::commands
