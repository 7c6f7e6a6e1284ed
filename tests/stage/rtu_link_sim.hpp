// SPDX-License-Identifier: Apache-2.0
// The cable between the gateway and a simulated Modbus RTU line: an RtuLink whose far end is an RtuLine, in manual
// time. Promises frames at the instants the line says, each with the number of the newest request sent before it was
// heard, and a cut that loses what is under way. Finds frames as libmodbus does: by the length their function byte
// tells, and after what was none it hears nothing until the line was silent. Never calls back from inside a call of its
// own.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adapters/modbus_rtu/rtu_link.hpp"
#include "tests/simulated/rtu_line.hpp"
#include "tests/stage/last_words.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

class RtuLinkSim final : public modbus_rtu::RtuLink {
 public:
  RtuLinkSim(ManualRuntime& runtime, simulated::RtuLineOptions options, std::uint64_t seed);

  [[nodiscard]] simulated::RtuLine& line() { return line_; }
  [[nodiscard]] simulated::Time time_of(Instant instant) const { return instant - origin_; }
  /// Drives live on although nobody speaks to them.
  void advance_drives() { line_.advance(time_of(runtime_.now())); }

  void start(modbus_rtu::RtuLinkEvents& events) override;
  void transmit(modbus_rtu::ExchangeNumber number, Bytes frame) override;
  void reopen(std::string_view why) override;
  void unplug();
  void plug();
  [[nodiscard]] bool plugged() const { return plugged_; }
  /// The wire is cut and the port stays open: nothing arrives on either side, and nobody says so.
  void cut_wire();
  void mend_wire() { wire_whole_ = true; }
  /// The drive's power goes and is back at once.
  void restart(std::size_t drive);
  /// Whoever held it has died: what it sent is on its way, what it has not taken is gone. start() takes it up again.
  void let_go();

  struct Sent {
    Instant at;
    modbus_rtu::ExchangeNumber number;
    std::vector<Byte> bytes;  ///< with the CRC
  };
  /// Everything the gateway has sent, and everything that came, with CRC and noise, for transcripts.
  std::vector<Sent> sent;
  std::function<void(bool to_drive, Bytes)> on_traffic = [](bool, Bytes) {};
  /// From inside on_traffic(): what becomes of the request just told.
  enum class Fate : std::uint8_t {
    delivered,
    refused,     ///< the drive does not see it; the answer is its error reply (exception 3)
    cut_before,  ///< the cable is pulled before it arrives
    cut_after,   ///< the drive acts, then the cable is pulled
  };
  Fate fate = Fate::delivered;
  std::function<void()> on_unplugged = [] {};
  LastWords last_words;  ///< whoever held it and died has none any more

 private:
  struct Chunk {
    simulated::Time at;
    modbus_rtu::ExchangeNumber newest;
    std::vector<Byte> bytes;
  };
  void deliver();
  void arm();
  void take(const Chunk& chunk);
  void take_frames(modbus_rtu::ExchangeNumber newest);
  void bad(std::size_t bytes);
  void forget();
  void forget_heard();
  [[nodiscard]] std::vector<Byte> error_reply(Bytes whole);
  [[nodiscard]] simulated::Time silence_at() const { return heard_until_ + line_.frame_gap(); }

  ManualRuntime& runtime_;
  Instant origin_;
  simulated::RtuLine line_;
  modbus_rtu::RtuLinkEvents* events_ = nullptr;
  std::vector<Chunk> arrived_;
  std::vector<Byte> begun_;  ///< of a frame
  bool noisy_ = false;       ///< after what was no frame, until the line is silent
  simulated::Time heard_until_{};
  modbus_rtu::ExchangeNumber newest_ = 0;
  std::optional<std::uint64_t> cut_when_heard_;  ///< so many requests by the drives
  std::optional<std::string> reopening_;
  bool plugged_ = true;
  bool wire_whole_ = true;
  bool up_ = false;
  std::unique_ptr<Timer> timer_;
};

}  // namespace axisgate::test
