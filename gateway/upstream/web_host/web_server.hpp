// SPDX-License-Identifier: Apache-2.0
// The web server of the gateway: axisgate-web with its keeper, and the web session that it is sent.
// Promises what host::Keeper promises of the process, and that nothing which comes from it asks anything of an axis.
// Never sends from inside a turn of a drive: what changes there arms a timer.
#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <optional>
#include <vector>

#include "gateway/core/clock.hpp"
#include "gateway/core/log.hpp"
#include "gateway/upstream/host/keeper.hpp"
#include "gateway/upstream/web/web_session.hpp"

namespace axisgate::web {

class WebServer final : private host::HostedSession {
 public:
  /// Everything passed by reference must outlive the server.
  WebServer(boost::asio::io_context& io, Runtime& runtime, Boot boot, ProcessImage& image, const EventRing& events,
            std::function<ProcessFigures()> figures, const Log& log, host::KeeperReports reports);
  ~WebServer() override;

  /// The configuration, or another one after a reload; the process is started again where that is for it to know.
  /// No settings: there is no page.
  void run(const std::optional<WebSettings>& settings, WebFacts facts);
  /// As Keeper::stop().
  void stop() { keeper_.stop(); }
  [[nodiscard]] const host::Keeper& keeper() const { return keeper_; }

 private:
  [[nodiscard]] host::Heard hear(Bytes packet) override;
  void on_link_up(Instant now) override { session_.on_link_up(now); }
  void on_link_down(Instant /*now*/) override { session_.on_link_down(); }
  void on_no_room() override { session_.on_no_room(); }
  [[nodiscard]] std::optional<std::vector<Byte>> next(Instant now) override;
  [[nodiscard]] Instant wake_at() const override { return session_.wake_at(); }

  Runtime& runtime_;
  host::Keeper keeper_;
  WebSession session_;
};

}  // namespace axisgate::web
