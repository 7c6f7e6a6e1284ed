// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/topics_command.hpp"

#include <axisgatePubSubTypes.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <iterator>
#include <optional>
#include <string_view>

#include "gateway/upstream/dds_process/participant/participant.hpp"
#include "gateway/upstream/dds_process/topics/command_topics.hpp"
#include "gateway/upstream/dds_process/topics/guarded_type.hpp"
#include "gateway/upstream/dds_process/topics_table.hpp"
#include "gateway/upstream/program/steady.hpp"

namespace axisgate::dds {
namespace {

using eprosima::fastrtps::Duration_t;
using eprosima::fastrtps::types::ReturnCode_t;

constexpr SteadyNs kRedrawPeriod = 200 * kMillisecond;
/// With --once: for the first axis, and then for one more.
constexpr SteadyNs kFirstWithin = 5'000 * kMillisecond;
constexpr SteadyNs kNextWithin = 500 * kMillisecond;
/// With --all as well: each gateway says once a second that it is there.
constexpr SteadyNs kNextGatewayWithin = 2'500 * kMillisecond;
/// Of all gateways of the domain.
constexpr std::int32_t kMostAxes = 16'000;
constexpr std::int32_t kMostGateways = 256;
/// Of one name, so that two which speak at once are both heard.
constexpr std::int32_t kStatesOfAName = 8;
constexpr int kNoAxisFound = 1;

volatile std::sig_atomic_t ended = 0;
void on_signal(int) { ended = 1; }

// ECMA-48: the alternate screen keeps what the user had on the terminal; its cursor is hidden while we redraw.
constexpr std::string_view kEnter = "\x1b[?1049h\x1b[?25l";
constexpr std::string_view kLeave = "\x1b[?25h\x1b[?1049l";

void put(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
  // Whoever read our output has gone.
  if (std::ferror(stdout) != 0) ended = 1;
}

/// Of the terminal that stdout is; {0, 0} of a file. One that does not know its own size is taken for a common one.
winsize window_size() {
  winsize window{};
  if (isatty(STDOUT_FILENO) != 1) return window;
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0 && window.ws_row > 0;
  return known ? window : winsize{.ws_row = 24, .ws_col = 80, .ws_xpixel = 0, .ws_ypixel = 0};
}

class Terminal {
 public:
  Terminal() { put(kEnter); }
  ~Terminal() { put(kLeave); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  static void draw(std::string_view text) {
    const winsize window = window_size();
    std::size_t rows = window.ws_row;
    std::string frame = "\x1b[H";
    for (bool first = true; !text.empty() && rows > 0; --rows, first = false) {
      const std::size_t end = text.find('\n');
      if (!first) frame += "\r\n";
      frame += text.substr(0, end).substr(0, window.ws_col);
      frame += "\x1b[K";
      text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    }
    put(frame + "\x1b[J");
  }
};

fastdds::DataReaderQos last_states(std::int32_t instances, std::int32_t depth) {
  fastdds::DataReaderQos qos;
  qos.reliability().kind = fastdds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = fastdds::TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.resource_limits().max_instances = instances;
  qos.history().depth = depth;
  qos.resource_limits().max_samples_per_instance = depth;
  qos.resource_limits().max_samples = instances * depth;
  qos.resource_limits().allocated_samples = 0;
  qos.data_sharing().off();
  return qos;
}

class Topics {
 public:
  explicit Topics(const TopicsOptions& options)
      : options_(options),
        participant_(options.participant, nullptr),
        reader_(participant_.make_reader(kStateTopicName, fastdds::TypeSupport(new GuardedType<AxisStatePubSubType>()),
                                         last_states(kMostAxes, 1), nullptr)),
        gateways_reader_(participant_.make_reader(kGatewayTopicName,
                                                  fastdds::TypeSupport(new GuardedType<GatewayStatePubSubType>()),
                                                  last_states(kMostGateways, kStatesOfAName), nullptr)) {}

  int run() {
    const bool redraws = isatty(STDOUT_FILENO) == 1 && !options_.json && !options_.once;
    std::optional<Terminal> terminal;
    if (redraws) terminal.emplace();
    const SteadyNs begun = program::steady_now();
    SteadyNs newest = begun;
    while (ended == 0) {
      reader_.wait_for_unread_message(Duration_t(0, static_cast<std::uint32_t>(kRedrawPeriod)));
      const SteadyNs now = program::steady_now();
      take_gateways();
      if (take(!redraws)) newest = now;
      if (terminal) {
        terminal->draw(heading() + tables());
        usleep(static_cast<useconds_t>(kRedrawPeriod / 1000));
      }
      if (options_.once && now - newest > patience()) break;
    }
    if (options_.once && !options_.json) put(axes_.empty() ? "" : tables());
    if (options_.once && axes_.empty()) {
      std::fprintf(stderr,
                   "axisgate-dds: no axis in domain %u: is the gateway running with \"dds\" in its configuration, "
                   "and are --domain and --interface the same?\n",
                   options_.participant.domain);
      return kNoAxisFound;
    }
    return 0;
  }

 private:
  std::string heading() const {
    return fmt::format("domain {}  {} axes  (rad or m, per s; torque 0.1 % of rated; Ctrl-C ends)\n",
                       options_.participant.domain, axes_.size());
  }

  [[nodiscard]] SteadyNs patience() const {
    if (axes_.empty()) return kFirstWithin;
    return options_.all ? kNextGatewayWithin : kNextWithin;
  }

  [[nodiscard]] std::string tables() const {
    const std::int64_t now = program::clock_ns(CLOCK_REALTIME);
    const std::string gateways = options_.all ? gateways_table(gateways_, now) + "\n" : std::string();
    return gateways + topics_table(axes_, now, window_size().ws_col);
  }

  [[nodiscard]] bool wanted(const std::string& gateway) const {
    return options_.all || !options_.gateway_name || *options_.gateway_name == gateway;
  }

  void take_gateways() {
    axisgate::GatewayState sample;
    fastdds::SampleInfo info;
    while (gateways_reader_.take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      SeenGateway& seen = gateways_[sample.gateway().to_string()];
      seen.state = sample;
      const auto& prefix = info.sample_identity.writer_guid().guidPrefix;
      seen.writers[std::string(std::begin(prefix.value), std::end(prefix.value))] = program::clock_ns(CLOCK_REALTIME);
    }
  }

  /// True: a new axis, or anything at all where there are lines.
  bool take(bool lines) {
    bool any_new = false;
    axisgate::AxisState sample;
    fastdds::SampleInfo info;
    while (ended == 0 && reader_.take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK) {
      const std::string gateway = sample.gateway().to_string();
      if (!info.valid_data || !wanted(gateway)) continue;
      const bool is_new = axes_.insert_or_assign(AxisKey(gateway, sample.axis()), sample).second;
      any_new = any_new || is_new;
      if (options_.json && (is_new || !options_.once)) {
        put(topics_json(sample) + "\n");
      } else if (lines && !options_.once) {
        put(topics_line(sample) + "\n");
      }
    }
    return any_new;
  }

  TopicsOptions options_;
  Participant participant_;
  fastdds::DataReader& reader_;
  fastdds::DataReader& gateways_reader_;
  AxisSamples axes_;
  SeenGateways gateways_;
};

}  // namespace

int run(const TopicsOptions& options) {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  Topics topics(options);
  // The library's own lines would tear the table.
  eprosima::fastdds::dds::Log::ClearConsumers();
  return topics.run();
}

}  // namespace axisgate::dds
