// SPDX-License-Identifier: Apache-2.0
// Simulated drives on one CAN bus behind the shipped core, with the words in which these tests speak.
// Promises a fresh world per rig. Never decides what is right: the tests do.
#pragma once

#include <string>
#include <vector>

#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test {

/// An SDO request as it left the gateway (CiA 301 7.2.4.3), expedited.
struct SdoRequest {
  Instant at;
  std::uint8_t node = 0;
  bool write = false;
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::uint32_t data = 0;
};

enum class CanType : std::uint8_t { leadshine, jd, md };
inline constexpr std::array kCanTypes{CanType::leadshine, CanType::jd, CanType::md};
[[nodiscard]] std::string name(CanType type);
[[nodiscard]] simulated::CanDriveOptions options_of(CanType type, std::uint8_t node);

class CanRig {
 public:
  /// One drive of each, nodes and axes from 1 on.
  explicit CanRig(const std::vector<CanType>& types);
  explicit CanRig(GatewayStage::Line line);

  GatewayStage stage;

  [[nodiscard]] const AxisImage& axis(AxisNumber number = 1) { return stage.axis(number); }
  [[nodiscard]] simulated::CanLine& line() { return stage.can_link(0).line(); }
  [[nodiscard]] simulated::CanopenNode& node(std::size_t position = 0) { return stage.can_node(0, position); }
  void online();
  /// The drive at this position has become operational, which it does by itself after it was told to.
  [[nodiscard]] bool becomes_operational(std::size_t position = 0);
  void enable(AxisNumber axis = 1);
  [[nodiscard]] bool settles(const std::function<bool()>& done) { return stage.run_until(done); }

  /// Since the last mark().
  void mark() { marked_ = stage.can_link(0).sent.size(); }
  [[nodiscard]] std::vector<SdoRequest> requests();
  [[nodiscard]] std::vector<SdoRequest> writes();
  [[nodiscard]] std::vector<std::string> nmt();  ///< "80 01"
  [[nodiscard]] bool told(const std::string& words);

 private:
  std::size_t marked_ = 0;
};

}  // namespace axisgate::test
