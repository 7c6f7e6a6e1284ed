// SPDX-License-Identifier: Apache-2.0
#include "gateway/compose/gateway.hpp"

#include <algorithm>
#include <string>

namespace axisgate::compose {
namespace {

// How long "event loop slow" stays set, so that an HMI that polls once a second sees it.
constexpr Duration kSlowLoopShown = std::chrono::seconds(10);

LogLevel level_of(EventKind kind) {
  return kind == EventKind::fault || kind == EventKind::warning ? LogLevel::warning : LogLevel::info;
}

/// What lines, drives and clients can repeat without end comes once a minute; what was done to an axis is told each.
LogPace pace_of(const Event& event) {
  if (event.asked_for) return LogPace::each;
  switch (event.kind) {
    case EventKind::fault:
    case EventKind::lease:
    case EventKind::homed:
    case EventKind::command:
      return LogPace::second;
    case EventKind::warning:
    case EventKind::link:
    case EventKind::boot:
    case EventKind::position_wrapped:
      break;
  }
  return LogPace::minute;
}

/// "axis 3 lift"; the name that an axis has without one in the configuration is its number.
LogSource source_of(const ProcessImage& image, const Event& event) {
  LogSource out{.words = "gateway"};
  if (event.axis != 0) {
    const AxisImage* const axis = image.find(event.axis);
    const bool on_bus = axis != nullptr && axis->bus < image.buses.size();
    out = log_source(event.axis, axis == nullptr ? std::string() : axis->name,
                     on_bus ? image.buses[axis->bus].name : std::string());
  }
  out.event = text(event.kind);
  return out;
}

}  // namespace

Gateway::Gateway(const config::Config& config, const Models& models, Runtime& runtime, const Log& log,
                 MakeWire make_wire)
    : runtime_(runtime),
      log_(log),
      make_wire_(std::move(make_wire)),
      events_([this](const Event& e) {
        log_.write(level_of(e.kind), source_of(image_, e), e.text, pace_of(e));
        image_.changes.mark(0);
      }),
      closing_(runtime.make_timer([this] {
        if (closed_) std::exchange(closed_, nullptr)();
      })),
      bus_release_ended_(runtime.make_timer([this] { bus_release_.reset(); })) {
  for (std::size_t i = 0; i < config.buses.size(); ++i) buses_.push_back(make_bus(config.buses[i], models[i], i));
  image_.buses.resize(buses_.size());
  for (std::size_t i = 0; i < buses_.size(); ++i) image_.buses[i].name = buses_[i]->name();
  find_places();
  image_.refresh = [this] { refresh(); };
}

Gateway::~Gateway() = default;

std::unique_ptr<BusLine> Gateway::make_bus(const config::BusConfig& config,
                                           const std::vector<model::DriveModel>& models, std::size_t place) {
  return std::make_unique<BusLine>(config, models, place, make_wire_,
                                   BusLine::Surroundings{runtime_, log_, image_, events_});
}

void Gateway::find_places() {
  places_.fill({});
  for (const auto& bus : buses_)
    for (const auto& drive : bus->drives())
      for (std::size_t a = 0; a < drive->axis_count(); ++a)
        places_[drive->model().axes[a].number] = {drive.get(), static_cast<AxisSlot>(a)};
}

void Gateway::start() {
  started_ = runtime_.now();
  image_.gateway.state = GatewayState::running;
  for (auto& bus : buses_) bus->start();
}

// --- Reload ----------------------------------------------------------------------------------------------------------

void Gateway::reload(const ReloadPlan& plan, config::Config wanted, Models models,
                     std::function<std::vector<std::string>()> last_word,
                     std::function<void(std::vector<std::string>)> done) {
  std::vector<BusLine*> leaving;
  for (const std::size_t place : plan.leaving_buses) leaving.push_back(buses_[place].get());
  bus_release_ended_->expires_at(kNever);  // of the reload before
  bus_release_ = std::make_unique<BusRelease>(runtime_, leaving, std::move(last_word),
                                              [this, plan, wanted = std::move(wanted), models = std::move(models),
                                               done = std::move(done)](std::vector<std::string> why_not) {
                                                bus_release_ended_->expires_at(runtime_.now());
                                                if (why_not.empty()) replace(plan, wanted, models);
                                                done(std::move(why_not));
                                              });
}

// Those that go first: a device, or an axis number, may be another bus's now.
void Gateway::replace(const ReloadPlan& plan, const config::Config& wanted, const Models& models) {
  std::vector<std::unique_ptr<BusLine>> before = std::exchange(buses_, {});
  places_.fill({});
  for (const std::size_t place : plan.leaving_buses) {
    before[place]->retire();
    before[place].reset();
  }
  image_.buses.assign(wanted.buses.size(), {});
  for (std::size_t i = 0; i < wanted.buses.size(); ++i) {
    const bool kept = plan.kept_buses[i].has_value();
    buses_.push_back(kept ? std::move(before[*plan.kept_buses[i]]) : make_bus(wanted.buses[i], models[i], i));
    buses_.back()->move_to(i);
    image_.buses[i].name = wanted.buses[i].name;
  }
  find_places();
  for (std::size_t i = 0; i < buses_.size(); ++i)
    if (!plan.kept_buses[i]) buses_[i]->start();
}

// --- The end ---------------------------------------------------------------------------------------------------------

void Gateway::close(std::function<void()> closed) {
  if (stopping_) return;
  stopping_ = true;
  bus_release_.reset();  // what it has closed is open again, and closed below
  image_.gateway.state = GatewayState::stopping;
  closed_ = std::move(closed);
  closing_->expires_at(runtime_.now() + kClosing);
  open_drives_ = 1;  // this function, so that the last one is told once
  for (const auto& bus : buses_) open_drives_ += bus->drives().size();
  for (const auto& bus : buses_)
    for (const auto& drive : bus->drives())
      drive->close(drive::Drive::Closing::gateway_ends, [this] { drive_closed(); });
  drive_closed();
}

void Gateway::stop() {
  stopping_ = stopped_ = true;
  image_.gateway.state = GatewayState::stopping;
}

void Gateway::drive_closed() {
  if (--open_drives_ == 0) closing_->expires_at(runtime_.now());
}

std::optional<BatchResult> Gateway::submit(AxisNumber axis, const WriteBatch& batch, BatchCallback on_result) {
  if (axis > kMaxAxisNumber || places_[axis].drive == nullptr) return BatchResult{{Errc::no_path, 0}, 0, 0};
  return places_[axis].drive->submit(places_[axis].slot, batch, std::move(on_result));
}

void Gateway::client_gone(ClientId client) {
  if (stopped_) return;  // it ends them all itself
  for (const auto& bus : buses_)
    for (const auto& drive : bus->drives()) drive->client_gone(client);
}

bool Gateway::holds(AxisNumber axis, Quantity quantity, std::int64_t value) const {
  if (axis > kMaxAxisNumber || places_[axis].drive == nullptr) return false;
  return places_[axis].drive->axis(places_[axis].slot).admission().holds(quantity, value);
}

bool Gateway::owner_asks(AxisNumber axis, ClientId client, Quantity quantity, std::int64_t value) const {
  if (axis > kMaxAxisNumber || places_[axis].drive == nullptr) return false;
  return places_[axis].drive->axis(places_[axis].slot).admission().owner_asks(client, quantity, value);
}

std::int32_t Gateway::set_position_value(AxisNumber axis) const {
  if (axis > kMaxAxisNumber || places_[axis].drive == nullptr) return 0;
  return places_[axis].drive->axis(places_[axis].slot).core().set_position_value;
}

const drive::Drive* Gateway::drive_of(AxisNumber axis) const {
  return axis > kMaxAxisNumber ? nullptr : places_[axis].drive;
}

bool Gateway::all_turn(Duration slack) const {
  return std::ranges::all_of(buses_, [&](const auto& bus) {
    const Instant due = bus->bus().turn_due();
    return due == kNever || runtime_.now() - due <= slack;
  });
}

void Gateway::report_loop_delay(Duration delay) {
  if (delay >= kSlowLoop) slow_loop_at_ = runtime_.now();
}

void Gateway::report_file_changed(const std::string& file) {
  file_changed_ = !file.empty();
  report(EventKind::warning, file_changed_
                                 ? file +
                                       " is not what the gateway runs with: check it, and reload it "
                                       "(axisgate reload) when the axes of the buses that change are disabled; a file "
                                       "of DDS is read when the gateway starts"
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
  for (std::size_t i = 0; i < buses_.size(); ++i) buses_[i]->show(image_.buses[i]);
  shown.alarms = gateway_alarms();
  if (stopping_ || started_ == kLongAgo) return;
  const bool all_online = shown.axes_online == image_.axes().size();
  shown.state = all_online ? GatewayState::running : GatewayState::degraded;
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
  set(GatewayAlarm::name_taken, name_taken_);
  set(GatewayAlarm::listener_down, missing_.any());
  set(GatewayAlarm::configuration_changed, file_changed_);
  return out;
}

}  // namespace axisgate::compose
