// SPDX-License-Identifier: Apache-2.0
// What a client can ask of an axis: the one-shot commands of design 3.4 and the write batch, all writes of one request
// together. Promises that both servers, Modbus and DDS, ask in the same words. Never holds raw drive values, but for
// the object mailbox.
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/core/bytes.hpp"
#include "gateway/core/clock.hpp"
#include "gateway/core/error.hpp"
#include "gateway/image/axis_image.hpp"
#include "gateway/image/lease.hpp"

namespace axisgate {

enum class Command : std::uint8_t {
  none = 0,
  enable = 1,
  disable = 2,
  quick_stop = 3,
  halt = 4,
  fault_reset = 5,
  move_absolute = 6,
  move_relative = 7,
  run_velocity = 8,
  run_torque = 9,
  home = 10,
  set_position = 11,
  save_parameters = 12,
  release = 13,
  take_over = 14,
  // Coils alone; never a register value, never in supported_commands.
  end_halt = 30,     ///< coil 3 going 1 -> 0
  jog_forward = 31,  ///< coil 8 going 0 -> 1
  jog_reverse = 32,  ///< coil 9 going 0 -> 1
  jog_end = 33,      ///< coil 8 or 9 going 1 -> 0, or both at 1: a halt where the axis jogs, else nothing
  end_run = 34,      ///< coil 7 going 1 -> 0: a halt where run_velocity runs, else nothing
};
inline constexpr std::uint16_t kLastCommand = 14;
[[nodiscard]] std::string_view text(Command command);
[[nodiscard]] constexpr bool is_stop(Command c) {
  return c == Command::disable || c == Command::quick_stop || c == Command::halt;
}
/// Enable voltage and, inverted, quick stop: a raw controlword with one of them 0 is anybody's stop.
inline constexpr std::uint16_t kStoppingBits = 0x0006;
/// A raw controlword that is a stop by design 3.4: bit 1 = 0 or bit 2 = 0 always; bits 0..3 = 6 or 7 only in a single
/// write.
[[nodiscard]] constexpr bool is_stop(std::uint16_t controlword, bool single_write) {
  constexpr unsigned kRequest = 0x0F, kShutdown = 0x06, kSwitchOn = 0x07;
  if ((controlword & kStoppingBits) != kStoppingBits) return true;
  const unsigned request = controlword & kRequest;
  return single_write && (request == kShutdown || request == kSwitchOn);
}
/// Commands 6 to 10 start a motion.
[[nodiscard]] constexpr bool starts_motion(Command c) { return c >= Command::move_absolute && c <= Command::home; }
/// Commands 6 to 11 need an axis that is enabled, not faulted and not stop-latched.
[[nodiscard]] constexpr bool needs_ready(Command c) { return starts_motion(c) || c == Command::set_position; }
/// A button is pressed.
[[nodiscard]] constexpr bool is_jog(Command c) { return c == Command::jog_forward || c == Command::jog_reverse; }
/// A command, or a button's press: it asks the axis to move.
[[nodiscard]] constexpr bool asks_to_move(Command c) { return starts_motion(c) || is_jog(c); }
/// A stop, or what is one where it ends a motion: coil 7 released in a run, coil 8 or 9 of a jog (design 3.4 Stops).
[[nodiscard]] constexpr bool asks_to_stop(Command c) {
  return is_stop(c) || c == Command::jog_end || c == Command::end_run;
}
/// What a start moves to, or runs with; none: it is no such command.
[[nodiscard]] std::optional<Quantity> target_of(Command command);
/// The coil of that button; it reads back which way the axis jogs.
[[nodiscard]] constexpr unsigned jog_coil(Command direction) { return direction == Command::jog_forward ? 8 : 9; }
/// They change whose the axis is, and ask nothing of it.
[[nodiscard]] constexpr bool hands_over(Command c) { return c == Command::release || c == Command::take_over; }

[[nodiscard]] std::string_view text(Role role);

/// The object mailbox (registers 80..88) and FC 43/13.
struct ObjectRequest {
  bool write = false;
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;
  std::uint8_t size = 0;  ///< bytes: 1, 2 or 4. 0 in a read: all there are; in a write: `bytes`
  std::uint32_t data = 0;
  /// Of a read with size 0, where the protocol knows no sizes (Modbus RTU): bytes wanted, 0: 2.
  std::uint16_t count = 0;
  ObjectBytes bytes{};  ///< of a write with size 0: 1 to kMaxObjectBytes
};

struct Setpoint {
  Quantity quantity;
  std::int64_t value;                   ///< in register units
  std::optional<std::int64_t> exact{};  ///< as the drive counts, where the object mailbox gave it so
  /// It asks only because a command acts in the same request: where that is refused, it is not accepted either.
  bool with_command = false;
};

/// All writes of one request to one axis. Run in this order: setpoints, mode, controlword, command, object.
struct WriteBatch {
  ClientId client = 0;
  Role role = Role::viewer;
  /// Who asks; none: the gateway itself, which owns nothing and is refused nothing.
  std::shared_ptr<const ClientLife> life{};
  /// The request asks for something that makes its client the owner (design 3.5: offsets 40..79, coils 4..9, coil 0 =
  /// 1, a mailbox or 43/13 write).
  bool claims = false;
  /// A write of any kind, for an axis that waits for its client: an orphan lease of its own origin and role is taken
  /// over by it, whatever it asks. A write batch that asks for nothing is submitted for this, and for its sign of life,
  /// alone.
  bool reclaims = false;
  bool all_zero = false;    ///< a block of nothing but zeros: it takes over no adopted axis
  bool zero_speed = false;  ///< registers 40 to 54, all 0: its owner's run, on or asked for, goes on with target 0
  bool renews = true;       ///< false: it was written too long ago to be a sign of life
  bool beats = false;       ///< register 56 was written with another value than before
  /// In register order; quantities but mode and controlword, each at most once.
  boost::container::static_vector<Setpoint, kQuantityCount> setpoints;
  std::optional<std::int16_t> mode;
  std::optional<std::uint16_t> controlword;
  /// The controlword stands alone in its request: only then do its stop bits count from a client that does not own the
  /// axis.
  bool single_controlword = false;
  Command command = Command::none;
  bool jogs = false;     ///< run_velocity for a button: its speed is the jog's, and no client's target
  bool latches = false;  ///< a lease's action: its stop latches the axis, whichever it is (design 3.4)
  /// Row 78; the axis keeps it (gateway's own, 0 at start).
  std::optional<std::int32_t> set_position_value;
  std::optional<std::uint32_t> jog_velocity{};  ///< row 58; the axis keeps it (gateway's own, 0 at start)
  std::optional<Command> jog_again{};           ///< jog_forward or jog_reverse: its coil was written 1 once more
  std::optional<ObjectRequest> object;
  std::uint16_t command_id = 0;
  Instant start_by = kNever;   ///< not begun by then: never_started
  Instant answer_by = kNever;  ///< begun, not acknowledged by then: timed_out
};

/// The write batch asks for nothing to be done: it is submitted for its client's ownership alone, and leaves the
/// client's result registers as they are.
[[nodiscard]] bool asks_nothing(const WriteBatch& batch);

/// What the write batch is about, in one name: its command, else what of it comes last ("controlword", "mode",
/// "profile_velocity", "object"); empty: it asks for nothing.
[[nodiscard]] std::string_view subject_of(const WriteBatch& batch);

/// The stop that a lease's action is; none: nothing is done.
[[nodiscard]] constexpr Command command_of(LeaseAction action) {
  switch (action) {
    case LeaseAction::quick_stop:
      return Command::quick_stop;
    case LeaseAction::halt:
      return Command::halt;
    case LeaseAction::disable:
      return Command::disable;
    case LeaseAction::none:
      break;
  }
  return Command::none;
}

struct BatchResult {
  Outcome outcome;
  std::uint32_t object_data = 0;  ///< of an object read, up to 4 bytes
  std::uint8_t object_size = 0;   ///< bytes of it; 0: `object_bytes`
  ObjectBytes object_bytes{};     ///< of an object read with size 0 that is longer
  /// Of an object request that the drive refused: the reason as a CiA 301 abort code, whatever the drive speaks
  /// (`outcome.detail` is what it said itself).
  std::uint32_t abort_code = 0;
  /// Of a write batch that asks for what is not there or not allowed (not_supported, bad_value): the first row that
  /// this is of, by its offset in the axis's block of registers.
  std::optional<std::uint16_t> refused_row{};
  std::string limit{};            ///< of bad_value: the limit that stands against it, "3 rpm"; empty: none
  bool controlword_done = false;  ///< of a write batch that failed: its controlword was carried out before
  bool command_sent = false;      ///< something was written for its command, or for a controlword that was not done
  std::uint64_t stop = 0;         ///< of a stop: its number on its axis, from 1 on
};

}  // namespace axisgate
