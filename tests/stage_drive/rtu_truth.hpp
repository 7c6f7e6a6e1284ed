// SPDX-License-Identifier: Apache-2.0
// What the drives of a simulated Modbus RTU line really answered, held against what the gateway stores of one of them.
// Promises to judge by the line's journal alone, with a reader of frames of its own: a stored number is true only if
// the drive sent it for that object in answer to the very request that asked. Never changes anything it looks at.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gateway/compose/gateway.hpp"
#include "tests/stage/rtu_link_sim.hpp"

namespace axisgate::test {

/// A request as it was put on the line, without unit and CRC.
struct RtuRequest {
  std::uint8_t unit = 0;
  bool write = false;
  std::uint16_t start = 0;
  std::uint16_t count = 1;
  std::vector<std::uint16_t> values{};  ///< of a write
  [[nodiscard]] bool covers(std::uint16_t number) const { return number >= start && number < start + count; }
};
[[nodiscard]] RtuRequest request_in(Bytes frame);
/// The registers of the first whole reply to this request among what a drive sent; a write's reply has its values.
[[nodiscard]] std::optional<std::vector<std::uint16_t>> reply_in(Bytes sent, const RtuRequest& request);

class RtuTruth {
 public:
  RtuTruth(const compose::Gateway& gateway, RtuLinkSim& link, AxisNumber axis);

  /// The first number stored since the last look that the drive did not send for it; none: all are true.
  [[nodiscard]] std::optional<std::string> lie();
  /// Numbers looked at so far: a watch that saw none proves nothing.
  [[nodiscard]] std::uint64_t looked_at() const { return looked_at_; }

 private:
  [[nodiscard]] bool true_of(const model::ObjectDef& object, const drive::ObjectState& state) const;
  [[nodiscard]] const simulated::RtuExchange* asked_at(Instant sent) const;

  const drive::Drive& drive_;
  RtuLinkSim& link_;
  AxisNumber axis_;
  std::vector<std::uint64_t> seen_;  ///< exchange of each object when it was last looked at
  std::uint64_t looked_at_ = 0;
};

}  // namespace axisgate::test
