// SPDX-License-Identifier: Apache-2.0
// What pages show of the configuration, and the image does not say.
// Promises what `axisgate check` says of the same configuration.
// Never changes but by a reload.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/upstream/web_link/records.hpp"

namespace axisgate::web {

/// Of an axis, what the image does not say.
struct AxisFacts {
  std::uint16_t axis = 0;
  std::string drive{};    ///< "Kinco JD"
  std::string profile{};  ///< "kinco-jd"
  std::uint16_t node = 0;
};

/// The configuration, as far as a page shows it.
struct WebFacts {
  bool low_word_first = false;
  bool float_numbers = false;
  std::vector<AxisFacts> axes{};
  std::vector<BusInfoRecord> buses{};
  std::vector<FaultWordRecord> fault_words{};
};

}  // namespace axisgate::web
