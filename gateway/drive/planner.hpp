// The planners: what each part of a group comes to on this axis, now (design 3.3 and 3.4). Pure: rules and facts in, a plan out.
// Promise that no plan moves the axis unless a start was asked for, and that a set-point the drive is known to hold is not
// sent again. Never carry a plan out: the conversation does.
#pragma once

#include "gateway/drive/action.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::drive {

/// Parameters and set-points. Targets are remembered in the motion rules even where they may not reach the drive now.
[[nodiscard]] Plan plan_setpoints(AxisCore& core, const Group& group);
/// A raw mode write, or the mode a command needs: writes it and waits for the display.
[[nodiscard]] Plan plan_mode(const AxisCore& core, std::int16_t mode);
/// A raw controlword that is no stop.
[[nodiscard]] Plan plan_controlword(const AxisCore& core, std::uint16_t controlword);
/// What must be so before a command's own actions are planned: the halt ended, the mode it needs in force.
[[nodiscard]] Plan plan_preparation(const AxisCore& core, Command command);
/// Commands that are no stops, once prepared. `mode_before`: the mode in force before the preparation.
[[nodiscard]] Plan plan_command(const AxisCore& core, Command command, int mode_before);
/// Commands 2, 3, 4: what removes torque or motion, then the state that shows it.
[[nodiscard]] Plan plan_stop(const AxisCore& core, Command command);
/// A raw controlword that is a stop.
[[nodiscard]] Plan plan_stop_controlword(const AxisCore& core, std::uint16_t controlword);
/// Halt on this drive in the mode in force is carried out by quick_stop.
[[nodiscard]] bool halt_is_quick_stop(const AxisCore& core);

/// What must be written before a halt may end: velocity and torque 0, target = actual, then the controlword without bit 8.
void add_end_of_halt(const AxisCore& core, Plan& plan);
/// Appends the profile's steps.
void add_steps(const AxisCore& core, const Steps& steps, Plan& plan);
/// Writes the quantity's value unless the drive is known to hold it. False where it cannot be had in the drive's numbers.
[[nodiscard]] bool add_write(const AxisCore& core, Quantity quantity, std::int64_t value, Plan& plan);
/// Makes velocity and torque set-points in the drive 0 unless they are known to be.
void add_zero_targets(const AxisCore& core, Plan& plan);
/// The steps of a command in the mode in force, or null where the drive has none.
[[nodiscard]] const Steps* steps_of(const AxisCore& core, Command command);

}  // namespace axisgate::drive
