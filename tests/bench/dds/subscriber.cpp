// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/dds/subscriber.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <ctime>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <mutex>
#include <stdexcept>

#include "axisgatePubSubTypes.h"
#include "gateway/upstream/dds_process/participant/participant.hpp"

namespace axisgate::bench {
namespace {

constexpr std::size_t kMostSamples = 1'000'000;

double realtime_us() {
  timespec time{};
  ::clock_gettime(CLOCK_REALTIME, &time);
  return 1e6 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) / 1e3;
}

class Latencies final : public dds::fastdds::DataReaderListener {
 public:
  void on_data_available(dds::fastdds::DataReader* reader) override {
    const double now = realtime_us();
    dds::fastdds::SampleInfo info;
    while (reader->take_next_sample(&sample_, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      const auto& stamp = sample_.stamp();
      const double then = 1e6 * static_cast<double>(stamp.sec()) + static_cast<double>(stamp.nanosec()) / 1e3;
      const std::lock_guard lock(mutex_);
      if (samples_.size() < kMostSamples) samples_.push_back(now - then);
      any_.notify_all();
    }
  }
  void await_one() {
    std::unique_lock lock(mutex_);
    any_.wait(lock, [&] { return !samples_.empty(); });
  }
  std::vector<double> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(samples_, {});
  }

 private:
  axisgate::AxisState sample_;
  std::mutex mutex_;
  std::condition_variable any_;
  std::vector<double> samples_;
};

void send_all(int socket, const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t sent = ::write(socket, at, size);
    if (sent <= 0) throw std::runtime_error(std::string("subscriber: ") + std::strerror(errno));
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
}

void receive_all(int socket, void* bytes, std::size_t size) {
  char* at = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t received = ::read(socket, at, size);
    if (received <= 0) throw std::runtime_error("the subscriber has ended");
    at += received;
    size -= static_cast<std::size_t>(received);
  }
}

}  // namespace

int subscribe(std::uint32_t domain) {
  dds::ParticipantOptions options;
  options.domain = domain;
  options.interfaces = {"lo"};
  dds::Participant participant(options, nullptr);
  Latencies latencies;
  dds::fastdds::DataReaderQos qos = dds::fastdds::DATAREADER_QOS_DEFAULT;
  qos.reliability().kind = dds::fastdds::RELIABLE_RELIABILITY_QOS;
  // By default a Fast DDS reader takes ten instances, and rejects the samples of all others again and again.
  constexpr std::int32_t kMostAxes = 500;
  qos.resource_limits().max_instances = kMostAxes;
  qos.resource_limits().max_samples_per_instance = 1;
  qos.resource_limits().max_samples = kMostAxes;
  static_cast<void>(participant.make_reader(
      "axisgate/axis_state", dds::fastdds::TypeSupport(new axisgate::AxisStatePubSubType), qos, &latencies));
  for (char question = 0; ::read(OtherSelf::kSocket, &question, 1) == 1;) {
    if (question == 'a') latencies.await_one();
    const std::vector<double> taken = latencies.take();
    const std::uint64_t count = question == 'l' ? taken.size() : 0;
    send_all(OtherSelf::kSocket, &count, sizeof count);
    send_all(OtherSelf::kSocket, taken.data(), count * sizeof(double));
  }
  return 0;
}

Subscriber::Subscriber(std::uint32_t domain) : other_("subscribe", domain, SOCK_STREAM) {}

std::string Subscriber::ask(const std::string& question) {
  send_all(other_.socket(), question.data(), question.size());
  std::uint64_t count = 0;
  receive_all(other_.socket(), &count, sizeof count);
  std::string bytes(count * sizeof(double), '\0');
  receive_all(other_.socket(), bytes.data(), bytes.size());
  return bytes;
}

void Subscriber::await_first_sample() { static_cast<void>(ask("a")); }
void Subscriber::forget() { static_cast<void>(ask("f")); }

std::vector<double> Subscriber::latencies() {
  const std::string bytes = ask("l");
  std::vector<double> out(bytes.size() / sizeof(double));
  std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

}  // namespace axisgate::bench
