// SPDX-License-Identifier: Apache-2.0
// A process image filled by hand and a command port that remembers: what the server is tested, measured and shown with.
// Promises the same numbers in every run, each register different from its neighbours. Never reaches a drive.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "gateway/image/command_port.hpp"
#include "gateway/image/process_image.hpp"

namespace axisgate::test {

/// Axes 1..`axes`, online and all quantities valid; axis n at position 100000 * n and turning at n rpm.
void fill_image(ProcessImage& image, AxisNumber axes, Instant now);

class RememberingPort final : public CommandPort {
 public:
  struct Submission {
    AxisNumber axis;
    WriteBatch batch;
    BatchCallback on_result;
  };

  [[nodiscard]] std::optional<BatchResult> submit(AxisNumber axis, const WriteBatch& batch,
                                                  BatchCallback on_result) override {
    submitted.push_back({axis, batch, std::move(on_result)});
    if (answers_at_once) return BatchResult{};
    return std::nullopt;
  }
  void client_gone(ClientId client) override { gone.push_back(client); }
  [[nodiscard]] bool holds(AxisNumber, Quantity, std::int64_t) const override { return false; }
  [[nodiscard]] bool owner_asks(AxisNumber, ClientId, Quantity, std::int64_t) const override { return false; }
  [[nodiscard]] std::int32_t set_position_value(AxisNumber) const override { return 0; }

  bool answers_at_once = true;
  std::vector<Submission> submitted;
  std::vector<ClientId> gone;
};

}  // namespace axisgate::test
