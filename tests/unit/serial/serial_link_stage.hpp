// SPDX-License-Identifier: Apache-2.0
// A serial link whose clock stands still and whose far end is a pty: only what the test does makes time or bytes move.
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <functional>
#include <vector>

#include "adapters/serial/serial_link.hpp"
#include "tests/unit/serial/pty.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

using namespace std::chrono_literals;

class LinkDiary final : public bus::ByteLinkEvents {
 public:
  void on_link_up() override {
    told.emplace_back("up");
    if (on_up) on_up();
  }
  void on_link_down(std::string_view why) override {
    told.push_back("down: " + std::string(why));
    if (on_down) on_down();
  }
  void on_bytes(Bytes bytes) override {
    received.append(bytes.begin(), bytes.end());
    if (on_received) on_received();
  }
  std::vector<std::string> told;
  std::string received;
  std::function<void()> on_up, on_down, on_received;
};

inline Bytes bytes_of(std::string_view text) { return {reinterpret_cast<const Byte*>(text.data()), text.size()}; }

/// Runs the loop until `condition` holds; the guard is for a test that would else hang, and far beyond any real wait.
template <typename Condition>
[[nodiscard]] bool run_until(boost::asio::io_context& context, Condition condition) {
  const auto guard = std::chrono::steady_clock::now() + 60s;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > guard) return false;
    context.restart();
    context.run_one_for(5ms);  // the far end of a pty wakes no loop
  }
  return true;
}

class SerialLinkStage : public testing::Test {
 protected:
  /// A link to `path`, tried once.
  void start_at(const std::string& path) {
    link = make_link(path);
    link->start(diary);
    turn();
  }
  std::unique_ptr<serial::SerialLink> make_link(const std::string& path) {
    return std::make_unique<serial::SerialLink>("lift", serial::SerialSettings{.device = path}, context, runtime, log);
  }
  /// What is due on the clock and ready in the loop, and no more.
  void turn() {
    runtime.run_due();
    context.restart();
    context.poll();
    runtime.run_due();
  }
  void pass(Duration time) {
    runtime.advance_by(time);
    turn();
  }
  template <typename Condition>
  [[nodiscard]] bool await(Condition condition) {
    return run_until(context, [&] {
      runtime.run_due();
      return condition();
    });
  }

  Folder folder;
  boost::asio::io_context context;
  ManualRuntime runtime;
  std::vector<std::string> log_lines;
  Log log{[this](LogLevel level, std::string_view, std::string_view message) {
    log_lines.push_back(fmt::format("{}: {}", text(level), message));
  }};
  LinkDiary diary;
  std::unique_ptr<serial::SerialLink> link;
};

}  // namespace axisgate::test
