// SPDX-License-Identifier: Apache-2.0
#include "tests/obey/dds_writers.hpp"

#include <numbers>
#include <stdexcept>

#include "gateway/upstream/dds/command_batches.hpp"
#include "tests/unit/dds/samples.hpp"

namespace axisgate::test::obey {
namespace {

using namespace reference;

constexpr double kPositionUnit = 2 * std::numbers::pi / 10'000;      // rad, of 1/10000 turn
constexpr std::uint64_t kPlaces = std::uint64_t{1} << 32;            // more than there are request_ids
constexpr double kVelocityUnit = 2 * std::numbers::pi / 60 / 1'000;  // rad/s, of 0.001 rpm

dds::DdsSettings settings() {
  dds::DdsSettings out;
  out.commands = true;
  out.gateway = dds::gateway_id("cell");
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

dds::CommandRecord DdsWriters::record_of(const Write& sample, const Writer& by, std::uint64_t id) {
  constexpr std::chrono::nanoseconds kTooOld = 2 * kMaxAge;
  const auto number = [&](std::uint16_t offset, std::uint32_t has, double unit, dds::CommandRecord& record) {
    if (!sample.sample.contains(offset)) return 0.0;
    record.mask |= has;
    return static_cast<double>(sample.sample.at(offset)) * unit;
  };
  const std::int64_t asked = sample.sample.contains(row::command) ? sample.sample.at(row::command) : 0;
  dds::CommandRecord record = command(by.guid, static_cast<std::uint8_t>(asked), id);
  record.strength = by.strength;
  record.received = record.written = now_ns();
  if (sample.flaw == Flaw::old) record.written -= kTooOld.count();
  if (sample.flaw == Flaw::ahead) record.written += kTooOld.count();
  record.gateway = settings().gateway;
  if (sample.flaw == Flaw::half && id % 2 == 0) record.gateway.key = 0;
  if (sample.flaw == Flaw::half && id % 2 != 0) record.gateway.name.clear();
  record.mode = static_cast<std::int16_t>(number(row::mode, dds::kHasMode, 1, record));
  record.target_position = number(row::target_position, dds::kHasTargetPosition, kPositionUnit, record);
  record.target_velocity = number(row::target_velocity, dds::kHasTargetVelocity, kVelocityUnit, record);
  record.jog_velocity = number(row::jog_velocity, dds::kHasJogVelocity, kVelocityUnit, record);
  record.set_position_value = number(row::set_position_value, dds::kHasSetPositionValue, kPositionUnit, record);
  return record;
}

std::uint64_t DdsWriters::begin(const Write& sample, std::size_t writer) {
  Writer& by = writers_.at(writer);
  if (sample.repeats != 0) {
    const std::uint64_t id = by.said.at(by.said.size() - sample.repeats).first;
    const std::uint64_t place = asked_.at(id)++;
    tell(record_of(sample, by, id));
    return place * kPlaces + id;
  }
  asked_[++last_] = 1;
  if (sample.flaw == Flaw::none) by.said.emplace_back(last_, sample);
  tell(record_of(sample, by, last_));
  return last_;
}

void DdsWriters::ask_another_gateway(const Write& sample, std::size_t writer) {
  dds::CommandRecord record = record_of(sample, writers_.at(writer), ++last_);
  record.gateway = dds::gateway_id("another");
  tell(record);
}

std::optional<Write> DdsWriters::said(std::size_t writer, std::size_t ago) {
  const Writer& by = writers_.at(writer);
  if (by.said.size() < ago) return {};
  auto [id, sample] = by.said.at(by.said.size() - ago);
  if (results_[id].size() != asked_.at(id)) return {};
  sample.repeats = ago;
  return sample;
}

std::optional<std::uint8_t> DdsWriters::result_of(std::uint64_t request) {
  read();
  const std::vector<std::uint8_t>& results = results_[request % kPlaces];
  if (results.size() <= request / kPlaces) return {};
  return results.at(request / kPlaces);
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
  old.said.clear();
  tell(writer_there(old.guid, old.strength));
}

void DdsWriters::process_dies() { session_.on_link_down(stage_.runtime().now()); }

void DdsWriters::process_returns() {
  session_.on_link_up(stage_.runtime().now());
  for (const Writer& each : writers_) tell(writer_there(each.guid, each.strength));
}

void DdsWriters::assert_liveliness(std::size_t writer) { tell(dds::BeatRecord{{writers_.at(writer).guid}}); }

void DdsWriters::beat(std::size_t writer, bool counts_on, std::uint32_t lease_ms) {
  Writer& of = writers_.at(writer);
  of.counter += counts_on ? 1 : 0;
  tell(dds::HeartbeatRecord{
      .writer = of.guid, .client = of.guid, .counter = of.counter, .lease_ms = lease_ms, .written = now_ns()});
}

void DdsWriters::beat_in_vain(std::size_t writer, bool too_old) {
  Writer& of = writers_.at(writer);
  dds::HeartbeatRecord record{.writer = of.guid, .client = of.guid, .counter = ++of.counter, .written = now_ns()};
  if (too_old)
    record.written -= std::chrono::nanoseconds(2 * kMaxAge).count();
  else
    ++record.writer.front();
  tell(record);
}

void DdsWriters::tell(const dds::Record& record) {
  session_.on_record(record, stage_.runtime().now());
  read();
}

void DdsWriters::read() {
  while (const auto record = session_.next(stage_.runtime().now()))
    if (const auto* const reply = std::get_if<dds::ReplyRecord>(&*record)) {
      results_[reply->request_id].push_back(reply->result);
      if (results_[reply->request_id].size() > asked_[reply->request_id])
        throw std::runtime_error("a request got more than one reply, or was another gateway's");
    }
}

}  // namespace axisgate::test::obey
