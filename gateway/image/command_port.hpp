// SPDX-License-Identifier: Apache-2.0
// The command port: the one way in which a server asks anything of an axis.
// Promises each submitted write batch exactly one result: at once, by return value, or later, by the callback, on the
// core thread. Never blocks and never throws.
#pragma once

#include <boost/noncopyable.hpp>
#include <functional>
#include <optional>

#include "gateway/image/command.hpp"

namespace axisgate {

using BatchCallback = std::function<void(const BatchResult&)>;

class CommandPort : boost::noncopyable {
 public:
  virtual ~CommandPort() = default;
  /// With a value: that is the result, and `on_result` is never called. Without: `on_result` is called once, later,
  /// never from inside submit(). An unknown axis number: no_path.
  [[nodiscard]] virtual std::optional<BatchResult> submit(AxisNumber axis, const WriteBatch& batch,
                                                          BatchCallback on_result) = 0;
  /// The client is gone for good: what it has waiting goes on, its callbacks are dropped by their owner.
  virtual void client_gone(ClientId client) = 0;
  /// The drive is known to hold exactly this value (a row that a block write may skip without asking the role).
  [[nodiscard]] virtual bool holds(AxisNumber axis, Quantity quantity, std::int64_t value) const = 0;
  /// The client owns the axis, and the value accepted last for this quantity is another one: a block that repeats its
  /// rows asks for this row all the same. False while leases are off, and while the drive is out of reach.
  [[nodiscard]] virtual bool owner_asks(AxisNumber axis, ClientId client, Quantity quantity,
                                        std::int64_t value) const = 0;
  [[nodiscard]] virtual std::int32_t set_position_value(AxisNumber axis) const = 0;
};

}  // namespace axisgate
