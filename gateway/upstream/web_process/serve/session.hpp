// SPDX-License-Identifier: Apache-2.0
// One connection: it reads requests, writes answers, and becomes a stream where one is asked for.
// Promises that nothing blocks, that what the other side does not take makes it read no further request, and that each
// state has its deadline. Never decides what is answered.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "gateway/upstream/web_process/api/reception.hpp"
#include "gateway/upstream/web_process/http/request_reader.hpp"
#include "gateway/upstream/web_process/stream/feed.hpp"
#include "gateway/upstream/web_process/stream/stream.hpp"
#include "gateway/upstream/web_process/stream/taken_watch.hpp"

namespace axisgate::web {

/// What all connections share; it outlives them.
struct Desk {
  Reception reception;
  Stores stores;
  Feed feed{};
  std::function<Now()> now;
  std::function<void(Refusal, const Address&)> on_refusal;
  /// Bodies of answers that are not taken yet, and how many there may be.
  std::size_t held = 0;
  std::size_t most_held = 0;
  /// A stream has begun: its turns are due.
  std::function<void()> on_stream;
};

class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(boost::asio::ip::tcp::socket socket, const Peer& peer, Desk& desk);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void start() { wait_readable(); }
  /// From time to time: its deadlines.
  void look();
  [[nodiscard]] bool streams() const { return state_ == State::streaming; }
  /// Its stream's turn.
  void turn();
  /// The program ends.
  void say_bye(std::string_view why);
  [[nodiscard]] bool ended() const { return state_ == State::ended; }

 private:
  /// leaving: all is sent, and what still comes is thrown away, so that the other side can read its answer.
  enum class State : std::uint8_t { reading, answering, streaming, leaving, ended };

  void wait_readable();
  void on_readable();
  void wait_writable();
  void on_writable();
  void serve_requests();
  void serve(const Request& request);
  void refuse(Refusal refusal);
  void respond(const Response& response, bool with_body, bool keep_alive);
  void begin_stream(const StreamRequest& request, const Now& now);
  /// False: the other side does not take all of it now, or is gone.
  bool write_out();
  void next_piece();
  void answered();
  void release();
  void leave();
  void end();
  [[nodiscard]] std::size_t unacknowledged();

  boost::asio::ip::tcp::socket socket_;
  const Peer peer_;
  Desk& desk_;
  State state_ = State::reading;
  RequestReader reader_;
  std::string out_;               ///< header, or frames
  std::optional<Response> body_;  ///< behind the header
  std::size_t held_ = 0;          ///< of Desk::held what is this answer's
  std::size_t written_ = 0;       ///< of both together
  std::uint64_t pieces_ = 0;      ///< bytes of the body that is made while it is taken
  bool close_ = false;            ///< behind this answer
  bool waits_writable_ = false;
  SteadyNs deadline_ = 0;  ///< of answering and leaving
  std::optional<Stream> stream_;
  std::optional<TakenWatch> taken_;
};

}  // namespace axisgate::web
