// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/view/top_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string_view>

#include "gateway/core/binary32.hpp"
#include "gateway/core/shown_words.hpp"
#include "gateway/core/words.hpp"
#include "gateway/image/command.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/image/quantity.hpp"
#include "gateway/image/register_map.hpp"

namespace axisgate::commands {
namespace {

/// One axis's registers, read as the quantities they are.
class AxisCells {
 public:
  AxisCells(const AxisReading& reading, WordOrder order, bool floats)
      : registers_(reading.registers), order_(order), floats_(floats) {}

  /// Of a quantity, or of a row that is none.
  [[nodiscard]] std::uint16_t word(auto what) const { return registers_[axis_offset(what)]; }
  [[nodiscard]] std::uint32_t pair(auto what) const { return pair_at(registers_, axis_offset(what), order_); }
  /// "-12.5", "-12.5?", "?", "-": see the header's promise. `decimals` places of the register's number.
  [[nodiscard]] std::string number(Quantity quantity, int decimals) const {
    if ((pair(Source::supported) & bit(quantity)) == 0) return "-";
    const RegisterType type = row(quantity).type;
    if (floats_ && type == RegisterType::i32) return float_number(quantity, decimals);
    const std::int64_t value = type == RegisterType::i32   ? static_cast<std::int32_t>(pair(quantity))
                               : type == RegisterType::i16 ? static_cast<std::int16_t>(word(quantity))
                                                           : word(quantity);
    if (value == no_value(type)) return "?";
    return with_point(value, decimals) + (good(quantity) ? "" : "?");
  }
  /// Nothing shows that it turns.
  [[nodiscard]] bool stands() const {
    if ((pair(Source::supported) & bit(Quantity::velocity_actual)) == 0) return true;
    constexpr double kTremble = 1;  // rpm
    const std::uint32_t bits = pair(Quantity::velocity_actual);
    constexpr double kUnits = 1000;  // of an rpm
    const double rpm = floats_ ? static_cast<double>(std::bit_cast<float>(bits))
                               : static_cast<double>(static_cast<std::int32_t>(bits)) / kUnits;
    return good(Quantity::velocity_actual) && rpm > -kTremble && rpm < kTremble;
  }
  /// The position in turns of the motor, as number(). Of a register of floats it is that number already.
  [[nodiscard]] std::string turns(const Rational& units_per_rev) const {
    const std::string position = number(Quantity::position_actual, 0);
    if (floats_ || position == "?" || position == "-") return position;
    constexpr std::int64_t kOfATurn = 1000;
    const auto turns =
        (Rational(kOfATurn) / units_per_rev).scale(static_cast<std::int32_t>(pair(Quantity::position_actual)));
    return turns ? with_point(*turns, 3) + (good(Quantity::position_actual) ? "" : "?") : "?";
  }
  [[nodiscard]] bool good(Quantity quantity) const { return (pair(Source::valid) & bit(quantity)) != 0; }

 private:
  [[nodiscard]] std::string float_number(Quantity quantity, int decimals) const {
    if (is_nan_binary32(pair(quantity))) return "?";
    constexpr int kOfATurn = 4;
    const int places = row(quantity).kind == Kind::position ? kOfATurn : decimals;
    return fmt::format("{:.{}f}", std::bit_cast<float>(pair(quantity)), places) + (good(quantity) ? "" : "?");
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
  const auto mode = static_cast<std::int16_t>(cells.word(Quantity::mode_display));
  if (mode == no_value(RegisterType::i16)) return "?";
  return shown_mode(mode) + (cells.good(Quantity::mode_display) ? "" : "?");
}

/// error_code is shown as the gateway gives it: for an axis out of reach it is the reason itself (0x8130), not an old
/// value.
std::string error_text(const AxisCells& cells) {
  const bool faulted = cells.word(Source::axis_state) == static_cast<std::uint16_t>(AxisState::error_stop);
  const std::uint32_t vendor = cells.pair(Quantity::vendor_error);
  const bool has_vendor = cells.good(Quantity::vendor_error) && vendor != no_value(RegisterType::u32);
  return shown_error(cells.word(Quantity::error_code), has_vendor ? vendor : 0, faulted);
}

std::string age_text(std::uint16_t age) { return age == 0xFFFF ? ">65 s" : fmt::format("{}", age); }

std::string alarms_text(WordKind kind, std::uint32_t bits, std::string_view none) {
  const std::string names = names_of_bits(kind, bits);
  return names.empty() ? std::string(none) : names;
}

std::string_view role_text(std::uint16_t role) {
  return role <= static_cast<std::uint16_t>(Role::engineer) ? text(static_cast<Role>(role)) : "?";
}

/// The word before what is named.
constexpr std::string_view kAlarms = "alarms:";

/// What a line of the table tells of an axis.
struct AxisTexts {
  std::string number, name, link, state, mode, position, turns, velocity, torque, current, age, error, alarms;
  Attention of_state = Attention::none;
  bool alarmed = false;
};

Attention of_state(LinkState link, AxisState state) {
  if (state == AxisState::error_stop || link == LinkState::offline || link == LinkState::link_down)
    return Attention::act;
  return link == LinkState::suspect || state == AxisState::stopping ? Attention::look : Attention::none;
}

/// Of this part of the block the speed tells whether it stands; a drive that tells none is shown latched.
bool latched_and_stands(const AxisCells& cells) {
  return (cells.pair(Source::axis_alarms) & bit(AxisAlarm::stop_latched)) != 0 && cells.stands();
}

/// Beside "standstill" a speed is that of before: it is read less often than the state.
std::string velocity_text(const AxisCells& cells) {
  constexpr int kOfAnRpm = 3;
  const std::string shown = cells.number(Quantity::velocity_actual, kOfAnRpm);
  const bool standstill = cells.word(Source::axis_state) == static_cast<std::uint16_t>(AxisState::standstill);
  const bool marked = shown.back() == '?' || shown == "-";
  return standstill && !marked && !cells.stands() ? shown + "?" : shown;
}

AxisTexts texts_of(const AxisReading& axis, WordOrder order, bool float_numbers) {
  const AxisCells cells(axis, order, float_numbers);
  return {.number = fmt::format("{}", axis.axis),
          .name = axis.name,
          .link = std::string(name_of(WordKind::link_state, cells.word(Source::link_state))),
          .state = std::string(axis_state_text(cells.word(Source::axis_state), latched_and_stands(cells))),
          .mode = mode_text(cells),
          .position = cells.number(Quantity::position_actual, 0),
          .turns = axis.units_per_rev ? cells.turns(*axis.units_per_rev) : std::string(),
          .velocity = velocity_text(cells),
          .torque = cells.number(Quantity::torque_actual, 1),
          .current = cells.number(Quantity::current_actual, 2),
          .age = age_text(cells.word(Source::age_ms)),
          .error = error_text(cells),
          .alarms = alarms_text(WordKind::axis_alarm, cells.pair(Source::axis_alarms), "-"),
          .of_state = of_state(LinkState{static_cast<std::uint8_t>(cells.word(Source::link_state))},
                               AxisState{static_cast<std::uint8_t>(cells.word(Source::axis_state))}),
          .alarmed = cells.pair(Source::axis_alarms) != 0};
}

/// What the configuration tells has columns where it is given.
struct Widths {
  std::size_t name = 0;
  bool turns = false;
};

TopLine wide_row(const AxisTexts& t, Widths widths) {
  const std::string name = widths.name == 0 ? std::string() : fmt::format("  {:<{}}", t.name, widths.name);
  const std::string turns = widths.turns ? fmt::format("  {:>10}", t.turns) : std::string();
  TopLine row{
      fmt::format("{:>4}{}  {:<9}  {:<17}  {:<17}  {:>12}{}  {:>12}  {:>8}  {:>9}  {:>6}  {:<18}  ", t.number, name,
                  t.link, t.state, t.mode, t.position, turns, t.velocity, t.torque, t.current, t.age, t.error),
      t.of_state};
  if (t.of_state == Attention::none && t.alarmed) {
    row.asks = Attention::look;
    row.asks_from = row.text.size();
  }
  row.text += t.alarms;
  return row;
}

AxisTexts column_names() {
  return {"axis",         "name",     "link",      "state",  "mode",  "position", "turns",
          "velocity rpm", "torque %", "current A", "age ms", "error", "alarms"};
}

/// Between words, so that no line is longer; one word that is, stands alone. From the word "alarms:" on it asks for
/// attention where there are some.
std::vector<TopLine> wrapped(std::string_view text, std::size_t columns, std::string_view first_indent,
                             std::string_view indent, bool alarmed = false) {
  std::vector<TopLine> lines;
  bool asks = false;
  while (!text.empty()) {
    const std::size_t end = text.find(' ');
    const std::string_view word = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    const bool begins = lines.empty() || lines.back().text.size() + 1 + word.size() > columns;
    if (begins)
      lines.push_back({std::string(lines.empty() ? first_indent : indent), asks ? Attention::look : Attention::none});
    else
      lines.back().text += " ";
    if (alarmed && word == kAlarms) {
      asks = true;
      lines.back().asks = Attention::look;
      lines.back().asks_from = lines.back().text.size();
    }
    lines.back().text += word;
  }
  return lines;
}

/// Longer names stand in the line below.
constexpr std::size_t kNarrowName = 14;

TopLine narrow_row(const AxisTexts& t, std::size_t name_width) {
  const std::string name =
      name_width == 0 || name_width > kNarrowName ? std::string() : fmt::format("  {:<{}}", t.name, name_width);
  return {
      fmt::format("{:>4}{}  {:<9}  {:<17}  {:>12}  {:>14}", t.number, name, t.link, t.state, t.position, t.velocity),
      t.of_state};
}

/// Below that row: what had no room in it, and its alarms.
std::vector<TopLine> more_of(const AxisTexts& t, std::size_t name_width, std::size_t columns) {
  std::string more = name_width > kNarrowName ? t.name + ": " : std::string();
  if (!t.turns.empty()) more += t.turns + " turns, ";
  more += t.mode + ", ";
  if (t.torque != "-") more += "torque " + t.torque + " %, ";
  if (t.current != "-") more += t.current + " A, ";
  more += "age " + t.age + " ms";
  if (t.error != "none") more += ", error " + t.error;
  constexpr std::string_view kIndent = "      ";
  std::vector<TopLine> lines = wrapped(more, columns, kIndent, kIndent);
  if (t.alarmed)
    std::ranges::move(wrapped(fmt::format("{} {}", kAlarms, t.alarms), columns, kIndent, kIndent, true),
                      std::back_inserter(lines));
  return lines;
}

/// What somebody would ask of first: of a fault, else of an alarm. Empty: of nothing.
std::string worth_explaining(const TopReading& reading, WordOrder order) {
  std::string alarm;
  for (const AxisReading& axis : reading.axes) {
    const AxisCells cells(axis, order, reading.float_numbers);
    const std::uint16_t code = cells.word(Quantity::error_code);
    if (code != 0 && code != no_value(RegisterType::u16) && find_error(code) != nullptr)
      return fmt::format("0x{:04X}", code);
    const std::uint32_t alarms = cells.pair(Source::axis_alarms);
    if (alarm.empty() && alarms != 0)
      alarm = names_of_bits(WordKind::axis_alarm, std::uint32_t{1} << std::countr_zero(alarms));
  }
  const std::uint32_t alarms = reading.gateway[6];
  if (alarm.empty() && alarms != 0)
    alarm = names_of_bits(WordKind::gateway_alarm, std::uint32_t{1} << std::countr_zero(alarms));
  return alarm;
}

}  // namespace

std::uint32_t pair_at(std::span<const std::uint16_t> registers, std::size_t at, WordOrder order) {
  const bool low_first = order == WordOrder::low_first;
  return std::uint32_t{registers[at + (low_first ? 1 : 0)]} << 16 | registers[at + (low_first ? 0 : 1)];
}

WordOrder word_order(std::span<const std::uint16_t, kGatewayRegisters> gateway) {
  if (pair_at(gateway, 10, WordOrder::high_first) == kWordOrderTest) return WordOrder::high_first;
  if (pair_at(gateway, 10, WordOrder::low_first) == kWordOrderTest) return WordOrder::low_first;
  return WordOrder::unknown;
}

void mark_out_of_reach(AxisReading& axis) {
  axis.registers[axis_offset(Source::link_state)] = static_cast<std::uint16_t>(LinkState::offline);
  const std::size_t valid = axis_offset(Source::valid);
  axis.registers[valid] = axis.registers[valid + 1] = 0;
}

std::vector<TopLine> table_lines(const TopReading& reading, std::size_t columns) {
  const WordOrder order = word_order(reading.gateway);
  const std::uint32_t up = pair_at(reading.gateway, 4, order);
  const std::uint16_t alarms = reading.gateway[6];
  const std::string first =
      fmt::format("axisgate {}  {}  axes online {} of {}  up {}:{:02}:{:02}  role {}  {} {}", reading.server,
                  name_of(WordKind::gateway_state, reading.gateway[2]), reading.gateway[3], reading.gateway[1],
                  up / 3600, up / 60 % 60, up % 60, role_text(reading.gateway[7]), kAlarms,
                  alarms_text(WordKind::gateway_alarm, alarms, "none"));
  std::vector<AxisTexts> axes;
  Widths widths;
  for (const AxisReading& axis : reading.axes) {
    axes.push_back(texts_of(axis, order, reading.float_numbers));
    widths.name = std::max(widths.name, axis.name.size());
    widths.turns = widths.turns || (axis.units_per_rev && !reading.float_numbers);
  }
  if (widths.name != 0) widths.name = std::max(widths.name, column_names().name.size());
  std::vector<TopLine> rows = wrapped(first, first.size(), "", "", alarms != 0);
  rows.push_back(wide_row(column_names(), widths));
  for (const AxisTexts& axis : axes) rows.push_back(wide_row(axis, widths));
  const auto fits = [&](const TopLine& row) { return row.text.size() <= columns; };
  if (columns != 0 && !std::ranges::all_of(rows, fits)) {
    rows = wrapped(first, columns, "", "  ", alarms != 0);
    rows.push_back(narrow_row(column_names(), widths.name));
    for (const AxisTexts& axis : axes) {
      rows.push_back(narrow_row(axis, widths.name));
      std::ranges::move(more_of(axis, widths.name, columns), std::back_inserter(rows));
    }
  }
  if (reading.axes.empty()) rows.push_back({"no axes"});
  return rows;
}

std::vector<TopLine> lines_below(const TopReading& reading, std::span<const std::string> notes, std::size_t columns,
                                 bool colours) {
  std::vector<TopLine> lines;
  const auto add = [&](std::string_view text) {
    if (lines.empty()) lines.push_back({});
    std::ranges::move(wrapped(text, columns, "", "  "), std::back_inserter(lines));
  };
  const std::string subject = worth_explaining(reading, word_order(reading.gateway));
  const bool words = std::ranges::count(subject, ' ') != 0;
  if (!subject.empty())
    add(fmt::format("{}axisgate explain {}", colours ? "yellow warns, red has failed; more: " : "what it means: ",
                    words ? "\"" + subject + "\"" : subject));
  for (const std::string& note : notes) add(note);
  return lines;
}

std::string text_of(std::span<const TopLine> lines) {
  std::string out;
  for (const TopLine& line : lines) out += line.text + "\n";
  return out;
}

}  // namespace axisgate::commands
