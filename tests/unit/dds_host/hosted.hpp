// SPDX-License-Identifier: Apache-2.0
// A DDS server over a real loop, a real socket pair and the stand-in program, with everything it tells kept.
#pragma once

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <boost/asio/io_context.hpp>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gateway/upstream/dds_host/dds_program.hpp"
#include "gateway/upstream/dds_host/dds_server.hpp"
#include "tests/unit/support/skipping_runtime.hpp"

namespace axisgate::dds {

/// Accepts everything at once.
class Axes final : public CommandPort {
 public:
  std::optional<BatchResult> submit(AxisNumber, const WriteBatch&, BatchCallback) override {
    ++submitted;
    return BatchResult{};
  }
  void client_gone(ClientId) override {}
  [[nodiscard]] bool holds(AxisNumber, Quantity, std::int64_t) const override { return false; }
  [[nodiscard]] bool owner_asks(AxisNumber, ClientId, Quantity, std::int64_t) const override { return false; }
  [[nodiscard]] std::int32_t set_position_value(AxisNumber) const override { return 0; }
  int submitted = 0;
};

class Hosted : public ::testing::Test {
 protected:
  Hosted() { setenv("AXISGATE_DDS_PROGRAM", AXISGATE_FAKE_DDS, 1); }
  ~Hosted() override {
    server.reset();
    unsetenv("AXISGATE_DDS_PROGRAM");
  }

  void start(const std::string& behaviour) {
    behave(behaviour);
    runtime = std::make_unique<test::SkippingRuntime>(io);
    server = std::make_unique<DdsServer>(
        io, *runtime, settings, image, events, axes, log,
        DdsReports{{[this](EventKind kind, std::string text) {
                      told.push_back({kind, std::move(text)});
                    },
                    [this](bool is) { down = is; }, [this](bool is) { address_missing = is; }},
                   {}});
    server->start();
  }
  static void behave(const std::string& behaviour) { setenv("FAKE_DDS", behaviour.c_str(), 1); }

  /// False: it never came true.
  template <typename Condition>
  [[nodiscard]] bool run_until(Condition&& condition) {
    const auto hanging = std::chrono::steady_clock::now() + std::chrono::seconds(100);
    while (!condition()) {
      io.restart();
      if (std::chrono::steady_clock::now() > hanging) return false;
      io.run_one_for(std::chrono::seconds(1));
    }
    return true;
  }
  [[nodiscard]] bool run_until_ready() {
    return run_until([&] { return !down; });
  }
  [[nodiscard]] bool run_until_told(std::size_t events_told) {
    return run_until([&] { return told.size() >= events_told; });
  }
  /// Where a program that hangs is waited for: a second is over at once, as often as it takes.
  [[nodiscard]] bool skip_until_told(std::size_t events_told) {
    return run_until([&] {
      if (told.size() < events_told) runtime->skip(std::chrono::seconds(1));
      return told.size() >= events_told;
    });
  }
  [[nodiscard]] bool run_until_said(const std::string& line) {
    return run_until([&] { return std::find(lines.begin(), lines.end(), line) != lines.end(); });
  }

  static bool no_child_is_left() { return waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD; }
  static std::ptrdiff_t open_descriptors() {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
  }

  struct Told {
    EventKind kind;
    std::string text;
  };
  boost::asio::io_context io{1};
  std::unique_ptr<test::SkippingRuntime> runtime;
  DdsSettings settings;
  ProcessImage image;
  EventRing events;
  Axes axes;
  std::vector<std::string> lines;
  Log log{[this](LogLevel, std::string_view source, std::string_view text) {
            lines.push_back(source == "dds" ? std::string(text) : std::string(source) + "?" + std::string(text));
          },
          LogLevel::debug};
  std::vector<Told> told;
  bool address_missing = false;
  bool down = false;
  std::unique_ptr<DdsServer> server;
};

}  // namespace axisgate::dds
