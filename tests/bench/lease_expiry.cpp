// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <exception>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/bench/benches.hpp"
#include "tests/bench/motor_stage.hpp"

namespace axisgate::bench {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kLease{1000};

enum class Death : std::uint8_t { closes, resets, falls_silent };
constexpr std::array<std::string_view, 3> kDeaths{"closes", "resets", "falls silent"};
using Waits = std::array<std::vector<double>, kDeaths.size()>;  // ms, by death

/// Reads for a while, and dies right after a reply. Returns when its last request was sent.
std::chrono::nanoseconds live_and_die(ModbusClient& client, int axis, Death death, milliseconds lasting) {
  constexpr milliseconds kBetweenReads{20};
  const auto end = steady_now() + lasting;
  for (;;) {
    const auto asked_at = steady_now();
    static_cast<void>(client.read(static_cast<std::uint16_t>(100 * axis), kRegisters));
    if (asked_at < end) {
      std::this_thread::sleep_for(kBetweenReads);
      continue;
    }
    if (death == Death::closes) client.close();
    if (death == Death::resets) client.reset();
    return asked_at;
  }
}

Waits waits_of(MotorStage& stage, std::size_t line, int runs) {
  constexpr milliseconds kPatience = 5 * kLease;
  constexpr milliseconds kStopIsOver{500};                  // the ramp, and the torque off after it
  constexpr unsigned kShortestLife = 300, kMoreLife = 100;  // ms: the deaths meet the bus at any point of its cycle
  std::minstd_rand random(static_cast<unsigned>(line + 1));
  const int axis = stage.first_axis(line);
  Waits waits;
  for (int run = 0; run < runs; ++run) {
    for (const Death death : {Death::closes, Death::resets, Death::falls_silent}) {
      ModbusClient client = running_axis(stage.port(), axis);
      const auto died_at = live_and_die(client, axis, death, milliseconds(kShortestLife + random() % kMoreLife));
      const auto stopped_at = stage.tap(line).await_stop(died_at, kPatience);
      waits[static_cast<std::size_t>(death)].push_back(
          std::chrono::duration<double, std::milli>(stopped_at - died_at).count());
      std::this_thread::sleep_for(kStopIsOver);
    }
  }
  return waits;
}

void print(Report& report, std::string_view name, const Waits& waits) {
  for (std::size_t death = 0; death < waits.size(); ++death) {
    const std::string what = fmt::format("{}, the client {}", name, kDeaths[death]);
    const Beside lease{"lease", static_cast<double>(kLease.count())};
    report.row(what + ": median ms", median(waits[death]), lease);
    report.row(what + ": worst ms", worst(waits[death]), lease);
  }
}

}  // namespace

void lease_expiry(const BenchOptions& options) {
  stay_on_processor(1);
  const int runs = options.times(10);
  // All lines hang on one gateway, and their clients die at times of their own.
  const std::span<const MotorDrive> drives = motor_drives();
  MotorStage stage(options, {drives.begin(), drives.end()}, {static_cast<int>(kLease.count()), {}});
  std::vector<Waits> waits(stage.lines());
  std::vector<std::exception_ptr> failures(stage.lines());
  std::vector<std::jthread> clients;
  for (std::size_t line = 0; line < stage.lines(); ++line)
    clients.emplace_back([&, line] {
      try {
        waits[line] = waits_of(stage, line, runs);
      } catch (...) {
        failures[line] = std::current_exception();
      }
    });
  clients.clear();
  for (std::size_t line = 0; line < stage.lines(); ++line) {
    try {
      if (failures[line]) std::rethrow_exception(failures[line]);
    } catch (const std::exception& error) {
      throw std::runtime_error(fmt::format("{}: {}", stage.drive(line).name, error.what()));
    }
    print(options.report, stage.drive(line).name, waits[line]);
  }
}

}  // namespace axisgate::bench
