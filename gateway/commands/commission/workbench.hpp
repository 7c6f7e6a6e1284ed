// SPDX-License-Identifier: Apache-2.0
// The bus of one axis, running, with nobody else on it, for a command that a person waits for: the shipped core, and
// what the person types meanwhile. Promises that polls and heartbeats go on while it waits, and that every wait but the
// one for the person ends. Never asks the person anything.
#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapters/asio/asio_runtime.hpp"
#include "adapters/asio/line_input.hpp"
#include "gateway/commands/commission/commission_plan.hpp"
#include "gateway/compose/gateway.hpp"

namespace axisgate::commands {

/// Why no bench may be opened now: a gateway runs with this configuration. Two who ask one drive at once would each
/// take the other's answers; and the gateway may enable it meanwhile. Empty: none is known to run.
[[nodiscard]] std::string gateway_beside(const std::string& config);

class Workbench {
 public:
  // A drive that has not come up by then is not there, or not on this line.
  static constexpr Duration kOnlineLimit = std::chrono::seconds(15);
  using Wires = std::function<compose::MakeWire(boost::asio::io_context&, Runtime&, const Log&)>;

  /// `config` and `models`: one bus. It is opened at once.
  Workbench(const config::Config& config, const compose::Models& models, const Wires& wires);

  [[nodiscard]] compose::Gateway& gateway() { return *gateway_; }
  [[nodiscard]] Instant now() const { return runtime_.now(); }
  [[nodiscard]] bool run_until(const std::function<bool()>& done, Duration limit);
  void run_for(Duration time);
  [[nodiscard]] bool comes_online(AxisNumber axis);
  /// What the person says, however long it takes; none: the input has ended.
  [[nodiscard]] std::optional<std::string> next_line();
  [[nodiscard]] BatchResult ask(AxisNumber axis, const ObjectRequest& request);
  [[nodiscard]] BatchResult ask(AxisNumber axis, WriteBatch batch);
  [[nodiscard]] std::optional<std::int64_t> read(const model::DriveModel& model, AxisNumber axis, model::ObjectId id);
  /// Of the whole drive, read now: the image of a value that comes by itself may be older than the person's answer.
  [[nodiscard]] std::vector<AxisShown> axes_now(const model::DriveModel& model);

 private:
  boost::asio::io_context io_{1};
  Log log_;
  AsioRuntime runtime_;
  LineInput person_;
  std::unique_ptr<compose::Gateway> gateway_;
};

}  // namespace axisgate::commands
