// SPDX-License-Identifier: Apache-2.0
// Modbus RTU on a serial line, as the bus sees it: requests out, answers back.
// Promises at most one reply per send(), none after abandon() or a loss of the link, none for a frame that was heard
// before its request was sent, that is the answer before said again by a drive that answers twice, or that may be the
// echo of its request; and that a line
// that babbles is opened again three times and then reported down until it is quiet. Never queues or repeats a request,
// and never judges a value.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapters/bus/echo_watch.hpp"
#include "adapters/bus/line_remarks.hpp"
#include "adapters/bus/line_watch.hpp"
#include "adapters/bus/wire.hpp"
#include "adapters/modbus_rtu/rtu_codec.hpp"
#include "adapters/modbus_rtu/rtu_timing.hpp"
#include "gateway/core/log.hpp"

namespace axisgate::modbus_rtu {

class RtuWire final : public bus::Wire, private RtuLinkEvents {
 public:
  /// `name` is the bus's, for the log; `nodes` are its drives. `runtime` and `log` must outlive the wire.
  RtuWire(std::string name, std::vector<RtuNode> nodes, LineSpeed speed, std::unique_ptr<RtuLink> link,
          Runtime& runtime, const Log& log);
  ~RtuWire() override;

  void start(bus::WireEvents& events) override;
  /// Every drive's write to unit 0, or to the broadcast unit of a node, is answered by nobody: it ends ok when the line
  /// has had the time to carry it.
  void send(const bus::Exchange& exchange) override;
  void abandon() override;
  [[nodiscard]] const bus::Statistics& statistics() const override;
  void set_decode(bool on) override { decode_ = on; }

 private:
  struct Outstanding {
    ExchangeNumber number = 0;
    bus::Exchange exchange;
    bool broadcast = false;
    Instant sent_at = kLongAgo;
    std::size_t request_bytes = 0;  ///< with the CRC
  };

  /// From one unit.
  struct Heard {
    Frame last;                       ///< an answer, or one that nobody waited for; none since a request was given up
    Instant unsure_since = kLongAgo;  ///< a request was given up, or a frame came that nobody waited for
  };

  void on_link_up() override;
  void on_link_down(std::string_view why) override;
  void on_frame(ExchangeNumber newest, Bytes frame) override;
  void on_bad_frame(ExchangeNumber newest, std::size_t bytes) override;
  void on_glitch(std::size_t bytes) override;

  void give_up();
  /// Of the request sent last; false: it is judged as an answer.
  [[nodiscard]] bool take_copy(Bytes frame);
  /// Takes what is not the answer; `remark` says why.
  void take_other(Bytes frame, std::string_view remark);
  void tell_misfit(Bytes frame, std::string_view why);
  void end(const bus::ExchangeResult& result);
  [[nodiscard]] bool early(Bytes frame) const;
  /// The answer to a request given up may still come, or be said again: four times as late as the drive's worst reply.
  [[nodiscard]] bool may_owe(std::uint8_t unit) const;
  void broadcast_over();
  [[nodiscard]] bool is_broadcast(std::uint8_t unit) const;
  [[nodiscard]] const RtuNode& node_of(std::uint8_t unit) const;
  [[nodiscard]] bool knows(std::uint8_t unit) const;
  void log_frame(std::string_view direction, Bytes frame, std::string_view words) const;

  LogSource log_source_;
  std::vector<RtuNode> nodes_;
  LineSpeed speed_;
  Runtime& runtime_;
  const Log& log_;
  bus::WireEvents* events_ = nullptr;
  ExchangeNumber last_number_ = 0;
  std::optional<Outstanding> outstanding_;
  bool timed_ = true;  ///< nothing has come sooner than the line could carry it, but what may have been a late answer
  std::map<std::uint8_t, Heard> heard_;  ///< by unit, of the nodes and what they obey
  Frame request_;                        ///< sent last
  bool clean_ = true;                    ///< no noise since then
  bus::EchoWatch echo_;
  bus::LineRemarks remarks_;
  bool decode_ = false;
  mutable bus::Statistics statistics_;
  // Last, so that they go first: none may call into a wire that is half gone.
  std::unique_ptr<Timer> broadcast_timer_;
  bus::LineWatch watch_;
  std::unique_ptr<RtuLink> link_;
};

}  // namespace axisgate::modbus_rtu
