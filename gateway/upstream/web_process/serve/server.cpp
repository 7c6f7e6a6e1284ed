// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/serve/server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <optional>

#include "gateway/core/log.hpp"
#include "gateway/upstream/link/exit_codes.hpp"
#include "gateway/upstream/program/steady.hpp"
#include "gateway/upstream/web_process/api/refusal_lines.hpp"
#include "gateway/upstream/web_process/serve/capture_folder.hpp"
#include "gateway/upstream/web_process/serve/listening.hpp"
#include "gateway/upstream/web_process/serve/session.hpp"
#include "gateway/upstream/web_process/system/confinement.hpp"

namespace axisgate::web {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr auto kLookEach = std::chrono::milliseconds(250);
constexpr auto kTurnEach = std::chrono::nanoseconds(kGrid);
/// Where the system has no descriptor left.
constexpr auto kAcceptAgain = std::chrono::milliseconds(100);
/// Of the memory's limit, for answers that are not taken yet.
constexpr std::size_t kShareOfAnswers = 4;
/// And for captures.
constexpr std::size_t kShareOfCaptures = 8;
/// In one turn of the loop, so that pages have theirs.
constexpr int kRecordsAtOnce = 256;

Now clocks() { return {program::steady_now(), program::time_of_day_difference()}; }

class Server {
 public:
  Server(const Settings& settings, const CaptureSettings& captures, Link& link)
      : link_(link),
        capture_bytes_((std::size_t{settings.memory_limit_mb} << 20) / kShareOfCaptures),
        folder_(captures.folder, [this](LogLevel level, const std::string& text) { tell(level, text); }),
        listening_(open_listening(io_, settings.listen)),
        from_gateway_(io_),
        end_signal_(io_, SIGTERM),
        look_(io_),
        turn_(io_),
        desk_{.reception = Reception(settings),
              .stores = Stores(std::size_t{settings.history_mb} << 20, captures, capture_bytes_),
              .now = [this] { return now(); },
              .on_refusal = [this](Refusal refusal, const Address& who) { tell_refusal(refusal, who); },
              .most_held = (std::size_t{settings.memory_limit_mb} << 20) / kShareOfAnswers,
              .on_stream = [this] { begin_turns(); }} {
    from_gateway_.assign(link_.fd());
  }
  ~Server() { from_gateway_.release(); }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int run() {
    begin();
    io_.run();
    for (const auto& session : sessions_) session->say_bye(why_);
    link_.flush();
    return exit_code_;
  }

 private:
  void begin() {
    end_signal_.async_wait([this](error_code error, int) {
      if (!error) end(link::kExitGatewayGone, "axisgate-web was asked to end");
    });
    folder_.restore(desk_.stores.recorder, capture_bytes_);
    wait_records();
    look_again();
    const Confinement done = confine(folder_.descriptor());
    desk_.reception.confined(done.confined);
    link_.send(ReadyRecord{AXISGATE_VERSION, done.confined});
    if (done.confined && !done.writes && folder_.descriptor() >= 0) {
      folder_.close();
      tell(LogLevel::warning,
           "new captures are in memory alone: the kernel cannot keep a program in one folder (Landlock)");
    }
    if (!done.confined)
      tell(LogLevel::warning, "the kernel has no filter of system calls (seccomp): this process is not confined");
    for (Listening& each : listening_) {
      tell(each.is_there ? LogLevel::info : LogLevel::warning,
           "the page is at http://" + each.address + "/" +
               (each.is_there ? "" : ", as soon as this computer has the address"));
      accept(each.acceptor);
    }
  }

  /// The same one for all that is done in a turn of the loop would be enough; asking costs no call of the system.
  Now now() {
    const Now read = clocks();
    // Measured again it differs by nanoseconds: the time of one and the same event would go to and fro.
    if (std::abs(read.to_utc - to_utc_) > kMillisecond) to_utc_ = read.to_utc;
    return {read.at, to_utc_};
  }

  void tell(LogLevel level, const std::string& text) { link_.send(LogRecord{static_cast<std::uint8_t>(level), text}); }
  void tell_refusal(Refusal refusal, const Address& who) {
    if (const auto line = lines_.on(refusal, who, now().at)) tell(LogLevel::warning, *line);
  }

  // --- The gateway --------------------------------------------------------------------------------------------------

  void wait_records() {
    from_gateway_.async_wait(asio::posix::stream_descriptor::wait_read, [this](error_code error) {
      if (!error) take_records();
    });
  }

  void take_records() {
    for (int i = 0; i < kRecordsAtOnce; ++i) {
      const Link::Got got = link_.receive();
      if (got.what == program::Received::nothing) break;
      if (got.what == program::Received::closed) return end(link::kExitGatewayGone, "the gateway has ended");
      if (got.what == program::Received::garbage) return end_for(got.problem);
      if (!desk_.stores.take(got.record, now())) return end_for("a record that the gateway never sends");
    }
    wait_records();
  }

  void end_for(const std::string& problem) {
    tell(LogLevel::error, "from the gateway: " + problem);
    end(link::kExitProtocol, "the gateway is of another version");
  }

  void end(int exit_code, const char* why) {
    exit_code_ = exit_code;
    why_ = why;
    io_.stop();
  }

  // --- Connections --------------------------------------------------------------------------------------------------

  void accept(tcp::acceptor& acceptor) {
    acceptor.async_accept([this, &acceptor](error_code error, tcp::socket socket) {
      if (error) return accept_later(acceptor);
      take_in(std::move(socket));
      accept(acceptor);
    });
  }

  void accept_later(tcp::acceptor& acceptor) {
    auto timer = std::make_shared<asio::steady_timer>(io_, kAcceptAgain);
    timer->async_wait([this, &acceptor, timer](error_code) { accept(acceptor); });
  }

  void take_in(tcp::socket socket) {
    error_code error;
    Peer peer;
    peer.address = address_of(socket.remote_endpoint(error).address());
    if (!error) peer.reached = address_of(socket.local_endpoint(error).address());
    if (error) return;
    if (const auto refusal = desk_.reception.enter(peer.address)) return turn_away(socket, peer, *refusal);
    auto session = std::make_shared<Session>(std::move(socket), peer, desk_);
    session->start();
    sessions_.push_back(std::move(session));
  }

  /// What is not kept: an answer where there is one, and the end, without waiting for what it asks.
  void turn_away(tcp::socket& socket, const Peer& peer, Refusal refusal) {
    tell_refusal(refusal, peer.address);
    if (status_of(refusal) == 0) return;
    const Response response = problem(refusal);
    const std::string text = header_of(response, false, now()) + std::string(response.body());
    error_code ignored;
    socket.non_blocking(true, ignored);
    socket.write_some(asio::buffer(text), ignored);
    socket.shutdown(tcp::socket::shutdown_send, ignored);
    // What has come is taken: with something unread the system would throw the answer away.
    std::array<char, kMaxHeader> unread{};
    socket.read_some(asio::buffer(unread), ignored);
  }

  void look_again() {
    look_.expires_after(kLookEach);
    look_.async_wait([this](error_code error) {
      if (error) return;
      for (const auto& session : sessions_) session->look();
      std::erase_if(sessions_, [](const auto& session) { return session->ended(); });
      folder_.take(desk_.stores.turn(now()));
      link_.flush();
      look_again();
    });
  }

  // --- Streams ------------------------------------------------------------------------------------------------------

  void begin_turns() {
    if (turning_) return;
    turning_ = true;
    next_turn();
  }

  void next_turn() {
    const SteadyNs at = program::steady_now();
    turn_.expires_after(kTurnEach - std::chrono::nanoseconds(at % kGrid));
    turn_.async_wait([this](error_code error) {
      if (error) return;
      turning_ = desk_.reception.served().streams != 0;
      if (!turning_) return;
      desk_.feed.update(desk_.stores.picture, desk_.reception.served(), now());
      for (const auto& session : sessions_)
        if (session->streams()) session->turn();
      next_turn();
    });
  }

  Link& link_;
  const std::size_t capture_bytes_;
  CaptureFolder folder_;
  asio::io_context io_{1};
  std::vector<Listening> listening_;
  asio::posix::stream_descriptor from_gateway_;
  asio::signal_set end_signal_;
  asio::steady_timer look_;
  asio::steady_timer turn_;
  Desk desk_;
  RefusalLines lines_;
  std::vector<std::shared_ptr<Session>> sessions_;
  std::int64_t to_utc_ = 0;
  bool turning_ = false;
  int exit_code_ = link::kExitInternal;
  const char* why_ = "";
};

}  // namespace

int serve(const Settings& settings, const CaptureSettings& captures, Link& link) {
  Server server(settings, captures, link);
  return server.run();
}

}  // namespace axisgate::web
