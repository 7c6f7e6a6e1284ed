// SPDX-License-Identifier: Apache-2.0
// The dialogue with a Lawicel adapter: close, bit rate, open, then frames, and now and then its status.
// Promises to get an adapter going that never answers as well as one that answers everything, one frame after another
// at the pace of its serial port, and to begin from scratch a second after the adapter has refused, overflowed or
// babbled. Never looks at a clock, and never waits for the acknowledgement of a frame.
#pragma once

#include <string>

#include "adapters/can/can_bus_off_plan.hpp"
#include "adapters/can/can_device.hpp"
#include "adapters/can/can_send_queue.hpp"
#include "adapters/can/lawicel.hpp"

namespace axisgate::can {

class LawicelSession {
 public:
  /// How long an answer to a command is waited for; an adapter that never answers costs this three times per start.
  static constexpr Duration kReplyWait = std::chrono::milliseconds(300);
  static constexpr Duration kRetry = std::chrono::seconds(1);
  /// Twice within BusOffPlan::kNoAckQuiet, so that a complaint that goes on is seen to go on.
  static constexpr Duration kStatusPeriod = std::chrono::milliseconds(500);
  /// A status that was never answered so often is not asked for again; one that was, tells that the adapter hangs.
  static constexpr int kMaxUnanswered = 3;
  /// Frames refused in a row: the adapter is bus-off, which its status does not tell, or nobody acknowledges.
  static constexpr int kMaxRefusals = 8;

  LawicelSession(CanDevice device, std::uint32_t bitrate);

  void on_port_up(Instant now);
  void on_port_down(std::string_view why);
  void on_line(const LawicelLine& line, Instant now);
  /// The port brings bytes without end that are no lines.
  void on_babble(Instant now);
  void on_deadline(Instant now);
  void send(const CanFrame& frame, bool urgent, Instant now);

  [[nodiscard]] bool up() const { return up_; }
  /// Why it is not up; empty where nothing has gone wrong yet.
  [[nodiscard]] const std::string& why() const { return why_; }
  [[nodiscard]] Instant due(Instant now) const;
  /// What is to be sent through the port now.
  [[nodiscard]] std::string take_output();
  /// As the adapter reported it; empty where it did not.
  [[nodiscard]] const std::string& version() const { return version_; }
  [[nodiscard]] bool answers() const { return answers_; }
  [[nodiscard]] CanTrouble& trouble() { return trouble_; }
  [[nodiscard]] const CanTrouble& trouble() const { return trouble_; }

 private:
  enum class Step : std::uint8_t { port_closed, closing, setting_rate, opening, running, resting };

  void begin(Instant now);
  void enter(Step step, std::string_view command, Instant now);
  void run(Instant now);
  void fail(std::string_view why, Instant now);
  void on_line_while_starting(const LawicelLine& line, Instant now);
  void on_line_while_running(const LawicelLine& line, Instant now);
  void on_refusal(Instant now);
  void on_status(Byte flags, Instant now);
  void on_step_deadline(Instant now);
  void ask_status(Instant now);
  void put(std::string_view bytes, Instant now);
  void pump(Instant now);
  /// Takes the health of the bus over into up() and why().
  void judge(Instant now);

  CanDevice device_;
  std::uint32_t bitrate_;
  Step step_ = Step::port_closed;
  Instant step_due_ = kNever;
  bool up_ = false;
  std::string why_;
  std::string version_;
  bool answers_ = false;
  bool status_offered_ = true;
  bool status_seen_ = false;
  Instant status_asked_at_ = kNever;
  int unanswered_ = 0;
  int refusals_ = 0;
  std::string output_;
  Instant line_free_at_ = kLongAgo;
  SendQueue queue_;
  BusOffPlan plan_;
  CanTrouble trouble_;
};

}  // namespace axisgate::can
