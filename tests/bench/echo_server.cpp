// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/echo_server.hpp"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <memory>

namespace axisgate::bench {
namespace {

using boost::asio::ip::tcp;

class Echo : public std::enable_shared_from_this<Echo> {
 public:
  Echo(tcp::socket socket, std::size_t request_size, std::size_t reply_size)
      : socket_(std::move(socket)), request_size_(request_size), reply_size_(reply_size) {}

  void read() {
    socket_.async_read_some(boost::asio::buffer(bytes_),
                            [self = shared_from_this()](const boost::system::error_code& error, std::size_t got) {
                              if (error) return;
                              self->received_ += got;
                              if (self->received_ < self->request_size_) return self->read();
                              self->received_ -= self->request_size_;
                              self->write();
                            });
  }

 private:
  void write() {
    boost::asio::async_write(socket_, boost::asio::buffer(bytes_, reply_size_),
                             [self = shared_from_this()](const boost::system::error_code& error, std::size_t) {
                               if (!error) self->read();
                             });
  }

  tcp::socket socket_;
  std::size_t request_size_;
  std::size_t reply_size_;
  std::size_t received_ = 0;
  std::array<std::uint8_t, 260> bytes_{};
};

}  // namespace

EchoServer::EchoServer(boost::asio::io_context& io, std::size_t request_size, std::size_t reply_size)
    : acceptor_(io, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0)),
      request_size_(request_size),
      reply_size_(reply_size) {
  accept();
}

void EchoServer::accept() {
  acceptor_.async_accept([this](const boost::system::error_code& error, tcp::socket socket) {
    if (!error) {
      socket.set_option(tcp::no_delay(true));
      std::make_shared<Echo>(std::move(socket), request_size_, reply_size_)->read();
    }
    accept();
  });
}

}  // namespace axisgate::bench
