// SPDX-License-Identifier: Apache-2.0
// axisgate-dds-bench: from a change of the image to the sample at a subscriber, beside a bare Fast DDS writer of the
// same run; and what both processes take of the machine with 64 axes at 100 Hz.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>
#include <thread>

#include "axisgatePubSubTypes.h"
#include "gateway/upstream/dds_process/participant.hpp"
#include "tests/bench/dds/changing_image.hpp"
#include "tests/bench/dds/subscriber.hpp"
#include "tests/bench/report.hpp"

namespace {

using namespace axisgate::bench;
namespace dds = axisgate::dds;
using std::chrono::milliseconds;

constexpr std::chrono::microseconds kEvery{2000};

/// A domain of its own for each run and each half of it, so that runs side by side do not meet.
std::uint32_t domain_of(std::uint32_t half) { return 1 + 2 * (static_cast<std::uint32_t>(::getpid()) % 50) + half; }

/// What a program of Fast DDS alone does: the same type, QoS and network.
class BareWriter {
 public:
  explicit BareWriter(std::uint32_t domain) : participant_(options(domain), nullptr) {
    dds::fastdds::DataWriterQos qos = dds::fastdds::DATAWRITER_QOS_DEFAULT;
    qos.reliability().kind = dds::fastdds::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = dds::fastdds::TRANSIENT_LOCAL_DURABILITY_QOS;
    qos.history().kind = dds::fastdds::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = 1;
    qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.data_sharing().off();
    writer_ = &participant_.make_writer("axisgate/axis_state", "axis_state",
                                        dds::fastdds::TypeSupport(new axisgate::AxisStatePubSubType), qos);
    sample_.axis(1);
    sample_.name("axis 1");
  }
  void write() {
    timespec time{};
    ::clock_gettime(CLOCK_REALTIME, &time);
    sample_.stamp().sec(static_cast<std::int32_t>(time.tv_sec));
    sample_.stamp().nanosec(static_cast<std::uint32_t>(time.tv_nsec));
    sample_.sequence_number(sample_.sequence_number() + 1);
    writer_->write(&sample_);
  }
  void write_for(milliseconds lasting) {
    const auto end = std::chrono::steady_clock::now() + lasting;
    for (auto due = std::chrono::steady_clock::now(); due < end; due += kEvery) {
      std::this_thread::sleep_until(due);
      write();
    }
  }

 private:
  static dds::ParticipantOptions options(std::uint32_t domain) {
    dds::ParticipantOptions out;
    out.domain = domain;
    return out;
  }
  dds::Participant participant_;
  dds::fastdds::DataWriter* writer_ = nullptr;
  axisgate::AxisState sample_;
};

void latency(Report& report, bool quick) {
  const milliseconds lasting(quick ? 300 : 4000);
  const int rounds = quick ? 1 : 5;
  BareWriter bare(domain_of(0));
  Subscriber of_bare(domain_of(0));
  ChangingImage image({domain_of(1), 1, kEvery, milliseconds(1)});
  Subscriber of_image(domain_of(1));
  image.change(true);
  of_image.await_first_sample();
  bare.write_for(milliseconds(200));
  of_bare.await_first_sample();
  Samples bare_samples, image_samples;
  for (int round = 0; round < rounds; ++round) {
    image.change(false);
    of_bare.forget();
    bare.write_for(lasting);
    append(bare_samples, of_bare.latencies());
    of_image.forget();
    image.change(true);
    std::this_thread::sleep_for(lasting);
    append(image_samples, of_image.latencies());
  }
  // A change each 2 ms, the two in turns; the bare one is write() to the same subscriber. Goal: 50 us more.
  report.rows("change of the image to a subscriber, us", image_samples, "bare writer", bare_samples);
}

struct Usage {
  double processor_s = 0;
  double resident_mib = 0;
};

Usage usage_of(pid_t pid) {
  const std::string folder = "/proc/" + std::to_string(pid);
  std::ifstream stat(folder + "/stat");
  std::string text(std::istreambuf_iterator<char>(stat), {});
  // proc(5): utime and stime are fields 14 and 15, the second one, in brackets, may hold blanks.
  text = text.substr(text.rfind(')') + 2);
  std::size_t at = 0;
  for (int field = 3; field < 14; ++field) at = text.find(' ', at) + 1;
  char* rest = nullptr;
  const double user = std::strtod(text.c_str() + at, &rest);
  const double system = std::strtod(rest, nullptr);
  std::ifstream statm(folder + "/statm");
  double pages = 0, resident = 0;
  statm >> pages >> resident;
  return {(user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK)),
          resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1024 * 1024)};
}

void load(Report& report, bool quick) {
  const milliseconds lasting(quick ? 1000 : 20'000);
  ChangingImage image({domain_of(1), 64, std::chrono::microseconds(10'000), milliseconds(10)});
  Subscriber subscriber(domain_of(1));
  image.change(true);
  subscriber.await_first_sample();
  std::this_thread::sleep_for(milliseconds(500));
  subscriber.forget();
  const Usage core = usage_of(::getpid()), process = usage_of(image.process());
  const std::uint64_t before = image.changes();
  std::this_thread::sleep_for(lasting);
  const Usage core_after = usage_of(::getpid()), process_after = usage_of(image.process());
  const auto changes = static_cast<double>(image.changes() - before);
  const Samples received = subscriber.latencies();
  const double seconds = std::chrono::duration<double>(lasting).count();
  // 64 axes, each changed 100 times a second, one subscriber. The gateway's half has this bench in it.
  report.row("samples received, 1/s", static_cast<double>(received.size()) / seconds,
             Beside{"changes", changes / seconds});
  report.row("gateway's half, % of a core", 100 * (core_after.processor_s - core.processor_s) / seconds);
  report.row("axisgate-dds, % of a core", 100 * (process_after.processor_s - process.processor_s) / seconds);
  report.row("axisgate-dds, resident MiB", process_after.resident_mib);
  report.row("latency, median us", median(received));
  report.row("latency, p99 us", quantile(received, 0.99));
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  try {
    if (words.size() == 2 && words[0] == "subscribe")
      return subscribe(static_cast<std::uint32_t>(std::stoul(words[1])));
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
      if (bench == "dds-latency")
        latency(report, quick);
      else if (bench == "dds-load")
        load(report, quick);
      else
        known = false;
    }
    if (known) return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "axisgate-dds-bench: {}\n", error.what());
    return 1;
  }
  fmt::print(stderr, "usage: axisgate-dds-bench [--quick] [--json FILE] dds-latency|dds-load...\n");
  return 2;
}
