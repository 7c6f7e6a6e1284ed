// SPDX-License-Identifier: Apache-2.0
// The cable between the gateway and a simulated Modbus RTU line: an RtuLink whose far end is an RtuLine, in manual
// time. Promises frames at the instants the line says, each with the number of the newest request sent before it was
// heard, and a cut that loses what is under way. Finds frames as the product's link does, and after what was none it
// hears nothing until the line was silent. Never calls back from inside a call of its
// own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/modbus_rtu/frame_finder.hpp"
#include "adapters/modbus_rtu/rtu_link.hpp"
#include "tests/simulated/rtu_line.hpp"
#include "tests/stage/serial_cable.hpp"

namespace axisgate::test {

class RtuLinkSim final : public modbus_rtu::RtuLink, public SerialCable {
 public:
  RtuLinkSim(ManualRuntime& runtime, const simulated::RtuLineOptions& options, std::uint64_t seed);

  [[nodiscard]] simulated::RtuLine& line() { return line_; }

  void start(modbus_rtu::RtuLinkEvents& events) override;
  void transmit(modbus_rtu::ExchangeNumber number, Bytes frame) override;
  void reopen(std::string_view why) override;
  /// Whoever held it has died: what it sent is on its way, what it has not taken is gone. start() takes it up again.
  void let_go();

  struct Sent {
    Instant at;
    modbus_rtu::ExchangeNumber number;
    std::vector<Byte> bytes;  ///< with the CRC
  };
  /// Everything the gateway has sent.
  std::vector<Sent> sent;

 private:
  struct Chunk {
    simulated::Time at;
    modbus_rtu::ExchangeNumber newest;
    std::vector<Byte> bytes;
  };
  void hear(simulated::Time at, std::vector<Byte> bytes) override;
  /// Its error reply (exception 3).
  std::vector<Byte> refusal(Bytes request) override;
  void forget() override;
  bool deliver() override;
  [[nodiscard]] Instant due() const override;
  void take(const Chunk& chunk);
  void take_frames(modbus_rtu::ExchangeNumber newest, bool silence);
  void hear_silence();
  void bad(std::size_t bytes);
  [[nodiscard]] simulated::Time silence_at() const { return heard_until_ + line_.frame_gap(); }

  simulated::RtuLine line_;
  modbus_rtu::RtuLinkEvents* events_ = nullptr;
  std::vector<Chunk> arrived_;
  modbus_rtu::FrameFinder finder_;
  bool noisy_ = false;  ///< after what was no frame, until the line is silent
  simulated::Time heard_until_{};
  modbus_rtu::ExchangeNumber newest_ = 0;
  std::optional<std::string> reopening_;
};

}  // namespace axisgate::test
