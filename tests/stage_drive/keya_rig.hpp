// SPDX-License-Identifier: Apache-2.0
// A drive of two motors without CiA 402, as a Keya is, behind the drive layer alone: its model made by hand, its wire
// and its motors played here, in the words of the exchange. Promises a fresh world per rig, a clock that stands still
// until a test moves it, and a journal of all that was sent. Never decides what is right: the tests do.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/drive/device/drive.hpp"
#include "tests/unit/support/manual_runtime.hpp"

namespace axisgate::test {

/// How the drive is spoken to: each command a frame of its own that is acknowledged; one frame for both motors that
/// nobody answers; or CANopen objects of which two share a place.
enum class Speech : std::uint8_t { single, composed };
[[nodiscard]] std::string name(Speech speech);

inline constexpr std::uint16_t kFaultQuery = 0x2112, kSpeedQuery = 0x2103, kPositionQuery = 0x2104,
                               kTemperatureQuery = 0x210F, kValue = 0x2000, kTorqueValue = 0x2001,
                               kPositionValue = 0x2002, kDisable = 0x200C, kEnable = 0x200D;
/// A tenth of the rated speed, in units of the register map and of the drive.
inline constexpr std::int64_t kRpm150 = 150'000, kRaw150 = 1'000;
inline constexpr Duration kKeepAlivePeriod = std::chrono::milliseconds(500);

/// Object names as in the model: "A.fault", "B.velocity".
struct KeyaOptions {
  Speech speech = Speech::single;
  std::vector<std::int16_t> modes{3};  ///< unified; the first is in force at bring-up
  int axes = 2;                        ///< configured motors, from A on
  Duration keep_alive{};               ///< 0: none
  LeaseRules lease{.on = false};
  Duration reply_delay = std::chrono::milliseconds(2);
  Duration unsolicited_every{};
  bool unsolicited = false;
};
[[nodiscard]] model::DriveModel keya_model(const KeyaOptions& options);

/// One motor: velocity at once, position at a thousand counts a millisecond.
struct FakeMotor {
  bool enabled = false;
  std::int64_t value = 0;
  std::uint16_t faults = 0;  ///< without bit 0
  double position = 0;
  Instant commanded = kLongAgo;
  std::vector<std::int64_t> moves;  ///< values that it was given while enabled
  int enables = 0;                  ///< how often it was turned on
  std::int16_t mode = 3;
  [[nodiscard]] double speed() const;  ///< rpm
  [[nodiscard]] std::uint16_t fault_word() const { return static_cast<std::uint16_t>(faults | (enabled ? 0 : 1)); }
};

struct Sent {
  Instant at = kLongAgo;
  bus::Exchange exchange;
};

enum class Fate : std::uint8_t { answered, muted, reply_lost, refused, cut_before, cut_after };
[[nodiscard]] std::string name(Fate fate);

class FakeKeya final : public bus::Wire {
 public:
  FakeKeya(KeyaOptions options, Runtime& runtime);
  void start(bus::WireEvents& events) override;
  void send(const bus::Exchange& exchange) override;
  void abandon() override;
  [[nodiscard]] const bus::Statistics& statistics() const override { return statistics_; }
  void set_decode(bool) override {}

  void plug();
  void cut();
  /// Motion and watchdog up to now.
  void settle();
  void tell(const bus::UnsolicitedEvent& unsolicited) { events_->on_unsolicited(unsolicited); }

  std::array<FakeMotor, 2> motors;
  std::vector<Sent> sent;
  /// What becomes of an exchange; none: it is answered.
  std::function<Fate(const bus::Exchange&)> fate;
  /// Called when the drive has acted, before its answer.
  std::function<void(const bus::Exchange&)> acted;
  Duration watchdog = std::chrono::milliseconds(1000);
  std::map<ObjectAddress, std::uint8_t> widths;  ///< what it answers in another width than it is asked for

 private:
  [[nodiscard]] bus::ExchangeResult answer(const bus::Exchange& exchange);
  [[nodiscard]] std::uint32_t read(const ObjectAddress& object) const;
  void write(const ObjectAddress& object, std::int64_t value);
  void write_frame(const bus::Exchange& exchange);

  KeyaOptions options_;
  Runtime& runtime_;
  bus::WireEvents* events_ = nullptr;
  bus::Statistics statistics_;
  std::optional<bus::ExchangeResult> reply_;
  bool down_after_ = false;
  bool up_ = false;
  Instant settled_ = kLongAgo;
  std::unique_ptr<Timer> timer_;
};

class KeyaRig {
 public:
  explicit KeyaRig(KeyaOptions options = {});

  void online();
  BatchResult ask(AxisSlot slot, const WriteBatch& batch);
  BatchResult command(AxisSlot slot, Command command) { return ask(slot, batch_of(command)); }
  BatchResult write(AxisSlot slot, Quantity quantity, std::int64_t value) {
    return ask(slot, batch_of(Command::none, {{quantity, value}}));
  }
  BatchResult word(AxisSlot slot, std::uint16_t controlword);
  BatchResult mailbox(AxisSlot slot, bool write, std::uint16_t index, std::uint8_t sub, std::uint8_t size,
                      std::uint32_t data = 0);
  /// Enabled, and, with a velocity, running at it (0.001 rpm).
  void enable(AxisSlot slot);
  void run_at(AxisSlot slot, std::int64_t velocity);
  void enable_and_run(AxisSlot slot);  ///< at kRpm150
  void run(Duration time);
  bool run_until(const std::function<bool()>& condition, Duration limit = std::chrono::seconds(5));
  /// What the drive is given to do, without waiting for it.
  std::shared_ptr<std::optional<BatchResult>> begin(AxisSlot slot, const WriteBatch& batch);

  void mark() { marked_ = wire->sent.size(); }
  [[nodiscard]] std::vector<Sent> since_mark() const;
  [[nodiscard]] std::vector<Sent> writes() const;
  [[nodiscard]] std::size_t reads_of(std::uint16_t index) const;
  /// When this motor's watchdog has heard a control write since the mark.
  [[nodiscard]] std::vector<Instant> heard(std::uint8_t motor) const;
  /// The number that a frame carries for this field.
  [[nodiscard]] static std::optional<std::int64_t> field(const bus::Exchange& exchange, std::uint16_t index,
                                                         std::uint8_t motor);

  [[nodiscard]] static WriteBatch batch_of(Command command, std::initializer_list<Setpoint> setpoints = {});
  [[nodiscard]] static Errc code(const BatchResult& result) { return result.outcome.code; }
  [[nodiscard]] const AxisImage& axis(AxisSlot slot) const { return images_[slot]; }
  [[nodiscard]] FakeMotor& motor(std::size_t slot) { return wire->motors.at(slot); }
  [[nodiscard]] bool enabled(AxisSlot slot) const { return axis(slot).has(AxisInput::enabled); }
  [[nodiscard]] model::ObjectId id(const std::string& object) const;
  [[nodiscard]] const drive::ObjectState& stored(const std::string& object) const { return drive->store()[id(object)]; }

  ManualRuntime runtime;
  EventRing events;
  Log log;
  FakeKeya* wire = nullptr;
  std::unique_ptr<bus::Bus> bus;
  std::unique_ptr<drive::Drive> drive;

 private:
  std::array<AxisImage, 2> images_{};
  std::size_t marked_ = 0;
};

/// Between two of them that follow one another.
[[nodiscard]] Duration longest_gap(const std::vector<Instant>& instants);

}  // namespace axisgate::test
