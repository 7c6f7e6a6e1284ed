// SPDX-License-Identifier: Apache-2.0
// One simulated Kinco JD or MD: what it adds to CiA 402's machine, as the sheets tell: objects, inputs, faults, EEPROM.
// Promises the same answers for the same requests at the same times.
// Never reads a clock, never draws a random number, and never knows a line: SerialLine does.
#pragma once

#include "tests/simulated/cia402_drive.hpp"
#include "tests/simulated/drive_options.hpp"
#include "tests/simulated/ten_byte_frame.hpp"

namespace axisgate::simulated {

class KincoDrive final : public Cia402Drive {
 public:
  static constexpr ObjectKey controlword{0x6040, 0};

  explicit KincoDrive(const DriveOptions& options);

  // What the line needs.
  std::optional<TenByteFrame> answer(const TenByteFrame& request, std::uint64_t tag, Time now);
  // The same for a protocol that addresses objects otherwise. `raw` in the low `width` bytes.
  std::optional<std::int64_t> read(ObjectKey key, Time now);
  Refusal write(ObjectKey key, int width, std::uint32_t raw, std::uint64_t tag, Time now);
  std::uint8_t station() const { return station_; }
  bool cascade() const { return cascade_; }
  std::uint32_t rs232_baud() const { return rs232_baud_; }
  bool rs485_speaks_kinco() const { return rs485_speaks_kinco_; }
  bool rs485_speaks_modbus() const { return !rs485_speaks_kinco_; }

  // What a world does to it.
  void inject_fault(int error_word, std::uint16_t bits);  // 1: 2601, 2: 2602; the cause stays until cleared
  void clear_fault_cause(int error_word, std::uint16_t bits);
  void trip(std::uint16_t word_1, std::uint16_t word_2) { raise_fault(word_1, word_2); }  // a fault whose cause is over

  // What a world looks at.
  const KincoModel& model() const { return model_; }
  const DriveOptions& options() const { return options_; }
  std::uint16_t error_word(int number) const { return number == 1 ? error_1_ : error_2_; }  // 2601, 2602
  std::int32_t position() const override { return static_cast<std::int32_t>(counts_of(axis_.actual())); }

 private:
  // kinco_drive.cpp: power, time
  void power_up() override;
  bool rests() const override { return sampled_rpm_ == 0; }
  void before_step() override;
  void after_step(Dec speed_before) override;
  void supervise() override;
  void begin_store(Keep what);
  void store_now() override;

  // kinco_drive_objects.cpp: reads and writes
  Refusal take_write(ObjectKey key, int width, std::uint32_t raw, std::uint64_t tag, bool counted) override;
  Refusal may_write(ObjectKey key, std::int64_t value) const;
  void written(ObjectKey key, std::int64_t value, std::uint64_t tag);
  void couple(ObjectKey key, std::int64_t value);
  void refresh_settings();

  // kinco_drive_control.cpp: modes, stops, faults
  void heard_beside_operation(std::uint16_t rising) override;
  bool can_halt() const override { return model_.has_halt && mode_ != 4; }
  bool follows_target() const override { return mode_ == 1 && (controlword_ & 0x1010) == 0x1010; }
  int direction() const override { return object(0x607E) == 1 ? -1 : 1; }
  void start_mode() override;
  void start_move(std::uint16_t word) override;
  void start_homing() override;
  void finish_homing() override { axis_.redefine(motion_.homing()->final_position()); }
  Dec target_speed() const override { return object(0x60FF); }
  Dec option_deceleration(std::int64_t option) const;
  Dec halt_deceleration() const override { return option_deceleration(object(0x605D)); }
  std::optional<Stop> stop_of(Cia402Command command) const override;
  void raise_fault(std::uint16_t word_1, std::uint16_t word_2);
  void reset_fault(std::uint64_t tag) override;

  // kinco_drive_status.cpp: what it reports
  std::uint16_t statusword() const;
  FinePosition set_position() const;
  bool inside_position_window() const;
  bool target_reached() const;
  std::uint16_t outputs() const;
  std::optional<std::int64_t> measured(ObjectKey key) const override;

  const DriveOptions options_;
  const KincoModel& model_;
  const std::int64_t encoder_counts_;
  Dec torque_command_ = 0;
  Dec current_ = 0;
  bool reset_input_ = false;
  bool locked_ = false;  // a user password was stored and has not been given since power-up (JD 1.4 point 6)
  std::uint16_t error_1_ = 0, error_2_ = 0;  // 2601 and 2602
  std::uint16_t cause_1_ = 0, cause_2_ = 0;  // still there
  std::int64_t sampled_rpm_ = 0;
  Time outside_window_at_{};  // last time, for target reached
  Keep store_what_ = Keep::eeprom;

  std::uint8_t station_ = 1;
  bool cascade_ = false;
  std::uint32_t rs232_baud_ = 38400;
  bool rs485_speaks_kinco_ = true;
};

}  // namespace axisgate::simulated
