// SPDX-License-Identifier: Apache-2.0
// Kinco's serial protocol on a line of bytes, as the bus sees it: frames out, answers back.
// Promises at most one reply per send(), none after abandon() or a loss of the link, and that a line that babbles is
// opened again three times and then reported down until it is quiet. Never queues or repeats a
// request, and never judges a value.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "adapters/bus/byte_link.hpp"
#include "adapters/bus/echo_watch.hpp"
#include "adapters/bus/line_remarks.hpp"
#include "adapters/bus/line_watch.hpp"
#include "adapters/bus/wire.hpp"
#include "adapters/kinco/kinco_receiver.hpp"
#include "gateway/core/log.hpp"

namespace axisgate::kinco {

class KincoWire final : public bus::Wire, private bus::ByteLinkEvents {
 public:
  /// `name` is the bus's, for the log.
  KincoWire(std::string name, std::unique_ptr<bus::ByteLink> link, Runtime& runtime, const Log& log);
  ~KincoWire() override;

  void start(bus::WireEvents& events) override;
  void send(const bus::Exchange& exchange) override;
  void abandon() override;
  [[nodiscard]] const bus::Statistics& statistics() const override;
  void set_decode(bool on) override { decode_ = on; }

 private:
  void on_link_up() override;
  void on_link_down(std::string_view why) override;
  void on_bytes(Bytes bytes) override;
  void give_up();
  void take_other(std::string_view remark);
  void log_frame(std::string_view direction, Bytes bytes, const Frame& frame, std::string_view remark) const;

  LogSource log_source_;
  const Log& log_;
  bus::WireEvents* events_ = nullptr;
  Runtime& runtime_;
  Receiver receiver_;
  std::optional<bus::Exchange> outstanding_;
  std::optional<bus::Exchange> before_;    ///< asked before it: its answer may be said twice
  std::optional<bus::Exchange> given_up_;  ///< last: its answer may be late
  bus::Exchange asked_;                    ///< last
  bus::EchoWatch echo_;
  bus::LineRemarks remarks_;
  bool decode_ = false;
  mutable bus::Statistics statistics_;
  // Last, so that they go first: neither may call into a wire that is half gone.
  bus::LineWatch watch_;
  std::unique_ptr<bus::ByteLink> link_;
};

}  // namespace axisgate::kinco
