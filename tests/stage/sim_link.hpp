// SPDX-License-Identifier: Apache-2.0
// The cable between the gateway and a simulated line: a ByteLink whose far end is a SerialLine, in manual time.
// Promises bytes at the instants the line says, a cut that loses what is under way, and a check that at most one
// request is outstanding. Never delivers a byte from inside send().
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adapters/bus/byte_link.hpp"
#include "tests/simulated/serial_line.hpp"
#include "tests/stage/last_words.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

class SimLink final : public bus::ByteLink {
 public:
  SimLink(ManualRuntime& runtime, simulated::LineOptions options, std::uint64_t seed);

  [[nodiscard]] simulated::SerialLine& line() { return line_; }
  [[nodiscard]] simulated::Time time_of(Instant instant) const { return instant - origin_; }
  /// Drives live on although nobody speaks to them.
  void advance_drives() { line_.advance(time_of(runtime_.now())); }

  void start(bus::ByteLinkEvents& events) override;
  void send(Bytes bytes) override;
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
    std::vector<Byte> bytes;
  };
  /// Everything the gateway has sent, and everything it was given, for transcripts.
  std::vector<Sent> sent;
  std::function<void(bool to_drive, Bytes)> on_traffic = [](bool, Bytes) {};
  /// From inside on_traffic(): what becomes of the request just told.
  enum class Fate : std::uint8_t {
    delivered,
    refused,     ///< the drive does not see it; the answer is an error (0x80, detail 0x06090030)
    cut_before,  ///< the cable is pulled before it arrives
    cut_after,   ///< the drive acts, then the cable is pulled
  };
  Fate fate = Fate::delivered;
  std::function<void()> on_unplugged = [] {};
  LastWords last_words;  ///< whoever held it and died has none any more

 private:
  void deliver();
  void arm();
  ManualRuntime& runtime_;
  Instant origin_;
  simulated::SerialLine line_;
  std::vector<Byte> arrived_;
  bus::ByteLinkEvents* events_ = nullptr;
  bool plugged_ = true;
  bool wire_whole_ = true;
  bool up_ = false;
  std::unique_ptr<Timer> timer_;
};

}  // namespace axisgate::test
