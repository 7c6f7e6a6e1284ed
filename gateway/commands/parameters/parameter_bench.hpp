// SPDX-License-Identifier: Apache-2.0
// The drive whose parameters are read and written, alone on its bus, and left as it is found: nothing is set up.
// Promises that nothing but reads leaves until a parameter is written, that a parameter is written only while no motor
// of the drive has torque and while it holds what was shown, and that its new value is read back. Never decides which.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gateway/commands/commission/workbench.hpp"
#include "gateway/commands/common/axis_place.hpp"
#include "gateway/commands/parameters/plan/parameter_plan.hpp"
#include "gateway/commands/try/guarded_link.hpp"

namespace axisgate::commands {

class ParameterBench {
 public:
  ParameterBench(const config::LoadedConfig& loaded, const AxisPlace& place);

  [[nodiscard]] bool comes_online() { return bench_.comes_online(axis()); }
  [[nodiscard]] LinkState link() { return bench_.gateway().image().find(axis())->link_state; }
  [[nodiscard]] const model::DriveModel& model() const { return model_; }
  /// Who the drive says it is.
  [[nodiscard]] DriveFacts facts();
  /// All of them; none: the drive fell silent, after `read` of them. `on_progress` is called now and then.
  [[nodiscard]] std::optional<Readings> read(const std::vector<Parameter>& parameters, std::size_t& read,
                                             const std::function<void(std::size_t, Duration)>& on_progress);
  /// Why nothing may be written now; empty: it may.
  [[nodiscard]] std::string forbidden() { return objection(bench_.axes_now(model_)); }
  [[nodiscard]] std::optional<std::string> next_line() { return bench_.next_line(); }

  /// `shown`: what the drive held when the person was asked.
  [[nodiscard]] Written write(const Parameter& parameter, std::int64_t shown, std::int64_t number);
  /// Has the drive store what was written.
  [[nodiscard]] Written save();

 private:
  [[nodiscard]] AxisNumber axis() const { return model_.axes[slot_].number; }
  [[nodiscard]] std::optional<Reading> read_one(const Parameter& parameter);
  [[nodiscard]] std::optional<std::uint32_t> number_of(ObjectAddress address);
  /// Asks again while the drive's memory has to be spared. Only now may a write leave.
  [[nodiscard]] BatchResult write_out(const WriteBatch& batch);

  model::DriveModel model_;
  AxisSlot slot_;
  LinkGuard guard_;
  Workbench bench_;
};

}  // namespace axisgate::commands
