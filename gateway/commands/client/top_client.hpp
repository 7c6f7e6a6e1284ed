// SPDX-License-Identifier: Apache-2.0
// A small Modbus-TCP client: one connection, one request at a time, as `axisgate top` needs it.
// Promises that every call ends within its time limit, whatever the server does or does not send.
// Never writes a register, and never uses a reply that does not fit its request.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "gateway/core/bytes.hpp"

namespace axisgate::commands {

/// Of any unit id: the flat map, also where a listener shows one axis per unit id.
inline constexpr std::uint8_t kFlatMapUnit = 255;

struct RegistersRead {
  std::vector<std::uint16_t> registers;
  std::uint8_t exception = 0;  ///< the server's, where it answered with one
  std::string problem;         ///< no usable answer: why, in words; the connection is closed then
  [[nodiscard]] bool connected() const { return problem.empty(); }
  [[nodiscard]] bool ok() const { return problem.empty() && exception == 0; }
};

struct ObjectRead {
  std::string text;     ///< empty where the server has no such object
  std::string problem;  ///< as RegistersRead's
};

class TopClient {
 public:
  using Limit = std::chrono::milliseconds;
  explicit TopClient(boost::asio::io_context& io) : socket_(io), resolver_(io), limit_timer_(io) {}

  /// Empty: connected. Otherwise what went wrong, in words.
  [[nodiscard]] boost::asio::awaitable<std::string> connect(std::string host, std::uint16_t port, Limit limit);
  /// Device identification (43/14): the text of one object.
  [[nodiscard]] boost::asio::awaitable<ObjectRead> identification(std::uint8_t object, Limit limit);
  /// Function 3. `count` 1..125.
  [[nodiscard]] boost::asio::awaitable<RegistersRead> read(std::uint16_t address, std::uint16_t count, Limit limit);
  void close();

 private:
  struct Answer {
    std::vector<Byte> pdu;  ///< empty: what came is none
    bool refused = false;   ///< it is an exception
    std::string problem;    ///< why nothing came
  };
  /// `longest`: an answer that is longer is none.
  [[nodiscard]] boost::asio::awaitable<Answer> ask(std::vector<Byte> pdu, std::size_t longest, Limit limit);
  void arm(Limit limit);
  [[nodiscard]] std::string reason(const boost::system::error_code& error) const;
  [[nodiscard]] boost::asio::awaitable<boost::system::error_code> receive(std::span<Byte> into);

  boost::asio::ip::tcp::socket socket_;
  boost::asio::ip::tcp::resolver resolver_;
  boost::asio::steady_timer limit_timer_;
  std::uint16_t transaction_ = 0;
  bool ran_out_ = false;
};

}  // namespace axisgate::commands
