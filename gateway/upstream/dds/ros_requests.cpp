// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/ros_requests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "gateway/image/register_map.hpp"
#include "gateway/image/shown.hpp"
#include "gateway/upstream/dds/command_batches.hpp"
#include "gateway/upstream/dds/dds_session.hpp"
#include "gateway/upstream/dds_link/ros_names.hpp"

namespace axisgate::dds {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kTooOld =
    "ros2: a sample is older than max_age_ms, or as far ahead of this clock, or this gateway came to it later than "
    "start_deadline_ms: it is no sign of life, and starts nothing";
constexpr Duration kToldAgainAfter = std::chrono::minutes(1);

/// Why a sample cannot be meant as it stands; empty: it can.
std::string wrong_with(const JointCommandsRecord& record) {
  const std::size_t joints = record.names.size();
  if (joints > kMaxJoints) return fmt::format("it names more than {} joints", kMaxJoints);
  const auto fits = [&](std::size_t count) { return count == 0 || count == joints; };
  if (!fits(record.positions.size()) || !fits(record.velocities.size()) || !fits(record.efforts)) {
    return fmt::format(
        "it names {} joints, with {} positions, {} velocities and {} efforts: each list has as many numbers as there "
        "are names, or none (give all joints the same command interfaces)",
        joints, record.positions.size(), record.velocities.size(), record.efforts);
  }
  const auto infinite = [](double value) { return std::isinf(value); };
  if (std::ranges::any_of(record.positions, infinite) || std::ranges::any_of(record.velocities, infinite))
    return "a number in it is infinite";
  std::set<std::string_view> seen;
  for (const std::string& name : record.names)
    if (!name.empty() && !seen.insert(name).second) return fmt::format("it names {} twice", name);
  return {};
}

/// None: a number that is no action.
Command command_of(RosAction action) {
  constexpr std::array kCommands{Command::enable, Command::disable, Command::quick_stop, Command::fault_reset,
                                 Command::home};  // in the order of the actions
  const auto number = static_cast<std::size_t>(action);
  return number < kCommands.size() ? kCommands[number] : Command::none;
}

/// A motion is on that a stream may have asked for.
bool streamed_motion(const AxisImage& axis) {
  return velocity_runs(axis) || axis.axis_state == AxisState::discrete_motion ||
         axis.axis_state == AxisState::continuous_motion;
}

/// It is not so already.
bool changes(Command command, const AxisImage& axis) {
  if (command == Command::enable) return !axis.has(AxisInput::enabled);
  return command != Command::fault_reset || axis.has(AxisInput::fault);
}

}  // namespace

RosRequests::Joint& RosRequests::joint_of(AxisNumber axis) {
  Joint& joint = joints_[axis];
  if (joint.life == nullptr) {
    joint.life = std::make_shared<ClientLife>();
    joint.life->id = kFirstRosClient + axis;
    // Whose sample may move it is judged before; none needs more.
    joint.life->role = std::max(with_.settings.role, Role::operator_);
    // No participant has this GUID prefix: nobody is of the same hand.
    joint.life->origin = {'r', 'o', 's', '2', static_cast<std::uint8_t>(axis >> 8U), static_cast<std::uint8_t>(axis)};
    joint.life->name = "ros2";
    joint.life->strength = 0;
  }
  return joint;
}

JointView RosRequests::view_of(const AxisImage& axis, const Joint& joint) const {
  const bool good = axis[Quantity::position_actual].valid;
  const double position =
      with_.units_of(axis.number).to_si(Quantity::position_actual, shown_value(axis, Quantity::position_actual));
  // An angle of the motor: on an axis in metres, the way that it is there.
  const double tolerance = with_.settings.sync_tolerance / (2 * std::numbers::pi) * with_.units_of(axis.number).turn();
  return joint_view(axis, good ? position : kNan, tolerance, joint.life->id);
}

std::map<std::string_view, const AxisImage*> RosRequests::axes_by_name() const {
  std::map<std::string_view, const AxisImage*> out;
  for (const auto& axis : with_.image.axes()) out.emplace(axis->name, axis.get());
  return out;
}

// `renews`: before anybody knows whether it is refused.
WriteBatch RosRequests::new_batch(const Joint& joint, bool renews) const {
  WriteBatch batch;
  batch.client = joint.life->id;
  batch.role = joint.life->role;
  batch.life = joint.life;
  batch.reclaims = true;
  batch.renews = batch.beats = renews;
  batch.start_by = joint.newest + with_.settings.start_deadline;
  batch.answer_by = joint.newest + with_.settings.reply_deadline;
  return batch;
}

// A sign of life of then.
void RosRequests::heard(const AxisImage& axis, Joint& joint, Instant then) {
  joint.life->last_request = joint.life->heartbeat = std::max(joint.life->last_request, then);
  // A repetition asks for nothing anew, but its owner writes all the same.
  if (axis.lease.owned_by(joint.life->id) && axis.lease.rules.renew == LeaseRenewal::write)
    submit_alone(axis.number, new_batch(joint, true));
}

void RosRequests::on_link_down(Instant now) {
  for (auto& [axis, joint] : joints_) joint.life->grace = {kGrace, now};
}

void RosRequests::complain(const std::string& line, Instant now) {
  const auto told = complaints_.find(line);
  if (!with_.tell || (told != complaints_.end() && now - told->second < kToldAgainAfter) || !lines_.takes(now)) return;
  if (complaints_.size() >= kMaxComplaints) complaints_.clear();
  complaints_[line] = now;
  with_.tell(line + left_out_text(lines_.left_out()));
}

// --- joint_commands --------------------------------------------------------------------------------------------------

void RosRequests::on_joint_commands(const JointCommandsRecord& record, Instant now) {
  if (!with_.settings.commands || identities_.role_of(record.writer) < Role::operator_) return;
  if (!with_.signs.fresh(record.written, record.received, now)) return complain(kTooOld, now);
  if (const std::string wrong = wrong_with(record); !wrong.empty())
    return complain("a sample of joint_commands is refused as a whole: " + wrong, now);
  const auto axes = axes_by_name();
  for (std::size_t i = 0; i < record.names.size(); ++i) {
    const auto axis = axes.find(record.names[i]);
    if (axis == axes.end()) {
      complain(fmt::format("joint_commands names '{}', and there is no axis of this name: its numbers are left out",
                           record.names[i]),
               now);
      continue;
    }
    const auto number = [&](const std::vector<double>& from) { return i < from.size() ? from[i] : kNan; };
    take_target(*axis->second, number(record.positions), number(record.velocities), record, now);
  }
}

void RosRequests::take_target(const AxisImage& axis, double position, double velocity, const JointCommandsRecord& from,
                              Instant now) {
  const bool is_velocity = std::isnan(position);
  if (is_velocity && std::isnan(velocity)) return;  // it leaves this axis alone, and is no sign of life for it
  Joint& joint = joint_of(axis.number);
  joint.newest = now;
  if (with_.stop_order.overtaken(axis.number, from.received)) return;
  const auto value = with_.units_of(axis.number)
                         .to_register(is_velocity ? Quantity::target_velocity : Quantity::target_position,
                                      is_velocity ? velocity : position);
  if (!value) {
    return complain(fmt::format("joint_commands asks {} for {:.6g}, which no register holds", axis.name,
                                is_velocity ? velocity : position),
                    now);
  }
  const JointView view = view_of(axis, joint);
  const auto target = joint.stream.on_sample(from.writer, {is_velocity, *value}, position, view);
  if (joint.stream.take_astray()) {
    complain(is_velocity
                 ? fmt::format("joint_commands asks {} for the velocity {:.6g}: it acts once it was 0 (the axis was "
                               "enabled or stopped, or another node writes)",
                               axis.name, velocity)
                 : fmt::format("joint_commands asks {} for {:.6g}, and it is at {:.6g}: positions act once they were "
                               "within {:.3g} of the axis (sync_tolerance)",
                               axis.name, position, view.position, view.tolerance),
             now);
  }
  if (joint.stream.take_leaving() && (joint.stream.busy() || streamed_motion(axis))) halt(axis.number, joint);
  // What does not act says nothing of the program whose stream moves the motor. Where none does, it keeps the torque.
  if (joint.stream.follows()) joint.followed = now;
  if (target) return ask(axis.number, target);
  if (joint.stream.follows() || !streamed_motion(axis)) heard(axis, joint, now);
}

void RosRequests::halt(AxisNumber axis, const Joint& joint) {
  WriteBatch batch = new_batch(joint, false);
  batch.command = Command::halt;
  submit_alone(axis, batch);
}

WriteBatch RosRequests::batch_of(const AxisImage& axis, const Joint& joint, const JointTarget& target) const {
  WriteBatch batch = new_batch(joint, false);
  batch.claims = true;
  batch.setpoints.push_back({target.is_velocity ? Quantity::target_velocity : Quantity::target_position, target.value});
  // While it runs, a new velocity acts by itself.
  if (!target.is_velocity || !velocity_runs(axis))
    batch.command = target.is_velocity ? Command::run_velocity : Command::move_absolute;
  return batch;
}

// Until one waits for the drive: the callback goes on from there.
void RosRequests::ask(AxisNumber number, std::optional<JointTarget> target) {
  while (target) {
    const AxisImage* const axis = with_.image.find(number);
    if (axis == nullptr) return;
    Joint& joint = joint_of(number);
    const WriteBatch batch = batch_of(*axis, joint, *target);
    if (with_.namesakes.taken() && batch.command != Command::none) return refuse_start(*axis, joint);
    const auto at_once =
        with_.commands.submit(number, batch, [self = std::weak_ptr(self_), number](const BatchResult& result) {
          const auto here = self.lock();
          if (here == nullptr) return;
          const AxisImage* const there = here->with_.image.find(number);
          if (there == nullptr) {
            here->joints_.erase(number);
            return;
          }
          here->ask(number, here->take_result(*there, result.outcome.code));
        });
    if (!at_once) return;
    target = take_result(*axis, at_once->outcome.code);
  }
}

// The axis has another gateway beside this one. Its stream must come into step anew: where it is by the time that the
// name is free nobody knows. Whoever asks a run for a position does not ask for the run any more.
void RosRequests::refuse_start(const AxisImage& axis, Joint& joint) {
  joint.stream.restart();
  static_cast<void>(joint.stream.on_result(Errc::never_started, view_of(axis, joint)));
  if (velocity_runs(axis)) halt(axis.number, joint);
  complain(fmt::format("joint_commands starts nothing on {}: {} has our name", axis.name, with_.namesakes.text()),
           joint.newest);
}

std::optional<JointTarget> RosRequests::take_result(const AxisImage& axis, Errc code) {
  Joint& joint = joint_of(axis.number);
  if (code == Errc::ok) heard(axis, joint, joint.followed);
  return joint.stream.on_result(code, view_of(axis, joint));
}

void RosRequests::submit_alone(AxisNumber axis, const WriteBatch& batch) {
  static_cast<void>(with_.commands.submit(axis, batch, [](const BatchResult&) {}));
}

// --- The topics of one axis ------------------------------------------------------------------------------------------

void RosRequests::on_action(const RosActionRecord& record, Instant now) {
  const Command command = command_of(RosAction{record.action});
  const AxisImage* const axis = with_.image.find(record.axis);
  if (!with_.settings.commands || identities_.role_of(record.writer) < Role::operator_) return;
  if (axis == nullptr || command == Command::none) return;
  if (!axis->supports(command))
    return complain(fmt::format("ros2: {} of {}: this drive cannot do it", text(command), axis->name), now);
  const bool starts = command == Command::enable || command == Command::home;
  const bool fresh = with_.signs.fresh(record.written, record.received, now);
  if (!is_stop(command) && !fresh) return complain(kTooOld, now);
  if (starts && with_.namesakes.taken())
    return complain(
        fmt::format("ros2: {} of {} is refused: {} has our name", text(command), axis->name, with_.namesakes.text()),
        now);
  if (is_stop(command)) {
    with_.stop_order.stopped(record.axis, record.received);
  } else if (with_.stop_order.overtaken(record.axis, record.received)) {
    return complain(
        fmt::format("ros2: {} of {}: a stop that came after it was carried out first", text(command), axis->name), now);
  }
  // A stop is carried out whatever its age. What is old, asks for what is so already, or is refused, says nothing of
  // the program that keeps a motor running.
  const bool acts = changes(command, *axis);
  Joint& joint = joint_of(record.axis);
  joint.newest = now;
  if (command == Command::home) return home(record.axis, joint, now);
  const bool renews = acts && fresh;
  if (renews) heard(*axis, joint, now);
  if (!is_stop(command) && acts) joint.stream.restart();
  WriteBatch batch = new_batch(joint, renews);
  batch.command = command;
  batch.claims = !is_stop(command);
  submit_alone(record.axis, batch);
}

// One that is refused leaves the stream that moves the motor as it is.
void RosRequests::home(AxisNumber number, Joint& joint, Instant now) {
  WriteBatch batch = new_batch(joint, false);
  batch.command = Command::home;
  batch.claims = true;
  const auto done = [self = std::weak_ptr(self_), number, now](const BatchResult& result) {
    const auto here = self.lock();
    const AxisImage* const axis = here == nullptr ? nullptr : here->with_.image.find(number);
    if (axis != nullptr && result.outcome.code == Errc::ok) here->heard(*axis, here->joint_of(number), now);
  };
  const auto at_once = with_.commands.submit(number, batch, done);
  if (at_once) done(*at_once);
  if (!at_once || at_once->outcome.code == Errc::ok) joint.stream.restart();
}

}  // namespace axisgate::dds
