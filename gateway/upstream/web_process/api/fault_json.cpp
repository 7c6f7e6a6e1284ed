// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/fault_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/core/words.hpp"

namespace axisgate::web {
namespace {

constexpr std::string_view kThenReset = "remove the cause, then fault_reset; then enable";
/// What the class of a code has as its remedy is advice for a terminal.
std::string or_reset(std::string_view remedy) { return std::string(remedy.empty() ? kThenReset : remedy); }

bool is_valid(const AxisPicture& axis, Quantity quantity) {
  return (axis.sample.valid & axis.sample.supported & bit(quantity)) != 0 && axis.of(quantity).known;
}

bool is_active(const FaultWordRecord& row, std::uint32_t vendor_error) {
  constexpr unsigned kHalf = 16;
  constexpr std::uint32_t kWord = 0xFFFF;
  const std::uint32_t word = row.word == 0 ? vendor_error & kWord : vendor_error >> kHalf;
  return row.whole ? word == (row.value & kWord) && word != 0 : row.bit < kHalf && (word >> row.bit & 1U) != 0;
}

FaultText of_class(std::uint32_t code) {
  const Word* word = find_error(static_cast<std::uint16_t>(code));
  if (word == nullptr) return {};
  return {std::string(word->meaning), std::string(word->causes), std::string(kThenReset)};
}

FaultText of_row(const FaultWordRecord& row) { return {row.text, of_class(row.error_code).text, or_reset(row.remedy)}; }

}  // namespace

FaultText fault_text(const Picture& picture, const std::string& profile, std::uint32_t code) {
  for (const FaultWordRecord& row : picture.fault_words())
    if (row.error_code == code && (profile.empty() || row.profile == profile)) return of_row(row);
  return of_class(code);
}

FaultText fault_text(const Picture& picture, const AxisPicture& axis) {
  if (is_valid(axis, Quantity::vendor_error))
    for (const FaultWordRecord& row : picture.fault_words())
      if (row.profile == axis.info.profile &&
          is_active(row, static_cast<std::uint32_t>(axis.of(Quantity::vendor_error).value)))
        return of_row(row);
  constexpr std::uint32_t kNotKnownYet = 0xFFFF, kNamedNone = 0x1000;
  const bool known = is_valid(axis, Quantity::error_code);
  const auto code = static_cast<std::uint32_t>(axis.of(Quantity::error_code).value);
  FaultText out = of_class(!known ? kNotKnownYet : code == 0 ? kNamedNone : code);
  if (out.text.empty()) out = of_class(kNamedNone);
  return out;
}

nlohmann::ordered_json fault_json(const Picture& picture, const AxisPicture& axis, const Now& now) {
  if (axis.fault == 0) return nullptr;
  const auto code_of = [&](Quantity quantity) {
    return is_valid(axis, quantity) ? nlohmann::ordered_json(axis.of(quantity).value) : nlohmann::ordered_json();
  };
  const FaultText text = fault_text(picture, axis);
  nlohmann::ordered_json out;
  out["code"] = code_of(Quantity::error_code);
  out["vendor_code"] = code_of(Quantity::vendor_error);
  out["text"] = text.text;
  out["cause"] = text.cause;
  out["remedy"] = text.remedy;
  out["since"] = utc_text(axis.fault, now);
  return out;
}

}  // namespace axisgate::web
