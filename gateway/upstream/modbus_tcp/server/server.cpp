// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/modbus_tcp/server/server.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "gateway/upstream/modbus_tcp/server/listener.hpp"

namespace axisgate::modbus_tcp {
namespace {

using Listeners = std::vector<std::shared_ptr<Listener>>;

bool is_among(const Listeners& listeners, const std::shared_ptr<Listener>& one) {
  return std::ranges::find(listeners, one) != listeners.end();
}

/// nullptr: none listens there.
std::shared_ptr<Listener> on_address_of(const ListenerSettings& settings, const Listeners& listeners) {
  const auto found =
      std::ranges::find_if(listeners, [&](const auto& each) { return same_address(each->settings(), settings); });
  return found == listeners.end() ? nullptr : *found;
}

}  // namespace

Server::Server(boost::asio::io_context& io, Runtime& runtime, std::span<const ListenerSettings> listeners,
               ProcessImage& image, CommandPort& commands, ClientRegistry& clients, const Log& log,
               ServerReports reports)
    : context_(new ServerContext{io, runtime, image, commands, clients, log, std::move(reports), {}, {}}) {
  for (const ListenerSettings& settings : listeners) {
    listeners_.push_back(std::make_shared<Listener>(*context_, settings, listeners_.size()));
  }
}

Server::~Server() { stop(); }

void Server::start(const DescriptorPlan& descriptors) {
  context_->descriptors = descriptors;
  try {
    for (const auto& listener : listeners_) listener->open();
  } catch (...) {
    stop();
    throw;
  }
  for (const auto& listener : listeners_) begin(*listener);
  report_down();
}

/// One that comes late has its address one day, with nobody who waits for it here.
void Server::begin(Listener& listener) {
  const auto say = [this, &listener] {
    context_->log.write(LogLevel::info, "modbus", "listening on " + listener.name(), LogPace::each);
  };
  if (listener.listens()) say();
  listener.start([this, say] {
    say();
    report_down();
  });
}

void Server::report_down() {
  if (!context_->reports.listener_down) return;
  context_->reports.listener_down(!std::ranges::all_of(listeners_, [](const auto& each) { return each->listens(); }));
}

void Server::prepare(std::span<const ListenerSettings> wanted, std::span<const std::optional<std::size_t>> kept) {
  Listeners prepared;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (kept[i]) {
      prepared.push_back(listeners_[*kept[i]]);
      continue;
    }
    prepared.push_back(std::make_shared<Listener>(*context_, wanted[i], i));
    if (!on_address_of(wanted[i], listeners_)) prepared.back()->open();
  }
  prepared_ = std::move(prepared);
}

void Server::commit(const DescriptorPlan& descriptors) {
  context_->descriptors = descriptors;
  const Listeners before = std::exchange(listeners_, std::exchange(prepared_, {}));
  for (const auto& listener : listeners_) {
    if (is_among(before, listener)) continue;
    if (const auto same = on_address_of(listener->settings(), before)) listener->take_socket(*same);
  }
  for (const auto& listener : before)
    if (!is_among(listeners_, listener)) listener->stop();
  for (const auto& listener : listeners_) {
    if (!is_among(before, listener)) begin(*listener);
  }
  report_down();
}

bool Server::serves(std::size_t place, ClientId client) const { return listeners_[place]->serves(client); }

void Server::stop() {
  for (const auto& listener : listeners_) listener->stop();
}

std::vector<std::uint16_t> Server::ports() const {
  std::vector<std::uint16_t> ports;
  for (const auto& listener : listeners_) ports.push_back(listener->port());
  return ports;
}

const ServerCounters& Server::counters() const { return context_->counters; }

}  // namespace axisgate::modbus_tcp
