#include "gateway/app/top_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string_view>

#include "gateway/core/binary32.hpp"
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
  std::string name = mode < 0 ? fmt::format("own {}", mode) : fmt::format("mode {}", mode);
  switch (mode) {
    case 0:
      name = "none";
      break;
    case 1:
      name = "profile position";
      break;
    case 3:
      name = "profile velocity";
      break;
    case 4:
      name = "torque";
      break;
    case 6:
      name = "homing";
      break;
    case 7:
      name = "interpolated";
      break;
    case 8:
      name = "csp";
      break;
    case 9:
      name = "csv";
      break;
    case 10:
      name = "cst";
      break;
    default:
      break;
  }
  return name + (cells.good(Quantity::mode_display) ? "" : "?");
}

/// error_code is shown as the gateway gives it: for an axis out of reach it is the reason itself (0x8130), not an old
/// value.
std::string error_text(const AxisCells& cells) {
  const std::uint16_t code = cells.word(kErrorCode);
  if (code == no_value(RegisterType::u16)) return "?";
  const std::uint32_t vendor = cells.pair(kVendorError);
  const bool has_vendor = cells.good(Quantity::vendor_error) && vendor != 0 && vendor != no_value(RegisterType::u32);
  const std::string shown = code == 0 ? "none" : fmt::format("0x{:04X}", code);
  return has_vendor ? fmt::format("{} (0x{:X})", shown, vendor) : shown;
}

std::string age_text(std::uint16_t age) { return age == 0xFFFF ? ">65 s" : fmt::format("{}", age); }

template <typename Word>
void add_word(std::string& list, const Word& word) {
  if (!list.empty()) list += ", ";
  list += word;
}

std::string alarms_text(std::uint32_t bits) {
  std::string list;
  for (unsigned i = 0; i < 32; ++i) {
    if ((static_cast<unsigned>(bits) >> i & 1U) == 0) continue;
    add_word(list, i < kAxisAlarmCount ? std::string(text(static_cast<AxisAlarm>(i))) : fmt::format("bit {}", i));
  }
  return list.empty() ? "-" : list;
}

std::string gateway_alarms_text(std::uint16_t bits) {
  // In the order of GatewayAlarm.
  static constexpr std::array<std::string_view, 13> kNames{
      "axis offline",        "bus down",         "drive fault",
      "identity mismatch",   "no comm watchdog", "check failed",
      "adopted running",     "DDS process down", "configuration changed",
      "certificate expires", "event loop slow",  "EEPROM write budget",
      "bus overloaded"};
  std::string list;
  for (unsigned i = 0; i < 16; ++i) {
    if ((static_cast<unsigned>(bits) >> i & 1U) == 0) continue;
    add_word(list, i < kNames.size() ? std::string(kNames[i]) : fmt::format("bit {}", i));
  }
  return list.empty() ? "none" : list;
}

std::string_view gateway_state_text(std::uint16_t state) {
  static constexpr std::array<std::string_view, 4> kNames{"starting", "running", "degraded", "stopping"};
  return state < kNames.size() ? kNames[state] : "?";
}

std::string_view role_text(std::uint16_t role) {
  return role <= static_cast<std::uint16_t>(Role::engineer) ? text(static_cast<Role>(role)) : "?";
}

constexpr std::string_view kRow = "{:>4}  {:<9}  {:<17}  {:<17}  {:>12}  {:>12}  {:>8}  {:>9}  {:>6}  {:<18}  {}\n";

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

std::string render_table(const TopReading& reading) {
  const WordOrder order = word_order(reading.gateway);
  const std::uint32_t up = word32(reading.gateway[4], reading.gateway[5], order);
  std::string out =
      fmt::format("axisgate {}  {}  axes online {} of {}  up {}:{:02}:{:02}  role {}  alarms: {}\n", reading.server,
                  gateway_state_text(reading.gateway[2]), reading.gateway[3], reading.gateway[1], up / 3600,
                  up / 60 % 60, up % 60, role_text(reading.gateway[7]), gateway_alarms_text(reading.gateway[6]));
  out += fmt::format(fmt::runtime(kRow), "axis", "link", "state", "mode", "position", "velocity rpm", "torque %",
                     "current A", "age ms", "error", "alarms");
  for (const AxisReading& axis : reading.axes) {
    const AxisCells cells(axis, order, reading.float_numbers);
    const auto link = std::min<std::uint16_t>(cells.word(kLinkState), 0xFF);
    const auto state = std::min<std::uint16_t>(cells.word(kAxisState), 0xFF);
    out += fmt::format(
        fmt::runtime(kRow), axis.axis, text(static_cast<LinkState>(link)), text(static_cast<AxisState>(state)),
        mode_text(cells), cells.number(Quantity::position_actual, kPosition, 0),
        cells.number(Quantity::velocity_actual, kVelocity, 3), cells.number(Quantity::torque_actual, kTorque, 1),
        cells.number(Quantity::current_actual, kCurrent, 2), age_text(cells.word(kAge)), error_text(cells),
        alarms_text(cells.pair(kAlarms)));
  }
  if (reading.axes.empty()) out += "no axes\n";
  return out;
}

}  // namespace axisgate::app
