// SPDX-License-Identifier: Apache-2.0
#include "adapters/asio/asio_runtime.hpp"

#include <gtest/gtest.h>

#include <boost/asio/post.hpp>
#include <optional>

namespace axisgate {
namespace {

using namespace std::chrono_literals;

class AsioRuntimeTest : public testing::Test {
 protected:
  void make(std::function<void()> on_expiry) { timer = runtime.make_timer(std::move(on_expiry)); }
  /// Runs until nothing is left to wait for.
  void run() {
    context.restart();
    context.run();
  }
  boost::asio::io_context context;
  AsioRuntime runtime{context};
  int fired = 0;
  std::unique_ptr<Timer> timer;
};

TEST_F(AsioRuntimeTest, the_clock_never_goes_back) {
  Instant before = runtime.now();
  for (int i = 0; i < 1000; ++i) {
    const Instant now = runtime.now();
    ASSERT_GE(now, before);
    before = now;
  }
}

TEST_F(AsioRuntimeTest, a_timer_fires_once_and_not_before_the_deadline_that_it_was_given_last) {
  // Each from now on; a timer armed for good would keep the context from ever coming to rest.
  const std::vector<std::vector<Duration>> armings{{5ms}, {1ms, 20ms}, {1h, 1ms}, {0ms, 5ms}, {0ms, 0ms}};
  for (const std::vector<Duration>& deadlines : armings) {
    fired = 0;
    Instant last{};
    make([&] {
      ++fired;
      EXPECT_GE(runtime.now(), last);
    });
    for (const Duration wait : deadlines) timer->expires_at(last = runtime.now() + wait);
    EXPECT_EQ(fired, 0) << "not inside the call";
    run();
    EXPECT_EQ(fired, 1);
  }
}

TEST_F(AsioRuntimeTest, neither_a_disarmed_timer_nor_a_destroyed_one_fires) {
  for (const Duration wait : {Duration(0), Duration(1ms)}) {
    make([this] { ++fired; });
    timer->expires_at(runtime.now() + wait);
    timer->expires_at(kNever);
    run();
    timer->expires_at(runtime.now() + wait);
    timer.reset();
    run();
  }
  EXPECT_EQ(fired, 0);
}

TEST_F(AsioRuntimeTest, a_timer_may_be_armed_anew_by_its_own_callback) {
  make([this] {
    if (++fired < 5) timer->expires_at(fired % 2 == 0 ? runtime.now() : runtime.now() + 1ms);
  });
  timer->expires_at(runtime.now());
  run();
  EXPECT_EQ(fired, 5);
}

TEST_F(AsioRuntimeTest, a_timer_may_be_destroyed_by_its_own_callback) {
  make([this, keeps_its_captures = std::string(100, 'x')] {
    timer.reset();
    fired += static_cast<int>(keeps_its_captures.size());
  });
  timer->expires_at(runtime.now());
  run();
  EXPECT_EQ(fired, 100);
}

TEST(AsioRuntimeEnd, the_context_may_go_with_timers_still_armed) {
  auto context = std::make_unique<boost::asio::io_context>();
  auto runtime = std::make_unique<AsioRuntime>(*context);
  auto waiting = runtime->make_timer([] { FAIL(); });
  auto due = runtime->make_timer([] { FAIL(); });
  waiting->expires_at(runtime->now() + 1h);
  due->expires_at(runtime->now());
  waiting.reset();
  due.reset();
  context.reset();
}

}  // namespace
}  // namespace axisgate
