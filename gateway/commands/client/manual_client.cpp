// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/client/manual_client.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <utility>

#include "gateway/commands/client/top_client.hpp"

namespace axisgate::commands {
namespace {

using Failure = boost::system::error_code;

constexpr std::size_t kLongestPdu = 253;
constexpr Byte kErrorFlag = 0x80;

}  // namespace

ManualClient::ManualClient(boost::asio::io_context& io, std::function<void(const std::string&)> on_lost)
    : socket_(io), resolver_(io), limit_(io), on_lost_(std::move(on_lost)) {}

void ManualClient::connect(const HostPort& place, std::function<void()> on_connected) {
  limit_.expires_after(kConnectLimit);
  limit_.async_wait([this](const Failure& error) {
    if (!error && !open_) lose("it does not answer");
  });
  resolver_.async_resolve(
      place.host, std::to_string(place.port),
      [this, on_connected = std::move(on_connected)](const Failure& unknown, const auto& endpoints) mutable {
        if (ended_) return;
        if (unknown) return lose(unknown.message());
        boost::asio::async_connect(socket_, endpoints,
                                   [this, on_connected = std::move(on_connected)](const Failure& refused, const auto&) {
                                     if (ended_) return;
                                     if (refused) return lose(refused.message());
                                     Failure ignored;
                                     socket_.set_option(boost::asio::ip::tcp::no_delay(true), ignored);
                                     open_ = true;
                                     limit_.cancel();
                                     read_head();
                                     on_connected();
                                   });
      });
}

void ManualClient::ask(const std::vector<Byte>& pdu, OnReply on_reply) {
  if (!open_) return;
  std::array<Byte, 7> head{};
  store_be16(head, 0, ++transaction_);
  store_be16(head, 4, static_cast<std::uint16_t>(pdu.size() + 1));
  head[6] = kFlatMapUnit;
  unsent_.insert(unsent_.end(), head.begin(), head.end());
  unsent_.insert(unsent_.end(), pdu.begin(), pdu.end());
  asked_.push_back({transaction_, pdu[0], std::chrono::steady_clock::now() + kAnswerLimit, std::move(on_reply)});
  if (asked_.size() == 1) arm();
  if (sending_.empty()) write();
}

/// For the oldest answer that is waited for.
void ManualClient::arm() {
  limit_.cancel();
  if (asked_.empty()) return;
  limit_.expires_at(asked_.front().by);
  limit_.async_wait([this](const Failure& error) {
    const bool due = !asked_.empty() && std::chrono::steady_clock::now() >= asked_.front().by;
    if (!error && due) lose("no answer in time");
  });
}

void ManualClient::write() {
  std::swap(sending_, unsent_);
  if (sending_.empty()) return;
  boost::asio::async_write(socket_, boost::asio::buffer(sending_), [this](const Failure& error, std::size_t) {
    if (ended_) return;
    sending_.clear();
    if (error) return lose(error.message());
    write();
  });
}

void ManualClient::read_head() {
  boost::asio::async_read(socket_, boost::asio::buffer(head_), [this](const Failure& error, std::size_t) {
    if (ended_) return;
    if (error == boost::asio::error::eof || error == boost::asio::error::connection_reset)
      return lose("it closed the connection: a stop, a client limit, or an allow-list that does not name this host");
    if (error) return lose(error.message());
    const std::size_t size = load_be16(head_, 4);
    const bool mine = !asked_.empty() && load_be16(head_, 0) == asked_.front().transaction && load_be16(head_, 2) == 0;
    if (!mine || size < 2 || size > kLongestPdu + 1) return lose("it answers as no Modbus-TCP server does");
    read_body(size - 1);
  });
}

void ManualClient::read_body(std::size_t size) {
  body_.resize(size);
  boost::asio::async_read(socket_, boost::asio::buffer(body_), [this](const Failure& error, std::size_t) {
    if (ended_) return;
    if (error) return lose(error.message());
    const Asked asked = std::move(asked_.front());
    asked_.pop_front();
    if ((body_[0] & ~kErrorFlag) != asked.function) return lose("it answers as no Modbus-TCP server does");
    arm();
    asked.on_reply(body_);
    if (!ended_) read_head();
  });
}

void ManualClient::lose(const std::string& why) {
  if (ended_) return;
  close();
  on_lost_(why);
}

void ManualClient::close() {
  ended_ = true;
  open_ = false;
  Failure ignored;
  resolver_.cancel();
  limit_.cancel();
  socket_.close(ignored);
}

}  // namespace axisgate::commands
