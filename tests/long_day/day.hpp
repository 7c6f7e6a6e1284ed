// SPDX-License-Identifier: Apache-2.0
// A day of that plant in virtual time: clients that move its axes, one fault each minute, and a quiet end. Promises to
// tell what is left over and what has grown. Never judges it: the test does.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"
#include "tests/long_day/day_client.hpp"
#include "tests/long_day/day_faults.hpp"

namespace axisgate::test::long_day {

/// Of one line, at the end.
struct LineLeft {
  std::uint32_t exchanges = 0, replies = 0;
  std::uint32_t unaccounted = 0;   ///< neither answered nor timed out
  std::uint64_t may_be_ended = 0;  ///< so many a lost link, or a drive that has started anew, may have ended
  std::size_t queued = 0;
};

struct DayLeft {
  std::vector<AxisNumber> not_online{}, never_moved{};
  std::vector<LineLeft> lines{};
  Asked asked{};
  std::size_t waiting = 0;  ///< clients without an answer
  std::string wrong{};      ///< what one of them was told; empty: nothing
  std::size_t events = 0, log_lines = 0;
  std::size_t allocated_at_first = 0, allocated = 0;  ///< bytes, after a third of the time and at the end
  std::string faults{};
};

class Day {
 public:
  explicit Day(std::uint64_t seed);
  /// So many faults, one in each `each`; with what was counted and left when it was quiet again.
  /// @param tell how far it is, after each virtual hour: a day takes more than one real hour
  [[nodiscard]] DayLeft pass(std::uint64_t faults, std::chrono::milliseconds each,
                             const std::function<void(const std::string&)>& tell);

 private:
  void live(Duration time, bool ask = true);
  void look_at_motors();
  void forget_what_tests_keep();
  void tell_lines();

  GatewayStage stage_;
  modbus_tcp::ListenerSettings settings_;
  modbus_tcp::ClientRegistry registry_;
  Log log_;
  const modbus_tcp::SessionContext context_{settings_, stage_.gateway().image(), stage_.gateway(), registry_,
                                            log_,      &stage_.runtime()};
  std::vector<std::unique_ptr<DayClient>> clients_;
  DayFaults faults_;
  simulated::Random random_;
  std::vector<std::int64_t> seen_at_ = std::vector<std::int64_t>(kAxes + 1);
  std::vector<int> moves_ = std::vector<int>(kAxes + 1);
  DayLeft left_;
};

}  // namespace axisgate::test::long_day
