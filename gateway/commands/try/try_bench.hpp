// SPDX-License-Identifier: Apache-2.0
// The drive of a trial, on a bus of its own: the shipped core, first with a model that only reads, then with the whole
// profile. Promises that one drive alone is spoken to, and that its axis has a lease, an owner (us) and the watch of
// units whatever the configuration says. Never decides what is asked of it.
#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>

#include "adapters/asio/asio_runtime.hpp"
#include "gateway/commands/common/axis_place.hpp"
#include "gateway/commands/try/guarded_link.hpp"
#include "gateway/commands/try/plan/try_plan.hpp"
#include "gateway/compose/gateway.hpp"
#include "gateway/config/config_loader.hpp"

namespace axisgate::commands {

class TryBench {
 public:
  /// Everything passed by reference outlives it.
  TryBench(const config::LoadedConfig& loaded, const AxisPlace& place, boost::asio::io_context& io,
           AsioRuntime& runtime, const Log& log);

  /// Only reads.
  void look() { begin(false); }
  [[nodiscard]] TryLook seen();
  /// We are there: a sign of life of the axis's owner.
  void beat();
  /// `answered` is called once, perhaps from inside.
  void carry_out(const TryOrder& order, const std::function<void(std::uint16_t, const BatchResult&)>& answered);
  /// The end on purpose; `closed` is called once.
  void close(std::function<void()> closed) { gateway_->close(std::move(closed)); }

 private:
  void begin(bool whole);
  [[nodiscard]] AxisNumber number() const { return model_.axes[slot_].number; }

  boost::asio::io_context& io_;
  AsioRuntime& runtime_;
  const Log& log_;
  config::Config config_;
  model::DriveModel model_;
  AxisSlot slot_;
  LinkGuard guard_;
  std::shared_ptr<ClientLife> life_;
  std::unique_ptr<compose::Gateway> gateway_;
};

}  // namespace axisgate::commands
