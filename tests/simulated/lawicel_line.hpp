// SPDX-License-Identifier: Apache-2.0
// A CAN bus behind a serial adapter that speaks Lawicel's text protocol (CANUSB manual 1.0): the adapter and its bus.
// Promises that nothing passes while the channel is closed, CR for what was done and BELL for what was not. Never
// shares code with the gateway's own reader of this protocol.
#pragma once

#include <string>

#include "tests/simulated/can_port_line.hpp"

namespace axisgate::simulated {

struct LawicelOptions {
  bool acknowledges = true;  // CR, BELL and the z of a sent frame; some adapters say nothing at all
  bool has_flags = true;     // F is answered
};

class LawicelLine final : public CanPortLine {
 public:
  static constexpr std::size_t longest_line = 32;

  LawicelLine(const CanLineOptions& options, const LawicelOptions& adapter, Random random, ToHostSink sink)
      : CanPortLine(options, random, std::move(sink)), adapter_(adapter) {}

  void from_host(std::span<const std::uint8_t> bytes, Time now) override;
  void cut() override;
  void set_bus_off(bool off, Time now) override;
  void miss_acknowledge(Time now) override;
  bool open() const { return open_; }

 protected:
  void to_host(const CanToHost& frame) override;

 private:
  void take(const std::string& line, Time now);
  void take_channel(const std::string& line, Time now);
  bool transmit(const std::string& line, Time now);
  void tell(const std::string& text, Time now, std::uint64_t tag = 0);
  void answer(bool done, Time now);

  LawicelOptions adapter_;
  std::string line_;
  bool overlong_ = false;
  bool open_ = false;
  bool listen_only_ = false;
  bool rate_set_ = false;
  bool timestamps_ = false;
  unsigned flags_ = 0;
};

}  // namespace axisgate::simulated
