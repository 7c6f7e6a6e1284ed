// SPDX-License-Identifier: Apache-2.0
// The cable between the gateway and a simulated serial line, in manual time: plugged or not, whole or cut, and who
// still speaks at its end. Promises bytes at the instants the line says, and a cut that loses what is under way. Never
// calls a link's events: the link that owns it does, from its timer.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "tests/simulated/drive_line.hpp"
#include "tests/stage/last_words.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

class SerialCable {
 public:
  [[nodiscard]] simulated::Time time_of(Instant instant) const { return instant - origin_; }
  [[nodiscard]] Instant at_time(simulated::Time time) const { return origin_ + time; }
  [[nodiscard]] simulated::Time now() const { return time_of(runtime_.now()); }
  /// Drives live on although nobody speaks to them.
  void advance_drives() { line_.advance(now()); }

  void unplug() {
    plugged_ = false;
    on_unplugged();
    forget_heard();
    line_.cut();
    wake();
  }
  void plug() {
    plugged_ = true;
    wake();
  }
  [[nodiscard]] bool plugged() const { return plugged_; }
  /// The wire is cut and the port stays open: nothing arrives on either side, and nobody says so.
  void cut_wire() {
    wire_whole_ = false;
    line_.cut();
  }
  void mend_wire() { wire_whole_ = true; }
  /// The drive's power goes and is back at once.
  void restart(std::size_t drive) {
    advance_drives();
    line_.restart(drive, now());
    wake();  // what it says when it is back was not foreseen
  }

  /// From inside on_traffic(): what becomes of the request just told.
  enum class Fate : std::uint8_t {
    delivered,
    refused,     ///< the drive does not see it; the answer is its protocol's refusal, or nothing where it has none
    cut_before,  ///< the cable is pulled before it arrives
    cut_after,   ///< the drive acts, then the cable is pulled
  };
  Fate fate = Fate::delivered;
  /// Everything the gateway sends, and everything that comes, noise too, for transcripts.
  std::function<void(bool to_drive, Bytes)> on_traffic = [](bool, Bytes) {};
  std::function<void()> on_unplugged = [] {};
  LastWords last_words;  ///< whoever held it and died has none any more

 protected:
  /// `line`: may be made after the cable.
  SerialCable(ManualRuntime& runtime, simulated::DriveLine& line)
      : runtime_(runtime), origin_(runtime.now()), line_(line), timer_(runtime.make_timer([this] { turn(); })) {}
  ~SerialCable() = default;
  SerialCable(const SerialCable&) = delete;
  SerialCable& operator=(const SerialCable&) = delete;

  /// Of the line.
  [[nodiscard]] simulated::ToHostSink sink() {
    return [this](const simulated::ToHost& chunk) {
      if (plugged_ && wire_whole_) hear(chunk.at, {chunk.bytes.begin(), chunk.bytes.end()});
    };
  }

  /// A request leaves the gateway: what becomes of it.
  void carry(Bytes request) {
    fate = Fate::delivered;
    on_traffic(true, request);
    if (wire_whole_) {
      if (fate == Fate::cut_before) return unplug();
      if (fate == Fate::refused) {
        hear(now(), refusal(request));
      } else {
        if (fate == Fate::cut_after) cut_when_heard_ = line_.requests_heard() + 1;
        line_.from_host(request, now());
      }
    }
    arm();
  }
  /// It was plugged or unplugged: tells the link's events.
  void tell_plugged(auto& events) {
    if (plugged_ == up_) return;
    up_ = plugged_;
    if (up_)
      events.on_link_up();
    else
      events.on_link_down("unplugged");
  }
  void forget_heard() {
    cut_when_heard_.reset();
    forget();
  }
  void wake() { timer_->expires_at(runtime_.now()); }

  ManualRuntime& runtime_;
  bool up_ = false;  ///< as the link has told

 private:
  /// The line has let the host hear this.
  virtual void hear(simulated::Time at, std::vector<Byte> bytes) = 0;
  virtual std::vector<Byte> refusal(Bytes request) = 0;
  /// What was heard and not taken is gone.
  virtual void forget() = 0;
  /// Tells what there is to tell. False: nobody listens.
  virtual bool deliver() = 0;
  /// When there is more to tell without an event of the line.
  [[nodiscard]] virtual Instant due() const = 0;

  [[nodiscard]] bool cuts() const { return cut_when_heard_ && line_.requests_heard() >= *cut_when_heard_; }
  void turn() {
    advance_drives();
    if (cuts()) unplug();
    if (!last_words.dead() && deliver()) arm();
  }
  void arm() {
    Instant next = due();
    if (plugged_ != up_ || cuts()) next = runtime_.now();
    if (const auto event = line_.next_event()) next = std::min(next, origin_ + *event);
    timer_->expires_at(std::max(next, runtime_.now()));
  }

  Instant origin_;
  simulated::DriveLine& line_;
  std::optional<std::uint64_t> cut_when_heard_;  ///< so many requests by the drives
  bool plugged_ = true;
  bool wire_whole_ = true;
  std::unique_ptr<Timer> timer_;
};

}  // namespace axisgate::test
