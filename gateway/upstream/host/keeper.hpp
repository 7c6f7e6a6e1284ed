// SPDX-License-Identifier: Apache-2.0
// The keeper of a program of the gateway's own (axisgate-dds, axisgate-web): starts it, starts it again when it ends,
// and carries packets between it and its session. Promises that nothing of it waits for that process, that one turn of
// the loop does bounded work, and that every end is reported (event, log, alarm). Never sends from inside a turn of a
// drive: what changes there arms a timer.
#pragma once

#include <sys/types.h>

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/core/clock.hpp"
#include "gateway/core/line_bucket.hpp"
#include "gateway/core/log.hpp"
#include "gateway/image/events.hpp"
#include "gateway/upstream/host/child_process.hpp"
#include "gateway/upstream/host/hosted_session.hpp"
#include "gateway/upstream/host/restart_plan.hpp"
#include "gateway/upstream/host/taking_watch.hpp"

namespace axisgate::host {

/// Packets that one turn of the loop reads, and sends.
inline constexpr int kMaxReadATurn = 64;
inline constexpr int kMaxSentATurn = 128;

/// Texts come from a process that listens to a network: one line of the log stays one line.
[[nodiscard]] std::string printable(std::string text);

/// What is reported to the gateway of the process.
struct KeeperReports {
  std::function<void(EventKind, std::string)> event;
  std::function<void(bool down)> down{};                ///< it does not run, or is not ready
  std::function<void(bool missing)> address_missing{};  ///< gateway alarm listener_down
};

class Keeper {
 public:
  using Arguments = std::vector<std::string>;  ///< of a command line
  /// Everything passed by reference must outlive the keeper; `session` is asked nothing before run().
  Keeper(boost::asio::io_context& io, Runtime& runtime, const HostedProgram& program, HostedSession& session,
         const Log& log, KeeperReports reports);
  ~Keeper();
  Keeper(const Keeper&) = delete;
  Keeper& operator=(const Keeper&) = delete;

  /// It is to run with these, and is started again where it runs with others. None: it is not to run.
  void run(std::optional<Arguments> arguments);
  /// The session has something to send: with the next turn of the loop.
  void wake() { turn_timer_->expires_at(runtime_.now()); }
  /// Ends the process; waits for it, kEndsWithin at most. When the loop has ended: it would stand still meanwhile.
  void stop();

  /// None: it does not run at present.
  [[nodiscard]] std::optional<pid_t> pid() const;
  [[nodiscard]] const HostedProgram& program() const { return program_; }
  [[nodiscard]] bool ready() const { return ready_; }
  /// How often it was ready again after an end.
  [[nodiscard]] std::uint32_t restarts() const { return starts_ == 0 ? 0 : starts_ - 1; }

 private:
  void go_on();
  void begin();
  void on_patience_ended();
  void look_whether_it_takes(Instant now);
  void read_soon();
  void read_turn();
  /// False: it was no record that the program may send, and is ended for it.
  bool take(Bytes packet, Instant now);
  void take_line(const Heard& line, Instant now);
  void on_ready(const std::string& version, Instant now);
  void report_down(bool down) const;
  void report_address(bool missing) const;
  void turn();
  void send_turn();
  /// False: packet_ waits for room, or the link is gone.
  bool send_packet(Instant now);
  void wait_for_room();
  /// Nothing goes over the socket any more; the process is to end by itself.
  void drop_link();
  /// It is not to go on: killed, and reported for `cause`.
  void fail(ProcessEnd cause);
  void on_end(const ProcessEnd& end);
  void take_last_lines(Instant now);

  boost::asio::io_context& io_;
  Runtime& runtime_;
  const HostedProgram& program_;
  std::optional<Arguments> arguments_;  ///< none: it is not to run
  HostedSession& session_;
  const Log& log_;
  KeeperReports reports_;
  std::unique_ptr<Timer> turn_timer_;
  std::unique_ptr<Timer> patience_;  ///< the next start, the next look, or until when something is waited for
  RestartPlan plan_;
  LineBucket lines_;
  TakingWatch taking_;
  std::unique_ptr<ChildProcess> process_;
  std::uint32_t starts_ = 0;
  bool ready_ = false;
  bool reading_ = false;             ///< called when it has sent something
  std::vector<Byte> packet_;         ///< taken from the session, and waits until it takes something; empty: none
  std::optional<ProcessEnd> cause_;  ///< why we have ended it
};

}  // namespace axisgate::host
