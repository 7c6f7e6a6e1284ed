// SPDX-License-Identifier: Apache-2.0
// The unit of a table's column as a unit of a profile: "rpm", "0.1 A", "counts".
// Promises exactly what was written, or nothing. Never takes a word for another one that is only near it.
#pragma once

#include <string>

#include "gateway/core/rational.hpp"
#include "gateway/model/model.hpp"

namespace axisgate::profile {

struct FormUnit {
  std::string name;     ///< under "units"
  std::string base;     ///< "rpm"
  Kind kind{};          ///< code: it is none that a profile counts in
  bool counts = false;  ///< of the position: position_units_per_rev of them are a turn
  Rational each{1};     ///< what one count of the drive is, in `base`
};

[[nodiscard]] FormUnit form_unit(const std::string& text);

}  // namespace axisgate::profile
