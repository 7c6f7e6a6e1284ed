// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/keya_parameters.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace axisgate::simulated {
namespace {

constexpr std::array<KeyaParameterRow, 26> parameter_rows{{
    {1, 10, 2, 32},          {2, 1500, 80, 3500}, {3, 150, 10, 500}, {4, 2500, 1000, 50000}, {13, 30, 1, 200},
    {17, 0, 0, 1},           {19, 1, 1, 8},       {20, 1, 1, 4},     {21, 2, 0, 0xFF},       {22, 1, 1, 12},
    {23, 85, 1, 200},        {24, 30, 1, 200},    {25, 120, 1, 200}, {26, 0, 0, 3},          {27, 10, 1, 30},
    {28, 1, 1, 20},          {30, 30, 1, 200},    {31, 10, 2, 32},   {32, 1500, 80, 3500},   {33, 150, 10, 500},
    {34, 2500, 1000, 50000}, {43, 30, 1, 200},    {50, 1, 1, 4},     {52, 1, 1, 12},         {57, 10, 1, 30},
    {60, 30, 1, 200},
}};

}  // namespace

std::span<const KeyaParameterRow> keya_parameter_rows() { return parameter_rows; }

const KeyaParameterRow* find_keya_parameter(int number) {
  const auto found = std::ranges::find(parameter_rows, number, &KeyaParameterRow::number);
  return found == parameter_rows.end() ? nullptr : &*found;
}

KeyaParameters::KeyaParameters(const KeyaOptions& options, KeyaInterface plugged) {
  for (const KeyaParameterRow& row : parameter_rows) values_[row.number] = row.initial;
  values_[19] = static_cast<std::int64_t>(plugged);
  for (const auto& [number, value] : options.parameters) {
    const KeyaParameterRow* row = find_keya_parameter(number);
    if (row == nullptr || value < row->minimum || value > row->maximum) {
      throw std::invalid_argument("parameter " + std::to_string(number) + " = " + std::to_string(value) +
                                  " is none of this drive");
    }
    values_[number] = value;
  }
}

}  // namespace axisgate::simulated
