// SPDX-License-Identifier: Apache-2.0
// A Keya on its maker's own CAN protocol (3): 29-bit identifiers, index low byte first, data high byte first.
// Promises an acknowledge for each correct write, an answer to each correct read, and silence to all else; a heartbeat
// each second with motor A's faults. Never does anything with a frame of 11 bits.
#pragma once

#include "tests/simulated/can_frames.hpp"
#include "tests/simulated/keya_drive.hpp"

namespace axisgate::simulated {

struct KeyaCanDrive {
  KeyaOptions drive{};
};

namespace keya_can {
inline constexpr std::uint32_t command = 0x06000000;  // + node, to the drive
inline constexpr std::uint32_t reply = 0x05800000;
inline constexpr std::uint32_t heartbeat = 0x07000000;
inline constexpr Time heartbeat_period = std::chrono::seconds(1);
}  // namespace keya_can

class KeyaCan final : public CanNode {
 public:
  explicit KeyaCan(const KeyaOptions& options) : drive_(options, KeyaInterface::can) {}

  KeyaDrive& drive() { return drive_; }

  void hear(const BusFrame& frame, std::uint64_t tag, Time now) override;
  void advance(Time now) override;
  std::vector<CanOutput> take_output() override;
  std::optional<Time> next_event() const override { return next_heartbeat_; }
  void restart(Time now) override;
  void announce_emergency(std::uint16_t, Time) override {}  // the protocol has none
  std::uint8_t node() const override { return drive_.options().node; }
  std::string describe() const override { return "keya-can@" + std::to_string(node()); }
  bool is_request(const BusFrame& frame) const override;
  bool wants_answer(const BusFrame&) const override { return true; }
  bool may_refuse(const BusFrame&) const override { return false; }  // no negative reply is documented
  BusFrame refuse(const BusFrame&, std::uint32_t) override { return {}; }
  BusFrame life_sign(CanView bytes) const override;

 private:
  using Data = std::optional<std::array<std::uint8_t, 4>>;  // nothing: a wrong request

  Data write(std::uint16_t index, std::uint8_t sub, std::int32_t value, Time now);
  Data read(std::uint16_t index, std::uint8_t sub) const;
  CanBytes heartbeat_bytes() const;

  KeyaDrive drive_;
  Time next_heartbeat_ = keya_can::heartbeat_period;
  bool was_booting_ = false;
  std::vector<CanOutput> output_;
};

}  // namespace axisgate::simulated
