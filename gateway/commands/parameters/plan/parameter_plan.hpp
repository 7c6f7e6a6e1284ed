// SPDX-License-Identifier: Apache-2.0
// What saving, comparing and restoring a drive's parameters comes to: what an answer says, what differs, what a restore
// writes and why it does not write the rest, and whether it goes on after an answer. Pure.
// Promises that only what differs is written, only to a drive of the same type, and that everything that differs and is
// not written is named with its reason. Never writes anything.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/commands/parameters/plan/parameter_file.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::commands {

/// How often an object is asked that the drive does not answer for, or is written that it refuses: the second time
/// after all others, since what it allows may depend on them.
inline constexpr int kParameterTries = 2;
/// So many objects one after the other without any answer: the drive is gone.
inline constexpr int kMostSilent = 3;
/// Lines of what is not written; the others are counted.
inline constexpr std::size_t kMostShown = 200;

/// In the same order as the parameters.
using Readings = std::vector<Reading>;

[[nodiscard]] ObjectRequest read_request(const model::DriveModel& model, const Parameter& parameter);
[[nodiscard]] ObjectRequest write_request(const Parameter& parameter, std::int64_t number);
[[nodiscard]] Reading reading_of(const model::DriveModel& model, const Parameter& parameter, const BatchResult& answer);
/// What a request came to: "refused by the drive: 0x06090030 value range (...)".
[[nodiscard]] std::string refusal_text(const BatchResult& answer);

/// After an answer: the next one; the same once more, since the drive's memory must be spared now; or no more, since
/// nobody knows what the drive does.
enum class After : std::uint8_t { next, again, end };
[[nodiscard]] After after(const BatchResult& answer);

/// What became of one write.
struct Written {
  bool held = false;       ///< the drive holds it
  bool try_later = false;  ///< the drive refused it: it may take it when the others are written
  bool ends = false;       ///< nothing more can be written
  std::string text{};
};
/// Why what was shown is not written any more: it is another number `now` (none: the drive is silent); none: it is.
[[nodiscard]] std::optional<Written> changed(const Parameter& parameter, std::int64_t shown,
                                             const std::optional<Reading>& now);
/// By the answer to the write, and by what was read back (none: the drive is silent).
[[nodiscard]] Written written(const Parameter& parameter, std::int64_t number, const BatchResult& answer,
                              const std::optional<Reading>& held);

[[nodiscard]] std::vector<SavedParameter> saved(const std::vector<Parameter>& parameters, const Readings& readings);

struct Difference {
  std::size_t place = 0;                ///< in the parameters; of no use where `known` is false
  bool known = true;                    ///< the profile or the EDS has the object
  std::string text;                     ///< "din1_function (2010.03): 1 in the file, 0 in the drive"
  std::optional<std::int64_t> write{};  ///< what a restore writes; none: it does not
  std::int64_t now = 0;                 ///< of `write`: what the drive holds
  std::string not_written{};            ///< why it does not
  bool counts = true;                   ///< false: it differs from hour to hour
};
/// In the order of the file, which is that of the addresses.
[[nodiscard]] std::vector<Difference> differences(const model::DriveModel& model,
                                                  const std::vector<Parameter>& parameters, const Readings& readings,
                                                  const ParameterFile& file);
[[nodiscard]] bool any_counts(const std::vector<Difference>& found);

/// Why what was saved of one drive is not for the other; empty: it may be.
[[nodiscard]] std::string objection(const DriveFacts& saved, const DriveFacts& now);
/// What is worth knowing of the two: another serial number, another firmware; lines.
[[nodiscard]] std::vector<std::string> remarks(const DriveFacts& saved, const DriveFacts& now);

/// What a restore costs the drive's memory, and how long that takes; lines.
[[nodiscard]] std::vector<std::string> cost(const model::DriveModel& model, AxisSlot slot,
                                            const std::vector<Parameter>& parameters,
                                            const std::vector<Difference>& found);
/// The profile has a command that keeps what was written over a restart.
[[nodiscard]] bool has_save_command(const model::DriveModel& model, AxisSlot slot);

/// "read 400 of 2000, about 12 s to go".
[[nodiscard]] std::string progress_text(std::size_t done, std::size_t all, Duration took);

}  // namespace axisgate::commands
