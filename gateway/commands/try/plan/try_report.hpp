// SPDX-License-Identifier: Apache-2.0
// What a trial of a profile has found: of each step what it would do, what it needed, what it saw, and a verdict.
// Promises a record of every step, of those that were not reached as well, and no verdict without a reason. Pure.
// Never says "right" of what nobody has seen.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::commands {

enum class TryStep : std::uint8_t { read, setup, turn, torque, moves, stops, loss, home };
inline constexpr std::size_t kTrySteps = 8;
/// "read", "setup", ..., as the report and consents call them.
[[nodiscard]] std::string_view text(TryStep step);
/// What it does, and what it needs of the person and the machine.
[[nodiscard]] std::string_view will(TryStep step);
[[nodiscard]] std::string_view needs(TryStep step);

enum class Verdict : std::uint8_t { not_tried, right, wrong };
[[nodiscard]] std::string_view text(Verdict verdict);

/// One object, as it was read.
struct ObjectRow {
  std::string name;
  std::string address;  ///< "6041.00", "register 12"
  std::string type;     ///< as the profile has it: "u16"
  std::optional<std::int64_t> value{};
  std::optional<std::int64_t> other_order{};  ///< 32 bits on Modbus RTU: the value in the other word order
  std::string remark{};
  bool wrong = false;
};

struct StepReport {
  Verdict verdict = Verdict::not_tried;
  std::vector<std::string> saw{};
};

struct TryReport {
  std::string config, profile, title, protocol, at, version;
  unsigned axis = 0;
  bool dry = false;
  std::string ended{};  ///< why it ended before its end; empty: it did not
  std::array<StepReport, kTrySteps> steps{};
  std::vector<ObjectRow> objects{};

  [[nodiscard]] StepReport& of(TryStep step) { return steps[static_cast<std::size_t>(step)]; }
  [[nodiscard]] const StepReport& of(TryStep step) const { return steps[static_cast<std::size_t>(step)]; }
  [[nodiscard]] bool any_wrong() const;
};

/// As it is carried in a pull request: indented, UTF-8, one end of line at its end.
[[nodiscard]] std::string json_text(const TryReport& report);

/// Lines of at most `width` columns, broken at spaces; each but the first begins with `indent` spaces.
[[nodiscard]] std::vector<std::string> wrapped(std::string_view text, std::size_t indent, std::size_t width = 79);

}  // namespace axisgate::commands
