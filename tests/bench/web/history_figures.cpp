// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/web/history_figures.hpp"

#include <fmt/format.h>

#include <chrono>
#include <ctime>

#include "gateway/upstream/web_process/history/history.hpp"

namespace axisgate::bench {
namespace {

using web::History;
using web::kMillisecond;
using web::kSecond;
using web::SteadyNs;

constexpr int kValues = 8;
constexpr SteadyNs kEach = 10 * kMillisecond;
constexpr std::size_t kMib = 1024 * 1024;
constexpr std::size_t kBytes = 48 * kMib;

double processor_s() {
  timespec at{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &at);
  return std::chrono::duration<double>(std::chrono::seconds(at.tv_sec) + std::chrono::nanoseconds(at.tv_nsec)).count();
}

/// Axes that all move, and a history that is told of them.
class Told {
 public:
  Told(std::size_t bytes, int axes) : history(bytes) {
    record_.at = kSecond;
    for (int number = 1; number <= axes; ++number) {
      web::AxisInfoRecord info;
      info.axis = static_cast<std::uint16_t>(number);
      history.take(info);
      web::AxisSample& sample = record_.axes.emplace_back();
      sample.axis = info.axis;
      sample.supported = sample.valid = UINT32_MAX;
      for (int i = 0; i < kValues; ++i) sample.values.push_back({static_cast<std::uint8_t>(i), 0, 1000});
    }
  }
  void turn() {
    record_.at += kEach;
    for (web::AxisSample& sample : record_.axes)
      for (web::Value& value : sample.values) ++value.value;
    history.take(record_);
  }
  /// Until it has thrown away as much as it holds.
  void fill() {
    turn();
    const SteadyNs began = history.oldest();
    do {
      turn();
    } while (history.oldest() - began < history.newest() - history.oldest());
  }
  History history;

 private:
  web::SamplesRecord record_;
};

}  // namespace

void history_figures(Report& report, bool quick) {
  const std::size_t bytes = quick ? kBytes / 16 : kBytes;
  for (const int axes : {5, 64, 499}) {
    Told told(bytes, axes);
    told.fill();
    const double seconds = static_cast<double>(told.history.newest() - told.history.oldest()) / kSecond;
    const double samples = seconds * axes * kValues * static_cast<double>(kSecond / kEach);
    if (axes == 64)
      report.row("64 axes, 8 values: history, s", seconds, goal(60));
    else
      report.row(fmt::format("{} axes, 8 values: history, s", axes), seconds);
    report.row(fmt::format("{} axes, 8 values: a sample, bytes", axes),
               static_cast<double>(told.history.bytes()) / samples);
  }
  Told told(bytes, 64);
  told.fill();
  const int turns = quick ? 200 : 10'000;
  const double began = processor_s();
  for (int i = 0; i < turns; ++i) told.turn();
  report.row("64 axes, 8 values at 100 Hz: to take them, % of a core",
             100 * (processor_s() - began) / (turns * static_cast<double>(kEach) / kSecond));
}

}  // namespace axisgate::bench
