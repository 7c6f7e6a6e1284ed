// SPDX-License-Identifier: Apache-2.0
// Two motors behind one controlword (simulated::PairDrive), behind bus and drive layer, with a profile of the tests.
// Promises a clock that stands still until a test moves it, and a journal of all that was sent. Never decides what is
// right: the tests do.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/drive/device/drive.hpp"
#include "tests/profiles/resolving.hpp"
#include "tests/simulated/pair_drive.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

class PairWire final : public bus::Wire {
 public:
  explicit PairWire(Runtime& runtime);
  void start(bus::WireEvents& events) override;
  void send(const bus::Exchange& exchange) override;
  void abandon() override;
  [[nodiscard]] const bus::Statistics& statistics() const override { return statistics_; }
  void set_decode(bool) override {}
  void emergency(std::uint16_t code);
  /// The motors, up to now.
  void settle();

  simulated::PairDrive drive;
  std::vector<bus::Exchange> sent;
  /// True: this exchange is not answered, and the drive has not heard it.
  std::function<bool(const bus::Exchange&)> loses;

 private:
  [[nodiscard]] bus::ExchangeResult answer(const bus::Exchange& exchange);

  Runtime& runtime_;
  Instant began_;
  bus::WireEvents* events_ = nullptr;
  bus::Statistics statistics_;
  std::optional<bus::ExchangeResult> reply_;
  std::unique_ptr<Timer> timer_;
};

class PairRig {
 public:
  /// `lease`: of both axes. `before`: while the drive is not yet looked at.
  explicit PairRig(
      LeaseRules lease = {.on = false}, const std::function<void(simulated::PairDrive&)>& before = [](auto&) {});

  void run(Duration time);
  bool run_until(const std::function<bool()>& condition, Duration limit = std::chrono::seconds(5));
  BatchResult ask(AxisSlot slot, WriteBatch batch);
  Errc command(AxisSlot slot, Command command, std::initializer_list<Setpoint> setpoints = {});
  /// Both have torque.
  void enable();
  /// At so many rpm, and seen to do so.
  void run_at(AxisSlot slot, std::int64_t rpm);
  [[nodiscard]] std::shared_ptr<ClientLife> client(ClientId id) const;

  void mark() { wire->sent.clear(); }
  /// Since the mark.
  [[nodiscard]] std::vector<std::uint32_t> written(std::uint16_t index) const;
  [[nodiscard]] const AxisImage& axis(AxisSlot slot) const { return images_.at(slot); }
  [[nodiscard]] simulated::PairDrive::Motor& motor(AxisSlot slot) { return wire->drive.motors.at(slot); }
  [[nodiscard]] bool has_torque(AxisSlot slot) { return motor(slot).state == simulated::PairDrive::State::enabled; }
  [[nodiscard]] bool latched(AxisSlot slot) const { return axis(slot).has(AxisInput::stop_latched); }

  ManualRuntime runtime;
  EventRing events;
  Log log;
  PairWire* wire = nullptr;
  std::unique_ptr<bus::Bus> bus;
  std::unique_ptr<drive::Drive> drive;
  /// In whose name what is asked is; none: nobody's of a server.
  std::shared_ptr<ClientLife> asker{};

 private:
  std::array<AxisImage, 2> images_{};
};

}  // namespace axisgate::test
