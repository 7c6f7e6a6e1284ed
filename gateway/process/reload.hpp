// SPDX-License-Identifier: Apache-2.0
// A reload of the running gateway: reads the configuration again and has the gateway go on with it, or
// says why it stays as it was. Promises all or nothing; that the file is read and checked on a thread of its own, so
// that the loop never waits for a disk; that a bus or listener whose section says the same is not touched. Never stops,
// enables or moves anything, and never closes the connection of a client whose axis is enabled.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/compose/gateway.hpp"
#include "gateway/compose/start_lines.hpp"
#include "gateway/config/config_loader.hpp"
#include "gateway/process/file_watch.hpp"
#include "gateway/upstream/dds_host/dds_server.hpp"
#include "gateway/upstream/modbus_tcp/server/server.hpp"
#include "gateway/upstream/web_host/web_server.hpp"

namespace axisgate::process {

struct ReloadResult {
  bool done = false;
  /// One each: what was done, or why nothing was.
  std::vector<std::string> lines;
};

class Reload {
 public:
  /// What runs. `dds`: nullptr where the configuration has none.
  struct Running {
    compose::Gateway& gateway;
    modbus_tcp::Server& server;
    dds::DdsServer* dds;
    web::WebServer& web;
    FileWatch& files;
    const Log& log;
  };
  using Done = std::function<void(const ReloadResult&)>;

  /// `load` is called on the thread. `running`: what `with` was made from. Everything referred to outlives the reload.
  Reload(boost::asio::io_context& io, config::Config running, std::function<config::LoadResult()> load,
         const Running& with);

  /// `done` is called once, on the loop; at once where another reload is under way. Not at all where the gateway ends
  /// before. The result is an event, too.
  void begin(Done done);

 private:
  void on_loaded(config::LoadResult loaded);
  void change(config::LoadedConfig wanted);
  [[nodiscard]] std::vector<std::string> clients_in_the_way(const compose::ReloadPlan& plan) const;
  void commit(const compose::ReloadPlan& plan, config::Config wanted, const std::vector<compose::StartLine>& start,
              web::WebFacts facts);
  void refuse(std::vector<std::string> why_not);
  void end(ReloadResult result);

  boost::asio::io_context& io_;
  config::Config running_;
  std::function<config::LoadResult()> load_;
  Running with_;
  Done done_{};  ///< of the reload that is under way
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
  boost::asio::thread_pool thread_{1};  ///< last: joined before the rest goes
};

/// With "lease": null nobody owns the axis, and still it would be stopped if the client went that commanded its motion.
/// `nothing_else_would`: no drive that notices a dead gateway, and none that CiA 402 has a state for.
[[nodiscard]] bool may_stop_with_a_client(const AxisImage& axis, bool nothing_else_would);

}  // namespace axisgate::process
