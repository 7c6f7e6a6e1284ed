// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_host/web_server.hpp"

#include <utility>

#include "gateway/upstream/web_host/web_program.hpp"

namespace axisgate::web {

WebServer::WebServer(boost::asio::io_context& io, Runtime& runtime, Boot boot, ProcessImage& image,
                     const EventRing& events, std::function<ProcessFigures()> figures, const Log& log,
                     host::KeeperReports reports)
    : runtime_(runtime),
      keeper_(io, runtime, kProgram, *this, log, std::move(reports)),
      session_(std::move(boot), image, events, std::move(figures), [this] { keeper_.wake(); }) {}

WebServer::~WebServer() { keeper_.stop(); }

void WebServer::run(const std::optional<WebSettings>& settings, WebFacts facts) {
  std::optional<host::Keeper::Arguments> arguments;
  if (settings) arguments = serve_arguments(*settings, host::kLinkDescriptor);
  session_.take(settings.value_or(WebSettings{}), std::move(facts), runtime_.now());
  keeper_.run(std::move(arguments));
  keeper_.wake();
}

host::Heard WebServer::hear(Bytes packet) { return host::heard<ReadyRecord, LogRecord>(decode(packet), kProgram.name); }

std::optional<std::vector<Byte>> WebServer::next(Instant now) {
  const auto record = session_.next(now);
  return record ? std::optional(encode(*record)) : std::nullopt;
}

}  // namespace axisgate::web
