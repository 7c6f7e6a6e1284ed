// SPDX-License-Identifier: Apache-2.0
#include "tests/stage_drive/keya_rig.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;

constexpr double kRatedRpm = 1500, kFull = 10'000, kCountsPerMs = 1'000;
/// Byte 0xC000 of a fault word: nothing was heard for too long, and only an enable ends it.
constexpr std::uint16_t kNotHeard = 0x4000;

double ms(Duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

}  // namespace

std::string name(Speech speech) { return speech == Speech::single ? "single commands" : "composed frames"; }

std::string name(Fate fate) {
  static const std::vector<std::string> names{"answered", "muted", "reply lost", "refused", "cut before", "cut after"};
  return names[static_cast<std::size_t>(fate)];
}

double FakeMotor::speed() const {
  if (!enabled) return 0;
  if (mode != 1) return static_cast<double>(value) / kFull * kRatedRpm;
  const double way = static_cast<double>(value) - position;
  return std::abs(way) < 1 ? 0 : std::copysign(kCountsPerMs * 60'000 / kFull, way);
}

// --- The wire and the drive ----------------------------------------------------------------------------------------

FakeKeya::FakeKeya(KeyaOptions options, Runtime& runtime)
    : options_(std::move(options)), runtime_(runtime), timer_(runtime.make_timer([this] {
        if (std::exchange(down_after_, false)) return cut();
        if (reply_) events_->on_reply(*std::exchange(reply_, std::nullopt));
      })) {
  for (FakeMotor& motor : motors) motor.mode = options_.modes.front();
}

void FakeKeya::start(bus::WireEvents& events) {
  events_ = &events;
  plug();
}

void FakeKeya::plug() {
  up_ = true;
  events_->on_wire_up();
}

void FakeKeya::cut() {
  if (!std::exchange(up_, false)) return;
  reply_.reset();
  events_->on_wire_down("pulled");
}

void FakeKeya::settle() {
  const Instant now = runtime_.now();
  if (settled_ == kLongAgo) settled_ = now;
  for (FakeMotor& motor : motors) {
    Instant until = now;
    const bool trips = motor.enabled && now - motor.commanded > watchdog;
    if (trips) until = motor.commanded + watchdog;
    if (motor.enabled && until > settled_) {
      const double passed = ms(until - settled_);
      if (motor.mode == 1) {
        const double way = static_cast<double>(motor.value) - motor.position;
        motor.position += std::clamp(way, -passed * kCountsPerMs, passed * kCountsPerMs);
      } else {
        motor.position += motor.speed() / 60'000 * kFull * passed;
      }
    }
    if (!trips) continue;
    motor.enabled = false;
    motor.faults |= kNotHeard;
  }
  settled_ = now;
}

void FakeKeya::send(const bus::Exchange& exchange) {
  settle();
  sent.push_back({runtime_.now(), exchange});
  const Fate chosen = fate ? fate(exchange) : Fate::answered;
  reply_.reset();
  const bool is_read = exchange.access == bus::Access::read;
  if (chosen == Fate::cut_before) {
    down_after_ = true;
  } else if (chosen == Fate::refused) {
    reply_ = bus::ExchangeResult{.code = Errc::refused_by_drive, .detail = 7};
  } else if (chosen != Fate::muted) {
    bus::ExchangeResult result = answer(exchange);
    if (acted) acted(exchange);
    if (chosen == Fate::cut_after) down_after_ = true;
    if (chosen == Fate::answered) reply_ = std::move(result);
  }
  if (chosen == Fate::muted || chosen == Fate::reply_lost) {
    // Of a frame that nobody answers it is known only that it was sent.
    if (is_read || options_.speech == Speech::single) return;
    reply_ = bus::ExchangeResult{};
  }
  timer_->expires_at(runtime_.now() + (down_after_ ? Duration{1us} : options_.reply_delay));
}

void FakeKeya::abandon() {
  reply_.reset();
  timer_->expires_at(kNever);
}

bus::ExchangeResult FakeKeya::answer(const bus::Exchange& exchange) {
  bus::ExchangeResult out;
  if (exchange.access == bus::Access::write) {
    if (options_.speech == Speech::composed)
      write_frame(exchange);
    else
      write(exchange.object, static_cast<std::int32_t>(exchange.raw));
    return out;
  }
  const auto add = [&](const ObjectAddress& object, std::uint8_t size) {
    if (const auto width = widths.find(object); width != widths.end()) size = width->second;
    out.fields.push_back({object, size, read(object)});
  };
  add(exchange.object, exchange.size == 0 ? 4 : exchange.size);
  for (const bus::Neighbour& more : exchange.more) add(more.object, more.size);
  return out;
}

std::uint32_t FakeKeya::read(const ObjectAddress& object) const {
  const auto number = [](double value) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value)));
  };
  switch (object.index) {
    case kFaultQuery:
      return motors.at(object.byte / 2).fault_word();
    case kSpeedQuery:
      return number(motors.at(object.byte / 2).speed()) & 0xFFFFU;
    case kPositionQuery:
      return number(motors.at(object.sub == 0 ? object.byte / 4 : object.sub - 2).position);
    case kTemperatureQuery:
      return object.byte == 0 ? 30 : 40U + object.byte;
    default:
      return 0;
  }
}

void FakeKeya::write(const ObjectAddress& object, std::int64_t value) {
  FakeMotor& motor = motors.at(object.sub - 1U);
  motor.commanded = runtime_.now();
  switch (object.index) {
    case kEnable:
      if (!motor.enabled) ++motor.enables;
      motor.enabled = true;
      motor.faults &= static_cast<std::uint16_t>(~kNotHeard);
      break;
    case kDisable:
      motor.enabled = false;
      break;
    default:
      motor.value = value;
      if (motor.enabled) motor.moves.push_back(value);
      break;
  }
}

void FakeKeya::write_frame(const bus::Exchange& exchange) {
  for (std::uint8_t number = 1; number <= 2; ++number) {
    FakeMotor& motor = motors.at(number - 1U);
    const auto on = KeyaRig::field(exchange, kEnable, number), value = KeyaRig::field(exchange, kValue, number);
    if (!on || !value) throw std::runtime_error("a control frame without all of its fields");
    motor.commanded = runtime_.now();
    motor.value = *value;
    if (*on == 0) {
      motor.enabled = false;
      continue;
    }
    if (!motor.enabled) ++motor.enables;
    motor.enabled = true;
    motor.faults &= static_cast<std::uint16_t>(~kNotHeard);
    motor.moves.push_back(*value);
  }
}

// --- The rig -------------------------------------------------------------------------------------------------------

KeyaRig::KeyaRig(KeyaOptions options) {
  auto owned = std::make_unique<FakeKeya>(options, runtime);
  wire = owned.get();
  if (options.keep_alive == Duration{}) wire->watchdog = 1h;
  bus::BusSettings settings;
  settings.name = "keya";
  settings.timeout = 20ms;
  bus = std::make_unique<bus::Bus>(settings, 1, std::move(owned), runtime, log);
  std::vector<AxisImage*> shown;
  for (int i = 0; i < options.axes; ++i) {
    images_.at(static_cast<std::size_t>(i)).number = static_cast<AxisNumber>(i + 1);
    shown.push_back(&images_.at(static_cast<std::size_t>(i)));
  }
  drive = std::make_unique<drive::Drive>(keya_model(options), 0, shown, *bus, runtime, events);
  bus->start();
}

void KeyaRig::run(Duration time) {
  runtime.advance_by(time);
  wire->settle();
}

bool KeyaRig::run_until(const std::function<bool()>& condition, Duration limit) {
  const Instant end = runtime.now() + limit;
  while (!condition()) {
    if (runtime.now() >= end) return false;
    run(1ms);
  }
  return true;
}

void KeyaRig::online() {
  if (!run_until([&] { return axis(0).link_state == LinkState::online; })) throw std::runtime_error("never online");
}

std::shared_ptr<std::optional<BatchResult>> KeyaRig::begin(AxisSlot slot, const WriteBatch& batch) {
  auto result = std::make_shared<std::optional<BatchResult>>();
  WriteBatch asked = batch;
  if (asked.start_by == kNever) asked.start_by = runtime.now() + 500ms;
  if (asked.answer_by == kNever) asked.answer_by = runtime.now() + 900ms;
  const auto at_once = drive->submit(slot, asked, [result](const BatchResult& r) { *result = r; });
  if (at_once) *result = *at_once;
  return result;
}

BatchResult KeyaRig::ask(AxisSlot slot, const WriteBatch& batch) {
  const auto result = begin(slot, batch);
  if (!run_until([&] { return result->has_value(); }, 10s)) throw std::runtime_error("no result");
  return **result;
}

BatchResult KeyaRig::word(AxisSlot slot, std::uint16_t controlword) {
  WriteBatch batch = batch_of(Command::none);
  batch.controlword = controlword;
  batch.single_controlword = true;
  return ask(slot, batch);
}

BatchResult KeyaRig::mailbox(AxisSlot slot, bool write, std::uint16_t index, std::uint8_t sub, std::uint8_t size,
                             std::uint32_t data) {
  WriteBatch batch = batch_of(Command::none);
  batch.object = ObjectRequest{write, index, sub, size, data};
  return ask(slot, batch);
}

void KeyaRig::enable(AxisSlot slot) {
  if (code(command(slot, Command::enable)) != Errc::ok || !motor(slot).enabled || !enabled(slot))
    throw std::runtime_error("not enabled");
}

void KeyaRig::run_at(AxisSlot slot, std::int64_t velocity) {
  if (code(ask(slot, batch_of(Command::run_velocity, {{Quantity::target_velocity, velocity}}))) != Errc::ok)
    throw std::runtime_error("does not run");
}

void KeyaRig::enable_and_run(AxisSlot slot) {
  enable(slot);
  run_at(slot, kRpm150);
}

std::vector<Sent> KeyaRig::since_mark() const {
  return {wire->sent.begin() + static_cast<std::ptrdiff_t>(marked_), wire->sent.end()};
}

std::vector<Sent> KeyaRig::writes() const {
  auto all = since_mark();
  std::erase_if(all, [](const Sent& s) { return s.exchange.access != bus::Access::write; });
  return all;
}

std::size_t KeyaRig::reads_of(std::uint16_t index) const {
  const auto all = since_mark();
  return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [&](const Sent& s) {
    return s.exchange.access == bus::Access::read && s.exchange.object.index == index;
  }));
}

std::vector<Instant> KeyaRig::heard(std::uint8_t motor) const {
  std::vector<Instant> out;
  for (const Sent& s : writes())
    if (field(s.exchange, kValue, motor) || field(s.exchange, kEnable, motor)) out.push_back(s.at);
  return out;
}

Duration longest_gap(const std::vector<Instant>& instants) {
  Duration longest{};
  for (std::size_t i = 1; i < instants.size(); ++i) longest = std::max(longest, instants[i] - instants[i - 1]);
  return longest;
}

std::optional<std::int64_t> KeyaRig::field(const bus::Exchange& exchange, std::uint16_t index, std::uint8_t motor) {
  const ObjectAddress wanted{index, motor};
  if (exchange.object == wanted) return static_cast<std::int32_t>(exchange.raw);
  for (const bus::Neighbour& more : exchange.more)
    if (more.object == wanted) return static_cast<std::int32_t>(more.raw);
  return std::nullopt;
}

WriteBatch KeyaRig::batch_of(Command command, std::initializer_list<Setpoint> setpoints) {
  WriteBatch batch;
  batch.client = 7;
  batch.role = Role::engineer;
  batch.command = command;
  for (const Setpoint& sp : setpoints) batch.setpoints.push_back(sp);
  return batch;
}

model::ObjectId KeyaRig::id(const std::string& object) const {
  const auto& objects = drive->model().objects;
  const auto at = std::find_if(objects.begin(), objects.end(), [&](const auto& o) { return o.name == object; });
  if (at == objects.end()) throw std::runtime_error("no object " + object);
  return static_cast<model::ObjectId>(at - objects.begin());
}

}  // namespace axisgate::test
