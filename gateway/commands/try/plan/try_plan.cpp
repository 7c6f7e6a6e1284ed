// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/try/plan/try_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gateway/core/words.hpp"

namespace axisgate::commands {
namespace {

constexpr std::size_t kMostLogLines = 50;  // of a step

std::string online_text(LinkState link) {
  return fmt::format(
      "the drive does not come online ({}): is it the right device and number, the gateway stopped, the "
      "drive on?",
      text(link));
}

std::string loss_text(std::uint16_t loss_stop_ms) {
  if (loss_stop_ms == kGoesOn) return "WITHOUT A GATEWAY THE DRIVE GOES ON with what it does";
  if (loss_stop_ms == kLossNotKnown) return "whether the drive stops without a gateway is not known";
  return fmt::format("without a gateway the drive stops within {} ms, says the profile", loss_stop_ms);
}

}  // namespace

TryPlan::TryPlan(const model::DriveModel& drive, AxisSlot slot, const TryArguments& arguments, Instant now)
    : drive_(drive), axis_(drive.axes[slot]), arguments_(arguments), patience_(now + kOnlineLimit) {
  report_.axis = arguments.axis;
  report_.dry = arguments.dry;
  report_.profile = drive.profile;
  report_.title = drive.title;
  report_.protocol = drive.protocol;
}

void TryPlan::say(std::string_view text, std::size_t indent) {
  for (std::string& line : wrapped(text, indent)) words_.push_back(std::move(line));
}

void TryPlan::see(std::string_view text) {
  report_.of(step_.step).saw.emplace_back(text);
  say(fmt::format("  saw    {}", text));
}

void TryPlan::on_log(std::string line) {
  std::vector<std::string>& saw = report_.of(step_.step).saw;
  if (saw.size() < kMostLogLines) saw.push_back("log: " + line);
}

void TryPlan::end(std::string_view why) {
  if (report_.ended.empty()) report_.ended = why;
}

void TryPlan::order(TryOrder order, Instant now) {
  if (order.kind == TryOrder::Kind::read || order.kind == TryOrder::Kind::write) {
    order.id = ++id_;
    waits_for_ = id_;
    result_.reset();
    patience_ = now + kAnswerLimit;
  }
  orders_.push_back(std::move(order));
}

std::optional<TryOrder> TryPlan::take_order() {
  if (orders_.empty()) return std::nullopt;
  TryOrder out = std::move(orders_.front());
  orders_.pop_front();
  return out;
}

void TryPlan::on_result(std::uint16_t id, const BatchResult& result) {
  if (waits_for_ == id) result_ = result;
}

std::optional<BatchResult> TryPlan::answer(Instant now) {
  if (!result_ && now >= patience_) result_ = BatchResult{.outcome = {Errc::timed_out, 0}};
  if (!result_) return std::nullopt;
  waits_for_.reset();
  return std::exchange(result_, std::nullopt);
}

void TryPlan::on_look(const TryLook& look, Instant now) {
  if (over()) return;
  if (!ending_ && report_.ended.empty()) advance(look, now);
  if (!ending_ && (step_.last_done || !report_.ended.empty())) begin_ending(now);
  if (ending_) look_at_ending(look, now);
}

void TryPlan::advance(const TryLook& look, Instant now) {
  if (!step_.begun) return begin_step(look, now);
  if (step_.step == TryStep::read) return look_at_reading(look, now);
  if (step_.step == TryStep::setup) return look_at_setup(look, now);
  look_at_acts(look, now);
}

void TryPlan::begin_ending(Instant now) {
  if (!report_.ended.empty()) {
    if (step_.begun) say(fmt::format("  => {}", text(report_.of(step_.step).verdict)));
    say("");
    for (std::string& line : wrapped(fmt::format("{}: {}", report_.ended, torque_ ? "stop and disable" : "ended"), 0))
      words_.push_back(std::move(line));
  }
  orders_.clear();
  if (step_.step == TryStep::loss) order({.kind = TryOrder::Kind::resume}, now);
  waits_for_.reset();
  person_.asked = false;
  ending_.emplace(torque_, before_, now);
}

// Steps.

void TryPlan::begin_step(const TryLook& look, Instant now) {
  const TryStep step = step_.step;
  const bool wanted = step <= TryStep::setup || (!arguments_.dry && (step != TryStep::home || arguments_.home));
  if (!wanted) {
    report_.of(step).saw.emplace_back(arguments_.dry ? "--dry" : "--home was not given");
    return close_step(Verdict::not_tried);
  }
  step_.begun = true;
  say("");
  say(fmt::format("{} {}", static_cast<int>(step) + 1, text(step)));
  say(fmt::format("  will   {}", will(step)));
  say(fmt::format("  needs  {}", needs(step)));
  if (step == TryStep::setup && !arguments_.dry) order({.kind = TryOrder::Kind::open}, now);
  patience_ = now + kOnlineLimit;
  if (step <= TryStep::setup) return;
  Acts made = acts_of(step, {drive_, axis_, look.image, arguments_.home.value_or(0), arguments_.open_before});
  if (!made.why_not.empty()) {
    see(made.why_not);
    return close_step(Verdict::not_tried);
  }
  acts_.assign(made.acts.begin(), made.acts.end());
  doing_ = {};
}

bool TryPlan::await_online(const TryLook& look, Instant now) {
  if (step_.online) return true;
  step_.online = look.image.link_state == LinkState::online;
  if (!step_.online && now >= patience_) wrong(online_text(look.image.link_state));
  return step_.online;
}

void TryPlan::look_at_reading(const TryLook& look, Instant now) {
  if (!await_online(look, now)) return;
  const std::vector<model::ObjectId> objects = objects_to_read(drive_);
  if (waits_for_) {
    const auto read = answer(now);
    if (!read) return;
    ObjectRow row = row_of(drive_, objects[step_.read++], *read);
    say("  " + line_of(row));
    if (row.wrong) step_.faults.push_back(fmt::format("{} ({}): {}", row.name, row.address, row.remark));
    report_.objects.push_back(std::move(row));
  }
  if (step_.read < objects.size())
    return order({.kind = TryOrder::Kind::read, .object = read_request(drive_, objects[step_.read])}, now);
  const auto answered =
      std::ranges::count_if(report_.objects, [](const ObjectRow& row) { return row.value.has_value(); });
  see(fmt::format("{} of {} objects were answered", answered, objects.size()));
  for (const std::string& fault : step_.faults) see(fault);
  const bool fits = step_.faults.empty();
  close_step(fits ? Verdict::right : Verdict::wrong);
  if (!fits && !arguments_.dry) end("what was read does not fit the profile");
}

void TryPlan::look_at_setup(const TryLook& look, Instant now) {
  if (!await_online(look, now)) return;
  if (waits_for_) {
    const auto read = answer(now);
    if (!read) return;
    const SetupRow row = setup_row(drive_, drive_.setup[step_.read++], *read);
    see(row.text);
    if (!row.holds) step_.faults.push_back(row.text);
  }
  while (step_.read < drive_.setup.size() && !drive_.object(drive_.setup[step_.read].object).readable) ++step_.read;
  if (step_.read < drive_.setup.size()) {
    const model::ObjectId next = drive_.setup[step_.read].object;
    return order({.kind = TryOrder::Kind::read, .object = read_request(drive_, next)}, now);
  }
  end_setup(look);
}

void TryPlan::end_setup(const TryLook& look) {
  if (arguments_.dry) {
    see("nothing was written");
    return close_step(Verdict::not_tried);
  }
  const std::uint32_t alarms = look.image.alarms;
  if (alarms != 0) see(fmt::format("axis alarms: {}", names_of_bits(WordKind::axis_alarm, alarms)));
  see(loss_text(look.image.loss_stop_ms));
  constexpr std::uint32_t kUnfit = bit(AxisAlarm::profile_mismatch) | bit(AxisAlarm::identity_mismatch);
  if ((alarms & kUnfit) != 0) return wrong("the drive is not the one of the profile, or refuses what it needs");
  if (!step_.faults.empty()) return wrong("the drive does not hold what the setup writes");
  close_step(Verdict::right);
  if (look.image.has(AxisInput::enabled)) end("the axis is enabled already: disable it first");
  if (look.image.has(AxisInput::fault)) end("the axis has a fault: axisgate explain tells what its error_code means");
}

void TryPlan::close_step(Verdict verdict) {
  report_.of(step_.step).verdict = verdict;
  if (step_.begun) say(fmt::format("  => {}", text(verdict)));
  acts_.clear();
  step_.last_done = step_.step == TryStep::home;
  if (!step_.last_done) step_ = {.step = static_cast<TryStep>(static_cast<int>(step_.step) + 1)};
}

void TryPlan::wrong(std::string_view why) {
  see(why);
  report_.of(step_.step).verdict = Verdict::wrong;
  end(fmt::format("step {} is wrong", text(step_.step)));
}

void TryPlan::look_at_ending(const TryLook& look, Instant now) {
  const bool waits = waits_for_ && !answer(now);
  if (auto write = ending_->next(look.image, waits, now))
    return order({.kind = TryOrder::Kind::write, .write = std::move(*write)}, now);
  if (!ending_->over()) return;
  if (!ending_->words().empty()) {
    end(ending_->words());
    say(ending_->words(), 0);
  } else if (torque_) {
    say("the motor stands and has no torque", 0);
  }
  step_.over = true;
}

}  // namespace axisgate::commands
