// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/commands/try_rig.hpp"

namespace axisgate::commands {
namespace {

enum : model::ObjectId { statusword, position, velocity, heartbeat };

model::ObjectDef object(const char* name, std::uint16_t index, std::uint8_t size, bool is_signed) {
  model::ObjectDef out;
  out.name = name;
  out.address = {index, 0};
  out.size = size;
  out.is_signed = is_signed;
  return out;
}

constexpr double kLook = 0.02;  // s
constexpr double kRamp = 60;    // rpm/s

}  // namespace

TrialRig::TrialRig() {
  drive_.protocol = "canopen";
  drive_.objects = {object("statusword", 0x6041, 2, false), object("position_actual", 0x6064, 4, true),
                    object("velocity_actual", 0x606C, 4, true), object("producer_heartbeat", 0x1017, 2, false)};
  drive_.setup = {{heartbeat, 1000, ""}};
  drive_.canopen.own_heartbeat = 500 * kMs;
  drive_.loss_after = 1500 * kMs;
  model::AxisModel axis;
  axis.number = 4;
  axis.statusword = statusword;
  axis.state_sources = {statusword};
  axis.binding_of.fill(-1);
  drive_.axes = {axis};
  for (const Quantity quantity : {Quantity::position_actual, Quantity::velocity_actual, Quantity::target_position,
                                  Quantity::target_velocity, Quantity::profile_velocity})
    image_.supported |= bit(quantity);
  for (const Quantity quantity : {Quantity::target_position, Quantity::target_velocity, Quantity::profile_velocity})
    image_.writable |= bit(quantity);
  for (Range& limit : image_.limits) limit = {-1000000000, 1000000000};
  for (int command = 1; command <= kLastCommand; ++command) image_.supported_commands |= 1U << command;
  image_.units_per_rev = Rational(kCounts);
  image_.link_state = LinkState::online;
}

void TrialRig::begin(TryArguments arguments) {
  arguments.axis = 4;
  plan_.emplace(drive_, AxisSlot{0}, arguments, now_);
}

void TrialRig::show() {
  const auto sample = [this](Quantity quantity, double value) {
    image_[quantity] = {static_cast<std::int64_t>(std::llround(value)), true, answers_ && !flaws_.no_units,
                        answers_ ? now_ : image_[quantity].at};
  };
  sample(Quantity::position_actual, turned_ * kCounts * flaws_.counts * flaws_.shown_position);
  sample(Quantity::velocity_actual, rpm_ / flaws_.speed * flaws_.shown_velocity * 1000);
  image_.inputs = enabled_ ? bit(AxisInput::enabled) : std::uint16_t{0};
  if (latched_) image_.inputs = static_cast<std::uint16_t>(image_.inputs | bit(AxisInput::quick_stop_active));
  image_.link_state = answers_ ? LinkState::online : LinkState::offline;
}

void TrialRig::turn() {
  if (now_ >= loss_at_ && !sees_heartbeats_ && !flaws_.ignores_loss) target_rpm_ = 0;
  if (flaws_.creeps && enabled_) turned_ += 0.0002;
  if (!enabled_) target_rpm_ = 0;
  const double change = std::clamp(target_rpm_ - rpm_, -kRamp * kLook, kRamp * kLook);
  rpm_ = std::abs(flaws_.speed) > 1 || goal_ ? target_rpm_ : rpm_ + change;
  double by = rpm_ / 60 * kLook;
  if (goal_ && std::abs(*goal_ - turned_) <= std::abs(by)) {
    by = *goal_ - turned_;
    rpm_ = target_rpm_ = 0;
    goal_.reset();
    image_.motion_state = MotionState::completed;
  }
  turned_ += by;
  fastest_ = std::max(fastest_, std::abs(rpm_));
}

void TrialRig::obey(const Write& write, std::uint16_t id) {
  ++writes_;
  const auto asked = [&](Quantity quantity) {
    for (const Setpoint& setpoint : write.setpoints)
      if (setpoint.quantity == quantity) return static_cast<double>(setpoint.value);
    return 0.0;
  };
  if (write.command == Command::none) return;
  commands_.push_back(write.command);
  if (write.command == Command::enable) enabled_ = true;
  if (write.command == Command::quick_stop) latched_ = true;
  if (write.command == Command::enable) latched_ = false;
  if (write.command == Command::disable) enabled_ = false;
  if (is_stop(write.command) && (!flaws_.stops_nothing || write.command == Command::disable)) {
    target_rpm_ = 0;
    goal_.reset();
  }
  if (!starts_motion(write.command)) return;
  image_.motion_id = id;
  image_.motion_state = MotionState::active;
  if (write.command == Command::run_velocity) {
    target_rpm_ = asked(Quantity::target_velocity) / 1000 * flaws_.speed;
  } else {
    const double by = asked(Quantity::target_position) / kCounts / flaws_.counts;
    goal_ = turned_ + by;
    target_rpm_ = std::copysign(10, by) * flaws_.speed;
  }
}

void TrialRig::carry_out(const TryOrder& order) {
  orders_.push_back(order.kind);
  if (order.kind == TryOrder::Kind::withhold) {
    sees_heartbeats_ = false;
    loss_at_ = now_ + drive_.loss_after;
  }
  if (order.kind == TryOrder::Kind::resume) sees_heartbeats_ = true;
  BatchResult result;
  if (order.kind == TryOrder::Kind::read) {
    const model::ObjectId id = drive_.find({order.object.index, order.object.subindex});
    result.object_size = drive_.object(id).size;
    result.object_data = id == heartbeat ? 1000 : 0;
  }
  if (order.kind == TryOrder::Kind::write && answers_) obey(order.write, order.id);
  if (!answers_) result.outcome = {Errc::offline, 0};
  plan_->on_result(order.id, result);
}

void TrialRig::step() {
  now_ += 20 * kMs;
  if (answers_) turn();
  show();
  TryLook look{image_, static_cast<std::uint32_t>(std::llround(turned_ * kCounts))};
  if (!raw_positions_.empty()) look.raw_position = raw_positions_.front();
  plan_->on_look(look, now_);
  while (const auto order = plan_->take_order()) carry_out(*order);
  for (std::string& line : plan_->take_words()) words_.push_back(std::move(line));
}

void TrialRig::until_asked() {
  for (int i = 0; i < 100000 && plan_->asks() == 0 && !plan_->over(); ++i) step();
}

void TrialRig::until_over() {
  for (int i = 0; i < 100000 && !plan_->over(); ++i) step();
  EXPECT_TRUE(plan_->over());
}

void TrialRig::say(std::optional<std::string> line) {
  plan_->on_line(std::move(line));
  step();
}

void TrialRig::go_on(TryStep last) {
  const std::string end = "\"4 " + std::string(text(last)) + "\"";
  for (until_asked(); !plan_->over(); until_asked()) {
    const std::string asked = words_.back();
    if (asked.find(end) != std::string::npos) return;
    if (const std::size_t at = asked.find("type \""); at != std::string::npos)
      say(asked.substr(at + 6, asked.find('"', at + 6) - at - 6));
    else
      say(asked.find("yes or no") != std::string::npos ? "yes" : "skip");
  }
}

std::string TrialRig::saw(TryStep step) const {
  std::string out;
  for (const std::string& line : const_cast<TryPlan&>(*plan_).report().of(step).saw) out += line + "\n";
  return out;
}

}  // namespace axisgate::commands
