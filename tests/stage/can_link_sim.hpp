// SPDX-License-Identifier: Apache-2.0
// The cable between the gateway and a simulated CAN bus: a CanLink whose far end is a CanLine, in manual time.
// Promises frames at the instants the line says, those alone that the gateway's filters let through, and a cut that
// loses what is under way. Never calls back from inside a call of its own.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adapters/can/can_link.hpp"
#include "tests/simulated/can_line.hpp"
#include "tests/stage/last_words.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

[[nodiscard]] can::CanFrame can_frame_of(const simulated::BusFrame& frame);
[[nodiscard]] simulated::BusFrame bus_frame_of(const can::CanFrame& frame);

class CanLinkSim final : public can::CanLink {
 public:
  CanLinkSim(ManualRuntime& runtime, simulated::CanLineOptions options, std::uint64_t seed);

  [[nodiscard]] simulated::CanLine& line() { return line_; }
  [[nodiscard]] simulated::Time time_of(Instant instant) const { return instant - origin_; }
  /// Drives live on although nobody speaks to them.
  void advance_drives() { line_.advance(time_of(runtime_.now())); }

  void start(can::CanLinkEvents& events, std::vector<can::CanFilter> filters) override;
  void send(const can::CanFrame& frame, bool urgent) override;
  [[nodiscard]] const can::CanTrouble& trouble() const override { return trouble_; }
  [[nodiscard]] const std::vector<can::CanFilter>& filters() const { return filters_; }

  /// The interface is gone, and back.
  void unplug() { go_down("can0 is gone"); }
  void plug();
  /// The controller has left the bus; plug() or bus_on() brings it back.
  void bus_off();
  void bus_on() { plug(); }
  [[nodiscard]] bool plugged() const { return plugged_; }
  /// Each drive's plug is pulled, and nobody says so: nothing arrives on either side, no sign of life either.
  void cut_wire() { connect_drives(false); }
  void mend_wire() { connect_drives(true); }
  /// The drive's power goes and is back at once.
  void restart(std::size_t drive);
  /// Whoever held it has died: what it sent is on its way, what it has not taken is gone. start() takes it up again.
  void let_go();

  struct Sent {
    Instant at;
    can::CanFrame frame;
    bool urgent;
  };
  /// Everything the gateway has sent, and everything it was given, for transcripts.
  std::vector<Sent> sent;
  struct Received {
    Instant at;
    std::uint64_t tag;  ///< of the request that caused it, as the line's journal counts; 0: nobody asked
    can::CanFrame frame;
  };
  std::vector<Received> received;
  std::function<void(bool to_drive, const can::CanFrame&)> on_traffic = [](bool, const can::CanFrame&) {};
  /// From inside on_traffic(): what becomes of the frame just told.
  enum class Fate : std::uint8_t {
    delivered,
    refused,     ///< an SDO request the drive does not see; the answer is an abort (0x06090030); in 29 bits: silence
    cut_before,  ///< the interface goes before it is sent
    cut_after,   ///< the drive acts, then the interface goes
  };
  Fate fate = Fate::delivered;
  std::function<void()> on_unplugged = [] {};
  LastWords last_words;  ///< whoever held it and died has none any more

 private:
  struct Arrived {
    simulated::Time at;
    std::uint64_t tag;
    can::CanFrame frame;
  };
  void deliver();
  void arm();
  void go_down(std::string why);
  void refuse(const can::CanFrame& frame);
  void connect_drives(bool connected);
  [[nodiscard]] bool passes(const can::CanFrame& frame) const;

  ManualRuntime& runtime_;
  Instant origin_;
  simulated::CanLine line_;
  can::CanLinkEvents* events_ = nullptr;
  std::vector<can::CanFilter> filters_;
  can::CanTrouble trouble_;
  std::vector<Arrived> arrived_;
  std::optional<std::uint64_t> cut_when_heard_;  ///< so many requests by the drives
  std::string why_down_;
  bool plugged_ = true;
  bool up_ = false;
  bool was_up_ = false;
  std::unique_ptr<Timer> timer_;
};

}  // namespace axisgate::test
