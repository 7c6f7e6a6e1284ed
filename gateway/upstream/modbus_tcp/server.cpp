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

void Server::start() {
  context_->descriptors = modbus_tcp::descriptor_rule(descriptor_limit());
  try {
    for (const auto& listener : listeners_) listener->open();
  } catch (...) {
    stop();
    throw;
  }
  std::uint64_t wanted = 0;
  for (const auto& listener : listeners_) {
    wanted += listener->settings().max_clients;
    context_->log.write(LogLevel::info, "modbus", "listening on " + listener->name());
    listener->start();
  }
  if (wanted > context_->descriptors.max_clients) {
    context_->log.write(LogLevel::warning, "modbus",
                        "only " + std::to_string(context_->descriptors.max_clients) + " of " + std::to_string(wanted) +
                            " clients fit under the system's descriptor limit; raise LimitNOFILE to " +
                            std::to_string(kSelectLimit + wanted));
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
const DescriptorRule& Server::descriptor_rule() const { return context_->descriptors; }

}  // namespace axisgate::modbus_tcp
