// SPDX-License-Identifier: Apache-2.0
// The control commands that are a drive's own: what it holds, its inputs, its faults.
#include <sstream>

#include "tests/axisgate_sim/control.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::size_t shown = 8;  // of a long record, the newest

std::string starts(const Id286pro& drive) {
  std::ostringstream text;
  const auto& log = drive.starts();
  text << ' ' << log.size();
  for (std::size_t i = log.size() > shown ? log.size() - shown : 0; i < log.size(); ++i) {
    text << ' ' << log[i].at / one_millisecond << "ms:#" << log[i].tag << ':' << log[i].command;
  }
  return text.str();
}

// "REGISTER:WRITES ... unknown REGISTER:WRITES ... segments SAVES"
std::string eeprom(const Id286proRegisters& registers) {
  std::ostringstream text;
  for (const auto& [row, count] : registers.stored_writes()) text << ' ' << row << ':' << count;
  text << " unknown";
  for (const auto& [row, count] : registers.unknown_writes()) text << ' ' << row << ':' << count;
  text << " segments " << registers.area_saves();
  return text.str();
}

std::string state(const Id286pro& drive) {
  if (drive.booting()) return " booting";
  const char* const names[] = {"", "disabled", "stopped", "running"};
  return std::string(" ") + names[static_cast<int>(drive.run_state())] +
         (drive.fault() == 0 ? "" : " fault " + std::to_string(drive.fault()));
}

std::string value_text(std::int64_t value) { return " " + std::to_string(value) + " " + in_hex(value); }

int input_in(const std::string& text, int inputs) {
  const std::int64_t input = number_in(text);
  if (input < 1 || input > inputs) refuse_word("this drive has no input " + text);
  return static_cast<int>(input);
}

// What all of them have.
template <class Drive>
std::optional<std::string> ask_one_motor(Drive& drive, int inputs, const ControlWords& words) {
  const std::string& command = words[0];
  if (command == "position") return " " + std::to_string(drive.position());
  if (command == "restarts") return " " + std::to_string(drive.restarts());
  if (command == "input") {
    need_words(words, 4, "input LINE/STATION NUMBER on|off");
    drive.set_input(input_in(words[2], inputs), on_or_off(words[3]));
    return "";
  }
  if (command == "jam") {
    need_words(words, 3, "jam LINE/STATION on|off");
    drive.jam(on_or_off(words[2]));
    return "";
  }
  return std::nullopt;
}

std::optional<std::string> tell(const Cia402Drive& drive, const ControlWords& words) {
  const std::string& command = words[0];
  if (command == "state") return " " + std::string(drive.booting() ? "booting" : name_of(drive.state()));
  if (command == "stores") return " " + std::to_string(drive.stores());
  if (command == "transitions") return transitions_text(drive.transitions());
  if (command == "get") {
    need_words(words, 3, "get LINE/STATION INDEX.SUB");
    const auto value = drive.peek(object_in(words[2]));
    if (!value) refuse_word("this drive has no object " + words[2]);
    return value_text(*value);
  }
  if (command == "writes") {
    need_words(words, 3, "writes LINE/STATION INDEX.SUB");
    return " " + std::to_string(drive.writes(object_in(words[2])));
  }
  return std::nullopt;
}

std::optional<std::string> change(Cia402Drive& drive, const ControlWords& words) {
  const std::string& command = words[0];
  if (command == "set") {
    need_words(words, 4, "set LINE/STATION INDEX.SUB VALUE");
    const Refusal refusal = drive.poke(object_in(words[2]), number_in(words[3]));
    if (refusal != Refusal::none) {
      refuse_word("the drive refuses " + words[2] + " with " + in_hex(static_cast<int>(refusal)));
    }
    return "";
  }
  if (command == "ignore-quick-stop") {
    need_words(words, 3, "ignore-quick-stop LINE/STATION on|off");
    drive.ignore_quick_stop(on_or_off(words[2]));
    return "";
  }
  return std::nullopt;
}

std::optional<std::string> tell(const Id286pro& drive, const ControlWords& words) {
  const std::string& command = words[0];
  if (command == "state") return state(drive);
  if (command == "eeprom") return eeprom(drive.registers());
  if (command == "starts") return starts(drive);
  if (command == "get") {
    need_words(words, 3, "get LINE/UNIT REGISTER");
    const auto value = drive.peek(register_in(words[2]));
    if (!value) refuse_word("this drive has no register " + words[2]);
    return value_text(*value);
  }
  if (command == "writes") {
    need_words(words, 3, "writes LINE/UNIT REGISTER");
    return " " + std::to_string(drive.registers().writes(register_in(words[2])));
  }
  return std::nullopt;
}

std::optional<std::string> change(Id286pro& drive, const ControlWords& words) {
  const std::string& command = words[0];
  if (command == "set") {
    need_words(words, 4, "set LINE/UNIT REGISTER VALUE");
    const RtuException refused = drive.poke(register_in(words[2]), number_in(words[3]));
    if (refused != RtuException::none) {
      refuse_word("the drive refuses " + words[2] + " with exception " + std::to_string(static_cast<int>(refused)));
    }
    return "";
  }
  if (command == "fault") {
    const bool hardware = words.size() == 4 && words[3] == "hardware";
    if (!hardware) need_words(words, 3, "fault LINE/UNIT CODE, or fault LINE/UNIT CODE hardware");
    drive.inject_fault(register_in(words[2]), !hardware);
    return "";
  }
  if (command == "clear") {
    need_words(words, 3, "clear LINE/UNIT, or clear LINE/UNIT CODE");
    if (drive.fault() != number_in(words[2])) refuse_word("the drive has no fault " + words[2]);
    drive.clear_fault_cause();
    return "";
  }
  if (command == "enable") {
    need_words(words, 3, "enable LINE/UNIT on|off");
    drive.set_enable_switch(on_or_off(words[2]));
    return "";
  }
  return std::nullopt;
}

}  // namespace

std::string transitions_text(const std::deque<Transition>& log) {
  std::ostringstream text;
  for (std::size_t i = log.size() > shown ? log.size() - shown : 0; i < log.size(); ++i) {
    text << ' ' << log[i].at / one_millisecond << "ms:#" << log[i].tag << ':' << name_of(log[i].to);
  }
  return text.str();
}

std::optional<std::string> ask_cia402(Cia402Drive& drive, const ControlWords& words) {
  if (auto told = ask_one_motor(drive, drive.input_count(), words)) return told;
  const auto told = tell(drive, words);
  return told ? told : change(drive, words);
}

std::optional<std::string> ask_kinco(KincoDrive& drive, const ControlWords& words) {
  const std::string& command = words[0];
  if (command == "fault") {
    need_words(words, 4, "fault LINE/STATION 2601|2602 BITS");
    drive.inject_fault(error_word_in(words[2]), static_cast<std::uint16_t>(number_in(words[3])));
    return "";
  }
  if (command == "clear") {
    need_words(words, 4, "clear LINE/STATION, or clear LINE/STATION 2601|2602 BITS");
    drive.clear_fault_cause(error_word_in(words[2]), static_cast<std::uint16_t>(number_in(words[3])));
    return "";
  }
  return ask_cia402(drive, words);
}

std::optional<std::string> ask_id286pro(Id286pro& drive, const ControlWords& words) {
  if (auto told = ask_one_motor(drive, Id286proInputs::count, words)) return told;
  const auto told = tell(drive, words);
  return told ? told : change(drive, words);
}

}  // namespace axisgate::simulated
