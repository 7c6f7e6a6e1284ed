// SPDX-License-Identifier: Apache-2.0
// A link over libmodbus whose clock stands still and whose far end is a pty: only what the test does makes time or
// bytes move. Its patience with a frame that has begun is far beyond what any machine needs, so that a slow one breaks
// no test; what ends a half frame is then tested by itself.
#pragma once

#include <fmt/format.h>
#include <sys/ioctl.h>

#include <functional>

#include "adapters/modbus_rtu/link/libmodbus_link.hpp"
#include "tests/unit/modbus_rtu/rtu_frames.hpp"
#include "tests/unit/serial/pty.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

using namespace std::chrono_literals;

class RtuLinkDiary final : public modbus_rtu::RtuLinkEvents {
 public:
  void on_link_up() override {
    told.emplace_back("up");
    if (on_up) on_up();
  }
  void on_link_down(std::string_view why) override {
    told.push_back("down: " + std::string(why));
    if (on_down) on_down();
  }
  void on_frame(modbus_rtu::ExchangeNumber newest, Bytes frame) override {
    frames.push_back(fmt::format("{}: {}", newest, hex_text(frame)));
    if (on_heard) on_heard();
  }
  void on_bad_frame(modbus_rtu::ExchangeNumber newest, std::size_t bytes) override {
    noise_after.push_back(newest);
    noise += bytes;
    if (on_noise) on_noise();
  }
  void on_glitch(std::size_t bytes) override { skipped += bytes; }
  /// Of frames nothing.
  [[nodiscard]] std::size_t dropped() const { return noise + skipped; }
  [[nodiscard]] bool up() const { return !told.empty() && told.back() == "up"; }
  [[nodiscard]] bool down() const { return !told.empty() && told.back() != "up"; }

  std::vector<std::string> told;
  std::vector<std::string> frames;  ///< "number: bytes"
  std::vector<modbus_rtu::ExchangeNumber> noise_after;
  std::size_t noise = 0, skipped = 0;
  std::function<void()> on_up, on_down, on_heard, on_noise;
};

/// The far end speaks bytes, as a slave would.
inline void answer(const Pty& pty, const ByteRow& bytes) {
  EXPECT_EQ(::write(pty.master(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
}
inline void answer(const Pty& pty, std::string_view frame) { answer(pty, with_crc(frame)); }

class LibmodbusLinkStage : public testing::Test {
 protected:
  static constexpr Duration kNoHurry = 20s;

  std::unique_ptr<modbus_rtu::LibmodbusLink> make_link(const std::string& path, Duration latency = kNoHurry) {
    return std::make_unique<modbus_rtu::LibmodbusLink>("lift", serial::SerialSettings{.device = path, .baud = 19200},
                                                       context, runtime, log, latency);
  }
  void start_at(const std::string& path, Duration latency = kNoHurry) {
    link = make_link(path, latency);
    link->start(diary);
  }
  void open_at(const std::string& path, Duration latency = kNoHurry) {
    start_at(path, latency);
    ASSERT_TRUE(await([this] { return diary.up(); }));
  }
  void send(modbus_rtu::ExchangeNumber number, std::string_view frame) { link->transmit(number, from_hex(frame)); }
  /// What has come to the far end, as soon as it is so many bytes.
  std::string request_at(const Pty& pty, std::size_t bytes) {
    std::string got;
    EXPECT_TRUE(await([&] {
      got += pty.read();
      return got.size() >= bytes;
    }));
    return hex_text({reinterpret_cast<const Byte*>(got.data()), got.size()});
  }
  /// A read of one register, sent under that number and heard at the far end.
  void ask(const Pty& pty, modbus_rtu::ExchangeNumber number = 1) {
    send(number, "01 03 32 00 00 01");
    EXPECT_EQ(request_at(pty, 8), "01 03 32 00 00 01 8A B2");
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
  /// Runs the loop until `condition` holds; the guard is for a test that would else hang, and far beyond any real wait.
  template <typename Condition>
  [[nodiscard]] bool await(Condition condition) {
    const auto guard = std::chrono::steady_clock::now() + 60s;
    while (runtime.run_due(), !condition()) {
      if (std::chrono::steady_clock::now() > guard) return false;
      context.restart();
      context.run_one_for(1ms);  // the far end of a pty wakes no loop
    }
    return true;
  }

  Folder folder;
  boost::asio::io_context context;
  ManualRuntime runtime;
  std::vector<std::string> log_lines;
  Log log{[this](LogLevel level, std::string_view, std::string_view message) {
    log_lines.push_back(fmt::format("{}: {}", text(level), message));
  }};
  RtuLinkDiary diary;
  std::unique_ptr<modbus_rtu::LibmodbusLink> link;
};

}  // namespace axisgate::test
