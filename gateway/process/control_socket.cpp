// SPDX-License-Identifier: Apache-2.0
#include "gateway/process/control_socket.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/crc.hpp>
#include <filesystem>
#include <utility>

namespace axisgate::process {
namespace {

using boost::asio::local::stream_protocol;
using boost::system::error_code;

constexpr std::string_view kControlPrefix = "axisgate/";
/// sun_path has 108 characters: the zero before an abstract name (unix(7)) and the one that Asio puts behind are two.
constexpr std::size_t kLongestName = 106;

bool may_ask(int descriptor) {
  ucred who{};
  socklen_t size = sizeof who;
  if (::getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &who, &size) != 0) return false;
  return who.uid == 0 || who.uid == ::geteuid();
}

}  // namespace

std::string control_name(const std::string& config) {
  std::error_code error;
  std::filesystem::path path = std::filesystem::absolute(config, error);
  std::string file = (error ? std::filesystem::path(config) : path).lexically_normal().string();
  const std::size_t room = kLongestName - kControlPrefix.size();
  if (file.size() <= room) return std::string(kControlPrefix) + file;
  // Two may end alike. A path begins with '/', so no short one has such a name.
  boost::crc_32_type crc;
  crc.process_bytes(file.data(), file.size());
  const std::string key = fmt::format("{:08x}...", crc.checksum());
  return std::string(kControlPrefix) + key + file.substr(file.size() - room + key.size());
}

struct ControlSocket::Shared : std::enable_shared_from_this<ControlSocket::Shared> {
  /// One who asks; lives as long as a handler of it does.
  struct Asker {
    explicit Asker(stream_protocol::socket with) : socket(std::move(with)) {}
    stream_protocol::socket socket;
    std::array<char, kReloadRequest.size()> request{};
    std::string answer;
    std::unique_ptr<Timer> patience;
  };

  Shared(boost::asio::io_context& io, Runtime& with, const Log& to, std::function<void(Reload::Done)> reload)
      : runtime(with), log(to), on_reload(std::move(reload)), acceptor(io) {}

  void open(const std::string& config) {
    error_code error;
    acceptor.open(stream_protocol(), error);
    if (!error) acceptor.bind(stream_protocol::endpoint('\0' + control_name(config)), error);
    if (!error) acceptor.listen(static_cast<int>(kMaxAskers), error);
    if (!error) return accept();
    log.write(LogLevel::warning, "gateway",
              fmt::format("`axisgate reload {}` will not be heard: {}; a SIGHUP will, where the gateway is a service",
                          config, error.message()));
  }
  void accept() {
    acceptor.async_accept([self = shared_from_this()](const error_code& error, stream_protocol::socket socket) {
      if (self->closed || error == boost::asio::error::operation_aborted) return;
      if (!error) self->admit(std::move(socket));
      self->accept();
    });
  }
  void admit(stream_protocol::socket socket) {
    if (askers >= kMaxAskers || !may_ask(socket.native_handle())) return;
    auto asker = std::make_shared<Asker>(std::move(socket));
    ++askers;
    asker->patience = runtime.make_timer([asker_now = std::weak_ptr(asker)] {
      error_code ignored;
      if (const auto there = asker_now.lock()) there->socket.close(ignored);
    });
    asker->patience->expires_at(runtime.now() + kMaySpeakFor);
    boost::asio::async_read(
        asker->socket, boost::asio::buffer(asker->request),
        [self = shared_from_this(), asker](const error_code& error, std::size_t) { self->on_request(asker, !error); });
  }
  void on_request(const std::shared_ptr<Asker>& asker, bool heard) {
    asker->patience->expires_at(kNever);
    if (closed || !heard || std::string_view(asker->request.data(), asker->request.size()) != kReloadRequest)
      return forget(asker);
    on_reload([self = shared_from_this(), asker](const ReloadResult& result) { self->answer(asker, result); });
  }
  void answer(const std::shared_ptr<Asker>& asker, const ReloadResult& result) {
    asker->answer = std::string(result.done ? kReloadDone : kReloadRefused) + '\n';
    for (const std::string& line : result.lines) asker->answer += line + '\n';
    if (!closed) asker->patience->expires_at(runtime.now() + kMaySpeakFor);
    boost::asio::async_write(
        asker->socket, boost::asio::buffer(asker->answer),
        [self = shared_from_this(), asker](const error_code&, std::size_t) { self->forget(asker); });
  }
  void forget(const std::shared_ptr<Asker>& asker) {
    error_code ignored;
    asker->socket.close(ignored);
    asker->patience.reset();
    --askers;
  }

  Runtime& runtime;
  const Log& log;
  std::function<void(Reload::Done)> on_reload;
  stream_protocol::acceptor acceptor;
  std::size_t askers = 0;
  bool closed = false;
};

ControlSocket::ControlSocket(boost::asio::io_context& io, Runtime& runtime, const Log& log, const std::string& config,
                             std::function<void(Reload::Done)> on_reload)
    : shared_(std::make_shared<Shared>(io, runtime, log, std::move(on_reload))) {
  shared_->open(config);
}

ControlSocket::~ControlSocket() {
  shared_->closed = true;
  error_code ignored;
  shared_->acceptor.close(ignored);
}

}  // namespace axisgate::process
