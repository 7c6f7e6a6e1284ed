// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/web/moving_axes.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <ctime>
#include <future>
#include <stdexcept>
#include <string>
#include <thread>

#include "adapters/asio/asio_runtime.hpp"
#include "gateway/image/events.hpp"
#include "gateway/upstream/web_host/web_server.hpp"

namespace axisgate::bench {
namespace {

constexpr std::int64_t kUnits = 10'000;

/// One that is free now.
std::uint16_t free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  const bool bound = ::bind(socket, reinterpret_cast<const sockaddr*>(&at), size) == 0 &&
                     ::getsockname(socket, reinterpret_cast<sockaddr*>(&at), &size) == 0;
  ::close(socket);
  if (!bound) throw std::runtime_error("no port is free");
  return ntohs(at.sin_port);
}

constexpr Quantity kMoving[] = {Quantity::statusword,     Quantity::position_actual, Quantity::velocity_actual,
                                Quantity::torque_actual,  Quantity::current_actual,  Quantity::following_error,
                                Quantity::digital_inputs, Quantity::dc_voltage};

}  // namespace

struct MovingAxes::Impl {
  Impl(int axes, std::chrono::milliseconds each, std::uint32_t streams) : every(each), port(free_port()), runtime(io) {
    web::WebFacts facts;
    for (int number = 1; number <= axes; ++number) {
      AxisImage& axis = image.add_axis(static_cast<AxisNumber>(number), "axis " + std::to_string(number), 0);
      axis.link_state = LinkState::online;
      for (const Quantity quantity : kMoving) axis.supported |= bit(quantity);
      facts.axes.push_back({axis.number, "a drive", "none", 1});
    }
    image.buses.emplace_back();
    facts.buses.push_back({0, "bus", "canopen", "can0", 0, 0});
    web::WebSettings settings;
    settings.listen = "127.0.0.1:" + std::to_string(port);
    settings.max_streams = streams;
    settings.max_connections = streams + 10;
    server = std::make_unique<web::WebServer>(
        io, runtime, web::Boot{"bench", 1, runtime.now()}, image, events, [] { return web::ProcessFigures{}; }, log,
        host::KeeperReports{[](EventKind, const std::string&) {},
                            [this](bool down) {
                              if (!down && !told) ready.set_value();
                              told = told || !down;
                            }});
    timer = runtime.make_timer([this] { turn(); });
    server->run(settings, facts);
    thread = std::thread([this] { io.run(); });
    ready.get_future().wait();
    if (every.count() > 0) boost::asio::post(io, [this] { timer->expires_at(due = runtime.now()); });
  }
  ~Impl() {
    boost::asio::post(io, [this] { io.stop(); });
    thread.join();
    server->stop();
  }

  /// One after another, as their drives answer.
  void turn() {
    AxisImage& axis = *image.axes()[next];
    next = (next + 1) % image.axes().size();
    for (const Quantity quantity : kMoving) axis[quantity] = {axis[quantity].value + 1, true, true, runtime.now()};
    ++axis.sequence;
    image.changes.mark(axis.number);
    due += Duration(every) / static_cast<int>(image.axes().size());
    timer->expires_at(due);
  }
  void set(std::int64_t turns) {
    AxisImage& axis = *image.find(1);
    axis[Quantity::position_actual] = {turns * kUnits, true, true, runtime.now()};
    ++axis.sequence;
    image.changes.mark(1);
  }

  std::chrono::milliseconds every;
  std::uint16_t port;
  boost::asio::io_context io{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work{io.get_executor()};
  AsioRuntime runtime;
  ProcessImage image;
  EventRing events;
  Log log{};
  std::promise<void> ready;
  bool told = false;
  std::unique_ptr<web::WebServer> server;
  std::unique_ptr<Timer> timer;
  std::size_t next = 0;
  Instant due{};
  std::thread thread;
};

MovingAxes::MovingAxes(int axes, std::chrono::milliseconds every, std::uint32_t streams)
    : impl_(std::make_unique<Impl>(axes, every, streams)) {}
MovingAxes::~MovingAxes() = default;

std::uint16_t MovingAxes::port() const { return impl_->port; }
pid_t MovingAxes::process() const { return impl_->server->keeper().pid().value_or(0); }

std::chrono::duration<double> MovingAxes::thread_time() const {
  clockid_t clock{};
  timespec time{};
  if (::pthread_getcpuclockid(impl_->thread.native_handle(), &clock) != 0 || ::clock_gettime(clock, &time) != 0)
    throw std::runtime_error("the thread's processor time is not to be had");
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

void MovingAxes::set(std::int64_t turns) {
  boost::asio::post(impl_->io, [this, turns] { impl_->set(turns); });
}

}  // namespace axisgate::bench
