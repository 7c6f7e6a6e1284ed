// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/dds/changing_image.hpp"

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <future>
#include <thread>

#include "adapters/asio/asio_runtime.hpp"
#include "gateway/image/events.hpp"
#include "gateway/upstream/dds_host/dds_server.hpp"

namespace axisgate::bench {
namespace {

class NoCommands final : public CommandPort {
 public:
  std::optional<BatchResult> submit(AxisNumber, const WriteBatch&, BatchCallback) override {
    return BatchResult{refusal(Errc::not_supported)};
  }
  void client_gone(ClientId) override {}
  bool holds(AxisNumber, Quantity, std::int64_t) const override { return false; }
  bool owner_asks(AxisNumber, ClientId, Quantity, std::int64_t) const override { return false; }
  std::int32_t set_position_value(AxisNumber) const override { return 0; }
};

dds::DdsSettings settings_of(const ChangingAxes& shape) {
  dds::DdsSettings settings;
  settings.domain = shape.domain;
  settings.min_period = shape.min_period;
  for (int axis = 1; axis <= shape.axes; ++axis) settings.units.push_back({static_cast<AxisNumber>(axis), {}, {}});
  return settings;
}

}  // namespace

struct ChangingImage::Impl {
  explicit Impl(const ChangingAxes& wanted) : shape(wanted), runtime(io) {
    for (int number = 1; number <= shape.axes; ++number) {
      AxisImage& axis = image.add_axis(static_cast<AxisNumber>(number), "axis " + std::to_string(number), 0);
      axis.link_state = LinkState::online;
      axis.supported = bit(Quantity::position_actual);
    }
    server = std::make_unique<dds::DdsServer>(io, runtime, settings_of(shape), image, events, commands, log,
                                              dds::DdsReports{{[](EventKind, const std::string&) {},
                                                               [this](bool down) {
                                                                 if (!down && !told) ready.set_value();
                                                                 told = told || !down;
                                                               }},
                                                              {}});
    timer = runtime.make_timer([this] { turn(); });
    server->start();
    thread = std::thread([this] { io.run(); });
    ready.get_future().wait();
  }
  ~Impl() {
    boost::asio::post(io, [this] { io.stop(); });
    thread.join();
    server->stop();
  }

  void turn() {
    if (!changing) return;
    AxisImage& axis = *image.find(static_cast<AxisNumber>(1 + next));
    next = (next + 1) % shape.axes;
    Sample& position = axis[Quantity::position_actual];
    position = {position.value + 1, true, true, runtime.now()};
    ++axis.sequence;
    image.changes.mark(axis.number);
    ++changed;
    due += Duration(shape.every) / shape.axes;
    timer->expires_at(due);
  }

  ChangingAxes shape;
  boost::asio::io_context io{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work{io.get_executor()};
  AsioRuntime runtime;
  ProcessImage image;
  EventRing events;
  NoCommands commands;
  Log log{};
  std::promise<void> ready;
  bool told = false;
  std::unique_ptr<dds::DdsServer> server;
  std::unique_ptr<Timer> timer;
  bool changing = false;
  int next = 0;
  Instant due{};
  std::atomic<std::uint64_t> changed = 0;
  std::thread thread;
};

ChangingImage::ChangingImage(const ChangingAxes& shape) : impl_(std::make_unique<Impl>(shape)) {}
ChangingImage::~ChangingImage() = default;

void ChangingImage::change(bool on) {
  std::promise<void> done;
  boost::asio::post(impl_->io, [&] {
    impl_->changing = on;
    impl_->due = impl_->runtime.now();
    if (on) impl_->timer->expires_at(impl_->due);
    done.set_value();
  });
  done.get_future().wait();
}

std::uint64_t ChangingImage::changes() const { return impl_->changed; }
pid_t ChangingImage::process() const { return impl_->server->keeper().pid().value_or(0); }

}  // namespace axisgate::bench
