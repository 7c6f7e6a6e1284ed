// SPDX-License-Identifier: Apache-2.0
// A CAN link through a Lawicel adapter on a serial port.
// Promises what CanLink promises: up and down in turn with the reason, frames in order, at most kMaxFramesPerTurn of
// them in one turn of the loop. Never opens the port itself: the ByteLink does, and keeps it open.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "adapters/bus/byte_link.hpp"
#include "adapters/bus/noise_watch.hpp"
#include "adapters/bus/opening_failures.hpp"
#include "adapters/can/can_filter_set.hpp"
#include "adapters/can/lawicel_session.hpp"
#include "gateway/core/log.hpp"

namespace axisgate::can {

class SlcanLink final : public CanLink, private bus::ByteLinkEvents {
 public:
  /// Bytes that wait for their turn; more mean that frames come faster than anybody takes them, and are lost.
  static constexpr std::size_t kMaxBacklog = 16384;

  /// `name` is the bus's, for the log. `runtime` and `log` must outlive the link.
  SlcanLink(std::string name, CanDevice device, std::uint32_t bitrate, std::unique_ptr<bus::ByteLink> port,
            Runtime& runtime, const Log& log);
  ~SlcanLink() override;

  void start(CanLinkEvents& events, std::vector<CanFilter> filters) override;
  void send(const CanFrame& frame, bool urgent) override;
  [[nodiscard]] const CanTrouble& trouble() const override { return session_.trouble(); }

 private:
  void on_link_up() override;
  void on_link_down(std::string_view why) override;
  void on_bytes(Bytes bytes) override;
  /// Lines, until kMaxFramesPerTurn frames have been handed over or none is left.
  void take_lines();
  void take(const LawicelLine& line);
  void wake();
  /// Sends what the session wants sent, and waits for what it waits for.
  void obey();
  /// Tells the events what they do not know yet.
  void report();

  LogSource log_source_;
  std::string path_;
  Runtime& runtime_;
  const Log& log_;
  CanLinkEvents* events_ = nullptr;
  FilterSet filters_;
  LawicelDecoder decoder_;
  LawicelSession session_;
  bus::NoiseWatch noise_;
  std::vector<Byte> backlog_;
  bool reported_up_ = false;
  bool ever_up_ = false;
  bus::OpeningFailures failures_;
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
  // Last, so that they go first: neither may call into a link that is half gone.
  std::unique_ptr<Timer> timer_;
  std::unique_ptr<bus::ByteLink> port_;
};

}  // namespace axisgate::can
