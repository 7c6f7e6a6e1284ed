// SPDX-License-Identifier: Apache-2.0
// A CommandPort that a test plays: it keeps what is submitted and answers at once or when told.
// Promises the port's own contract: one result each, callbacks never from inside submit(), and for a write batch that
// asks for nothing at once. Never decides anything by itself.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "gateway/image/command_port.hpp"

namespace axisgate::modbus_tcp::test {

class FakeCommandPort : public CommandPort {
 public:
  struct Submitted {
    AxisNumber axis;
    WriteBatch batch;
  };

  std::optional<BatchResult> submit(AxisNumber axis, const WriteBatch& batch, BatchCallback on_result) override {
    submitted.push_back({axis, batch});
    if (!at_once.empty()) {
      const BatchResult result = at_once.front();
      at_once.pop_front();
      return result;
    }
    if (!slow || asks_nothing(batch)) return BatchResult{};
    waiting.push_back(std::move(on_result));
    return std::nullopt;
  }
  void client_gone(ClientId client) override { gone.push_back(client); }
  bool holds(AxisNumber axis, Quantity quantity, std::int64_t value) const override {
    return cached.contains({axis, quantity, value});
  }
  bool owner_asks(AxisNumber axis, ClientId client, Quantity quantity, std::int64_t value) const override {
    const auto found = accepted.find({axis, quantity});
    return owner == client && found != accepted.end() && found->second != value;
  }
  std::int32_t set_position_value(AxisNumber axis) const override {
    const auto found = set_positions.find(axis);
    return found == set_positions.end() ? 0 : found->second;
  }

  /// The oldest waiting write batch ends.
  void finish(const Outcome& outcome = {}, std::uint32_t data = 0, std::uint8_t size = 0) {
    finish_with({outcome, data, size});
  }
  void finish_with(const BatchResult& result, std::size_t place = 0) {
    const BatchCallback callback = std::move(waiting.at(place));
    waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(place));
    callback(result);
  }
  /// Takes the record of what was submitted.
  [[nodiscard]] std::vector<Submitted> taken() { return std::exchange(submitted, {}); }

  bool slow = false;                ///< true: results come by finish()
  std::deque<BatchResult> at_once;  ///< used up first, whatever `slow` says
  std::vector<Submitted> submitted;
  std::deque<BatchCallback> waiting;
  std::vector<ClientId> gone;
  std::set<std::tuple<AxisNumber, Quantity, std::int64_t>> cached;
  std::map<AxisNumber, std::int32_t> set_positions;
  std::optional<ClientId> owner;                                     ///< for owner_asks(): who owns every axis
  std::map<std::pair<AxisNumber, Quantity>, std::int64_t> accepted;  ///< the value accepted last; none: as asked
};

}  // namespace axisgate::modbus_tcp::test
