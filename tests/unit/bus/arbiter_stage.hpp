// SPDX-License-Identifier: Apache-2.0
// Words for telling stories about an arbiter: who submits what, who gets the wire, who is told of an end.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "adapters/bus/arbiter.hpp"

namespace axisgate::bus {

inline void PrintTo(const Arbiter::Ending& ending, std::ostream* out) {
  *out << "job " << ending.id << " of drive " << int{ending.drive} << ": " << text(ending.code);
}

}  // namespace axisgate::bus

namespace axisgate::test {

using namespace std::chrono_literals;
using bus::Arbiter;
using bus::BusJob;
using bus::JobId;
using bus::Priority;

inline constexpr ObjectAddress kTargetPosition{0x607A, 0};
inline constexpr ObjectAddress kProfileVelocity{0x6081, 0};
inline constexpr ObjectAddress kStatusword{0x6041, 0};

inline BusJob job(Priority priority, DriveSlot drive, AxisSlot axis = 0) {
  BusJob o;
  o.priority = priority;
  o.drive = drive;
  o.axis = axis;
  return o;
}
inline BusJob stop(DriveSlot drive, AxisSlot axis = 0) { return job(Priority::stop, drive, axis); }
inline BusJob command(DriveSlot drive, AxisSlot axis = 0) { return job(Priority::command, drive, axis); }
inline BusJob interactive(DriveSlot drive, AxisSlot axis = 0) { return job(Priority::interactive, drive, axis); }
inline BusJob setup(DriveSlot drive) { return job(Priority::setup, drive, kNoAxis); }
inline BusJob setpoint(DriveSlot drive, ObjectAddress object = kTargetPosition, AxisSlot axis = 0) {
  BusJob o = command(drive, axis);
  o.setpoints_only = true;
  o.writes.push_back(object);
  return o;
}
inline BusJob reading(DriveSlot drive, ObjectAddress object = kStatusword, std::uint8_t size = 2) {
  BusJob o = interactive(drive);
  o.read = {object, size};
  return o;
}

class ArbiterStage : public testing::Test {
 protected:
  static constexpr std::size_t kDrives = 4;

  JobId submit(const BusJob& o) {
    const auto submission = arbiter.submit(o, now);
    EXPECT_EQ(submission.code, Errc::ok);
    EXPECT_FALSE(submission.joined);
    return submission.id;
  }
  void expect_refused(const BusJob& o) { EXPECT_EQ(arbiter.submit(o, now).code, Errc::queue_full); }
  /// Who gets the wire next; 0 for a poll. The exchange is over at once.
  std::optional<JobId> exchange() {
    const auto grant = arbiter.next(now);
    if (!grant) return std::nullopt;
    granted_drive = grant->drive;
    arbiter.exchange_over(now);
    return grant->id;
  }
  /// A bus job of one exchange from grant to end.
  std::optional<JobId> serve() {
    const auto id = exchange();
    if (id) arbiter.finish(*id);
    return id;
  }
  std::vector<Arbiter::Ending> endings() {
    std::vector<Arbiter::Ending> all;
    while (const auto ending = arbiter.take_ending(now)) all.push_back(*ending);
    return all;
  }

  Arbiter arbiter{kDrives};
  Instant now = Instant{} + 1h;
  DriveSlot granted_drive = 0;
};

}  // namespace axisgate::test
