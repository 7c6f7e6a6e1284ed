// SPDX-License-Identifier: Apache-2.0
// The guard of one axis: it may hold torque only while somebody answers for it, and move only while somebody answers
// for the motion (design 3.4, 3.5). Pure: what the axis shows, what waits for it and instants go in; which stop is due,
// and why, comes out. Promises each stop once; of several that are due together the strongest alone, and a disable
// behind it; that what is owed is due again until it shows, or a later enable was accepted. Never sends: the axis does.
#pragma once

#include <boost/container/static_vector.hpp>
#include <memory>
#include <optional>
#include <string>

#include "gateway/drive/motion/jog.hpp"
#include "gateway/drive/motion/late_enable.hpp"
#include "gateway/drive/motion/owed_stop.hpp"
#include "gateway/drive/motion/ownership.hpp"
#include "gateway/image/axis_image.hpp"
#include "gateway/image/command.hpp"
#include "gateway/image/events.hpp"

namespace axisgate::drive {

/// A stop that the gateway asks for by itself, and what is said of it.
struct OwnStop {
  Command command = Command::none;  ///< none: nothing is sent
  bool latches = false;
  bool again = false;          ///< it was accepted before, and is owed
  bool shown = true;           ///< its result is the axis's latest
  bool with_another = false;   ///< another axis was stopped, and this one is stopped as one with it
  ClientId client = 0;         ///< in whose name; 0: nobody's
  Instant answer_by = kNever;  ///< see WriteBatch
  EventKind kind = EventKind::warning;
  std::uint32_t code = 0;
  std::string why{};  ///< empty: it was said already
};

[[nodiscard]] Command command_of(StopKind stop);

class Guard {
 public:
  using ClientPtr = std::shared_ptr<const ClientLife>;
  /// Stops that are due at once; what is asked for again meanwhile is the same.
  static constexpr std::size_t kMostDue = 8;
  /// A disable waits so long for the stop that goes before it.
  static constexpr Duration kStopFirst = OwedStop::kPace;

  /// What the axis shows, and what waits for it.
  struct Seen {
    Instant now = kLongAgo;
    std::uint64_t exchange = 0;            ///< the newest so far
    AxisState state = AxisState::unknown;  ///< as it is published
    bool torque = false;                   ///< it may have torque: it is enabled, or nobody knows
    bool runs = false;                     ///< a motion runs, moves, or was asked for
    bool runs_raw = false;
    bool stopping = false;          ///< by a stop that was accepted
    bool writes = false;            ///< something that is no stop waits, or is under way
    bool enables = false;           ///< likewise an enable
    bool stop_waits = false;        ///< likewise a stop
    bool owed_waits = false;        ///< it is sent already, or what will end it
    bool halt_is_certain = true;    ///< what a halt would write is known
    bool stops_without_us = false;  ///< the drive, or whoever commands it, would stop the motor
    Instant jog_limit = kNever;     ///< when the jog must be halted before its position limit
  };

  /// `jog`: the button that is held, if one is.
  Guard(Lease& lease, const LeaseRules& rules, Jog& jog) : ownership_(lease, rules), jog_(jog) {}

  // --- Who answers --------------------------------------------------------------------------------------------------

  [[nodiscard]] Ownership& ownership() { return ownership_; }
  [[nodiscard]] const Ownership& ownership() const { return ownership_; }
  [[nodiscard]] Jog& jog() { return jog_; }
  [[nodiscard]] const Jog& jog() const { return jog_; }
  /// Its motion is this client's from now on.
  void commanded(ClientId client, const ClientPtr& life) { motion_by_ = {client, life}; }
  /// The axis is enabled, and nobody owns it.
  void adopted(Instant now);

  // --- What asks for a stop -----------------------------------------------------------------------------------------

  /// A jog, if there is one, has lost what it needs.
  void end_jog(std::string_view why) {
    if (jog_.active()) halt_jog("jog: " + std::string(why) + ": halted");
  }
  /// Likewise, of a jog that may have ended.
  void halt_jog(std::string what);
  /// This client will never speak again.
  void client_gone(ClientId client, const Seen& seen);
  /// `object`: its name; the drive tells it no more, and a motion needs it.
  void blind(std::string_view object, const Seen& seen);
  /// A homing has run for longer than it may.
  void homing_timed_out();
  /// What is due against what the watch has seen, or the drive's own restart.
  void asks(Command stop) { note({.command = stop}); }
  /// An axis that is stopped as one with it was stopped, by this client.
  void stop_with_another(Command stop, ClientId client, std::string why) {
    note({.command = stop,
          .shown = false,
          .with_another = true,
          .client = client,
          .kind = EventKind::command,
          .code = static_cast<std::uint32_t>(stop),
          .why = std::move(why)});
  }

  // --- What is owed -------------------------------------------------------------------------------------------------

  [[nodiscard]] OwedStop& owed() { return owed_; }
  [[nodiscard]] const OwedStop& owed() const { return owed_; }
  /// Torque that nobody has asked for: a disable is owed.
  void enabled_itself(std::string why, std::uint64_t exchange) {
    tell(EventKind::warning, 0, std::move(why));
    owed_.accepted(StopKind::disable, exchange);
  }
  /// An enable was answered with "unknown" or was withdrawn: it may come late.
  [[nodiscard]] LateEnable& late_enable() { return late_enable_; }
  /// The drive is out of sight. `heard`: when it was heard last.
  void lost(Instant heard, std::uint64_t exchange);
  /// What it shows, by this exchange. `turns`: see OwedStop.
  void shows(model::State402 state, std::uint64_t exchange, bool turns, const Seen& seen);
  /// An attempt at a stop has ended, or what ends one was carried out.
  void discharged(OwedStop::End end);

  // --- What is due --------------------------------------------------------------------------------------------------

  /// The next of what is due; call it until there is none.
  [[nodiscard]] std::optional<OwnStop> due(const Seen& seen);
  /// When due() may change without anything being reported.
  [[nodiscard]] Instant next_deadline(Instant now) const;

 private:
  void note(OwnStop stop);
  void tell(EventKind kind, std::uint32_t code, std::string text) {
    note({.kind = kind, .code = code, .why = std::move(text)});
  }
  void end_lease(const Ownership::Expired& expired, const Seen& seen);
  [[nodiscard]] std::optional<OwnStop> strongest(const Seen& seen);

  Ownership ownership_;
  Jog& jog_;
  OwedStop owed_;
  LateEnable late_enable_;
  struct {
    std::optional<ClientId> client{};
    ClientPtr life{};
  } motion_by_;  ///< who commanded the motion that runs
  boost::container::static_vector<OwnStop, kMostDue> due_;
  Instant stopped_at_ = kLongAgo;  ///< when the newest stop of these was due
};

}  // namespace axisgate::drive
