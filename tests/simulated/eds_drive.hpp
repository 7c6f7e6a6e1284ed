// SPDX-License-Identifier: Apache-2.0
// One simulated CiA 402 drive of a type of which nothing but an EDS is known: what it adds to CiA 402's machine is in
// its EdsDriveType. Promises the same answers for the same requests at the same times. Never reads a clock, never draws
// a random number, and never speaks CiA 301: CanopenNode does.
#pragma once

#include <map>

#include "tests/simulated/canopen_node.hpp"
#include "tests/simulated/cia402_drive.hpp"
#include "tests/simulated/eds_drive_type.hpp"

namespace axisgate::simulated {

struct EdsDriveOptions {
  const EdsDriveType* type;
  std::uint8_t node = 1;
  std::map<ObjectKey, std::int64_t> stored{};  // objects as they were saved before the world began
  Mechanics mechanics{};
  Time boot_time = std::chrono::seconds(1);
  Time store_time = std::chrono::milliseconds(50);
};

class EdsDrive final : public CanDevice, public Cia402Drive {
 public:
  explicit EdsDrive(const EdsDriveOptions& options);

  // What the node needs.
  ObjectReply read(ObjectKey key, Time now) override;
  std::optional<std::uint32_t> mapped(ObjectKey key, Time now) override;
  std::uint32_t write(ObjectKey key, CanView bytes, std::uint64_t tag, Time now) override;
  bool may_be_mapped(ObjectKey key, PdoDirection direction) const override;
  std::uint32_t poke(ObjectKey key, std::int64_t value) override { return abort_of(Cia402Drive::poke(key, value)); }
  void advance(Time now) override { Cia402Drive::advance(now); }
  void restart(Time now) override;
  bool booting() const override { return Cia402Drive::booting(); }
  void connect() override {}
  void lose_master(MasterLoss how, Time now) override;
  std::uint16_t error_code() const override { return error_; }
  std::uint8_t error_register() const override;
  std::uint64_t stores() const override { return Cia402Drive::stores(); }
  std::string describe() const override;

  // What a world does to it.
  void inject_fault(std::uint16_t code);  // its EMCY, and 603Fh where it has that; the cause stays until cleared
  void clear_fault_cause() { cause_ = 0; }
  void tell_no_number(bool no_number) { no_number_ = no_number; }  // of REAL32 speeds

  // What a world looks at.
  const EdsDriveOptions& options() const { return options_; }
  std::int32_t position() const override;  // 6064h
  std::int64_t encoder_counts() const { return type().encoder_counts; }

 private:
  static constexpr std::int64_t vl_mode = 2;         // CiA 402's velocity mode of frequency converters
  static constexpr std::int64_t full_torque = 3000;  // per thousand of the rated torque; what the motor can give

  const EdsDriveType& type() const { return *options_.type; }

  // eds_drive.cpp: power, time, reads and writes, units
  void power_up() override;
  void wire_inputs();
  void store_now() override { objects_.store(Keep::eeprom); }
  void before_step() override;
  void after_step(Dec speed_before) override { last_step_ = axis_.speed() - speed_before; }
  void supervise() override {}
  void finish_homing() override;
  Refusal take_write(ObjectKey key, int width, std::uint32_t raw, std::uint64_t tag, bool counted) override;
  void written(ObjectKey key, std::int64_t value, std::uint64_t tag);
  void refresh_settings();
  std::int64_t object_or(std::uint16_t index, std::int64_t otherwise, std::uint8_t sub = 0) const;
  FinePosition fine_of(std::int64_t raw) const;
  std::int64_t amount_of(std::int64_t raw) const;
  std::int64_t raw_of(FinePosition position) const;
  Dec speed_of(std::int64_t raw) const;
  std::int64_t raw_speed_of(Dec speed) const;
  Dec acceleration_of(std::int64_t raw) const;
  Dec vl_ramp(std::uint16_t index) const;

  // eds_drive_control.cpp: modes, stops, faults, what it reports
  void heard_beside_operation(std::uint16_t) override {}
  bool can_halt() const override { return true; }
  void halt_ended() override;
  int direction() const override { return 1; }
  void start_mode() override;
  void start_move(std::uint16_t word) override;
  void start_homing() override;
  Dec target_speed() const override;
  Dec halt_deceleration() const override;
  Dec stop_deceleration(std::int64_t option) const;
  std::optional<Stop> stop_of(Cia402Command command) const override;
  void raise_fault(std::uint16_t code);
  void reset_fault(std::uint64_t tag) override;
  bool target_reached() const;
  std::uint16_t statusword() const;
  std::uint32_t input_word() const;
  std::int64_t torque_actual() const;
  std::optional<std::int64_t> measured(ObjectKey key) const override;

  const EdsDriveOptions options_;
  EdsUnits units_{};
  std::int64_t torque_demand_ = 0;  // per thousand of the rated torque
  Dec last_step_ = 0;               // change of speed in the last millisecond
  std::uint16_t error_ = 0;
  std::uint16_t cause_ = 0;  // still there
  bool no_number_ = false;
};

CommunicationFacts communication_of(const EdsDriveOptions& options);

}  // namespace axisgate::simulated
