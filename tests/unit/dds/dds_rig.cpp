// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/dds/dds_rig.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gateway/upstream/dds/command_batches.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

constexpr Duration kBeatPeriod = 200ms;

std::vector<GatewayStage::Line> lines(const DdsRigOptions& options) {
  std::vector<GatewayStage::Line> out;
  out.push_back(line_of(simulated::KincoType::jd, kServo));
  out.back().drives.front().axis.limits.position = options.position_limits;
  out.back().drives.front().constants["rated_current_a"] = Rational(5);
  out.push_back(rtu_line_of({simulated::Id286proOptions{}}, kStepper));
  for (GatewayStage::Line& line : out) line.lease = options.lease;
  return out;
}

}  // namespace

DdsRig::DdsRig(DdsRigOptions options) : stage(lines(options)) {
  options.settings.commands = true;
  session_ = std::make_unique<dds::DdsSession>(
      options.settings, stage.gateway().image(), stage.gateway().events(), stage.gateway(), [this] { woken_ = true; },
      dds::DdsDomainReports{[this](const std::string& line) { told.push_back(line); }, {}});
  link_up();
  if (!run_until([&] {
        return axis(kServo).link_state == LinkState::online && axis(kStepper).link_state == LinkState::online;
      }))
    throw std::runtime_error("the axes never came online");
  run(3s);
}

void DdsRig::link_up() {
  up_ = true;
  session_->on_link_up(now());
  read();
}

void DdsRig::link_down() {
  up_ = false;
  session_->on_link_down(now());
}

void DdsRig::read() {
  woken_ = false;
  while (const auto record = session_->next(now())) {
    if (const auto* const state = std::get_if<dds::StateRecord>(&*record)) {
      samples.push_back(*state);
      states_[state->axis] = *state;
    }
    if (const auto* const event = std::get_if<dds::EventRecord>(&*record)) events.push_back(*event);
    if (const auto* const each = std::get_if<dds::GatewayRecord>(&*record)) gateway.push_back(*each);
    if (const auto* const reply = std::get_if<dds::ReplyRecord>(&*record)) replies_.push_back(*reply);
    if (const auto* const reply = std::get_if<dds::ObjectReplyRecord>(&*record)) object_replies_.push_back(*reply);
  }
}

bool DdsRig::run_until(const std::function<bool()>& done, Duration limit) {
  const Instant end = now() + limit;
  while (!done()) {
    if (now() >= end) return false;
    stage.runtime().advance_by(1ms);
    if (up_ && now() >= next_beat_ && !beating_.empty()) {
      next_beat_ = now() + kBeatPeriod;
      session_->on_record(dds::BeatRecord{beating_}, now());
    }
    if (up_ && (woken_ || session_->wake_at() <= now())) read();
  }
  return true;
}

void DdsRig::run(Duration time) {
  const Instant end = now() + time;
  static_cast<void>(run_until([&] { return now() >= end; }, time + 1s));
}

dds::Guid DdsRig::writer(std::uint8_t participant, std::uint8_t entity, std::int32_t strength) {
  const dds::Guid out = guid(participant, entity);
  strengths_[out] = strength;
  session_->on_record(writer_there(out, strength), now());
  if (std::ranges::find(beating_, out) == beating_.end()) beating_.push_back(out);
  return out;
}

void DdsRig::die(const dds::Guid& writer) {
  fall_silent(writer);
  session_->on_record(writer_gone(writer), now());
}

std::uint64_t DdsRig::send(dds::CommandRecord record) {
  send_again(std::move(record), ++last_id_);
  return last_id_;
}

void DdsRig::send_again(dds::CommandRecord record, std::uint64_t id) {
  record.request_id = id;
  if (const auto known = strengths_.find(record.writer); known != strengths_.end()) record.strength = known->second;
  session_->on_record(record, now());
  read();
}

void DdsRig::give(const dds::Record& record) {
  session_->on_record(record, now());
  read();
}

std::size_t DdsRig::replies(std::uint64_t id) const {
  return static_cast<std::size_t>(std::ranges::count(replies_, id, &dds::ReplyRecord::request_id));
}

dds::ReplyRecord DdsRig::ask(dds::CommandRecord record) {
  const std::uint64_t id = send(record);
  if (!run_until([&] { return replies(id) != 0; }, 10s)) throw std::runtime_error("a request never got its reply");
  run(1ms);
  if (replies(id) != 1) throw std::runtime_error("a request got more than one reply");
  const dds::ReplyRecord out = *std::ranges::find(replies_, id, &dds::ReplyRecord::request_id);
  if (out.writer != record.writer || out.axis != record.axis) throw std::runtime_error("it is another's reply");
  return out;
}

dds::ReplyRecord DdsRig::ask(const dds::Guid& writer, std::uint8_t number, AxisNumber axis) {
  return ask(test::command(writer, number, 0, axis));
}

dds::ReplyRecord DdsRig::run_at(const dds::Guid& writer, double turns_per_s, AxisNumber axis) {
  dds::CommandRecord record = test::command(writer, 8, 0, axis);
  record.mask = dds::kHasTargetVelocity;
  record.target_velocity = turns_per_s * kTurn;
  return ask(record);
}

dds::ObjectReplyRecord DdsRig::ask(dds::ObjectRequestRecord record) {
  record.request_id = ++last_id_;
  session_->on_record(record, now());
  read();
  const auto mine = [&](const dds::ObjectReplyRecord& each) { return each.request_id == record.request_id; };
  if (!run_until([&] { return std::ranges::any_of(object_replies_, mine); }, 10s))
    throw std::runtime_error("a request never got its reply");
  run(1ms);
  if (std::ranges::count_if(object_replies_, mine) != 1) throw std::runtime_error("a request got more than one reply");
  return *std::ranges::find_if(object_replies_, mine);
}

bool DdsRig::has_event(const std::string& part) const {
  return std::ranges::any_of(events, [&](const auto& each) { return each.text.find(part) != std::string::npos; });
}

std::int64_t DdsRig::position(AxisNumber axis) {
  return axis == kServo ? stage.drive(0).position() : stage.id286pro(1).position();
}

bool DdsRig::turns(AxisNumber axis) {
  const std::int64_t before = position(axis);
  run(100ms);
  return std::abs(position(axis) - before) > 1;
}

Errc DdsRig::modbus(const std::shared_ptr<ClientLife>& client, WriteBatch batch, bool claims) {
  client->last_request = now();
  batch.client = client->id;
  batch.role = client->role;
  batch.life = client;
  batch.claims = claims;
  const auto place = stage.begin(kServo, std::move(batch));
  if (!run_until([&] { return place->has_value(); })) throw std::runtime_error("a write batch never got its result");
  return (*place)->outcome.code;
}

dds::CommandRecord move_to(const dds::Guid& writer, double turns, AxisNumber axis) {
  dds::CommandRecord record = command(writer, 6, 0, axis);
  record.mask = dds::kHasTargetPosition | dds::kHasProfileVelocity;
  record.target_position = turns * kTurn;
  record.profile_velocity = 10 * kTurn;
  return record;
}

}  // namespace axisgate::test
