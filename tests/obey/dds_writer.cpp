// SPDX-License-Identifier: Apache-2.0
#include "tests/obey/dds_writer.hpp"

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
  out.units.push_back({.axis = 1});
  return out;
}

}  // namespace

DdsWriter::DdsWriter(GatewayStage& stage, std::uint8_t participant)
    : stage_(stage),
      participant_(participant),
      session_(settings(), stage.gateway().image(), stage.gateway().events(), stage.gateway(), [] {}) {
  session_.on_link_up(stage_.runtime().now());
  session_.on_record(writer_there(guid(participant_)), stage_.runtime().now());
  read();
}

std::uint64_t DdsWriter::begin(const Write& sample) {
  const auto has = [&](std::uint16_t offset) { return sample.sample.contains(offset); };
  const auto of = [&](std::uint16_t offset) { return static_cast<double>(sample.sample.at(offset)); };
  const std::int64_t number = has(row::command) ? sample.sample.at(row::command) : 0;
  dds::CommandRecord record = command(guid(participant_), static_cast<std::uint8_t>(number), ++last_);
  if (has(row::target_position)) {
    record.mask |= dds::kHasTargetPosition;
    record.target_position = of(row::target_position) * kPositionUnit;
  }
  if (has(row::target_velocity)) {
    record.mask |= dds::kHasTargetVelocity;
    record.target_velocity = of(row::target_velocity) * kVelocityUnit;
  }
  session_.on_record(record, stage_.runtime().now());
  read();
  return last_;
}

std::optional<std::uint8_t> DdsWriter::result_of(std::uint64_t request) {
  read();
  const auto found = results_.find(request);
  if (found == results_.end()) return {};
  return found->second;
}

void DdsWriter::replace() {
  session_.on_record(writer_gone(guid(participant_)), stage_.runtime().now());
  session_.on_record(writer_there(guid(++participant_)), stage_.runtime().now());
  read();
}

void DdsWriter::read() {
  while (const auto record = session_.next(stage_.runtime().now()))
    if (const auto* const reply = std::get_if<dds::ReplyRecord>(&*record))
      if (!results_.emplace(reply->request_id, reply->result).second)
        throw std::runtime_error("a request got more than one reply");
}

}  // namespace axisgate::test::obey
