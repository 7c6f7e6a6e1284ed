// SPDX-License-Identifier: Apache-2.0
// What our server is measured against: a bare Asio server that knows nothing but two lengths.
// Promises one read and one write per request, and no other work.
// Never parses, allocates or times anything per request.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstddef>
#include <cstdint>

namespace axisgate::bench {

class EchoServer {
 public:
  EchoServer(boost::asio::io_context& io, std::size_t request_size, std::size_t reply_size);
  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  void accept();
  boost::asio::ip::tcp::acceptor acceptor_;
  std::size_t request_size_;
  std::size_t reply_size_;
};

}  // namespace axisgate::bench
