// SPDX-License-Identifier: Apache-2.0
// What a drive is sent beside a client's commands: the keep-alive that it needs to go on, and the frames that command
// all of its motors at once what to do. Pure: the drive and its axes as they are in this turn go in. Promises that a
// frame goes by a state which was shown lately, that a repetition goes before everything but a stop, that nothing is
// repeated to a drive that was adopted or owes a reply, and that what a frame has written counts for all of its motors.
// Never sends and never enables: what it gives is sent by the drive, in a turn that was somebody's.
#pragma once

#include <optional>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "gateway/drive/device/control_frame.hpp"
#include "gateway/drive/device/keep_alive.hpp"

namespace axisgate::drive {

class DriveControl {
 public:
  /// What a motor showed longer ago says nothing of what it does now: this process may have been held up meanwhile, and
  /// the drive's watchdog (1000 ms after the last command) may have turned it off.
  static constexpr Duration kShownFor = std::chrono::milliseconds(500);

  struct AxisTurn {
    const AxisCore& core;
    bool enabling = false;   ///< an enable of it is under way
    bool disabling = false;  ///< a disable of it waits for the wire
    bool stopping = false;   ///< a stop of it is pending, under way or owed
    bool live = false;       ///< somebody answers for what it does
  };
  /// The drive in this turn.
  struct Turn {
    Instant now = kLongAgo;
    bool online = false;   ///< link_state 1
    bool suspect = false;  ///< it owes a reply
    bool adopted = false;
    std::vector<AxisTurn> axes;  ///< one per axis of the model
  };

  DriveControl(const model::DriveModel& model, ObjectStore& store)
      : model_(model), store_(store), frame_(model), keep_alive_(model) {}

  /// The drive comes up from scratch: nothing that was sent counts.
  void reset() { keep_alive_.reset(); }
  /// This drive needs either: a turn has to be shown to it.
  [[nodiscard]] bool concerned() const { return keep_alive_.wanted() || !model_.composed.empty(); }

  /// Whose repetition is due, and the exchange: the repetition, or the look at the motors that has to come before it.
  struct Due {
    AxisSlot axis = 0;
    bus::Exchange exchange;
  };
  [[nodiscard]] std::optional<Due> due(const Turn& turn) const;
  /// When due() gives the next one.
  [[nodiscard]] Instant next_due(const Turn& turn) const;
  /// The repetition for this axis came to nothing.
  void failed(AxisSlot axis, Instant now) { keep_alive_.failed(axis, now); }

  /// What is to be read before a client's frame is sent. `stop`: it is a stop's.
  [[nodiscard]] std::optional<model::ObjectId> look_before(const Turn& turn, bool stop) const;
  /// The exchange as it goes on the wire; none: the neighbour's state has no frame.
  [[nodiscard]] std::optional<bus::Exchange> whole(const Turn& turn, const bus::Exchange& exchange, bool stop) const;

  /// Of an exchange of this drive. `repeated`: it was given by due(), for this axis. `trusted`: its reply can be no
  /// late one.
  void on_result(const bus::Exchange& exchange, const bus::ExchangeResult& result, std::optional<AxisSlot> repeated,
                 Instant sent_at, bool trusted, Instant now);

 private:
  [[nodiscard]] bool shown_lately(model::ObjectId object, Instant now) const;
  [[nodiscard]] bool looked_just_now(Instant now) const;
  [[nodiscard]] std::vector<MotorShows> motors_show(const Turn& turn) const;
  [[nodiscard]] bool may_repeat(const Turn& turn) const;
  void on_written(model::ObjectId id, std::uint32_t raw, Errc code, Instant sent_at);

  const model::DriveModel& model_;
  ObjectStore& store_;
  ControlFrame frame_;
  KeepAlive keep_alive_;
};

}  // namespace axisgate::drive
