// SPDX-License-Identifier: Apache-2.0
// The real clock and timers, and time that a test may leave out: where nothing can happen in it but what is waited for.
// Promises that timers keep their order. Never skips by itself.
#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <set>
#include <utility>

#include "adapters/asio/asio_runtime.hpp"

namespace axisgate::test {

class SkippingRuntime final : public Runtime {
 public:
  explicit SkippingRuntime(boost::asio::io_context& io) : inner_(io) {}
  [[nodiscard]] Instant now() const override { return inner_.now() + skipped_; }
  [[nodiscard]] std::unique_ptr<Timer> make_timer(std::function<void()> on_expiry) override {
    return std::make_unique<Skipping>(*this, std::move(on_expiry));
  }
  void skip(Duration time) {
    skipped_ += time;
    for (Skipping* timer : timers_) timer->arm();
  }

 private:
  class Skipping final : public Timer {
   public:
    Skipping(SkippingRuntime& runtime, std::function<void()> on_expiry)
        : runtime_(runtime), inner_(runtime.inner_.make_timer([this, on_expiry = std::move(on_expiry)] {
            deadline_ = kNever;
            on_expiry();
          })) {
      runtime_.timers_.insert(this);
    }
    ~Skipping() override { runtime_.timers_.erase(this); }
    void expires_at(Instant deadline) override {
      deadline_ = deadline;
      arm();
    }
    void arm() {
      const bool moves = deadline_ != kNever && deadline_ != kLongAgo;
      inner_->expires_at(moves ? deadline_ - runtime_.skipped_ : deadline_);
    }

   private:
    SkippingRuntime& runtime_;
    std::unique_ptr<Timer> inner_;
    Instant deadline_ = kNever;
  };
  AsioRuntime inner_;
  Duration skipped_{};
  std::set<Skipping*> timers_;
};

}  // namespace axisgate::test
