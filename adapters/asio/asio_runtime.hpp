// SPDX-License-Identifier: Apache-2.0
// The clock and the timers of the product: a Runtime over one Boost.Asio io_context and the steady clock.
// Promises that a timer fires on the context's thread, never before its deadline, and not at all once it is destroyed.
// Never starts a thread.
#pragma once

#include <boost/asio/io_context.hpp>

#include "gateway/core/clock.hpp"

namespace axisgate {

class AsioRuntime final : public Runtime {
 public:
  /// `context` must outlive the runtime and all its timers, and be run by one thread.
  explicit AsioRuntime(boost::asio::io_context& context) : context_(context) {}

  [[nodiscard]] Instant now() const override;
  [[nodiscard]] std::unique_ptr<Timer> make_timer(std::function<void()> on_expiry) override;

 private:
  boost::asio::io_context& context_;
};

}  // namespace axisgate
