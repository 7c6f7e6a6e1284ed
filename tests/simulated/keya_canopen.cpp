// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/keya_canopen.hpp"

#include <algorithm>

namespace axisgate::simulated {
namespace {

struct VendorObject {
  std::uint16_t index;
  std::uint8_t sub;
  std::uint8_t width;
  bool writable;
};

// From 2000h on (6.4). 2003h and 2004h are named in a mapping alone: a word each.
constexpr std::array<VendorObject, 29> vendor_objects{{
    {0x2000, 0, 2, false}, {0x2003, 0, 2, false}, {0x2004, 0, 2, false}, {0x2010, 0, 2, false}, {0x2011, 0, 2, false},
    {0x2012, 0, 2, false}, {0x2013, 0, 2, false}, {0x2014, 0, 2, false}, {0x2015, 0, 2, false}, {0x2016, 0, 4, false},
    {0x2017, 0, 2, false}, {0x2020, 0, 2, false}, {0x2021, 0, 2, false}, {0x2022, 0, 2, false}, {0x2023, 0, 2, false},
    {0x2024, 0, 2, false}, {0x2025, 0, 2, false}, {0x2026, 0, 4, false}, {0x2027, 0, 2, false}, {0x203A, 0, 2, false},
    {0x203B, 0, 4, false}, {0x203C, 0, 2, false}, {0x203D, 0, 4, false}, {0x607A, 0, 4, true},  {0x6081, 0, 4, true},
    {0x6083, 0, 4, true},  {0x6084, 0, 4, true},  {0x6099, 1, 4, true},  {0x6099, 2, 4, true},
}};

const VendorObject* find(ObjectKey key) {
  const auto found = std::ranges::find_if(
      vendor_objects, [key](const VendorObject& row) { return row.index == key.index && row.sub == key.sub; });
  return found == vendor_objects.end() ? nullptr : &*found;
}

std::uint32_t absent(ObjectKey key) {
  const bool known =
      std::ranges::any_of(vendor_objects, [key](const VendorObject& row) { return row.index == key.index; });
  return known ? sdo_abort::no_such_sub : abort_of(Refusal::no_such_object);
}

constexpr std::uint32_t enabling = 0x030D2000, disabling = 0x030C2000, zeroing = 0x030D0000;
constexpr std::uint32_t no_code = 0;  // "data only" in an RPDO: the enabling stays as it is

}  // namespace

CommunicationFacts communication_of(const KeyaCanopenDrive& options) {
  CommunicationFacts facts;
  facts.sdo.segmented = false;  // expedited transfers alone are described
  facts.pdo.event_timer = facts.pdo.receive_timers = facts.pdo.compatibility = true;
  facts.pdo.type = 255;
  facts.pdo.inhibit_unit = one_millisecond;
  facts.pdo.on_change = options.drive.pdo_on_change;
  facts.pdo.free_mapping = true;
  facts.pdo.entries = 4;
  facts.pdo.receive = {
      {1000, 2, {0x607A0020, 0x60810020}}, {1000, 2, {0x60830020, 0x60840020}}, {1000, 0, {}}, {1000, 0, {}}};
  facts.pdo.transmit = {{1000, 3, {0x20120010, 0x20100010, 0x20160020}},
                        {1011, 3, {0x20220010, 0x20200010, 0x20260020}},
                        {1022, 4, {0x20110010, 0x20210010, 0x20130010, 0x203C0010}},
                        {0, 0, {0x20030010, 0, 0x20040010}}};
  facts.answers_guarding = false;
  facts.consumers = 0;
  facts.sends_emergencies = false;
  facts.heartbeat = options.drive.producer_heartbeat;
  facts.heartbeat_width = 4;
  facts.identity_object = false;
  facts.keeps_settings = true;
  facts.device_type = 0;
  facts.version_numbers = 1;
  return facts;
}

std::uint8_t KeyaCanopen::error_register() const {
  const unsigned both = drive_.faults(KeyaMotorName::a) | drive_.faults(KeyaMotorName::b);
  return (both & ~unsigned{keya_fault::disabled}) != 0 ? 1 : 0;
}

std::int64_t KeyaCanopen::value_of_motor(std::uint8_t row, KeyaMotorName name) const {
  const KeyaMotor& motor = drive_.at(name);
  switch (row) {
    case 0:
      return motor.current();
    case 1:
      return drive_.faults(name);
    case 2:
      return motor.rpm();
    case 3:
      return drive_.measured().voltage;
    case 4:
      return drive_.measured().motor_temperature[static_cast<std::size_t>(name)];
    case 5:
      return motor.mechanical_angle();
    case 6:
      return motor.count();
    default:
      return motor.electrical_angle();
  }
}

std::int64_t KeyaCanopen::value_of(ObjectKey key) const {
  if (key.index >= 0x2010 && key.index <= 0x2017) {
    return value_of_motor(static_cast<std::uint8_t>(key.index & 7U), KeyaMotorName::a);
  }
  if (key.index >= 0x2020 && key.index <= 0x2027) {
    return value_of_motor(static_cast<std::uint8_t>(key.index & 7U), KeyaMotorName::b);
  }
  const auto state = drive_.control_state();
  switch (key.index) {
    case 0x2000:
      return drive_.options().node;
    case 0x203B:
      return std::int64_t{drive_.faults(KeyaMotorName::b)} << 16 | drive_.faults(KeyaMotorName::a);
    case 0x203C:
      return drive_.measured().temperature;
    case 0x203D:
      return drive_.measured().version;
    case 0x607A:
    case 0x6083:
      return codes_[key.index == 0x607A ? 0 : 1];
    case 0x6081:
    case 0x6084:
      return data_[key.index == 0x6081 ? 0 : 1];
    case 0x6099:
      return drive_.at(key.sub == 1 ? KeyaMotorName::a : KeyaMotorName::b).speed_limit();
    default:
      return state[1] << 8 | state[0];  // 203Ah, 2003h, 2004h: their bits are not described
  }
}

ObjectReply KeyaCanopen::read(ObjectKey key, Time now) {
  const VendorObject* row = find(key);
  if (row == nullptr) return {absent(key), {}};
  drive_.advance(now);
  return {0, little_endian(static_cast<std::uint32_t>(value_of(key)), row->width)};
}

std::optional<std::uint32_t> KeyaCanopen::mapped(ObjectKey key, Time now) {
  if (find(key) == nullptr) return std::nullopt;
  drive_.advance(now);
  return static_cast<std::uint32_t>(value_of(key));
}

std::uint32_t KeyaCanopen::write(ObjectKey key, CanView bytes, std::uint64_t tag, Time now) {
  const VendorObject* row = find(key);
  if (row == nullptr) return absent(key);
  if (!row->writable) return abort_of(Refusal::read_only);
  if (bytes.size() != row->width) return abort_of(Refusal::wrong_width);
  drive_.advance(now);
  const std::uint32_t raw = little_endian(bytes);
  switch (key.index) {
    case 0x607A:
      return take_code(KeyaMotorName::a, raw, tag, now);
    case 0x6083:
      return take_code(KeyaMotorName::b, raw, tag, now);
    case 0x6081:
      return take_data(KeyaMotorName::a, static_cast<std::int32_t>(raw), tag, now);
    case 0x6084:
      return take_data(KeyaMotorName::b, static_cast<std::int32_t>(raw), tag, now);
    default:
      if (raw > static_cast<std::uint32_t>(keya_full_scale)) return abort_of(Refusal::value_range);
      drive_.limit_speed(key.sub == 1 ? KeyaMotorName::a : KeyaMotorName::b, raw);
      return 0;
  }
}

std::uint32_t KeyaCanopen::take_code(KeyaMotorName motor, std::uint32_t code, std::uint64_t tag, Time now) {
  const auto n = static_cast<std::size_t>(motor);
  const std::uint32_t number = static_cast<std::uint32_t>(n) + 1;
  std::optional<KeyaMode> mode;
  switch (code - number) {
    case enabling | 0x10:
      mode = KeyaMode::speed;
      break;
    case enabling | 0x30:
      mode = KeyaMode::absolute;
      break;
    case enabling | 0x40:
      mode = KeyaMode::relative;
      break;
    case enabling:
      mode = drive_.at(motor).configured_mode();
      break;
    case disabling:
      drive_.disable(motor, now);
      break;
    case disabling | 0xF0:
      drive_.reset_faults(motor, now);
      break;
    default:
      if (code == zeroing) {
        drive_.zero_count(motor, now);
      } else if (code == no_code) {
        drive_.feed(now);
      } else {
        return abort_of(Refusal::value_range);
      }
  }
  codes_[n] = code;
  if (!mode) return 0;
  const bool was = drive_.enabled(motor);
  drive_.enable(motor, mode, now);
  if (!was) enabled_by_[n] = tag;
  return 0;
}

std::uint32_t KeyaCanopen::take_data(KeyaMotorName motor, std::int32_t value, std::uint64_t tag, Time now) {
  const auto n = static_cast<std::size_t>(motor);
  const bool plain_enable = value == 0 && tag != 0 && enabled_by_[n] == tag &&
                            drive_.at(motor).mode() == KeyaMode::absolute && !drive_.options().enable_with_zero_moves;
  data_[n] = value;
  if (plain_enable) {
    drive_.feed(now);
    return 0;
  }
  return drive_.set_value(motor, value, std::nullopt, now) ? 0 : abort_of(Refusal::value_range);
}

bool KeyaCanopen::may_be_mapped(ObjectKey key, PdoDirection direction) const {
  const VendorObject* row = find(key);
  return row != nullptr && (direction == PdoDirection::from_drive || row->writable);
}

std::uint32_t KeyaCanopen::poke(ObjectKey key, std::int64_t value) {
  if (find(key) == nullptr) return absent(key);
  KeyaMeasured& measured = drive_.measured();
  const bool b = key.index >= 0x2020 && key.index <= 0x2027;
  KeyaMotor& motor = drive_.at(b ? KeyaMotorName::b : KeyaMotorName::a);
  switch (key.index) {
    case 0x2010:
    case 0x2020:
      motor.show_current(static_cast<std::uint16_t>(value));
      return 0;
    case 0x2013:
    case 0x2023:
      measured.voltage = static_cast<std::uint8_t>(value);
      return 0;
    case 0x2014:
    case 0x2024:
      measured.motor_temperature[b ? 1 : 0] = static_cast<std::int16_t>(value);
      return 0;
    case 0x2016:
    case 0x2026:
      motor.set_count(static_cast<std::int32_t>(value));
      return 0;
    case 0x203C:
      measured.temperature = static_cast<std::int16_t>(value);
      return 0;
    case 0x203D:
      measured.version = static_cast<std::uint32_t>(value);
      return 0;
    default:
      return abort_of(Refusal::read_only);
  }
}

}  // namespace axisgate::simulated
