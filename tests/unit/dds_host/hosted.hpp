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

#include "adapters/asio/asio_runtime.hpp"
#include "gateway/upstream/dds_host/dds_server.hpp"

namespace axisgate::dds {

/// The same clock and timers with time that runs faster, for what takes seconds.
class FasterRuntime final : public Runtime {
 public:
  FasterRuntime(boost::asio::io_context& io, int factor) : inner_(io), factor_(factor) {}
  [[nodiscard]] Instant now() const override { return Instant(inner_.now().time_since_epoch() * factor_); }
  [[nodiscard]] std::unique_ptr<Timer> make_timer(std::function<void()> on_expiry) override {
    return std::make_unique<Faster>(inner_.make_timer(std::move(on_expiry)), factor_);
  }

 private:
  class Faster final : public Timer {
   public:
    Faster(std::unique_ptr<Timer> inner, int factor) : inner_(std::move(inner)), factor_(factor) {}
    void expires_at(Instant deadline) override {
      if (deadline == kNever || deadline == kLongAgo) return inner_->expires_at(deadline);
      inner_->expires_at(Instant(deadline.time_since_epoch() / factor_ + Duration(1)));
    }

   private:
    std::unique_ptr<Timer> inner_;
    int factor_;
  };
  AsioRuntime inner_;
  int factor_;
};

/// Accepts everything at once.
class Axes final : public CommandPort {
 public:
  std::optional<GroupResult> submit(AxisNumber, const Group&, GroupCallback) override {
    ++submitted;
    return GroupResult{};
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

  /// `speed`: how many seconds of the server pass in one.
  void start(const std::string& behaviour, int speed = 1) {
    behave(behaviour);
    runtime = std::make_unique<FasterRuntime>(io, speed);
    server = std::make_unique<DdsServer>(io, *runtime, settings, image, events, axes, log,
                                         DdsReports{[this](EventKind kind, std::string text) {
                                                      told.push_back({kind, std::move(text)});
                                                    },
                                                    [this](bool is) { down = is; }});
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
  std::unique_ptr<Runtime> runtime;
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
  bool down = false;
  std::unique_ptr<DdsServer> server;
};

}  // namespace axisgate::dds
