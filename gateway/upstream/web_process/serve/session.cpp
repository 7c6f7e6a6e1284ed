// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/serve/session.hpp"

#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <utility>

namespace axisgate::web {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

/// What is read ahead of sixteen series, and a piece.
constexpr std::size_t kHeldForPieces = 160 * 1024;
constexpr SteadyNs kLeavesWithin = 2 * kSecond;
/// In one turn of the loop, so that others have theirs.
constexpr std::size_t kReadAtOnce = 16 * 1024;
/// One thread reads, and what was read is copied at once.
std::array<char, kReadAtOnce> scratch;

}  // namespace

Session::Session(asio::ip::tcp::socket socket, const Peer& peer, Desk& desk)
    : socket_(std::move(socket)), peer_(peer), desk_(desk), reader_(desk.now().at) {
  error_code ignored;
  socket_.non_blocking(true, ignored);
  socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
}

Session::~Session() { end(); }

void Session::end() {
  if (state_ == State::ended) return;
  state_ = State::ended;
  release();
  desk_.reception.leave();
  if (stream_) desk_.reception.end_stream();
  stream_.reset();
  error_code ignored;
  socket_.close(ignored);
}

// --- Reading ---------------------------------------------------------------------------------------------------------

void Session::wait_readable() {
  socket_.async_wait(asio::ip::tcp::socket::wait_read, [self = shared_from_this()](error_code error) {
    if (!error) self->on_readable();
  });
}

void Session::on_readable() {
  if (state_ == State::ended) return;
  const bool reads = state_ == State::reading;
  const std::size_t room = reads ? std::min(reader_.room(), scratch.size()) : scratch.size();
  error_code error;
  const std::size_t size = socket_.read_some(asio::buffer(scratch.data(), room), error);
  if (error == asio::error::would_block || error == asio::error::interrupted) return wait_readable();
  if (error) return end();
  if (!reads) return wait_readable();  // nothing is asked of a stream, or behind the last answer
  reader_.received({scratch.data(), size}, desk_.now().at);
  serve_requests();
  if (state_ == State::streaming || state_ == State::leaving || state_ == State::reading) wait_readable();
}

void Session::serve_requests() {
  while (state_ == State::reading) {
    const auto read = reader_.next();
    if (!read) return;
    if (const auto* refusal = std::get_if<Refusal>(&*read))
      refuse(*refusal);
    else
      serve(std::get<Request>(*read));
  }
}

void Session::refuse(Refusal refusal) {
  desk_.reception.count(refusal);
  respond(problem(refusal), true, false);
}

void Session::serve(const Request& request) {
  if (desk_.held > desk_.most_held) {
    desk_.reception.count(Refusal::memory);
    return respond(problem(Refusal::memory), request.method != Request::Method::head, request.keep_alive);
  }
  const Now now = desk_.now();
  const Answer answer = desk_.reception.answer(request, peer_, desk_.stores, now);
  if (answer.refused) desk_.on_refusal(*answer.refused, peer_.address);
  if (const auto* stream = std::get_if<StreamRequest>(&answer.what)) return begin_stream(*stream, now);
  respond(std::get<Response>(answer.what), request.method != Request::Method::head, request.keep_alive);
}

// --- Answering -------------------------------------------------------------------------------------------------------

void Session::respond(const Response& response, bool with_body, bool keep_alive) {
  const Now now = desk_.now();
  state_ = State::answering;
  deadline_ = now.at + kAnswerTakenIn;
  out_ = header_of(response, keep_alive, now);
  close_ = response.close || !keep_alive;
  if (with_body) body_ = response;
  pieces_ = 0;
  if (write_out()) return answered();
  if (state_ != State::answering) return;
  held_ = response.pieces ? kHeldForPieces : response.owned ? response.owned->size() : 0;
  desk_.held += held_;
}

void Session::release() { desk_.held -= std::exchange(held_, 0); }

bool Session::write_out() {
  const std::string_view body = body_ ? body_->body() : std::string_view();
  while (written_ < out_.size() + body.size()) {
    const std::size_t of_out = std::min(written_, out_.size());
    const std::size_t of_body = written_ - of_out;
    const std::array<asio::const_buffer, 2> rest{asio::buffer(out_.data() + of_out, out_.size() - of_out),
                                                 asio::buffer(body.data() + of_body, body.size() - of_body)};
    error_code error;
    const std::size_t size = socket_.write_some(rest, error);
    if (error == asio::error::would_block || error == asio::error::interrupted) {
      wait_writable();
      return false;
    }
    if (error) {
      end();
      return false;
    }
    written_ += size;
    if (taken_) taken_->sent(size);
  }
  out_.clear();
  written_ = 0;
  if (body_ && body_->pieces) {
    next_piece();
    return false;
  }
  body_.reset();
  return true;
}

/// It goes out in a turn of the loop of its own, so that others have theirs.
void Session::next_piece() {
  const std::string piece = body_->pieces();
  pieces_ += piece.size();
  if (pieces_ > kMaxPieces) {
    desk_.reception.count(Refusal::large_answer);
    return end();
  }
  out_ = piece_of(*body_, piece);
  if (piece.empty()) body_.reset();
  deadline_ = desk_.now().at + kAnswerTakenIn;
  wait_writable();
}

void Session::wait_writable() {
  if (waits_writable_) return;
  waits_writable_ = true;
  socket_.async_wait(asio::ip::tcp::socket::wait_write, [self = shared_from_this()](error_code error) {
    self->waits_writable_ = false;
    if (!error) self->on_writable();
  });
}

void Session::on_writable() {
  if (state_ == State::ended || !write_out()) return;
  if (state_ == State::streaming) return turn();
  if (state_ != State::answering) return;
  answered();
  serve_requests();
  if (state_ == State::streaming || state_ == State::leaving || state_ == State::reading) wait_readable();
}

void Session::answered() {
  release();
  if (close_) return leave();
  state_ = State::reading;
  reader_.answered(desk_.now().at);
}

void Session::leave() {
  state_ = State::leaving;
  deadline_ = desk_.now().at + kLeavesWithin;
  error_code ignored;
  socket_.shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
}

// --- Streaming -------------------------------------------------------------------------------------------------------

void Session::begin_stream(const StreamRequest& request, const Now& now) {
  state_ = State::streaming;
  stream_.emplace(request, desk_.stores.picture, now.at);
  taken_.emplace(now.at);
  out_ = stream_header(now);
  desk_.feed.update(desk_.stores.picture, desk_.reception.served(), now);
  if (write_out()) turn();
  desk_.on_stream();
}

void Session::turn() {
  while (state_ == State::streaming && out_.empty()) {
    out_ = stream_->next(desk_.stores, desk_.feed, desk_.now());
    if (out_.empty() || !write_out()) return;
  }
}

void Session::say_bye(std::string_view why) {
  if (state_ == State::streaming) {
    out_ += Stream::bye(why);
    write_out();
  }
  end();
}

// --- Deadlines -------------------------------------------------------------------------------------------------------

std::size_t Session::unacknowledged() {
  int bytes = 0;
  return ::ioctl(socket_.native_handle(), TIOCOUTQ, &bytes) == 0 ? static_cast<std::size_t>(bytes) : 0;
}

void Session::look() {
  const SteadyNs now = desk_.now().at;
  const auto slow = [this] {
    desk_.reception.count(Refusal::slow_reader);
    desk_.on_refusal(Refusal::slow_reader, peer_.address);
    end();
  };
  switch (state_) {
    case State::reading:
      if (now < reader_.deadline()) return;
      return reader_.late() ? refuse(Refusal::slow_header) : end();
    case State::answering:
      return now >= deadline_ ? slow() : void();
    case State::streaming:
      return taken_->stuck(unacknowledged(), !out_.empty(), now) ? slow() : void();
    case State::leaving:
      return now >= deadline_ ? end() : void();
    case State::ended:
      return;
  }
}

}  // namespace axisgate::web
