// SPDX-License-Identifier: Apache-2.0
// A Keya in its CANopen mode (6): the objects of its dictionary, which is not CiA 402's; commands are codes in 607Ah
// and 6083h, their data 6081h and 6084h. Promises the widths and codes the manual prints, and an abort for every other
// code. Never speaks CiA 301: CanopenNode does.
#pragma once

#include "tests/simulated/canopen_node.hpp"
#include "tests/simulated/keya_drive.hpp"

namespace axisgate::simulated {

struct KeyaCanopenDrive {
  KeyaOptions drive{};
};

class KeyaCanopen final : public CanDevice {
 public:
  explicit KeyaCanopen(const KeyaOptions& options) : drive_(options, KeyaInterface::canopen) {}

  KeyaDrive& drive() { return drive_; }

  ObjectReply read(ObjectKey key, Time now) override;
  std::optional<std::uint32_t> mapped(ObjectKey key, Time now) override;
  std::uint32_t write(ObjectKey key, CanView bytes, std::uint64_t tag, Time now) override;
  bool may_be_mapped(ObjectKey key, PdoDirection direction) const override;
  std::uint32_t poke(ObjectKey key, std::int64_t value) override;
  void advance(Time now) override { drive_.advance(now); }
  void restart(Time now) override { drive_.restart(now); }
  // With another interface selected nothing is heard on this one.
  bool booting() const override { return drive_.booting() || !drive_.obeys(KeyaInterface::canopen); }
  void connect() override {}
  void lose_master(MasterLoss, Time) override {}
  std::uint16_t error_code() const override { return 0; }  // what an EMCY tells is not described
  std::uint8_t error_register() const override;
  std::uint64_t stores() const override { return 0; }
  std::string describe() const override { return "keya-kydas4860-2e@" + std::to_string(drive_.options().node); }

 private:
  std::uint32_t take_code(KeyaMotorName motor, std::uint32_t code, std::uint64_t tag, Time now);
  std::uint32_t take_data(KeyaMotorName motor, std::int32_t value, std::uint64_t tag, Time now);
  std::int64_t value_of(ObjectKey key) const;
  std::int64_t value_of_motor(std::uint8_t row, KeyaMotorName motor) const;

  KeyaDrive drive_;
  std::array<std::uint32_t, 2> codes_{};
  std::array<std::int32_t, 2> data_{};
  std::array<std::uint64_t, 2> enabled_by_{};  // the frame that enabled the motor
};

CommunicationFacts communication_of(const KeyaCanopenDrive& options);

}  // namespace axisgate::simulated
