// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/serve_command.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <variant>

#include "gateway/core/log.hpp"
#include "gateway/upstream/dds_process/commands/command_readers.hpp"
#include "gateway/upstream/dds_process/commands/liveliness_readers.hpp"
#include "gateway/upstream/dds_process/discovery/namesake_reader.hpp"
#include "gateway/upstream/dds_process/discovery/writer_discovery.hpp"
#include "gateway/upstream/dds_process/participant/certificates.hpp"
#include "gateway/upstream/dds_process/publish/publishers.hpp"
#include "gateway/upstream/dds_process/ros/ros_topics.hpp"
#include "gateway/upstream/dds_process/system/dds_log.hpp"
#include "gateway/upstream/dds_process/system/dead_segments.hpp"
#include "gateway/upstream/dds_process/system/standstill.hpp"
#include "gateway/upstream/link/exit_codes.hpp"
#include "gateway/upstream/program/memory_limit.hpp"
#include "gateway/upstream/program/record_link.hpp"
#include "gateway/upstream/program/start_error.hpp"
#include "gateway/upstream/program/steady.hpp"

namespace axisgate::dds {
namespace {

using Link = program::RecordLink<Record, decode>;
using program::Received;

constexpr SteadyNs kBeatPeriod = 100 * kMillisecond;
constexpr SteadyNs kMemoryPeriod = 250 * kMillisecond;
/// In one turn of the loop, so that neither direction starves the other.
constexpr int kRecordsPerTurn = 256;
/// What one turn may send, the socket being idle: nothing of it may be lost for want of room.
constexpr std::size_t kMostSentPerTurn =
    2 * kMaxWritersKnown + kMostBeatRecords + kSamplesPerTurn + kRosSamplesPerTurn + kNamesakesPerTurn + 1;
static_assert(kMostSentPerTurn <= program::kMaxPacketsWaiting);

void tell(Link& link, LogLevel level, const std::string& text) {
  link.send(LogRecord{static_cast<std::uint8_t>(level), text});
}

/// From a participant that is there to the end of the socket.
class Server {
 public:
  Server(const ServeOptions& options, Link& link, DdsLog& log, program::Wake& wake)
      : link_(link),
        log_(log),
        wake_(wake),
        namesakes_(gateway_key(options.gateway_name)),
        discovery_(watch_, namesakes_, wake_),
        participant_(options.participant, &discovery_),
        publishers_(participant_, gateway_id(options.gateway_name), wake_),
        namesake_reader_(participant_, !options.participant.discovery_servers.empty(), namesakes_, wake_) {
    if (!options.certificates.empty()) require_authentication(participant_.qos());
    for (const std::string& file : options.certificates)
      identities_.push_back({static_cast<std::uint16_t>(identities_.size()), guid_of_certificate(file)});
    if (options.ros2)
      ros_.emplace(participant_, wake_, options.gateway_name, options.min_period_ms * kMillisecond, options.commands);
    if (options.commands) {
      readers_.emplace(participant_, options.participant.domain, watch_, wake_);
      liveliness_.emplace(readers_->participant_of_commands(), participant_, watch_, wake_);
    }
  }

  int run() {
    link_.send(ReadyRecord{AXISGATE_VERSION});
    for (const IdentityRecord& record : identities_) link_.send(record);
    SteadyNs next_beat = program::steady_now();
    SteadyNs next_memory_check = program::steady_now();
    for (;;) {
      wait(next_beat);
      standstill_.turn(program::steady_now());
      publishers_.publish_held(program::steady_now());
      if (program::steady_now() >= next_memory_check) {
        program::check_memory();
        next_memory_check = program::steady_now() + kMemoryPeriod;
      }
      if (const std::optional<int> end = take_records()) return *end;
      wake_.clear();
      if (!link_.flush()) return link::kExitGatewayGone;
      more_ = false;
      namesake_reader_.update();
      const SteadyNs now = program::steady_now();
      // All that one turn takes goes out together: else what comes last would never find the socket idle.
      if (link_.idle()) {
        if (readers_ && now >= next_beat) {
          for (const BeatRecord& record : watch_.beats(now)) link_.send(record);
          next_beat = now + kBeatPeriod;
        }
        take_namesakes();
        take_samples();
      }
      if (ros_ && now >= ros_->due()) ros_->on_time(now, difference_);
      while (link_.idle()) {
        const std::optional<LogRecord> line = log_.next(now);
        if (!line) break;
        link_.send(*line);
      }
    }
  }

 private:
  void wait(SteadyNs next_beat) {
    pollfd fds[] = {{link_.fd(), static_cast<short>(link_.idle() ? POLLIN : POLLIN | POLLOUT), 0},
                    {wake_.fd(), POLLIN, 0}};
    // Samples and changes wait while the gateway does not read: only its socket can change that.
    const nfds_t count = link_.idle() ? 2 : 1;
    const SteadyNs now = program::steady_now();
    SteadyNs until = std::min(now + kMemoryPeriod, publishers_.due());
    if (readers_ && link_.idle()) until = std::min(until, next_beat);
    if (ros_) until = std::min(until, ros_->due());
    if (more_) until = now;
    poll(fds, count, static_cast<int>(std::max<SteadyNs>(0, (until - now + kMillisecond - 1) / kMillisecond)));
  }

  /// An exit code where this was the last.
  std::optional<int> take_records() {
    // Measured anew it differs by nanoseconds: the stamp of one and the same value would go to and fro.
    if (const ClockDifference measured = program::time_of_day_difference();
        std::abs(measured - difference_) > kMillisecond) {
      difference_ = measured;
    }
    for (int taken = 0; taken < kRecordsPerTurn; ++taken) {
      const Link::Got packet = link_.receive();
      if (packet.what == Received::nothing) break;
      if (packet.what == Received::closed) return link::kExitGatewayGone;
      if (packet.what == Received::garbage) return protocol_error(packet.problem);
      if (!publishers_.publish(packet.record, program::steady_now(), difference_)) {
        return protocol_error("a record that the gateway never sends");
      }
      if (ros_) ros_->on_record(packet.record);
    }
    return std::nullopt;
  }

  int protocol_error(const std::string& problem) {
    tell(link_, LogLevel::error, "from the gateway: " + problem);
    return link::kExitProtocol;
  }

  void take_namesakes() {
    const std::vector<NamesakeRecord> told = namesakes_.take(kNamesakesPerTurn);
    for (const NamesakeRecord& record : told) link_.send(record);
    more_ = more_ || told.size() == kNamesakesPerTurn;
  }

  void take_samples() {
    std::vector<Record> actions;
    std::vector<Record> samples;
    std::vector<Record> targets;
    if (ros_) more_ = !ros_->take(difference_, actions, targets) || more_;
    send_dated(actions);
    if (readers_) {
      // First the samples, then what is known of writers: so no sample is older than what is told before it.
      more_ = !readers_->take(samples) || more_;
      const WriterWatch::Changes changes = watch_.take_changes(program::steady_now());
      for (const WriterRecord& record : changes.before) link_.send(record);
      send_dated(samples);
      for (const WriterRecord& record : changes.after) link_.send(record);
      if (changes.refused > 0) {
        tell(link_, LogLevel::warning,
             "more than " + std::to_string(kMaxWritersKnown) + " writers of commands: some are not known");
      }
      liveliness_->update();
    }
    send_dated(targets);
  }

  void send_all(const std::vector<Record>& records) {
    for (const Record& record : records) link_.send(record);
  }

  /// Samples of clients, each with when it came.
  void send_dated(std::vector<Record>& records) {
    for (Record& record : records)
      std::visit(
          [this](auto& sample) {
            if constexpr (requires { sample.received; }) sample.received = standstill_.came(sample.received);
          },
          record);
    send_all(records);
  }

  Link& link_;
  DdsLog& log_;
  program::Wake& wake_;
  WriterWatch watch_;
  NamesakeWatch namesakes_;
  WriterDiscovery discovery_;
  Participant participant_;
  Publishers publishers_;
  NamesakeReader namesake_reader_;
  std::optional<RosTopics> ros_;
  std::optional<CommandReaders> readers_;
  std::optional<LivelinessReaders> liveliness_;
  std::vector<IdentityRecord> identities_;
  ClockDifference difference_ = program::time_of_day_difference();
  Standstill standstill_;
  bool more_ = false;
};

/// Taking leave of the other participants is a courtesy. Fast DDS 2.9.1 can run for ever in the heartbeat of a writer
/// that is being deleted, and no gateway would be there any more to end that.
void leave_soon() {
  constexpr unsigned kSecondsToLeave = 1;
  std::signal(SIGALRM, [](int) { ::_exit(link::kExitGatewayGone); });
  ::alarm(kSecondsToLeave);
}

int serve(const ServeOptions& options, Link& link) {
  program::Wake wake;
  DdsLog log(wake);
  take_over_library_log(log);
  int code = link::kExitInternal;
  if (options.participant.shared_memory) remove_dead_segments("/dev/shm");
  try {
    Server server(options, link, log, wake);
    code = server.run();
    leave_soon();
  } catch (const program::StartError& error) {
    release_library_log();
    while (const std::optional<LogRecord> line = log.next(program::steady_now())) link.send(*line);
    tell(link, LogLevel::error, error.what());
    code = error.exit_code;
  }
  release_library_log();
  return code;
}

}  // namespace

int run(const ServeOptions& options) {
  // Ctrl-C on the terminal means the gateway, which ends us by closing the socket.
  std::signal(SIGINT, SIG_IGN);
  program::limit_memory(options.memory_limit_mib);
  Link link(options.link_fd, "axisgate-dds", "; to look at topics, run: axisgate-dds topics");
  try {
    return serve(options, link);
  } catch (const std::system_error& error) {
    // How the library's attempt to start a thread ends where there is no room for its stack.
    if (error.code() == std::errc::resource_unavailable_try_again) program::end_for_memory();
    tell(link, LogLevel::error, error.what());
    return link::kExitInternal;
  }
}

}  // namespace axisgate::dds
