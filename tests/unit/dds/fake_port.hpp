// SPDX-License-Identifier: Apache-2.0
// A command port that tests play themselves: what was submitted lies here until it is answered.
// Promises to answer nothing by itself, unless told how all are answered at once. Never decides what is right.
#pragma once

#include <utility>
#include <vector>

#include "gateway/image/command_port.hpp"

namespace axisgate::test {

class FakePort final : public CommandPort {
 public:
  struct Submitted {
    AxisNumber axis = 0;
    WriteBatch batch;
    BatchCallback on_result;
  };
  std::vector<Submitted> submitted;
  std::optional<BatchResult> at_once{};
  std::vector<ClientId> gone;

  std::optional<BatchResult> submit(AxisNumber axis, const WriteBatch& batch, BatchCallback on_result) override {
    submitted.push_back({axis, batch, std::move(on_result)});
    return at_once;
  }
  void client_gone(ClientId client) override { gone.push_back(client); }
  [[nodiscard]] bool holds(AxisNumber, Quantity, std::int64_t) const override { return false; }
  [[nodiscard]] bool owner_asks(AxisNumber, ClientId, Quantity, std::int64_t) const override { return false; }
  [[nodiscard]] std::int32_t set_position_value(AxisNumber) const override { return 0; }
};

}  // namespace axisgate::test
