// SPDX-License-Identifier: Apache-2.0
// A Modbus-TCP client that does not wait for one answer before it asks the next: a stop goes out behind whatever is
// still waited for. Promises that answers are reported in the order of the requests, that a reply which fits no request
// and one that does not come in time are the end of the connection, reported once, and that nothing is reported once it
// is gone. Never reconnects, and never repeats a request.
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "gateway/commands/client/host_port.hpp"
#include "gateway/core/bytes.hpp"

namespace axisgate::commands {

class ManualClient {
 public:
  using OnReply = std::function<void(Bytes pdu)>;
  /// Longer than any write of a drive takes: then nobody is there any more.
  static constexpr std::chrono::milliseconds kAnswerLimit{5000};
  static constexpr std::chrono::milliseconds kConnectLimit{3000};

  ManualClient(boost::asio::io_context& io, std::function<void(const std::string& why)> on_lost);

  void connect(const HostPort& place, std::function<void()> on_connected);
  /// Nothing happens where the connection is gone.
  void ask(const std::vector<Byte>& pdu, OnReply on_reply);
  [[nodiscard]] std::size_t waiting() const { return asked_.size(); }
  void close();

 private:
  struct Asked {
    std::uint16_t transaction = 0;
    Byte function = 0;
    std::chrono::steady_clock::time_point by;
    OnReply on_reply;
  };
  void arm();
  void write();
  void read_head();
  void read_body(std::size_t size);
  void lose(const std::string& why);

  boost::asio::ip::tcp::socket socket_;
  boost::asio::ip::tcp::resolver resolver_;
  boost::asio::steady_timer limit_;
  std::function<void(const std::string&)> on_lost_;
  std::deque<Asked> asked_;
  std::vector<Byte> unsent_;
  std::vector<Byte> sending_;
  std::array<Byte, 7> head_{};
  std::vector<Byte> body_;
  std::uint16_t transaction_ = 0;
  bool open_ = false;
  bool ended_ = false;
};

}  // namespace axisgate::commands
