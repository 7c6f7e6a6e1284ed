// SPDX-License-Identifier: Apache-2.0
// Keya's serial control frame: one write of one motor becomes the whole desired state of both (DriveModel::composed).
// Pure: what was written last and what the motors show go in, the frame comes out. Promises that a motor is on in it
// only if this write turns it on, or if it was on by the last frame (or found so) and shows enabled now, or is about to
// by a client's word: one that has tripped never comes back by a frame meant for its neighbour; and that a motor which
// is not moved by this write keeps what it was sent. Never guesses what a motor that somebody else has started should
// do: it says that it cannot.
#pragma once

#include <optional>
#include <vector>

#include "adapters/bus/exchange.hpp"
#include "gateway/drive/state/object_store.hpp"

namespace axisgate::drive {

/// What one motor shows, as far as its axis knows.
struct MotorShows {
  bool enabled = false;    ///< by a sample that nothing has happened to since
  bool enabling = false;   ///< a client's enable of it is under way, and no fault has shown since
  bool disabling = false;  ///< a disable of it waits for the wire
  bool moving = false;
  int mode = 0;                            ///< unified number
  std::optional<std::int64_t> position{};  ///< as the drive counts
};

class ControlFrame {
 public:
  explicit ControlFrame(const model::DriveModel& model) : model_(model) {}

  /// The write is one of a field of the frame.
  [[nodiscard]] bool carries(const bus::Exchange& write) const;
  /// The write with all other fields beside it. `motors`: one per axis of the model. `stop`: it must be sent, whatever
  /// is not known; else none where the neighbour's state has no frame.
  [[nodiscard]] std::optional<bus::Exchange> complete(const bus::Exchange& write, const ObjectStore& store,
                                                      const std::vector<MotorShows>& motors, bool stop) const;

 private:
  struct Motor {
    model::ObjectId on = model::kNoObject;
    model::ObjectId value = model::kNoObject;
  };
  [[nodiscard]] Motor motor(AxisSlot slot) const;
  struct Desired {
    bool on = false;
    std::int64_t value = 0;
  };
  [[nodiscard]] std::optional<Desired> desired(const bus::Exchange& write, const ObjectStore& store, AxisSlot slot,
                                               const MotorShows& shows, bool stop) const;
  [[nodiscard]] bool on(const ObjectState& commanded, const MotorShows& shows) const;
  [[nodiscard]] std::optional<std::int64_t> value(const ObjectState& commanded, const MotorShows& shows, bool on,
                                                  bool stop) const;

  const model::DriveModel& model_;
};

}  // namespace axisgate::drive
