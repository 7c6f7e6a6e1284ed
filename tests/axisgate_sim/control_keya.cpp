// SPDX-License-Identifier: Apache-2.0
// The control commands of a Keya: what both of its motors do, whatever a fieldbus believes of it.
#include "tests/axisgate_sim/control.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::string_view mode_names[] = {"", "speed", "torque", "absolute", "relative"};

KeyaMotorName motor_in(const std::string& text) {
  if (text != "A" && text != "B") refuse_word("'" + text + "' is no motor: write A or B");
  return text == "A" ? KeyaMotorName::a : KeyaMotorName::b;
}

template <class Tell>
std::string of_both(const KeyaDrive& drive, Tell tell) {
  std::string text;
  for (const KeyaMotorName motor : keya_motors) text += " " + tell(drive, motor);
  return text;
}

std::string state_of(const KeyaDrive& drive, KeyaMotorName motor) {
  return drive.enabled(motor) ? std::string(mode_names[static_cast<std::size_t>(drive.at(motor).mode())]) : "disabled";
}

std::optional<std::string> tell_motors(const KeyaDrive& drive, const std::string& command) {
  using Name = KeyaMotorName;
  if (command == "state") return drive.booting() ? " booting" : of_both(drive, state_of);
  if (command == "faults") {
    return of_both(drive, [](const KeyaDrive& it, Name motor) { return in_hex(it.faults(motor)); });
  }
  if (command == "enabled") {
    return of_both(drive, [](const KeyaDrive& it, Name motor) { return std::string(it.enabled(motor) ? "1" : "0"); });
  }
  if (command == "position") {
    return of_both(drive, [](const KeyaDrive& it, Name motor) { return std::to_string(it.at(motor).count()); });
  }
  if (command == "speed") {
    return of_both(drive, [](const KeyaDrive& it, Name motor) { return std::to_string(it.at(motor).rpm()); });
  }
  if (command == "moves") {
    return of_both(drive, [](const KeyaDrive& it, Name motor) { return std::to_string(it.moves(motor)); });
  }
  return std::nullopt;
}

std::optional<std::string> tell(const KeyaDrive& drive, const std::string& command, Time now) {
  if (command == "last-command") {
    const auto last = drive.last_control();
    return last ? " " + std::to_string((now - *last) / one_millisecond) + " ms ago" : " never";
  }
  if (command == "commands") return " " + std::to_string(drive.controls());
  if (command == "trips") return " " + std::to_string(drive.trips());
  if (command == "restarts") return " " + std::to_string(drive.restarts());
  return tell_motors(drive, command);
}

// Nothing: an object, which the node knows.
std::optional<std::string> set(KeyaDrive& drive, const ControlWords& words) {
  KeyaMeasured& measured = drive.measured();
  const std::string& what = words.size() > 2 ? words[2] : words[0];
  if (what == "voltage" || what == "temperature" || what == "version") {
    need_words(words, 4, "set LINE/NODE voltage|temperature|version VALUE");
    const std::int64_t value = number_in(words[3]);
    if (what == "voltage") measured.voltage = static_cast<std::uint8_t>(value);
    if (what == "temperature") measured.temperature = static_cast<std::int16_t>(value);
    if (what == "version") measured.version = static_cast<std::uint32_t>(value);
    return "";
  }
  if (what != "count" && what != "current" && what != "motor-temperature") return std::nullopt;
  need_words(words, 5, "set LINE/NODE count|current|motor-temperature A|B VALUE");
  const KeyaMotorName motor = motor_in(words[3]);
  const std::int64_t value = number_in(words[4]);
  if (what == "count") drive.at(motor).set_count(static_cast<std::int32_t>(value));
  if (what == "current") drive.at(motor).show_current(static_cast<std::uint16_t>(value));
  if (what == "motor-temperature") {
    measured.motor_temperature[static_cast<std::size_t>(motor)] = static_cast<std::int16_t>(value);
  }
  return "";
}

}  // namespace

std::optional<std::string> ask_keya(KeyaDrive& drive, const ControlWords& words, Time now) {
  const std::string& command = words[0];
  if (auto told = tell(drive, command, now)) return told;
  if (command == "set") return set(drive, words);
  if (command == "fault" || command == "clear") {
    need_words(words, 4, "fault|clear LINE/NODE A|B BITS, for example fault cart/1 A 0x0800");
    const auto bits = static_cast<std::uint16_t>(number_in(words[3]));
    const KeyaMotorName motor = motor_in(words[2]);
    command == "fault" ? drive.inject_fault(motor, bits) : drive.clear_fault_cause(motor, bits);
    return "";
  }
  if (command == "jam") {
    need_words(words, 4, "jam LINE/NODE A|B on|off");
    drive.at(motor_in(words[2])).jam(on_or_off(words[3]));
    return "";
  }
  return std::nullopt;
}

}  // namespace axisgate::simulated
