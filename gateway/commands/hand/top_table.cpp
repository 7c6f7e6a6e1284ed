// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/hand/top_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string_view>

#include "gateway/core/binary32.hpp"
#include "gateway/core/words.hpp"
#include "gateway/image/command.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/image/quantity.hpp"

namespace axisgate::app {
namespace {

// Offsets in an axis's block (design 3.1).
constexpr std::size_t kModeDisplay = 1;
constexpr std::size_t kPosition = 2;
constexpr std::size_t kVelocity = 4;
constexpr std::size_t kTorque = 6;
constexpr std::size_t kCurrent = 7;
constexpr std::size_t kErrorCode = 10;
constexpr std::size_t kVendorError = 12;
constexpr std::size_t kLinkState = 18;
constexpr std::size_t kAge = 19;
constexpr std::size_t kSupported = 20;
constexpr std::size_t kValid = 22;
constexpr std::size_t kAxisState = 31;
constexpr std::size_t kAlarms = 34;

constexpr std::uint32_t kOrderTest = 0x01020304;

std::uint32_t word32(std::uint16_t first, std::uint16_t second, WordOrder order) {
  const std::uint32_t high = order == WordOrder::low_first ? second : first;
  const std::uint32_t low = order == WordOrder::low_first ? first : second;
  return high << 16 | low;
}

/// One axis's registers, read as the quantities they are.
class AxisCells {
 public:
  AxisCells(const AxisReading& reading, WordOrder order, bool floats)
      : registers_(reading.registers), order_(order), floats_(floats) {}

  [[nodiscard]] std::uint16_t word(std::size_t offset) const { return registers_[offset]; }
  [[nodiscard]] std::uint32_t pair(std::size_t offset) const {
    return word32(registers_[offset], registers_[offset + 1], order_);
  }
  /// "-12.5", "-12.5?", "?", "-": see the header's promise. `decimals` places of the register's number.
  [[nodiscard]] std::string number(Quantity quantity, std::size_t offset, int decimals) const {
    if ((pair(kSupported) & bit(quantity)) == 0) return "-";
    const RegisterType type = row(quantity).type;
    if (floats_ && type == RegisterType::i32) return float_number(quantity, offset, decimals);
    const std::int64_t value = type == RegisterType::i32   ? static_cast<std::int32_t>(pair(offset))
                               : type == RegisterType::i16 ? static_cast<std::int16_t>(word(offset))
                                                           : word(offset);
    if (value == no_value(type)) return "?";
    return with_point(value, decimals) + (good(quantity) ? "" : "?");
  }
  [[nodiscard]] bool good(Quantity quantity) const { return (pair(kValid) & bit(quantity)) != 0; }

 private:
  [[nodiscard]] std::string float_number(Quantity quantity, std::size_t offset, int decimals) const {
    if (is_nan_binary32(pair(offset))) return "?";
    constexpr int kOfATurn = 4;
    const int places = row(quantity).kind == Kind::position ? kOfATurn : decimals;
    return fmt::format("{:.{}f}", std::bit_cast<float>(pair(offset)), places) + (good(quantity) ? "" : "?");
  }
  static std::string with_point(std::int64_t value, int decimals) {
    std::int64_t unit = 1;
    for (int i = 0; i < decimals; ++i) unit *= 10;
    const std::int64_t size = value < 0 ? -value : value;
    const char* sign = value < 0 ? "-" : "";
    if (decimals == 0) return fmt::format("{}{}", sign, size);
    return fmt::format("{}{}.{:0{}}", sign, size / unit, size % unit, decimals);
  }

  std::span<const std::uint16_t, kAxisRegisters> registers_;
  WordOrder order_;
  bool floats_;
};

std::string mode_text(const AxisCells& cells) {
  const auto mode = static_cast<std::int16_t>(cells.word(kModeDisplay));
  if (mode == no_value(RegisterType::i16)) return "?";
  const Word* word = mode < 0 ? nullptr : find_word(WordKind::mode, static_cast<std::uint32_t>(mode));
  std::string name = mode < 0 ? fmt::format("own {}", mode) : fmt::format("mode {}", mode);
  if (word != nullptr) name = word->name;
  return name + (cells.good(Quantity::mode_display) ? "" : "?");
}

/// error_code is shown as the gateway gives it: for an axis out of reach it is the reason itself (0x8130), not an old
/// value.
std::string error_text(const AxisCells& cells) {
  const std::uint16_t code = cells.word(kErrorCode);
  if (code == no_value(RegisterType::u16)) return "?";
  const std::uint32_t vendor = cells.pair(kVendorError);
  const bool has_vendor = cells.good(Quantity::vendor_error) && vendor != 0 && vendor != no_value(RegisterType::u32);
  const Word* word = find_error(code);
  std::string shown = code == 0 ? "none" : fmt::format("0x{:04X}", code);
  if (word != nullptr) shown += fmt::format(" {}", word->name);
  return has_vendor ? fmt::format("{} (0x{:X})", shown, vendor) : shown;
}

std::string age_text(std::uint16_t age) { return age == 0xFFFF ? ">65 s" : fmt::format("{}", age); }

std::string alarms_text(WordKind kind, std::uint32_t bits, std::string_view none) {
  const std::string names = names_of_bits(kind, bits);
  return names.empty() ? std::string(none) : names;
}

std::string_view role_text(std::uint16_t role) {
  return role <= static_cast<std::uint16_t>(Role::engineer) ? text(static_cast<Role>(role)) : "?";
}

/// What a line of the table tells of an axis.
struct AxisTexts {
  std::string number, name, link, state, mode, position, velocity, torque, current, age, error, alarms;
};

AxisTexts texts_of(const AxisReading& axis, WordOrder order, bool float_numbers) {
  const AxisCells cells(axis, order, float_numbers);
  return {.number = fmt::format("{}", axis.axis),
          .name = axis.name,
          .link = std::string(name_of(WordKind::link_state, cells.word(kLinkState))),
          .state = std::string(name_of(WordKind::axis_state, cells.word(kAxisState))),
          .mode = mode_text(cells),
          .position = cells.number(Quantity::position_actual, kPosition, 0),
          .velocity = cells.number(Quantity::velocity_actual, kVelocity, 3),
          .torque = cells.number(Quantity::torque_actual, kTorque, 1),
          .current = cells.number(Quantity::current_actual, kCurrent, 2),
          .age = age_text(cells.word(kAge)),
          .error = error_text(cells),
          .alarms = alarms_text(WordKind::axis_alarm, cells.pair(kAlarms), "-")};
}

std::string wide_row(const AxisTexts& t, std::size_t name_width) {
  const std::string name = name_width == 0 ? std::string() : fmt::format("  {:<{}}", t.name, name_width);
  return fmt::format("{:>4}{}  {:<9}  {:<17}  {:<17}  {:>12}  {:>12}  {:>8}  {:>9}  {:>6}  {:<18}  {}\n", t.number,
                     name, t.link, t.state, t.mode, t.position, t.velocity, t.torque, t.current, t.age, t.error,
                     t.alarms);
}

AxisTexts column_names() {
  return {"axis",         "name",     "link",      "state",  "mode",  "position",
          "velocity rpm", "torque %", "current A", "age ms", "error", "alarms"};
}

/// Between words, so that no line is longer; one word that is, stands alone.
std::string wrapped(std::string_view text, std::size_t columns, std::string_view first_indent,
                    std::string_view indent) {
  std::string out, line;
  while (!text.empty()) {
    const std::size_t end = text.find(' ');
    const std::string_view word = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (!line.empty() && line.size() + 1 + word.size() > columns) {
      out += line + "\n";
      line.clear();
    }
    if (line.empty())
      line = std::string(out.empty() ? first_indent : indent) + std::string(word);
    else
      line += " " + std::string(word);
  }
  return out + line + "\n";
}

constexpr std::string_view kNarrowRow = "{:>4}  {:<9}  {:<17}  {:>12}  {:>14}  {:>9}\n";

std::string narrow_rows(const AxisTexts& t, std::size_t columns) {
  std::string more = t.name.empty() ? std::string() : t.name + ": ";
  more += t.mode + ", " + t.current + " A, age " + t.age + " ms";
  if (t.error != "none") more += ", error " + t.error;
  if (t.alarms != "-") more += ", alarms: " + t.alarms;
  constexpr std::string_view kIndent = "      ";
  return fmt::format(fmt::runtime(kNarrowRow), t.number, t.link, t.state, t.position, t.velocity, t.torque) +
         wrapped(more, columns, kIndent, kIndent);
}

}  // namespace

WordOrder word_order(std::span<const std::uint16_t, kGatewayRegisters> gateway) {
  if (word32(gateway[10], gateway[11], WordOrder::high_first) == kOrderTest) return WordOrder::high_first;
  if (word32(gateway[10], gateway[11], WordOrder::low_first) == kOrderTest) return WordOrder::low_first;
  return WordOrder::unknown;
}

void mark_out_of_reach(AxisReading& axis) {
  axis.registers[kLinkState] = static_cast<std::uint16_t>(LinkState::offline);
  axis.registers[kValid] = 0;
  axis.registers[kValid + 1] = 0;
}

std::string render_table(const TopReading& reading, std::size_t columns) {
  const WordOrder order = word_order(reading.gateway);
  const std::uint32_t up = word32(reading.gateway[4], reading.gateway[5], order);
  const std::string first =
      fmt::format("axisgate {}  {}  axes online {} of {}  up {}:{:02}:{:02}  role {}  alarms: {}", reading.server,
                  name_of(WordKind::gateway_state, reading.gateway[2]), reading.gateway[3], reading.gateway[1],
                  up / 3600, up / 60 % 60, up % 60, role_text(reading.gateway[7]),
                  alarms_text(WordKind::gateway_alarm, reading.gateway[6], "none"));
  std::vector<AxisTexts> axes;
  std::size_t name_width = 0;
  for (const AxisReading& axis : reading.axes) {
    axes.push_back(texts_of(axis, order, reading.float_numbers));
    name_width = std::max(name_width, axis.name.size());
  }
  if (name_width != 0) name_width = std::max(name_width, column_names().name.size());
  std::string rows = wide_row(column_names(), name_width);
  for (const AxisTexts& axis : axes) rows += wide_row(axis, name_width);
  std::size_t widest = 0;
  for (std::size_t at = 0; at < rows.size(); at = rows.find('\n', at) + 1)
    widest = std::max(widest, rows.find('\n', at) - at);
  const bool narrow = columns != 0 && std::max(widest, first.size()) > columns;
  std::string out = first + "\n";
  if (narrow) {
    out = wrapped(first, columns, "", "  ");
    const AxisTexts names = column_names();
    rows = fmt::format(fmt::runtime(kNarrowRow), names.number, names.link, names.state, names.position, names.velocity,
                       names.torque);
    for (const AxisTexts& axis : axes) rows += narrow_rows(axis, columns);
  }
  out += rows;
  if (reading.axes.empty()) out += "no axes\n";
  return out;
}

namespace {

/// One of its alarms is named: in a line of its own after "alarms: ", in the wide layout in the last column.
bool names_an_alarm(std::string_view line) {
  if (line.find("alarms: ") != std::string_view::npos) return !line.ends_with("alarms: none");
  const std::size_t before = line.rfind("  ");
  if (before == std::string_view::npos) return false;
  const std::string_view first = line.substr(before + 2, line.find(',', before) - before - 2);
  return first.starts_with("bit ") || std::ranges::any_of(words(), [&](const Word& word) {
           return word.kind == WordKind::axis_alarm && word.name == first;
         });
}

}  // namespace

Attention attention(std::string_view line) {
  const auto says = [&](WordKind kind, auto number) {
    return line.find("  " + std::string(name_of(kind, static_cast<std::uint32_t>(number)))) != std::string_view::npos;
  };
  using enum WordKind;
  if (says(axis_state, AxisState::error_stop) || says(link_state, LinkState::offline) ||
      says(link_state, LinkState::link_down))
    return Attention::act;
  const bool look =
      says(link_state, LinkState::suspect) || says(axis_state, AxisState::stopping) || names_an_alarm(line);
  return look ? Attention::look : Attention::none;
}

}  // namespace axisgate::app
