// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/commission/workbench.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/local/stream_protocol.hpp>
#include <utility>

#include "gateway/process/control_socket.hpp"
#include "gateway/process/stderr_log.hpp"

namespace axisgate::commands {
namespace {

constexpr Duration kWriteLimit = std::chrono::seconds(5);
constexpr Duration kTurn = std::chrono::milliseconds(100);

}  // namespace

std::string gateway_beside(const std::string& config) {
  boost::asio::io_context io;
  boost::asio::local::stream_protocol::socket socket(io);
  boost::system::error_code error;
  socket.connect(boost::asio::local::stream_protocol::endpoint('\0' + process::control_name(config)), error);
  return error ? std::string()
               : fmt::format("a gateway runs with {}: stop it first, the drive is asked by one at a time", config);
}

Workbench::Workbench(const config::Config& config, const compose::Models& models, const Wires& wires)
    : log_(process::stderr_log(LogLevel::warning)), runtime_(io_), person_(io_, STDIN_FILENO) {
  gateway_ = std::make_unique<compose::Gateway>(config, models, runtime_, log_, wires(io_, runtime_, log_));
  gateway_->start();
}

bool Workbench::run_until(const std::function<bool()>& done, Duration limit) {
  const Instant end = runtime_.now() + limit;
  while (!done()) {
    if (runtime_.now() >= end) return false;
    io_.run_one_for(kTurn);
  }
  return true;
}

void Workbench::run_for(Duration time) {
  static_cast<void>(run_until([] { return false; }, time));
}

bool Workbench::comes_online(AxisNumber axis) {
  return run_until([&] { return gateway_->image().find(axis)->link_state == LinkState::online; }, kOnlineLimit);
}

std::optional<std::string> Workbench::next_line() {
  std::optional<std::string> line;
  bool said = false;
  person_.next([&](std::optional<std::string> typed) {
    line = std::move(typed);
    said = true;
  });
  while (!said) io_.run_one_for(kTurn);
  return line;
}

BatchResult Workbench::ask(AxisNumber axis, const ObjectRequest& request) {
  WriteBatch batch;
  batch.object = request;
  return ask(axis, std::move(batch));
}

BatchResult Workbench::ask(AxisNumber axis, WriteBatch batch) {
  batch.role = Role::engineer;
  batch.start_by = batch.answer_by = runtime_.now() + kWriteLimit;
  const auto result = std::make_shared<std::optional<BatchResult>>();  // it may come after we gave up
  if (auto at_once = gateway_->submit(axis, batch, [result](const BatchResult& r) { *result = r; })) return *at_once;
  if (!run_until([&] { return result->has_value(); }, kWriteLimit + kWriteLimit)) return {{Errc::timed_out, 0}, 0, 0};
  return **result;
}

std::optional<std::int64_t> Workbench::read(const model::DriveModel& model, AxisNumber axis, model::ObjectId id) {
  const model::ObjectDef& object = model.object(id);
  const BatchResult result = ask(axis, ObjectRequest{false, object.address.index, object.address.sub, object.size, 0});
  if (result.outcome.code != Errc::ok) return std::nullopt;
  return object.number(result.object_data);
}

std::vector<AxisShown> Workbench::axes_now(const model::DriveModel& model) {
  std::vector<AxisShown> out;
  for (const model::AxisModel& axis : model.axes) {
    const bool state_known = std::ranges::all_of(axis.state_sources, [&](model::ObjectId id) {
      return model.object(id).emulated || read(model, axis.number, id);
    });
    const AxisImage& image = *gateway_->image().find(axis.number);
    out.push_back({axis.number, image.link_state, state_known, image.has(AxisInput::enabled)});
  }
  return out;
}

}  // namespace axisgate::commands
