// SPDX-License-Identifier: Apache-2.0
// What a drive itself can add to its EDS: who it is, how it counts, which modes it has.
// Promises to ask for nothing but what the EDS says can be read, and a line for each answer. Never takes silence for an
// answer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gateway/profile/eds/eds.hpp"

namespace axisgate::profile {

[[nodiscard]] std::vector<ObjectAddress> asked_of_node(const Eds& eds);

struct NodeAnswer {
  ObjectAddress address;
  std::optional<std::uint32_t> raw;  ///< none: refused
};
/// Puts the answer in the EDS's place; what is refused goes. `node`: who answered, for the line.
[[nodiscard]] std::string take_answer(Eds& eds, const NodeAnswer& answer, std::uint8_t node);

}  // namespace axisgate::profile
