// SPDX-License-Identifier: Apache-2.0
// A bus with a wire that does as the test says and drives that keep a diary.
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "adapters/bus/bus.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

using namespace std::chrono_literals;
using bus::Access;
using bus::Bus;
using bus::BusJob;
using bus::Exchange;
using bus::ExchangeResult;
using bus::JobId;
using bus::Priority;

using Diary = std::vector<std::string>;

inline ExchangeResult ended_as(Errc code) {
  ExchangeResult result;
  result.code = code;
  return result;
}

/// One or two words for the diary; the texts for people may change.
inline std::string word(Errc code) {
  switch (code) {
    case Errc::ok:
      return "ok";
    case Errc::superseded:
      return "superseded";
    case Errc::offline:
      return "offline";
    case Errc::timed_out:
      return "timed out";
    case Errc::link_lost:
      return "link lost";
    default:
      return std::string(text(code));
  }
}

class FakeWire final : public bus::Wire {
 public:
  void start(bus::WireEvents& to) override { events = &to; }
  void send(const Exchange& exchange) override {
    EXPECT_FALSE(outstanding) << "at most one exchange on the wire";
    outstanding = true;
    sent.push_back(exchange);
    if (on_send) on_send();
  }
  void abandon() override {
    EXPECT_TRUE(outstanding);
    outstanding = false;
    ++abandoned;
  }
  [[nodiscard]] const bus::Statistics& statistics() const override { return counted; }
  void set_decode(bool on) override { decode = on; }

  void up() { events->on_wire_up(); }
  void down(std::string_view why) {
    outstanding = false;
    events->on_wire_down(why);
  }
  void reply(const ExchangeResult& result = {}) {
    EXPECT_TRUE(outstanding);
    outstanding = false;
    events->on_reply(result);
  }

  bus::WireEvents* events = nullptr;
  std::function<void()> on_send;
  std::vector<Exchange> sent;
  bool outstanding = false;
  int abandoned = 0;
  bool decode = false;
  bus::Statistics counted;
};

/// Each bus job takes `exchanges_per_job` exchanges, unless a hook says otherwise.
class DiaryDrive final : public bus::BusDrive {
 public:
  DiaryDrive(std::uint8_t node, Diary& diary) : node_(node), diary_(diary) {}

  std::optional<Exchange> on_grant(const bus::Arbiter::Grant& grant) override {
    const JobId id = grant.id;
    granted = id;
    diary_.push_back(fmt::format("drive {}: grant {}", node_, id == 0 ? "poll" : std::to_string(id)));
    if (grant_hook) return grant_hook(id, grant.priority);
    return exchange();
  }
  void on_result(const Exchange& exchange, const ExchangeResult& result) override {
    EXPECT_EQ(exchange.node, node_) << "a result of another drive";
    diary_.push_back(fmt::format("drive {}: {}", node_, word(result.code)));
    if (result_hook) result_hook(result);
  }
  void on_job_ended(const bus::Arbiter::Ending& ending) override {
    const auto [id, code] = std::pair(ending.id, ending.code);
    diary_.push_back(fmt::format("drive {}: job {} {}", node_, id, word(code)));
    if (ended_hook) ended_hook(id, code);
  }
  void on_link(bool up) override {
    diary_.push_back(fmt::format("drive {}: link {}", node_, up ? "up" : "down"));
    if (link_hook) link_hook(up);
  }

  std::uint8_t node() const override { return node_; }
  void on_unsolicited(const bus::UnsolicitedEvent& unsolicited) override {
    diary_.push_back(fmt::format("drive {}: unsolicited {}", node_, static_cast<int>(unsolicited.kind)));
    if (unsolicited_hook) unsolicited_hook(unsolicited);
  }

  [[nodiscard]] Exchange exchange() const {
    return {.node = node_, .access = Access::read, .object = {0x6041, 0}, .size = 2};
  }

  JobId granted = 0;
  std::function<std::optional<Exchange>(JobId, Priority)> grant_hook;
  std::function<void(const ExchangeResult&)> result_hook;
  std::function<void(JobId, Errc)> ended_hook;
  std::function<void(bool)> link_hook;
  std::function<void(const bus::UnsolicitedEvent&)> unsolicited_hook;

 private:
  std::uint8_t node_;
  Diary& diary_;
};

class BusStage : public testing::Test {
 protected:
  static constexpr std::size_t kDrives = 2;
  static constexpr Duration kTimeout = 100ms;
  static constexpr Duration kGap = 2ms;
  static constexpr Duration kSettle = 10ms;

  BusStage() {
    auto made = std::make_unique<FakeWire>();
    wire = made.get();
    bus = std::make_unique<Bus>(bus::BusSettings{"lift", kTimeout, kGap, kSettle}, kDrives, std::move(made), runtime,
                                log);
    for (std::size_t i = 0; i < kDrives; ++i) bus->attach(static_cast<DriveSlot>(i), drives[i]);
    bus->start();
  }
  void link_up() {
    wire->up();
    diary.clear();
    log_lines.clear();
  }
  JobId submit(DriveSlot drive, Priority priority = Priority::command, AxisSlot axis = 0) {
    BusJob job;
    job.priority = priority;
    job.drive = drive;
    job.axis = axis;
    const auto submission = bus->submit(job);
    EXPECT_EQ(submission.code, Errc::ok);
    return submission.id;
  }
  /// A turn of the loop at the same instant.
  void turn() { runtime.run_due(); }
  /// The silence between two exchanges passes.
  void pass_gap() { runtime.advance_by(kGap); }

  Diary diary;
  std::vector<std::string> log_lines;
  Log log{[this](LogLevel level, std::string_view source, std::string_view message) {
    log_lines.push_back(fmt::format("{} {}: {}", text(level), source, message));
  }};
  ManualRuntime runtime;
  std::array<DiaryDrive, kDrives> drives{DiaryDrive{1, diary}, DiaryDrive{2, diary}};
  FakeWire* wire = nullptr;
  std::unique_ptr<Bus> bus;
};

}  // namespace axisgate::test
