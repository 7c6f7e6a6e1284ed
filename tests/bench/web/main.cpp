// SPDX-License-Identifier: Apache-2.0
// axisgate-web-bench: what the gateway's half and axisgate-web take of the machine with 64 axes at 100 Hz and 0, 1, 10
// and 50 pages; how long a change takes to a page's text; how far back the history reaches, and what it takes; how long
// a scrape of them takes.
#include <fmt/format.h>

#include <exception>
#include <string>
#include <thread>

#include "tests/bench/report.hpp"
#include "tests/bench/usage.hpp"
#include "tests/bench/web/history_figures.hpp"
#include "tests/bench/web/looking.hpp"
#include "tests/bench/web/moving_axes.hpp"

namespace {

using namespace axisgate::bench;
using std::chrono::milliseconds;

/// Eight values of 64 axes, each changed 100 times a second; pages with the stream's own period of 100 ms.
void load(Report& report, bool quick) {
  constexpr int kAxes = 64, kPeriodMs = 100;
  const milliseconds lasting(quick ? 500 : 10'000);
  MovingAxes axes(kAxes, milliseconds(10), 50);
  struct Watched {
    int pages;
    std::string series{};
  };
  for (const auto& [pages, series] :
       {Watched{0}, Watched{1}, Watched{10}, Watched{50},
        Watched{50,
                "1.position_rev,1.velocity_rpm,1.torque_percent,1.current_a,64.position_rev,64.velocity_rpm,"
                "64.torque_percent,64.current_a"}}) {
    const Looking looking(axes.port(), pages, kPeriodMs, series);
    const std::uint64_t bytes = looking.bytes();
    const auto core = axes.thread_time();
    const Usage web = usage_of(axes.process());
    std::this_thread::sleep_for(lasting);
    const double seconds = std::chrono::duration<double>(lasting).count();
    const auto core_after = axes.thread_time();
    const Usage web_after = usage_of(axes.process());
    const auto of = [&](const char* what) {
      return fmt::format("{} pages{}: {}", pages, series.empty() ? "" : " with 8 series", what);
    };
    report.row(of("gateway's half, % of a core"), 100 * (core_after - core).count() / seconds, goal(1));
    report.row(of("axisgate-web, % of a core"), 100 * (web_after.processor_s - web.processor_s) / seconds);
    report.row(of("axisgate-web, resident MiB"), web_after.resident_mib);
    if (pages > 0)
      report.row(of("a stream, kB/s"), static_cast<double>(looking.bytes() - bytes) / 1000 / pages / seconds);
  }
}

/// From a change of the image to the text that a page reads, with the shortest period of a stream.
void latency(Report& report, bool quick) {
  MovingAxes axes(1, milliseconds(0), 1);
  Looking page(axes.port(), 1, 50);
  Samples samples;
  const int changes = quick ? 5 : 200;
  for (int change = 1; change <= changes; ++change) {
    // Some time after the change before, so that a change meets any phase of the stream's period.
    std::this_thread::sleep_for(milliseconds(150 + 7 * (change % 11)));
    const std::string text = fmt::format("\"position_rev\":{}", change);
    page.look_for(text);
    axes.set(change);
    samples.push_back(1000 * page.until_first_page_reads(text).count());
  }
  report.row("change to a page's text, median ms", median(samples));
  report.row("change to a page's text, p95 ms", quantile(samples, 0.95));
}

/// From a scraper's request to the last byte of its answer, beside values that change; what the core's thread takes
/// meanwhile.
void scrapes(Report& report, bool quick) {
  constexpr int kAxes = 64;
  MovingAxes axes(kAxes, milliseconds(10), 1);
  std::this_thread::sleep_for(milliseconds(1500));  // counts come once a second
  Samples samples;
  std::string answer;
  const int count = quick ? 5 : 200;
  for (int i = 0; i < count; ++i) {
    std::this_thread::sleep_for(milliseconds(25));  // an address has 50 requests a second
    const auto asked = std::chrono::steady_clock::now();
    answer = Looking::get(axes.port(), "/metrics");
    samples.push_back(1000 * std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count());
  }
  double series = 0;
  for (std::size_t at = answer.find("\naxisgate_"); at != answer.npos; at = answer.find("\naxisgate_", at + 1))
    ++series;
  report.row("a scrape of 64 axes, median ms", median(samples), goal(20));
  report.row("a scrape of 64 axes, p95 ms", quantile(samples, 0.95));
  report.row("its series", series, goal(6000));
  report.row("its kB", static_cast<double>(answer.size()) / 1000);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  try {
    const bool quick = std::erase(words, "--quick") != 0;
    std::string json;
    if (words.size() > 2 && words[0] == "--json") {
      json = words[1];
      words.erase(words.begin(), words.begin() + 2);
    }
    Report report(json);
    bool known = !words.empty();
    for (const std::string& bench : words) {
      report.begin(bench);
      if (bench == "web-latency")
        latency(report, quick);
      else if (bench == "web-history")
        history_figures(report, quick);
      else if (bench == "web-load")
        load(report, quick);
      else if (bench == "web-scrapes")
        scrapes(report, quick);
      else
        known = false;
    }
    if (known) return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "axisgate-web-bench: {}\n", error.what());
    return 1;
  }
  fmt::print(stderr,
             "usage: axisgate-web-bench [--quick] [--json FILE] web-history|web-latency|web-load|web-scrapes...\n");
  return 2;
}
