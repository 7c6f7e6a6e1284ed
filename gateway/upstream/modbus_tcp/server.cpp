#include "gateway/upstream/modbus_tcp/server.hpp"

#include <string>

#include "gateway/upstream/modbus_tcp/listener.hpp"

namespace axisgate::modbus_tcp {

Server::Server(boost::asio::io_context& io, Runtime& runtime, std::span<const ListenerSettings> listeners,
               ProcessImage& image, CommandPort& commands, ClientRegistry& clients, const Log& log)
    : context_(new ServerContext{io, runtime, image, commands, clients, log, {}, {}}) {
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
  for (const auto& listener : listeners_) {
    context_->log.write(LogLevel::info, "modbus", "listening on " + listener->name());
    listener->start();
  }
}

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
