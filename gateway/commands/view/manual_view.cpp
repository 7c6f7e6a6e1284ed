// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/view/manual_view.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "gateway/core/binary32.hpp"
#include "gateway/core/words.hpp"
#include "gateway/image/quantity.hpp"
#include "gateway/image/register_map.hpp"

namespace axisgate::commands {
namespace {

constexpr Byte kReadInputs = 0x02, kReadHolding = 0x03, kWriteCoil = 0x05, kWriteRegister = 0x06,
               kWriteRegisters = 0x10, kException = 0x80;
constexpr std::int64_t kPerRpm = 1000;

std::optional<double> number_at(std::span<const std::uint16_t> registers, std::size_t at,
                                const ManualListener& listener, double unit) {
  const std::uint32_t bits = pair_at(registers, at, listener.order);
  if (listener.float_numbers) {
    if (is_nan_binary32(bits)) return std::nullopt;
    return static_cast<double>(std::bit_cast<float>(bits));
  }
  const auto value = static_cast<std::int32_t>(bits);
  if (value == no_value(RegisterType::i32)) return std::nullopt;
  return static_cast<double>(value) / unit;
}

/// A row in 0.001 rpm, to the unit.
std::optional<Rational> rpm_at(std::span<const std::uint16_t> registers, std::size_t at,
                               const ManualListener& listener) {
  const std::uint32_t bits = pair_at(registers, at, listener.order);
  if (!listener.float_numbers)
    return bits == no_value(RegisterType::u32) ? std::nullopt : std::optional(Rational(bits, kPerRpm));
  const double rpm = static_cast<double>(std::bit_cast<float>(bits));
  constexpr double kMost = 4294967.0;
  if (is_nan_binary32(bits) || rpm < 0 || rpm > kMost) return std::nullopt;
  return Rational(std::llround(rpm * kPerRpm), kPerRpm);
}

/// number * scale, rounded half away from zero. 128 bits hold every product of two halves that came from 64.
std::optional<std::int64_t> whole(const Rational& number, const Rational& scale) {
  const Int128 above = static_cast<Int128>(number.numerator()) * scale.numerator();
  const Int128 below = static_cast<Int128>(number.denominator()) * scale.denominator();
  const Int128 size = above < 0 ? -above : above;
  const Int128 rounded = (2 * size + below) / (2 * below);
  if (rounded > INT64_MAX) return std::nullopt;
  return static_cast<std::int64_t>(above < 0 ? -rounded : rounded);
}

void append_be16(std::vector<Byte>& out, std::uint16_t value) {
  out.push_back(static_cast<Byte>(value >> 8));
  out.push_back(static_cast<Byte>(value & 0xFF));
}

std::vector<Byte> request_of(Byte function, std::uint16_t first, std::uint16_t second) {
  std::vector<Byte> out{function};
  append_be16(out, first);
  append_be16(out, second);
  return out;
}

std::vector<Byte> write_two(std::uint16_t address, std::uint16_t first, std::uint16_t second) {
  std::vector<Byte> out = request_of(kWriteRegisters, address, 2);
  out.push_back(4);
  append_be16(out, first);
  append_be16(out, second);
  return out;
}

/// A row of 32 bits whose number is in turns or rpm.
std::optional<std::vector<Byte>> write_number(std::uint16_t address, const Rational& number, const Rational& scale,
                                              RegisterType type, const ManualListener& listener) {
  const auto value = whole(number, scale);
  if (!value || !range_of(type).holds(*value) || *value == no_value(type)) return std::nullopt;
  const auto bits =
      listener.float_numbers ? to_binary32(1, number) : static_cast<std::uint32_t>(static_cast<std::uint64_t>(*value));
  const auto high = static_cast<std::uint16_t>(bits >> 16), low = static_cast<std::uint16_t>(bits & 0xFFFF);
  return listener.order == WordOrder::low_first ? write_two(address, low, high) : write_two(address, high, low);
}

std::string shown_number(const std::optional<double>& number, bool good, int decimals, std::string_view unit) {
  return number ? fmt::format("{:.{}f} {}{}", *number, decimals, unit, good ? "" : "?") : fmt::format("? {}", unit);
}

}  // namespace

ManualView manual_view(std::span<const std::uint16_t> registers, std::uint16_t inputs, const ManualListener& listener) {
  const auto word = [&](auto what) { return registers[axis_offset(what)]; };
  const auto pair = [&](auto what) { return pair_at(registers, axis_offset(what), listener.order); };
  ManualView view;
  view.link = static_cast<LinkState>(word(Source::link_state));
  view.state = static_cast<AxisState>(word(Source::axis_state));
  view.motion = static_cast<MotionState>(word(Source::motion_state));
  view.motion_id = word(Source::motion_id);
  view.command_id_seen = word(Source::command_id_seen);
  view.result = static_cast<CommandResult>(word(Source::command_result));
  view.detail = pair(Source::command_detail);
  view.owner = word(Source::owner);
  view.owner_address = pair(Source::owner_address);
  view.lease_remaining_ms = word(Source::lease_remaining_ms);
  view.error_code = word(Quantity::error_code);
  view.alarms = pair(Source::axis_alarms);
  view.loss_stop_ms = word(Source::loss_stop_ms);
  view.can.supported = pair(Source::supported);
  view.can.supported_commands = pair(Source::supported_commands);
  view.profile_rpm = rpm_at(registers, axis_offset(Quantity::profile_velocity), listener);
  view.jog_rpm = rpm_at(registers, axis_offset(Source::jog_velocity), listener);
  if (const std::uint32_t rated = pair(Source::rated_speed); rated != no_value(RegisterType::u32))
    view.rated_rpm = Rational(rated, kPerRpm);
  view.inputs = inputs;
  if (pair(Source::units_numerator) != 0 && pair(Source::units_denominator) != 0)
    view.units_per_rev = Rational(pair(Source::units_numerator), pair(Source::units_denominator));
  view.turns = number_at(registers, axis_offset(Quantity::position_actual), listener, view.units_per_rev.to_double());
  view.rpm = number_at(registers, axis_offset(Quantity::velocity_actual), listener, kPerRpm);
  view.turns_good = (pair(Source::valid) & bit(Quantity::position_actual)) != 0;
  view.rpm_good = (pair(Source::valid) & bit(Quantity::velocity_actual)) != 0;
  return view;
}

std::string owner_text(const ManualView& view) {
  const std::uint32_t address = view.owner_address;
  if (address == 0) return "another client";
  return fmt::format("{}.{}.{}.{}", address >> 24, address >> 16 & 0xFF, address >> 8 & 0xFF, address & 0xFF);
}

std::string manual_line(AxisNumber axis, const ManualView& view, std::string_view doing) {
  constexpr int kOfATurn = 4, kOfAnRpm = 1;
  // Its speed is read less often than its state, and may be that of before: what stands shows none.
  constexpr double kTremble = 1;  // rpm
  const bool old_speed =
      view.rpm_good && view.state == AxisState::standstill && std::abs(view.rpm.value_or(0)) > kTremble;
  std::string out =
      fmt::format("axis {}  {}  {}  {}", axis, shown_number(view.turns, view.turns_good, kOfATurn, "turns"),
                  shown_number(old_speed ? 0 : view.rpm, view.rpm_good, kOfAnRpm, "rpm"),
                  axis_state_text(static_cast<std::uint32_t>(view.state),
                                  view.has(AxisInput::stop_latched) && !view.has(AxisInput::moving)));
  if (!view.in_sight())
    out += fmt::format(", link {}", name_of(WordKind::link_state, static_cast<std::uint32_t>(view.link)));
  return doing.empty() ? out : out + "  " + std::string(doing);
}

std::optional<std::vector<Byte>> manual_request(const ManualWrite& write, AxisNumber axis,
                                                const ManualListener& listener, const Rational& units_per_rev) {
  using What = ManualWrite::What;
  const std::uint16_t first = address_of(Block::axis, axis);
  const auto at = [&](auto what) { return static_cast<std::uint16_t>(first + axis_offset(what)); };
  const auto number = static_cast<std::uint16_t>(write.command);
  constexpr std::uint16_t kCoilOn = 0xFF00;
  switch (write.what) {
    case What::target_position:
      return write_number(at(Quantity::target_position), write.number, units_per_rev, RegisterType::i32, listener);
    case What::profile_velocity:
      return write_number(at(Quantity::profile_velocity), write.number, Rational(kPerRpm), RegisterType::u32, listener);
    case What::jog_velocity:
      return write_number(at(Source::jog_velocity), write.number, Rational(kPerRpm), RegisterType::u32, listener);
    case What::command:
      return write_two(at(Source::command), number, write.id);
    case What::stop:
      return request_of(kWriteRegister, at(Source::command), number);
    case What::coil:
      return request_of(kWriteCoil, static_cast<std::uint16_t>(first + write.coil), write.on ? kCoilOn : 0);
    case What::heartbeat:
      break;
  }
  return request_of(kWriteRegister, at(Source::heartbeat), write.id);
}

std::vector<Byte> identification_request(std::uint8_t object) { return {0x2B, 0x0E, 0x04, object}; }

std::string identification_in(Bytes reply) {
  constexpr std::size_t kHead = 9;  // up to the object's length
  if (reply.size() < kHead || reply.size() != kHead + reply[kHead - 1]) return {};
  return {reply.begin() + kHead, reply.end()};
}

std::vector<Byte> read_registers_request(std::uint16_t address, std::uint16_t count) {
  return request_of(kReadHolding, address, count);
}

std::vector<Byte> read_inputs_request(std::uint16_t address, std::uint16_t count) {
  return request_of(kReadInputs, address, count);
}

std::optional<std::vector<std::uint16_t>> registers_in(Bytes reply, std::uint16_t count) {
  const std::size_t bytes = std::size_t{2} * count;
  if (reply.size() != 2 + bytes || reply[0] != kReadHolding || reply[1] != bytes) return std::nullopt;
  std::vector<std::uint16_t> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(load_be16(reply, 2 + 2 * i));
  return out;
}

std::optional<std::uint16_t> inputs_in(Bytes reply, std::uint16_t count) {
  const std::size_t bytes = (std::size_t{count} + 7) / 8;
  if (bytes > 2 || reply.size() != 2 + bytes || reply[0] != kReadInputs || reply[1] != bytes) return std::nullopt;
  return bytes == 2 ? load_le16(reply, 2) : reply[2];
}

ModbusException exception_in(Bytes reply) {
  const bool is_one = reply.size() == 2 && (reply[0] & kException) != 0;
  return is_one ? static_cast<ModbusException>(reply[1]) : ModbusException::none;
}

std::string exception_text(ModbusException exception) {
  const auto number = static_cast<std::uint8_t>(exception);
  return fmt::format("exception 0x{:02X} {}", number, name_of(WordKind::exception, number));
}

}  // namespace axisgate::commands
