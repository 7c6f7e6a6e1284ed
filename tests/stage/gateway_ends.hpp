// SPDX-License-Identifier: Apache-2.0
// The gateway's end of each kind of simulated cable: what its wires own, while the stage owns the cable and the drives.
// Promises that the cable is let go when the end is destroyed, so that drives and cable outlive a gateway. Never keeps
// anything of its own.
#pragma once

#include <utility>
#include <vector>

#include "tests/stage/can_link_sim.hpp"
#include "tests/stage/rtu_link_sim.hpp"

namespace axisgate::test {

/// Of a SimLink or a KeyaLinkSim.
template <class Cable>
class ByteEnd final : public bus::ByteLink {
 public:
  explicit ByteEnd(Cable& cable) : cable_(cable) {}
  ~ByteEnd() override { cable_.let_go(); }
  ByteEnd(const ByteEnd&) = delete;
  ByteEnd& operator=(const ByteEnd&) = delete;
  void start(bus::ByteLinkEvents& events) override { cable_.start(events); }
  void send(Bytes bytes) override { cable_.send(bytes); }
  void reopen(std::string_view why) override { cable_.reopen(why); }

 private:
  Cable& cable_;
};

class RtuEnd final : public modbus_rtu::RtuLink {
 public:
  explicit RtuEnd(RtuLinkSim& cable) : cable_(cable) {}
  ~RtuEnd() override { cable_.let_go(); }
  RtuEnd(const RtuEnd&) = delete;
  RtuEnd& operator=(const RtuEnd&) = delete;
  void start(modbus_rtu::RtuLinkEvents& events) override { cable_.start(events); }
  void transmit(modbus_rtu::ExchangeNumber number, Bytes frame) override { cable_.transmit(number, frame); }
  void withdraw(modbus_rtu::ExchangeNumber number) override { cable_.withdraw(number); }
  void reopen(std::string_view why) override { cable_.reopen(why); }

 private:
  RtuLinkSim& cable_;
};

class CanEnd final : public can::CanLink {
 public:
  explicit CanEnd(CanLinkSim& cable) : cable_(cable) {}
  ~CanEnd() override { cable_.let_go(); }
  CanEnd(const CanEnd&) = delete;
  CanEnd& operator=(const CanEnd&) = delete;
  void start(can::CanLinkEvents& events, std::vector<can::CanFilter> filters) override {
    cable_.start(events, std::move(filters));
  }
  void send(const can::CanFrame& frame, bool urgent) override { cable_.send(frame, urgent); }
  [[nodiscard]] const can::CanTrouble& trouble() const override { return cable_.trouble(); }

 private:
  CanLinkSim& cable_;
};

}  // namespace axisgate::test
