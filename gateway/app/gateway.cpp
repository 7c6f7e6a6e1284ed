#include "gateway/app/gateway.hpp"

#include <algorithm>
#include <string>

#include "gateway/app/adapter_names.hpp"

namespace axisgate::app {
namespace {

// How long "event loop slow" stays set, so that an HMI that polls once a second sees it.
constexpr Duration kSlowLoopShown = std::chrono::seconds(10);

LogLevel level_of(EventKind kind) {
  return kind == EventKind::fault || kind == EventKind::warning ? LogLevel::warning : LogLevel::info;
}

/// "axis 3 lift"; the name that an axis has without one in the configuration is its number.
std::string source_of(const ProcessImage& image, AxisNumber number) {
  if (number == 0) return "gateway";
  const std::string plain = "axis " + std::to_string(number);
  const AxisImage* const axis = image.find(number);
  return axis == nullptr || axis->name.empty() || axis->name == plain ? plain : plain + " " + axis->name;
}

}  // namespace

Gateway::Gateway(const Config& config, Models models, Runtime& runtime, const Log& log, const MakeWire& make_wire)
    : runtime_(runtime),
      log_(log),
      models_(std::move(models)),
      events_([this](const Event& e) {
        log_.write(level_of(e.kind), source_of(image_, e.axis), e.text);
        image_.changes.mark(0);
      }),
      closing_(runtime.make_timer([this] {
        if (closed_) std::exchange(closed_, nullptr)();
      })) {
  image_.buses.resize(config.buses.size());
  for (std::size_t i = 0; i < config.buses.size(); ++i) add_bus(config.buses[i], i, make_wire);
  image_.refresh = [this] { refresh(); };
}

Gateway::~Gateway() = default;

void Gateway::add_bus(const BusConfig& config, std::size_t index, const MakeWire& make_wire) {
  const std::uint32_t bit_rate = adapter::on_can(config.adapter) ? config.bitrate : 0;
  bus::BusSettings settings{config.name, config.timeout, config.min_gap, config.settle, bit_rate};
  image_.buses[index].name = config.name;
  buses_.push_back(std::make_unique<bus::Bus>(std::move(settings), config.drives.size(),
                                              make_wire(config, models_[index]), runtime_, log_));
  if (config.decode) buses_.back()->set_decode(true);
  for (std::size_t d = 0; d < config.drives.size(); ++d) {
    const drive::DriveModel& model = models_[index][d];
    std::vector<AxisImage*> images;
    for (const drive::AxisModel& axis : model.axes)
      images.push_back(&image_.add_axis(axis.number, axis.name, static_cast<std::uint8_t>(index)));
    drives_.push_back(std::make_unique<drive::Drive>(model, static_cast<bus::DriveSlot>(d), std::move(images),
                                                     *buses_.back(), runtime_, events_));
    bus_of_drive_.push_back(index);
    for (std::size_t a = 0; a < model.axes.size(); ++a)
      places_[model.axes[a].number] = {drives_.back().get(), static_cast<bus::AxisSlot>(a)};
  }
}

void Gateway::start() {
  started_ = runtime_.now();
  image_.gateway.state = GatewayState::running;
  for (auto& bus : buses_) bus->start();
}

void Gateway::close(std::function<void()> closed) {
  if (stopping_) return;
  stopping_ = true;
  image_.gateway.state = GatewayState::stopping;
  closed_ = std::move(closed);
  closing_->expires_at(runtime_.now() + kClosing);
  open_drives_ = drives_.size() + 1;  // and this function, so that the last one is told once
  for (const auto& drive : drives_) drive->close([this] { drive_closed(); });
  drive_closed();
}

void Gateway::stop() {
  stopping_ = stopped_ = true;
  image_.gateway.state = GatewayState::stopping;
}

void Gateway::drive_closed() {
  if (--open_drives_ == 0) closing_->expires_at(runtime_.now());
}

std::optional<GroupResult> Gateway::submit(AxisNumber axis, const Group& group, GroupCallback on_result) {
  if (axis > kMaxAxisNumber || places_[axis].drive == nullptr) return GroupResult{{Errc::no_path, 0}, 0, 0};
  return places_[axis].drive->submit(places_[axis].slot, group, std::move(on_result));
}

void Gateway::client_gone(ClientId client) {
  if (stopped_) return;  // it ends them all itself
  for (const auto& drive : drives_) drive->client_gone(client);
}

bool Gateway::holds(AxisNumber axis, Quantity quantity, std::int64_t value) const {
  if (axis > kMaxAxisNumber || places_[axis].drive == nullptr) return false;
  return places_[axis].drive->axis(places_[axis].slot).holds(quantity, value);
}

bool Gateway::owner_asks(AxisNumber axis, ClientId client, Quantity quantity, std::int64_t value) const {
  if (axis > kMaxAxisNumber || places_[axis].drive == nullptr) return false;
  return places_[axis].drive->axis(places_[axis].slot).owner_asks(client, quantity, value);
}

std::int32_t Gateway::set_position_value(AxisNumber axis) const {
  if (axis > kMaxAxisNumber || places_[axis].drive == nullptr) return 0;
  return places_[axis].drive->axis(places_[axis].slot).set_position_value();
}

const drive::Drive* Gateway::drive_of(AxisNumber axis) const {
  return axis > kMaxAxisNumber ? nullptr : places_[axis].drive;
}

void Gateway::report_loop_delay(Duration delay) {
  if (delay >= kSlowLoop) slow_loop_at_ = runtime_.now();
}

void Gateway::report_file_changed(const std::string& file) {
  file_changed_ = !file.empty();
  report(EventKind::warning, file_changed_ ? file +
                                                 " is not what the gateway runs with: check it, and restart the "
                                                 "gateway when its axes are disabled"
                                           : "the files on disk are what the gateway runs with again");
}

// --- Rows of the gateway and of the buses, gathered when somebody reads them
// ------------------------------------------

void Gateway::refresh() {
  GatewayImage& shown = image_.gateway;
  shown.axes_online = 0;
  for (const auto& axis : image_.axes())
    shown.axes_online = static_cast<std::uint16_t>(shown.axes_online + axis->reachable());
  const auto up = runtime_.now() - started_;
  shown.uptime_s = static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::seconds>(up).count());
  for (std::size_t i = 0; i < buses_.size(); ++i) refresh_bus(i);
  shown.alarms = gateway_alarms();
  if (stopping_ || started_ == kLongAgo) return;
  const bool all_online = shown.axes_online == image_.axes().size();
  shown.state = all_online ? GatewayState::running : GatewayState::degraded;
}

void Gateway::refresh_bus(std::size_t index) {
  const bus::Bus& bus = *buses_[index];
  BusImage& shown = image_.buses[index];
  const bus::Statistics s = bus.statistics();
  bool suspect = false;
  Duration slowest{};
  for (std::size_t d = 0; d < drives_.size(); ++d) {
    if (bus_of_drive_[d] != index) continue;
    suspect =
        suspect || drives_[d]->link_state() == LinkState::suspect || drives_[d]->link_state() == LinkState::offline;
    for (std::size_t a = 0; a < drives_[d]->axis_count(); ++a)
      slowest = std::max(slowest, drives_[d]->axis(static_cast<bus::AxisSlot>(a)).cycle());
  }
  shown.link = bus.up() ? (suspect ? 2 : 1) : 0;
  shown.load_permille = bus.load_permille();
  shown.cycle_ms = static_cast<std::uint16_t>(
      std::min<std::int64_t>(UINT16_MAX, std::chrono::duration_cast<std::chrono::milliseconds>(slowest).count()));
  shown.queue_depth = static_cast<std::uint16_t>(bus.queue_depth());
  shown.requests = s.requests;
  shown.replies = s.replies;
  shown.timeouts = s.timeouts;
  shown.bad_frames = s.bad_frames;
  shown.late_replies = s.late_replies;
  shown.dropped_bytes = s.dropped_bytes;
  shown.refused = s.refused;
  shown.coalesced = s.coalesced;
  shown.superseded = s.superseded;
  shown.reconnects = s.reconnects;
}

std::uint16_t Gateway::gateway_alarms() const {
  std::uint16_t out = 0;
  const auto set = [&](GatewayAlarm alarm, bool on) {
    if (on) out = static_cast<std::uint16_t>(out | (1U << static_cast<unsigned>(alarm)));
  };
  constexpr std::uint32_t kChecks =
      bit(AxisAlarm::local_control) | bit(AxisAlarm::limit_inputs_open) | bit(AxisAlarm::stop_options);
  for (const auto& axis : image_.axes()) {
    const auto has = [&](AxisAlarm alarm) { return (axis->alarms & bit(alarm)) != 0; };
    set(GatewayAlarm::axis_offline, !axis->reachable());
    set(GatewayAlarm::drive_fault, axis->reachable() && axis->has(AxisInput::fault));
    set(GatewayAlarm::identity_mismatch, has(AxisAlarm::identity_mismatch));
    set(GatewayAlarm::no_comm_watchdog, has(AxisAlarm::no_comm_watchdog));
    set(GatewayAlarm::check_failed, (axis->alarms & kChecks) != 0);
    set(GatewayAlarm::adopted_running, has(AxisAlarm::adopted_running));
    set(GatewayAlarm::nvm_budget, has(AxisAlarm::nvm_budget));
  }
  constexpr std::uint16_t kOverloaded = 990;  // 0.1 %: polls stretch from here on
  for (const BusImage& bus : image_.buses) {
    set(GatewayAlarm::bus_down, bus.link == 0);
    set(GatewayAlarm::bus_overloaded, bus.load_permille >= kOverloaded);
  }
  const bool slow = slow_loop_at_ != kLongAgo && runtime_.now() - slow_loop_at_ < kSlowLoopShown;
  set(GatewayAlarm::event_loop_slow, slow);
  set(GatewayAlarm::dds_process_down, dds_down_);
  set(GatewayAlarm::configuration_changed, file_changed_);
  return out;
}

}  // namespace axisgate::app
