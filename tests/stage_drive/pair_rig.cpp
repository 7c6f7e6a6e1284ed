// SPDX-License-Identifier: Apache-2.0
#include "tests/stage_drive/pair_rig.hpp"

#include <stdexcept>

namespace axisgate::test {

using namespace std::chrono_literals;

PairWire::PairWire(Runtime& runtime)
    : runtime_(runtime), began_(runtime.now()), timer_(runtime.make_timer([this] {
        if (reply_) events_->on_reply(*std::exchange(reply_, std::nullopt));
      })) {}

void PairWire::start(bus::WireEvents& events) {
  events_ = &events;
  events_->on_wire_up();
}

void PairWire::settle() { drive.advance(std::chrono::duration_cast<simulated::Time>(runtime_.now() - began_)); }

void PairWire::send(const bus::Exchange& exchange) {
  settle();
  sent.push_back(exchange);
  reply_.reset();
  if (loses && loses(exchange)) return;
  reply_ = answer(exchange);
  timer_->expires_at(runtime_.now() + 1ms);
}

void PairWire::abandon() {
  reply_.reset();
  timer_->expires_at(kNever);
}

void PairWire::emergency(std::uint16_t code) {
  events_->on_unsolicited({.kind = bus::UnsolicitedEvent::Kind::emergency, .node = 1, .code = code});
}

bus::ExchangeResult PairWire::answer(const bus::Exchange& exchange) {
  if (exchange.access == bus::Access::command) return {};
  const simulated::PairDrive::Object object{exchange.object.index, exchange.object.sub};
  const std::uint8_t size = drive.size_of(object);
  if (size == 0 || exchange.mask != 0) return {.code = Errc::refused_by_drive, .detail = 0x06020000};
  bus::ExchangeResult out;
  if (exchange.access == bus::Access::read)
    out.fields.push_back({exchange.object, size, drive.read(object)});
  else
    drive.write(object, exchange.raw);
  return out;
}

// --- The rig -------------------------------------------------------------------------------------------------------

PairRig::PairRig(LeaseRules lease, const std::function<void(simulated::PairDrive&)>& before) {
  auto owned = std::make_unique<PairWire>(runtime);
  wire = owned.get();
  before(wire->drive);
  bus::BusSettings settings;
  settings.name = "pair";
  settings.timeout = 20ms;
  bus = std::make_unique<bus::Bus>(settings, 1, std::move(owned), runtime, log);
  profile::ResolveInput input = profile::one_axis("canopen");
  input.axes.push_back(input.axes.front());
  std::vector<AxisImage*> shown;
  for (std::size_t i = 0; i < 2; ++i) {
    input.axes[i].number = images_.at(i).number = static_cast<AxisNumber>(i + 1);
    input.axes[i].lease = lease;
    shown.push_back(&images_.at(i));
  }
  drive = std::make_unique<drive::Drive>(profile::resolved(profile::valid_file("shared-pair"), input), 0, shown, *bus,
                                         runtime, events);
  bus->start();
  if (!run_until([&] { return axis(0).link_state == LinkState::online; })) throw std::runtime_error("never online");
}

void PairRig::run(Duration time) {
  runtime.advance_by(time);
  wire->settle();
}

bool PairRig::run_until(const std::function<bool()>& condition, Duration limit) {
  const Instant end = runtime.now() + limit;
  while (!condition()) {
    if (runtime.now() >= end) return false;
    run(1ms);
  }
  return true;
}

BatchResult PairRig::ask(AxisSlot slot, WriteBatch batch) {
  if (batch.client == 0) batch.client = asker ? asker->id : 7;
  if (!batch.life) batch.life = asker;
  batch.role = Role::engineer;
  batch.start_by = runtime.now() + 500ms;
  batch.answer_by = runtime.now() + 3s;
  auto result = std::make_shared<std::optional<BatchResult>>();
  if (const auto at_once = drive->submit(slot, batch, [result](const BatchResult& r) { *result = r; })) return *at_once;
  if (!run_until([&] { return result->has_value(); })) throw std::runtime_error("never answered");
  return **result;
}

Errc PairRig::command(AxisSlot slot, Command command, std::initializer_list<Setpoint> setpoints) {
  WriteBatch batch;
  batch.command = command;
  batch.claims = asker != nullptr && !is_stop(command);
  for (const Setpoint& sp : setpoints) batch.setpoints.push_back(sp);
  return ask(slot, batch).outcome.code;
}

void PairRig::enable() {
  if (command(0, Command::enable) != Errc::ok || !has_torque(0) || !has_torque(1))
    throw std::runtime_error("not enabled");
}

void PairRig::run_at(AxisSlot slot, std::int64_t rpm) {
  if (command(slot, Command::run_velocity, {{Quantity::target_velocity, 1000 * rpm}}) != Errc::ok)
    throw std::runtime_error("does not run");
  const auto there = [&] { return axis(slot)[Quantity::velocity_actual].value == 1000 * rpm; };
  if (!run_until(there)) throw std::runtime_error("never so fast");
}

std::shared_ptr<ClientLife> PairRig::client(ClientId id) const {
  auto out = std::make_shared<ClientLife>();
  out->id = id;
  out->role = Role::engineer;
  out->origin[15] = static_cast<std::uint8_t>(id);
  out->name = "client " + std::to_string(id);
  out->last_request = runtime.now();
  return out;
}

std::vector<std::uint32_t> PairRig::written(std::uint16_t index) const {
  std::vector<std::uint32_t> out;
  for (const bus::Exchange& each : wire->sent)
    if (each.access == bus::Access::write && each.object.index == index) out.push_back(each.raw);
  return out;
}

}  // namespace axisgate::test
