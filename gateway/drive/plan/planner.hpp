// SPDX-License-Identifier: Apache-2.0
// The planners: what each part of a write batch comes to on this axis, now (design 3.3 and 3.4). Pure: rules and facts
// in, a plan out. Promise that no plan moves the axis unless a start was asked for, that no stop enables it, and that a
// set-point the drive is known to hold is not sent again. Never carry a plan out: the command sequence does.
#pragma once

#include "gateway/drive/plan/action.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::drive {

// --- Parameters, set-points and mode ---------------------------------------------------------------------------------

/// Rows 72 to 75 are checked as a pair: what is written against what is written with it, or else cached.
[[nodiscard]] bool limits_in_order(const AxisCore& core, const WriteBatch& batch);
/// Where the axis may be sent: within the limits of axis and profile, and those that the drive holds, as far as they
/// are known, or is written in the same write batch. 0 and 0 is how drives are set to have none.
[[nodiscard]] Range position_range(const AxisCore& core, const WriteBatch& batch = {});
/// Parameters and set-points: those that may reach the drive now.
[[nodiscard]] Plan plan_setpoints(const AxisCore& core, const WriteBatch& batch);
/// The turn of these set-points has come: starts go by them, even where they may not reach the drive now.
void remember_setpoints(AxisCore& core, const WriteBatch& batch);
/// The mode a command needs: writes it and waits for the display.
[[nodiscard]] Plan plan_mode(const AxisCore& core, std::int16_t mode);
/// A mode that a client writes: as plan_mode(), and nothing the drive holds from before moves it.
[[nodiscard]] Plan plan_raw_mode(const AxisCore& core, std::int16_t mode);
/// Parameters, set-points and mode alone, and the drive is known to hold them all: the wire is not needed.
[[nodiscard]] bool nothing_to_send(const AxisCore& core, const WriteBatch& batch);

// --- Starts --------------------------------------------------------------------------------------------------------

/// A raw controlword that is no stop. `command_follows`: in the same write batch, and is planned from what the word has
/// led to.
[[nodiscard]] Plan plan_controlword(const AxisCore& core, std::uint16_t controlword, bool command_follows);
/// A raw controlword that starts a motion, in a mode that has starts, of an axis that is enabled then, or not.
[[nodiscard]] bool word_starts(const AxisCore& core, std::uint16_t controlword, bool enabled);
/// What must be so before a command's own actions are planned: the halt ended, the mode it needs in force.
[[nodiscard]] Plan plan_preparation(const AxisCore& core, Command command);
/// What an axis that is shared with this one says of a command which acts on both.
[[nodiscard]] Errc judge_shared(const AxisCore& core, Command command);
/// A start that the axis's state refuses now: the set-points that came with it are not accepted either (design 3.3 What
/// asks and what claims).
[[nodiscard]] bool refused_by_state(const AxisCore& core, Command command);
/// Nothing of the write batch would be accepted now: it is a command that is refused, alone or beside set-points that
/// are refused with it.
[[nodiscard]] bool accepts_nothing(const AxisCore& core, const WriteBatch& batch);
/// Commands that are no stops, once prepared. `mode_before`: the mode in force before the preparation.
[[nodiscard]] Plan plan_command(const AxisCore& core, Command command, int mode_before);
/// Whether the move that a start would begin stays within the limits: bad_value where it does not.
[[nodiscard]] Errc judge_move(const AxisCore& core, bool relative);
/// Command 11: by the drive's own homing on the present position; what it needs for that is put back afterwards.
[[nodiscard]] Plan plan_set_position(const AxisCore& core, int mode_before);

// --- Stops ---------------------------------------------------------------------------------------------------------

/// The stop of a write batch: commands 2, 3, 4, a raw controlword, or both.
/// @param unheeded the drive has acknowledged it, and shows that it went on. One that begins to listen with a first
///   controlword only (its profile's setup writes it) is sent that word: it ends the torque.
[[nodiscard]] Plan plan_stop(const AxisCore& core, const WriteBatch& batch, bool unheeded = false);
/// How long a stop may take to show: a ramp at the drive's own deceleration. Meanwhile it is repeated
/// (CommandSequence).
inline constexpr Duration kStopLimit = std::chrono::seconds(5);
/// Disabled: neither operation enabled nor still in quick stop.
[[nodiscard]] model::Condition torque_off(const AxisCore& core);
/// Halt on this drive in the mode in force is carried out by quick_stop.
[[nodiscard]] bool halt_is_quick_stop(const AxisCore& core);
/// Bit 8 rises in the word, and this drive has no such halt: what its profile halts by takes its place.
[[nodiscard]] bool asks_for_missing_halt(const AxisCore& core, const WriteBatch& batch);
/// In the mode in force the axis halts by bit 8 of the controlword: its profile's halt is that bit, or it is virtual.
[[nodiscard]] bool halts_by_word(const AxisCore& core);
/// What must be written before a halt may end, and the controlword without bit 8.
/// The drive is in `mode_after` (CiA 402, unified) then, whatever mode that took meanwhile.
void add_end_of_halt(const AxisCore& core, int mode_after, Plan& plan);

// --- Virtual axes --------------------------------------------------------------------------------------------------

/// A raw controlword that is no stop, on an axis whose drive has none: its operation bits become the drive's commands.
[[nodiscard]] Plan plan_virtual_controlword(const AxisCore& core, std::uint16_t controlword);
/// The mode is the gateway's own: nothing is sent, but what runs in another one is halted before.
[[nodiscard]] Plan plan_virtual_mode(const AxisCore& core, std::int16_t mode, bool asked_for);
/// Appends the controlword in effect from now on; nothing where the drive has its own.
void add_virtual_controlword(const AxisCore& core, std::uint16_t controlword, Plan& plan);
/// The words of an enable that was carried out, also for the axes that it has enabled with this one.
void add_virtual_enable(const AxisCore& core, Plan& plan);
/// Where a set-point moves the axis by being written: what the set-point of the mode in force must be before torque
/// comes on, 0 or the present position; nothing where `steps` write it themselves.
void add_quiet_setpoint(const AxisCore& core, const model::Steps* steps, Plan& plan);

// --- Building blocks -----------------------------------------------------------------------------------------------

/// Appends another plan; false where that one is refused (its refusal becomes this plan's).
bool append(Plan& plan, Plan more);
/// The state is read, and all is planned again by it.
[[nodiscard]] Plan look_at_state(const AxisCore& core);
/// Appends the profile's steps.
void add_steps(const AxisCore& core, const model::Steps& steps, Plan& plan);
/// A directed object's way before its magnitude, and before another way a magnitude of 0: whatever of it is carried
/// out, the motor never turns the wrong way. 0 has no way. `starts`: a way that is a trigger is written also where it
/// is the same.
[[nodiscard]] std::vector<Action> with_directions(const AxisCore& core, std::vector<Action> actions, bool starts);
/// Appends the command's steps in the mode in force; false (and refused) where the drive has none.
bool add_command_steps(const AxisCore& core, Command command, Plan& plan);
/// Writes the mode, whatever is in force, and waits until the drive shows it; nothing where it is none of the drive's.
void add_mode(const AxisCore& core, int mode, Plan& plan);
/// What a motion in this mode (CiA 402, 6060h) goes by: speeds, ramps and max_torque as a client has asked for them
/// last, where the drive holds others, having restarted perhaps; and the configured limit for what it holds beyond
/// that, from its maker or another tool.
void add_speeds(const AxisCore& core, int mode, Plan& plan);
/// Nothing of it is known to be another one in the drive.
[[nodiscard]] bool holds_asked_speeds(const AxisCore& core, int mode);
/// In some mode add_speeds() looks at it.
[[nodiscard]] bool is_speed_of_motion(Quantity quantity);
/// The speeds and ramps asked for here have failed: no start goes by them.
void forget_speeds(AxisCore& core, const WriteBatch& batch);
/// The drive's constants were read: what it cannot hold any more is forgotten, and limits are for what it holds.
void rescale(AxisCore& core);
/// The drive shows another speed or ramp than was asked for, of those that it forgets with its power.
[[nodiscard]] bool has_lost_speeds(const AxisCore& core);
/// As the drive counts; none: it cannot.
[[nodiscard]] std::optional<std::int64_t> raw_of(const AxisCore& core, const model::Binding& by, const Wanted& wanted);
/// Writes the quantity's value unless the drive is known to hold it. False where it cannot be had in the drive's
/// numbers.
[[nodiscard]] bool add_write(const AxisCore& core, Quantity quantity, const Wanted& wanted, Plan& plan);
/// Makes the velocity and torque set-points in the drive 0, or, with `keep_wanted`, what was asked for since the last
/// stop; of an axis that is enabled only what was not set aside since (AxisRecord).
void add_running_targets(const AxisCore& core, bool keep_wanted, Plan& plan);
/// Makes the position set-point the actual position.
void add_target_here(const AxisCore& core, Plan& plan);
/// On this drive the write of this set-point is what moves the axis: it goes with a start, and while that runs.
[[nodiscard]] bool moves_by_write(const AxisCore& core, model::ObjectId object);
/// The set-point of this mode; none where it has none.
[[nodiscard]] std::optional<Quantity> setpoint_of_mode(int mode);
/// Position, velocity or torque: what a start goes by.
[[nodiscard]] bool is_target(Quantity quantity);
/// One object, or two at one place in the drive.
[[nodiscard]] bool same_place(const AxisCore& core, model::ObjectId a, model::ObjectId b);
/// Written to this object, the number is a controlword that takes the axis to operation enabled, or keeps it there.
[[nodiscard]] bool is_enabling_word(const AxisCore& core, model::ObjectId object, std::int64_t number);
/// The plan writes this object.
[[nodiscard]] bool writes(const Plan& plan, model::ObjectId object);
/// The steps of a command in the mode in force, or null where the drive has none.
[[nodiscard]] const model::Steps* steps_of(const AxisCore& core, Command command);
/// In the mode in force a halt is a move back to where the axis was when it was asked: it gets faster again on the way.
[[nodiscard]] bool halts_by_position(const AxisCore& core);

}  // namespace axisgate::drive
