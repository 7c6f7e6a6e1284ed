// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/make/form_units.hpp"

#include <algorithm>
#include <array>

#include "gateway/profile/eds/eds_lines.hpp"
#include "gateway/profile/make/form.hpp"

namespace axisgate::profile {
namespace {

struct Word {
  std::string_view word, base;
  Kind kind;
};

constexpr std::array kWords = std::to_array<Word>({
    {"rpm", "rpm", Kind::velocity},
    {"r/min", "rpm", Kind::velocity},
    {"rps", "rps", Kind::velocity},
    {"r/s", "rps", Kind::velocity},
    {"rpm/s", "rpm/s", Kind::acceleration},
    {"rps/s", "rps/s", Kind::acceleration},
    {"r/s2", "rps/s", Kind::acceleration},
    {"r/s^2", "rps/s", Kind::acceleration},
    {"rev", "rev", Kind::position},
    {"turn", "rev", Kind::position},
    {"turns", "rev", Kind::position},
    {"count", "counts", Kind::position},
    {"counts", "counts", Kind::position},
    {"pulse", "counts", Kind::position},
    {"pulses", "counts", Kind::position},
    {"inc", "counts", Kind::position},
    {"increments", "counts", Kind::position},
    {"arms", "Arms", Kind::current},
    {"a", "Arms", Kind::current},
    {"%", "%", Kind::torque},
    {"degc", "degC", Kind::temperature},
    {"\xC2\xB0"
     "c",
     "degC", Kind::temperature},
    {"v", "V", Kind::voltage},
});

}  // namespace

FormUnit form_unit(const std::string& text) {
  FormUnit out;
  const std::string small = eds_lower(text);
  const std::size_t end = std::min(small.find_first_not_of("0123456789."), small.size());
  const std::string number = small.substr(0, end);
  const std::string_view unit = eds_bare(std::string_view(small).substr(end));
  const auto word = std::ranges::find(kWords, unit, &Word::word);
  const auto factor = number.empty() ? std::optional(Rational(1)) : Rational::parse(number);
  if (word == kWords.end() || !factor || factor->numerator() <= 0) return out;
  out.kind = word->kind;
  out.counts = word->base == "counts";
  std::string name(word->base);
  std::ranges::replace(name, '/', '_');
  out.name = name == "%" ? "percent" : eds_lower(name);
  out.base = out.counts ? "rev" : std::string(word->base);
  out.each = *factor;
  if (*factor != Rational(1)) out.name += "_" + object_name("by " + number);
  return out;
}

}  // namespace axisgate::profile
