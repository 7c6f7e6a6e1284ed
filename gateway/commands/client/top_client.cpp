// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/client/top_client.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>

namespace axisgate::commands {

using boost::asio::awaitable;
using boost::system::error_code;

namespace {

constexpr auto kAwait = boost::asio::as_tuple(boost::asio::use_awaitable);
constexpr std::size_t kHeader = 7;  // MBAP: transaction, protocol, length, unit
constexpr Byte kReadHolding = 0x03;
constexpr Byte kExceptionFlag = 0x80;
constexpr std::array<Byte, 3> kIdentify{0x2B, 0x0E, 0x04};  // one object alone
constexpr std::size_t kObjectHead = 9;                      // of the answer: up to the object's length
constexpr std::size_t kRegistersHead = 2;                   // of the answer: function and byte count
constexpr std::size_t kLargestPdu = 253;
constexpr const char* kNoReply = "the answer is no Modbus-TCP reply to the request";

}  // namespace

awaitable<std::string> TopClient::connect(std::string host, std::uint16_t port, Limit limit) {
  close();
  arm(limit);
  const auto [unknown, endpoints] = co_await resolver_.async_resolve(host, std::to_string(port), kAwait);
  error_code error = unknown;
  if (!error) {
    const auto [refused, endpoint] = co_await boost::asio::async_connect(socket_, endpoints, kAwait);
    error = refused;
  }
  limit_timer_.cancel();
  if (error) {
    const std::string why = reason(error);
    close();
    co_return why;
  }
  error_code ignored;
  socket_.set_option(boost::asio::ip::tcp::no_delay(true), ignored);
  co_return std::string();
}

awaitable<TopClient::Answer> TopClient::ask(std::vector<Byte> pdu, std::size_t longest, Limit limit) {
  std::vector<Byte> request(kHeader);
  store_be16(request, 0, ++transaction_);
  store_be16(request, 4, static_cast<std::uint16_t>(pdu.size() + 1));
  request[6] = kFlatMapUnit;
  request.insert(request.end(), pdu.begin(), pdu.end());

  arm(limit);
  Answer answer;
  auto [error, written] = co_await boost::asio::async_write(socket_, boost::asio::buffer(request), kAwait);
  std::array<Byte, kHeader> head{};
  if (!error) error = co_await receive(head);
  if (!error) {
    const std::size_t size = load_be16(head, 4);
    const bool mine = load_be16(head, 0) == transaction_ && load_be16(head, 2) == 0 && head[6] == kFlatMapUnit;
    if (mine && size > 2 && size <= longest + 1) {
      answer.pdu.resize(size - 1);
      error = co_await receive(answer.pdu);
    }
  }
  limit_timer_.cancel();
  if (error) answer.problem = reason(error);
  answer.refused = answer.pdu.size() == 2 && answer.pdu[0] == (pdu[0] | kExceptionFlag);
  co_return answer;
}

awaitable<ObjectRead> TopClient::identification(std::uint8_t object, Limit limit) {
  std::vector<Byte> request(kIdentify.begin(), kIdentify.end());
  request.push_back(object);
  const Answer answer = co_await ask(std::move(request), kLargestPdu, limit);
  const std::vector<Byte>& pdu = answer.pdu;
  const bool answered = pdu.size() >= kObjectHead && pdu[0] == kIdentify[0] && pdu[kObjectHead - 2] == object &&
                        pdu.size() == kObjectHead + pdu[kObjectHead - 1];
  ObjectRead result{{}, answer.problem};
  if (result.problem.empty() && !answer.refused && !answered) result.problem = kNoReply;
  if (!result.problem.empty())
    close();
  else if (answered)
    result.text.assign(pdu.begin() + kObjectHead, pdu.end());
  co_return result;
}

awaitable<RegistersRead> TopClient::read(std::uint16_t address, std::uint16_t count, Limit limit) {
  std::vector<Byte> request(5);
  request[0] = kReadHolding;
  store_be16(request, 1, address);
  store_be16(request, 3, count);
  const std::size_t size = kRegistersHead + 2U * count;
  const Answer answer = co_await ask(std::move(request), size, limit);
  const std::vector<Byte>& pdu = answer.pdu;
  const bool answered = pdu.size() == size && pdu[0] == kReadHolding && pdu[1] == 2 * count;
  RegistersRead result{{}, 0, answer.problem};
  if (result.connected() && !answer.refused && !answered) result.problem = kNoReply;
  if (!result.connected())
    close();
  else if (answer.refused)
    result.exception = pdu[1];
  else
    for (std::size_t at = kRegistersHead; at < size; at += 2) result.registers.push_back(load_be16(pdu, at));
  co_return result;
}

void TopClient::close() {
  error_code ignored;
  socket_.close(ignored);
}

void TopClient::arm(Limit limit) {
  ran_out_ = false;
  limit_timer_.expires_after(limit);
  limit_timer_.async_wait([this](const error_code& error) {
    if (error) return;
    ran_out_ = true;
    resolver_.cancel();
    close();  // ends what is waiting on the socket
  });
}

std::string TopClient::reason(const error_code& error) const {
  if (ran_out_) return "no answer in time";
  if (error == boost::asio::error::eof || error == boost::asio::error::connection_reset) {
    return "it closed the connection (a stop, a client limit, or an allow-list that does not name this host)";
  }
  return error.message();
}

awaitable<error_code> TopClient::receive(std::span<Byte> into) {
  const auto [error, bytes] =
      co_await boost::asio::async_read(socket_, boost::asio::buffer(into.data(), into.size()), kAwait);
  co_return error;
}

}  // namespace axisgate::commands
