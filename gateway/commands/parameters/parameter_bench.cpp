// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/parameters/parameter_bench.hpp"

#include <fmt/format.h>

#include <utility>

#include "gateway/commands/try/read_only_drive.hpp"
#include "gateway/drive/state/nvm_budget.hpp"
#include "gateway/profile/make/profile_text.hpp"

namespace axisgate::commands {
namespace {

constexpr Duration kProgressPeriod = std::chrono::seconds(5);
constexpr Duration kAgainPeriod = std::chrono::seconds(1);
/// One more write in each kOneMore.
constexpr Duration kSparedLimit = drive::NvmBudget::kOneMore + std::chrono::seconds(10);
constexpr std::uint16_t kIdentityObject = 0x1018, kSoftwareVersion = 0x100A;

/// Who it is, is asked and judged here: an exchanged drive has another serial number.
model::DriveModel stranger(model::DriveModel model) {
  model.canopen.identity = {};
  return only_read(std::move(model));
}

config::Config alone(const config::LoadedConfig& loaded, const AxisPlace& place) {
  config::Config out;
  out.file = loaded.config.file;
  out.buses = {loaded.config.buses[place.bus]};
  out.buses[0].drives = {loaded.config.buses[place.bus].drives[place.drive]};
  return out;
}

}  // namespace

ParameterBench::ParameterBench(const config::LoadedConfig& loaded, const AxisPlace& place)
    : model_(stranger(loaded.models[place.bus][place.drive])),
      slot_(place.slot),
      bench_(alone(loaded, place), {{model_}}, [this](boost::asio::io_context& io, Runtime& runtime, const Log& log) {
        return guarded_wires(io, runtime, log, guard_);
      }) {}

std::optional<std::uint32_t> ParameterBench::number_of(ObjectAddress address) {
  const BatchResult answer = bench_.ask(axis(), ObjectRequest{false, address.index, address.sub, 4, 0});
  return answer.outcome.code == Errc::ok ? std::optional(answer.object_data) : std::nullopt;
}

DriveFacts ParameterBench::facts() {
  DriveFacts out{model_.profile, model_.title, model_.protocol, model_.node, {}, {}};
  if (!model::is_canopen(model_)) return out;
  for (std::uint8_t i = 0; i < out.identity.size(); ++i)
    out.identity[i] = number_of({kIdentityObject, static_cast<std::uint8_t>(i + 1)});
  const BatchResult version = bench_.ask(axis(), ObjectRequest{false, kSoftwareVersion, 0, 0, 0});
  if (version.outcome.code == Errc::ok && version.object_bytes)
    out.firmware = profile::plain_text(std::string(version.object_bytes->begin(), version.object_bytes->end()));
  return out;
}

std::optional<Reading> ParameterBench::read_one(const Parameter& parameter) {
  if (!parameter.object.readable) return Reading{{}, "it can only be written"};
  BatchResult answer;
  for (int i = 0; i < kParameterTries; ++i) {
    answer = bench_.ask(axis(), read_request(model_, parameter));
    const bool answered = after(answer) != After::end || answer.outcome.code == Errc::bad_reply;
    if (answered) return reading_of(model_, parameter, answer);
    if (!comes_online()) return std::nullopt;
  }
  return Reading{{}, refusal_text(answer), false};
}

std::optional<Readings> ParameterBench::read(const std::vector<Parameter>& parameters, std::size_t& read,
                                             const std::function<void(std::size_t, Duration)>& on_progress) {
  Readings out;
  const Instant begun = bench_.now();
  Instant told = begun;
  int silent = 0;
  for (const Parameter& parameter : parameters) {
    read = out.size();
    const Instant asked = bench_.now();
    if (asked - told >= kProgressPeriod) {
      on_progress(read, asked - begun);
      told = asked;
    }
    auto reading = read_one(parameter);
    silent = reading && reading->answered ? 0 : silent + 1;
    if (!reading || silent == kMostSilent) return std::nullopt;
    out.push_back(*std::move(reading));
  }
  return out;
}

BatchResult ParameterBench::write_out(const WriteBatch& batch) {
  const Instant end = bench_.now() + kSparedLimit;
  guard_.writes_objects = true;
  BatchResult answer = bench_.ask(axis(), batch);
  while (after(answer) == After::again && bench_.now() < end) {
    bench_.run_for(kAgainPeriod);
    answer = bench_.ask(axis(), batch);
  }
  guard_.writes_objects = false;
  return answer;
}

Written ParameterBench::write(const Parameter& parameter, std::int64_t shown, std::int64_t number) {
  if (const auto objection = changed(parameter, shown, read_one(parameter))) return *objection;
  // Whether a motor has torque is looked at last, next to the write.
  if (const std::string why = forbidden(); !why.empty()) return {.ends = true, .text = "not written: " + why};
  WriteBatch batch;
  batch.object = write_request(parameter, number);
  const BatchResult answer = write_out(batch);
  const bool done = answer.outcome.code == Errc::ok;
  return written(parameter, number, answer, done ? read_one(parameter) : std::nullopt);
}

Written ParameterBench::save() {
  if (const std::string why = forbidden(); !why.empty()) return {.ends = true, .text = "not stored: " + why};
  WriteBatch batch;
  batch.command = Command::save_parameters;
  batch.command_id = 1;
  const BatchResult answer = write_out(batch);
  const bool done = answer.outcome.code == Errc::ok;
  static_cast<void>(comes_online());  // one that stores may be unresponsive for a moment
  return {.held = done, .text = done ? "stored in the drive" : "NOT stored in the drive: " + refusal_text(answer)};
}

}  // namespace axisgate::commands
