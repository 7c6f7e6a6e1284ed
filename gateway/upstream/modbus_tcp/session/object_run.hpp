// SPDX-License-Identifier: Apache-2.0
// One request of function 43/13 on its way through the command port.
// Promises one result, and that a drive's refusal shows in the client's command_detail also when its connection has
// gone meanwhile. Never repeats anything.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "gateway/image/command_port.hpp"
#include "gateway/upstream/modbus_tcp/client/client_registry.hpp"

namespace axisgate::modbus_tcp {

class ObjectRun : public std::enable_shared_from_this<ObjectRun> {
 public:
  using OnDone = std::function<void(const BatchResult&)>;

  ObjectRun(const std::shared_ptr<Client>& client, AxisNumber axis) : client_(client), axis_(axis) {}

  /// With a value: that is the end, and `on_done` is never called. Without: it is called once, later.
  [[nodiscard]] std::optional<BatchResult> start(CommandPort& commands, const WriteBatch& batch, OnDone on_done);
  /// Nobody waits any longer: what was submitted goes on.
  void abandon() { on_done_ = nullptr; }

 private:
  void record(const BatchResult& result) const;

  std::weak_ptr<Client> client_;
  AxisNumber axis_;
  OnDone on_done_;
};

}  // namespace axisgate::modbus_tcp
