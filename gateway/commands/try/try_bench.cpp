// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/try/try_bench.hpp"

#include <utility>

#include "gateway/commands/try/read_only_drive.hpp"

namespace axisgate::commands {
namespace {

constexpr Duration kStartLimit = std::chrono::seconds(5);
constexpr Duration kAnswerLimit = std::chrono::seconds(12);
constexpr Duration kLease = std::chrono::seconds(2);
constexpr ClientId kUs = 1;

/// As configured, but for what a person beside a motor needs.
model::DriveModel owned(model::DriveModel model) {
  for (model::AxisModel& axis : model.axes) {
    axis.lease = {.on = true, .timeout = kLease, .on_expiry = LeaseAction::quick_stop, .renew = LeaseRenewal::any};
    axis.watch.reaction = model::WatchReaction::stop;
    axis.watch.units = true;
  }
  return model;
}

}  // namespace

TryBench::TryBench(const config::LoadedConfig& loaded, const AxisPlace& place, boost::asio::io_context& io,
                   AsioRuntime& runtime, const Log& log)
    : io_(io),
      runtime_(runtime),
      log_(log),
      model_(loaded.models[place.bus][place.drive]),
      slot_(place.slot),
      life_(std::make_shared<ClientLife>()) {
  config_.file = loaded.config.file;
  config_.buses = {loaded.config.buses[place.bus]};
  config_.buses[0].drives = {loaded.config.buses[place.bus].drives[place.drive]};
  life_->id = kUs;
  life_->role = Role::engineer;
  life_->name = "axisgate profile try";
  beat();
}

void TryBench::begin(bool whole) {
  gateway_.reset();  // its port is free
  guard_ = {.only_reads = !whole};
  compose::Models models(1);
  models[0].push_back(whole ? owned(model_) : only_read(model_));
  gateway_ =
      std::make_unique<compose::Gateway>(config_, models, runtime_, log_, guarded_wires(io_, runtime_, log_, guard_));
  gateway_->start();
}

TryLook TryBench::seen() {
  const AxisImage& image = *gateway_->image().find(number());
  TryLook out{image};
  const drive::Drive& drive = *gateway_->drive_of(number());
  if (const model::Binding* binding = drive.model().axes[slot_].binding(Quantity::position_actual)) {
    const bool known = binding->object != model::kNoObject && drive.store()[binding->object].known;
    if (known) out.raw_position = static_cast<std::uint32_t>(drive.store()[binding->object].number);
  }
  return out;
}

void TryBench::beat() { life_->last_request = life_->heartbeat = runtime_.now(); }

void TryBench::carry_out(const TryOrder& order,
                         const std::function<void(std::uint16_t, const BatchResult&)>& answered) {
  if (order.kind == TryOrder::Kind::open) return begin(true);
  if (order.kind == TryOrder::Kind::withhold || order.kind == TryOrder::Kind::resume) {
    guard_.withholds = order.kind == TryOrder::Kind::withhold;
    return;
  }
  WriteBatch batch;
  batch.role = Role::engineer;
  if (order.kind == TryOrder::Kind::read) {
    batch.object = order.object;
  } else {
    batch.client = kUs;
    batch.life = life_;
    batch.claims = true;
    batch.setpoints.assign(order.write.setpoints.begin(), order.write.setpoints.end());
    batch.command = order.write.command;
    batch.command_id = order.id;
  }
  batch.start_by = runtime_.now() + kStartLimit;
  batch.answer_by = runtime_.now() + kAnswerLimit;
  const auto answer = [answered, id = order.id](const BatchResult& result) { answered(id, result); };
  if (const auto at_once = gateway_->submit(number(), batch, answer)) answer(*at_once);
}

}  // namespace axisgate::commands
