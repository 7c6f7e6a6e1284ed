// SPDX-License-Identifier: Apache-2.0
// One run of a program: started beside the gateway, joined to it by a socket pair, waited for by its pidfd.
// Promises that its end is reported once, with its status, that nothing of it is left behind, and that signals go to
// this very process, never to another one that got its number. Never waits for it but in the destructor, kEndsWithin at
// most.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gateway/upstream/host/packet_socket.hpp"
#include "gateway/upstream/host/restart_cause.hpp"

namespace axisgate::host {

/// The socket's number in the program.
inline constexpr int kLinkDescriptor = 3;
/// Of ours: both ends of the pair while it starts, its pidfd, and one more.
inline constexpr std::uint64_t kDescriptorsNeeded = 4;

class ChildProcess {
 public:
  /// `nicer`: below this process's own priority. `on_end` runs on the context's thread, once, not after the object is
  /// destroyed.
  static std::variant<std::unique_ptr<ChildProcess>, ProcessEnd> start(boost::asio::io_context& context,
                                                                       const std::string& program,
                                                                       const std::vector<std::string>& arguments,
                                                                       int nicer,
                                                                       std::function<void(const ProcessEnd&)> on_end);
  /// Closes the socket, which tells the program to end; one that has not done so in time is killed.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  /// None after close_socket().
  [[nodiscard]] PacketSocket* socket() { return socket_.get(); }
  void close_socket() { socket_.reset(); }
  void kill();

 private:
  ChildProcess(boost::asio::io_context& context, pid_t pid, int pidfd, int socket,
               std::function<void(const ProcessEnd&)> on_end);
  void wait();
  void await_end();
  /// No value: it still runs.
  std::optional<ProcessEnd> reap();

  pid_t pid_;
  bool ended_ = false;
  boost::asio::posix::stream_descriptor pidfd_;
  std::unique_ptr<PacketSocket> socket_;
  std::function<void(const ProcessEnd&)> on_end_;
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace axisgate::host
