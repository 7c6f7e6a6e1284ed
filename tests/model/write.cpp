// SPDX-License-Identifier: Apache-2.0
#include "tests/model/write.hpp"

#include <algorithm>
#include <array>

namespace axisgate::test::reference {
namespace {

constexpr std::array<std::uint16_t, 16> kWide{42, 44, 48, 50, 52, 58, 62, 64, 66, 68, 70, 72, 74, 76, 78, 84};
constexpr std::array<std::uint16_t, 3> kSigned{row::mode, row::target_torque, row::homing_method};
constexpr std::array<std::uint16_t, 4> kSignedWide{42, 44, 68, 78};
constexpr int kWordBits = 16;

template <class List>
bool in(const List& list, std::uint16_t offset) {
  return std::ranges::find(list, offset) != list.end();
}

}  // namespace

bool is_wide(std::uint16_t offset) { return in(kWide, offset); }

bool is_parameter(std::uint16_t offset) {
  return offset == row::target_torque || offset == row::max_torque ||
         (offset >= row::homing_speed_switch && offset <= row::max_velocity);
}

std::optional<std::uint16_t> half_row(const Write& write) {
  if (write.function != fc::write_register) return {};
  if (is_wide(write.first)) return write.first;
  const auto before = static_cast<std::uint16_t>(write.first - 1);
  if (is_wide(before)) return before;
  return {};
}

Write one(std::uint16_t offset, std::int64_t value, int function) {
  const bool wide = is_wide(offset);
  Write write = block(offset, static_cast<std::uint16_t>(offset + (wide ? 1 : 0)), {{offset, value}});
  write.function = function != 0 ? function : wide ? fc::write_registers : fc::write_register;
  return write;
}

Write block(std::uint16_t first, std::uint16_t last, const Rows& rows, int function) {
  Write write{function, first, std::vector<std::uint16_t>(static_cast<std::size_t>(last - first + 1))};
  for (const auto& [offset, value] : rows) {
    const auto at = static_cast<std::size_t>(offset - first);
    const auto bits = static_cast<std::uint32_t>(value);
    if (is_wide(offset)) write.words.at(at) = static_cast<std::uint16_t>(bits >> kWordBits);
    write.words.at(at + (is_wide(offset) ? 1 : 0)) = static_cast<std::uint16_t>(bits);
  }
  return write;
}

Write one_coil(std::uint16_t number, bool on, int function) {
  return {function, number, {static_cast<std::uint16_t>(on ? 1 : 0)}};
}

Write coil_block(std::uint16_t first, std::vector<std::uint16_t> values) {
  return {fc::write_coils, first, std::move(values)};
}

bool asserts_stop(const Write& write) {
  if (!write.coils()) {
    const Rows rows = rows_of(write);
    return rows.contains(row::command) && is_stop(rows.at(row::command));
  }
  for (std::size_t i = 0; i < write.words.size(); ++i) {
    const std::size_t number = write.first + i;
    if (write.words[i] != 0 && (number == coil::quick_stop || number == coil::halt)) return true;
  }
  return false;
}

Rows rows_of(const Write& write) {
  if (write.function == fc::sample) return write.sample;
  if (half_row(write)) return {};
  Rows rows;
  for (std::size_t i = 0; i < write.words.size(); ++i) {
    const auto offset = static_cast<std::uint16_t>(write.first + i);
    const std::uint16_t word = write.words[i];
    if (!is_wide(offset)) {
      rows[offset] = in(kSigned, offset) ? static_cast<std::int16_t>(word) : std::int64_t{word};
      continue;
    }
    if (i + 1 == write.words.size()) break;
    const std::uint32_t whole = static_cast<std::uint32_t>(word) << kWordBits | write.words[i + 1];
    rows[offset] = in(kSignedWide, offset) ? static_cast<std::int32_t>(whole) : std::int64_t{whole};
    ++i;
  }
  return rows;
}

std::string text(const Write& write) {
  std::string out = write.function == fc::sample ? "sample" : "FC" + std::to_string(write.function);
  for (const auto& [offset, value] : write.sample) out += " " + std::to_string(offset) + "=" + std::to_string(value);
  constexpr std::array kFlaws{"", " too old", " too far ahead", " for half of us"};
  if (write.function == fc::sample)
    return out + kFlaws.at(static_cast<std::size_t>(write.flaw)) + (write.repeats == 0 ? "" : " once more");
  if (write.coils()) {
    for (std::size_t i = 0; i < write.words.size(); ++i)
      out += " coil" + std::to_string(write.first + i) + "=" + std::to_string(write.words[i]);
    return out;
  }
  if (half_row(write)) return out + " half " + std::to_string(write.first) + "=" + std::to_string(write.words[0]);
  out += " " + std::to_string(write.first) + ".." + std::to_string(write.first + write.words.size() - 1);
  for (const auto& [offset, value] : rows_of(write))
    if (value != 0 || write.words.size() <= 2) out += " " + std::to_string(offset) + "=" + std::to_string(value);
  return out;
}

}  // namespace axisgate::test::reference
