// SPDX-License-Identifier: Apache-2.0
// axisgate-dds-bench: from a change of the image to the sample at a subscriber, beside a bare Fast DDS writer of the
// same run, and one in a process of its own that is told by a socket; and what both processes take of the machine with
// 64 axes at 100 Hz.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <exception>
#include <string>
#include <thread>

#include "axisgatePubSubTypes.h"
#include "gateway/upstream/dds_process/participant/participant.hpp"
#include "tests/bench/dds/changing_image.hpp"
#include "tests/bench/dds/other_self.hpp"
#include "tests/bench/dds/subscriber.hpp"
#include "tests/bench/report.hpp"
#include "tests/bench/usage.hpp"

namespace {

using namespace axisgate::bench;
namespace dds = axisgate::dds;
using std::chrono::milliseconds;

constexpr std::chrono::microseconds kEvery{2000};

/// A domain of its own for each run and each part of it, so that runs side by side do not meet.
std::uint32_t domain_of(std::uint32_t part) { return 1 + 3 * (static_cast<std::uint32_t>(::getpid()) % 33) + part; }

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
    write(time);
  }
  void write(const timespec& time) {
    sample_.stamp().sec(static_cast<std::int32_t>(time.tv_sec));
    sample_.stamp().nanosec(static_cast<std::uint32_t>(time.tv_nsec));
    sample_.sequence_number(sample_.sequence_number() + 1);
    writer_->write(&sample_);
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

/// A process of its own that writes what it is told to, as axisgate-dds does, and nothing else: what the way through a
/// second process costs by itself.
class Relay {
 public:
  explicit Relay(std::uint32_t domain) : other_("relay", domain, SOCK_SEQPACKET) {}

  void write() {
    timespec time{};
    ::clock_gettime(CLOCK_REALTIME, &time);
    if (::send(other_.socket(), &time, sizeof time, MSG_NOSIGNAL) < 0) throw std::runtime_error("the relay has ended");
  }
  /// The side of that process, to the end of its socket.
  static int run(std::uint32_t domain) {
    BareWriter writer(domain);
    for (timespec time{}; ::recv(OtherSelf::kSocket, &time, sizeof time, 0) == sizeof time;) writer.write(time);
    return 0;
  }

 private:
  OtherSelf other_;
};

/// One sample each kEvery.
template <typename Writer>
void write_for(Writer& writer, milliseconds lasting) {
  const auto end = std::chrono::steady_clock::now() + lasting;
  for (auto due = std::chrono::steady_clock::now(); due < end; due += kEvery) {
    std::this_thread::sleep_until(due);
    writer.write();
  }
}

/// Returns when the subscriber has heard of it. What is written before they know each other nobody hears.
template <typename Writer>
void meet(Writer& writer, Subscriber& subscriber) {
  std::atomic<bool> met = false;
  std::jthread writing([&] {
    while (!met) write_for(writer, milliseconds(20));
  });
  subscriber.await_first_sample();
  met = true;
}

template <typename Writer>
void measure(Writer& writer, Subscriber& subscriber, milliseconds lasting, Samples& to) {
  subscriber.forget();
  write_for(writer, lasting);
  append(to, subscriber.latencies());
}

void latency(Report& report, bool quick) {
  const milliseconds lasting(quick ? 300 : 4000);
  const int rounds = quick ? 1 : 5;
  BareWriter bare(domain_of(0));
  Subscriber of_bare(domain_of(0));
  Relay relay(domain_of(2));
  Subscriber of_relay(domain_of(2));
  ChangingImage image({domain_of(1), 1, kEvery, milliseconds(1)});
  Subscriber of_image(domain_of(1));
  image.change(true);
  of_image.await_first_sample();
  meet(bare, of_bare);
  meet(relay, of_relay);
  Samples bare_samples, relay_samples, image_samples;
  for (int round = 0; round < rounds; ++round) {
    image.change(false);
    measure(bare, of_bare, lasting, bare_samples);
    measure(relay, of_relay, lasting, relay_samples);
    of_image.forget();
    image.change(true);
    std::this_thread::sleep_for(lasting);
    append(image_samples, of_image.latencies());
  }
  // A change each 2 ms, the two in turns; the bare one is write() to the same subscriber. Goal: 50 us more.
  report.rows("change of the image to a subscriber, us", image_samples, "bare writer", bare_samples);
  report.rows("change of the image to a subscriber, us", image_samples, "two processes", relay_samples);
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
    if (words.size() == 2 && words[0] == "relay") return Relay::run(static_cast<std::uint32_t>(std::stoul(words[1])));
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
