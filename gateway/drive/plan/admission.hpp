// SPDX-License-Identifier: Apache-2.0
// Admission: what can be judged of a write batch before it is queued (design 3.3 Outcomes). Pure.
// Promises that a write batch it lets pass asks only for what this drive has, within the limits of axis, profile and
// drive. Never looks at the state of the motion: that is judged when the write batch's turn has come.
#pragma once

#include "adapters/bus/bus_job.hpp"
#include "gateway/drive/state/axis_core.hpp"
#include "gateway/image/command.hpp"

namespace axisgate::drive {

/// ok, not_supported, bad_value, or still_in_setup where the drive has not reported yet what it needs to be judged.
[[nodiscard]] Errc admit(const AxisCore& core, const WriteBatch& batch);
/// The number nearest to what a write batch asks for that its row would take, where it is beyond a limit.
struct PassedLimit {
  Kind kind = Kind::code;
  std::int64_t limit = 0;
};
/// None: no limit stands against it.
[[nodiscard]] std::optional<PassedLimit> passed_limit(const AxisCore& core, const WriteBatch& batch);

/// Of a write batch that was refused with not_supported or bad_value, here or at its turn: the first row of the
/// register map that is refused so by itself, or with the one that it is checked with; else the one that asks for the
/// action. No value with any other code.
[[nodiscard]] std::optional<std::uint16_t> refused_row(const AxisCore& core, const WriteBatch& batch, Errc code);
/// The write batch reads an object and does nothing else.
[[nodiscard]] bool reads_alone(const WriteBatch& batch);
/// Its controlword is a stop by design 3.4.
[[nodiscard]] bool stops_by_word(const WriteBatch& batch);
/// The write batch holds a stop by design 3.4.
[[nodiscard]] bool holds_stop(const WriteBatch& batch);
/// The write batch holds a stop and nothing else.
[[nodiscard]] bool stops_alone(const WriteBatch& batch);
/// The same, or it ends a jog, which is a stop where there is one: it passes where only stops do.
[[nodiscard]] bool stops_at_most(const WriteBatch& batch);
/// The write batch asks for operation_enabled, by command or controlword.
[[nodiscard]] bool asks_to_enable(const WriteBatch& batch);
/// Likewise for a fault_reset.
[[nodiscard]] bool resets_fault(const WriteBatch& batch);
/// To enable, or for what an axis must be enabled for.
[[nodiscard]] bool asks_to_begin(const WriteBatch& batch);
/// What is left of a write batch that holds a stop when everything else is taken out of it.
[[nodiscard]] WriteBatch stop_alone(const WriteBatch& batch);
/// The stop latches the axis: quick_stop, by command, controlword, or because this drive has no other halt.
[[nodiscard]] bool stop_latches(const AxisCore& core, const WriteBatch& batch);
/// The write batch starts a motion: target_reached reads 0 until it has its result.
[[nodiscard]] bool starts_motion(const AxisCore& core, const WriteBatch& batch);
/// A mailbox write of an object that a quantity uses becomes a write of that quantity, with its limits, latch and
/// edges; bad_value where it cannot stand for one.
struct Translated {
  WriteBatch batch;
  Errc code = Errc::ok;
};
[[nodiscard]] Translated as_quantities(const AxisCore& core, const WriteBatch& batch);
/// What the arbiter must know of the write batch.
[[nodiscard]] bus::BusJob job_for(const AxisCore& core, const WriteBatch& batch, bool stop);

}  // namespace axisgate::drive
