// SPDX-License-Identifier: Apache-2.0
#include "tests/obey/dds_writers.hpp"

#include <numbers>
#include <stdexcept>

#include "gateway/upstream/dds/command_batches.hpp"
#include "tests/unit/dds/samples.hpp"

namespace axisgate::test::obey {
namespace {

using namespace model;

constexpr double kPositionUnit = 2 * std::numbers::pi / 10'000;      // rad, of 1/10000 turn
constexpr double kVelocityUnit = 2 * std::numbers::pi / 60 / 1'000;  // rad/s, of 0.001 rpm

dds::DdsSettings settings() {
  dds::DdsSettings out;
  out.commands = true;
  out.max_age = kMaxAge;
  out.units.push_back({.axis = 1});
  return out;
}

}  // namespace

DdsWriters::DdsWriters(GatewayStage& stage, std::uint8_t participant, std::vector<std::int32_t> strengths)
    : stage_(stage),
      participant_(participant),
      session_(settings(), stage.gateway().image(), stage.gateway().events(), stage.gateway(), [] {}) {
  session_.on_link_up(stage_.runtime().now());
  for (const std::int32_t strength : strengths) {
    writers_.push_back({guid(participant_++), strength});
    tell(writer_there(writers_.back().guid, strength));
  }
}

dds::SteadyNs DdsWriters::now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(stage_.runtime().now().time_since_epoch()).count();
}

std::uint64_t DdsWriters::begin(const Write& sample, std::size_t writer) {
  constexpr std::chrono::nanoseconds kTooOld = 2 * kMaxAge;
  const auto has = [&](std::uint16_t offset) { return sample.sample.contains(offset); };
  const auto of = [&](std::uint16_t offset) { return static_cast<double>(sample.sample.at(offset)); };
  const std::int64_t number = has(row::command) ? sample.sample.at(row::command) : 0;
  const Writer& by = writers_.at(writer);
  dds::CommandRecord record = command(by.guid, static_cast<std::uint8_t>(number), ++last_);
  record.strength = by.strength;
  record.received = now_ns();
  record.written = record.received - (sample.stale ? kTooOld.count() : 0);
  if (has(row::target_position)) {
    record.mask |= dds::kHasTargetPosition;
    record.target_position = of(row::target_position) * kPositionUnit;
  }
  if (has(row::target_velocity)) {
    record.mask |= dds::kHasTargetVelocity;
    record.target_velocity = of(row::target_velocity) * kVelocityUnit;
  }
  if (has(row::jog_velocity)) {
    record.mask |= dds::kHasJogVelocity;
    record.jog_velocity = of(row::jog_velocity) * kVelocityUnit;
  }
  tell(record);
  return last_;
}

std::optional<std::uint8_t> DdsWriters::result_of(std::uint64_t request) {
  read();
  const auto found = results_.find(request);
  if (found == results_.end()) return {};
  return found->second;
}

void DdsWriters::replace(std::size_t writer, bool of_the_same_participant) {
  Writer& old = writers_.at(writer);
  tell(writer_gone(old.guid));
  constexpr std::size_t kLowestByteOfEntity = 14;
  if (of_the_same_participant)
    ++old.guid.at(kLowestByteOfEntity);
  else
    old.guid = guid(participant_++);
  old.counter = 0;
  tell(writer_there(old.guid, old.strength));
}

void DdsWriters::assert_liveliness(std::size_t writer) { tell(dds::BeatRecord{{writers_.at(writer).guid}}); }

void DdsWriters::beat(std::size_t writer, bool counts_on, std::uint32_t lease_ms) {
  Writer& of = writers_.at(writer);
  of.counter += counts_on ? 1 : 0;
  tell(dds::HeartbeatRecord{
      .writer = of.guid, .client = of.guid, .counter = of.counter, .lease_ms = lease_ms, .written = now_ns()});
}

void DdsWriters::tell(const dds::Record& record) {
  session_.on_record(record, stage_.runtime().now());
  read();
}

void DdsWriters::read() {
  while (const auto record = session_.next(stage_.runtime().now()))
    if (const auto* const reply = std::get_if<dds::ReplyRecord>(&*record))
      if (!results_.emplace(reply->request_id, reply->result).second)
        throw std::runtime_error("a request got more than one reply");
}

}  // namespace axisgate::test::obey
