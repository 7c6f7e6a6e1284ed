// SPDX-License-Identifier: Apache-2.0
// The DDS server of the gateway: runs axisgate-dds, starts it again when it ends, and carries records between it and
// the DDS server. Promises that nothing of it waits for that process, that one turn of the loop does bounded work, and
// that every end is reported (event, log, alarm). Never sends from inside a turn of a drive: what changes there arms a
// timer.
#pragma once

#include <sys/types.h>

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/clock.hpp"
#include "gateway/core/line_bucket.hpp"
#include "gateway/core/log.hpp"
#include "gateway/upstream/dds/dds_session.hpp"
#include "gateway/upstream/dds_host/child_process.hpp"
#include "gateway/upstream/dds_host/restart_plan.hpp"
#include "gateway/upstream/dds_host/taking_watch.hpp"

namespace axisgate::dds {

/// Packets that one turn of the loop reads, and sends.
inline constexpr int kMaxReadATurn = 64;
inline constexpr int kMaxSentATurn = 128;

/// What is reported to the gateway of the process.
struct DdsReports {
  std::function<void(EventKind, std::string)> event;
  std::function<void(bool down)> down;                  ///< gateway alarm dds_process_down
  std::function<void(bool taken)> name_taken{};         ///< gateway alarm of that name
  std::function<void(bool missing)> address_missing{};  ///< gateway alarm listener_down
};

class DdsServer {
 public:
  /// Everything passed by reference must outlive the server.
  DdsServer(boost::asio::io_context& io, Runtime& runtime, const DdsSettings& settings, ProcessImage& image,
            const EventRing& events, CommandPort& commands, const Log& log, DdsReports reports);
  ~DdsServer();
  DdsServer(const DdsServer&) = delete;
  DdsServer& operator=(const DdsServer&) = delete;

  void start();
  /// The image has other axes now, with these units.
  void take_axes(const std::vector<AxisUnits>& units) { session_.take_axes(units, runtime_.now()); }
  /// Ends the process; waits for it, kEndsWithin at most. When the loop has ended: it would stand still meanwhile.
  void stop();

  /// None: it does not run at present.
  [[nodiscard]] std::optional<pid_t> pid() const;

 private:
  void begin();
  void on_patience_ended();
  void look_whether_it_takes(Instant now);
  void read_soon();
  void read_turn();
  /// False: it was no record that axisgate-dds may send, and is ended for it.
  bool take(Bytes packet, Instant now);
  bool take(const Record& record, Instant now);
  void take_line(const LogRecord& line, Instant now);
  void on_ready(const ReadyRecord& record, Instant now);
  void on_name_taken(bool taken, const std::string& where);
  void turn();
  void send_turn();
  void wait_for_room();
  /// Nothing goes over the socket any more; the process is to end by itself.
  void drop_link();
  /// It is not to go on: killed, and reported for `cause`.
  void fail(ProcessEnd cause);
  void on_end(const ProcessEnd& end);
  void take_last_lines(Instant now);

  boost::asio::io_context& io_;
  Runtime& runtime_;
  const DdsSettings settings_;
  const Log& log_;
  DdsReports reports_;
  std::unique_ptr<Timer> turn_timer_;
  std::unique_ptr<Timer> patience_;  ///< the next start, the next look, or until when something is waited for
  DdsSession session_;
  RestartPlan plan_;
  LineBucket lines_;
  TakingWatch taking_;
  std::unique_ptr<ChildProcess> process_;
  bool ready_ = false;
  bool reading_ = false;             ///< called when it has sent something
  bool waiting_for_room_ = false;    ///< called when it has taken something
  std::vector<Byte> packet_;         ///< taken from the session, not by the socket yet; empty: none
  std::optional<ProcessEnd> cause_;  ///< why we have ended it
};

}  // namespace axisgate::dds
