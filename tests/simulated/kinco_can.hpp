// SPDX-License-Identifier: Apache-2.0
// A Kinco JD or MD on its CAN port: the same drive, reached by SDO and PDO (JD 2.3, MD 4).
// Promises the objects and the behaviour of KincoDrive, and that a JD obeys no controlword before a first 0x06.
// Never speaks CiA 301: CanopenNode does.
#pragma once

#include <set>

#include "tests/simulated/canopen_node.hpp"
#include "tests/simulated/kinco_drive.hpp"

namespace axisgate::simulated {

// What the sheets leave open (JD 10, MD 12), so tests may choose.
struct KincoCanOptions {
  bool echoes_written = true;  // printed (JD 8.3, MD 10.3); the standard has zeros
  bool short_frames = false;   // six bytes for small objects, as printed (K36)
  bool segmented = true;       // the JD's manual names it (JD 2.3)
  bool block = false;
  bool first_word_needed = true;      // JD 2.3; the MD's manual does not print it
  bool stops_without_master = true;   // what 1016h does is not said
  std::uint16_t loss_alarm = 0x1000;  // bits of 2602h of a master that is gone: not said either
  bool leaves_operational_on_loss = true;
  bool sends_emergencies = true;     // of drive alarms
  std::set<ObjectKey> unmappable{};  // the attribute M is printed for few objects
  std::uint32_t vendor = 0x300;      // "manufacturer station number" in the PC tool (JD 2.3)
  std::uint32_t product = 1;
  std::uint32_t revision = 1;
  std::uint32_t serial = 1;
};

struct KincoCanDrive {
  DriveOptions drive{};
  KincoCanOptions can{};
};

class KincoCan final : public CanDevice {
 public:
  explicit KincoCan(const KincoCanDrive& options);

  KincoDrive& drive() { return drive_; }

  ObjectReply read(ObjectKey key, Time now) override;
  std::optional<std::uint32_t> mapped(ObjectKey key, Time now) override;
  std::uint32_t write(ObjectKey key, CanView bytes, std::uint64_t tag, Time now) override;
  bool may_be_mapped(ObjectKey key, PdoDirection direction) const override;
  std::uint32_t poke(ObjectKey key, std::int64_t value) override { return abort_of(drive_.poke(key, value)); }
  void advance(Time now) override { drive_.advance(now); }
  void restart(Time now) override { drive_.restart(now); }
  bool booting() const override { return drive_.booting(); }
  void connect() override;
  void lose_master(MasterLoss how, Time now) override;
  std::uint16_t error_code() const override;
  std::uint8_t error_register() const override { return error_code() != 0 ? 1 : 0; }
  std::uint64_t stores() const override { return drive_.stores(); }
  std::string describe() const override;

 private:
  const KincoCanOptions options_;
  KincoDrive drive_;
  bool waits_for_first_word_ = false;
};

CommunicationFacts communication_of(const KincoCanDrive& options);

}  // namespace axisgate::simulated
