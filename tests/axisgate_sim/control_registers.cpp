// SPDX-License-Identifier: Apache-2.0
// The control commands of drives that are a table of registers: an EM2RS or CS2RS, and a ZLAC8015D.
#include "tests/axisgate_sim/control.hpp"

namespace axisgate::simulated {
namespace {

std::optional<std::string> ask_registers(RegisterSlave& drive, const ControlWords& words) {
  const std::string& command = words[0];
  if (command == "get") {
    need_words(words, 3, "get LINE/UNIT REGISTER");
    const auto value = drive.peek(register_in(words[2]));
    if (!value) refuse_word("this drive has no register " + words[2]);
    return " " + std::to_string(*value) + " " + in_hex(*value);
  }
  if (command == "writes") {
    need_words(words, 3, "writes LINE/UNIT REGISTER");
    return " " + std::to_string(drive.writes(register_in(words[2])));
  }
  if (command == "set") {
    need_words(words, 4, "set LINE/UNIT REGISTER VALUE");
    const RtuException refused = drive.poke(register_in(words[2]), number_in(words[3]));
    if (refused != RtuException::none)
      refuse_word("the drive refuses " + words[2] + " with exception " + std::to_string(static_cast<int>(refused)));
    return "";
  }
  return std::nullopt;
}

std::size_t wheel_in(const std::string& text) {
  if (text != "left" && text != "right") refuse_word("'" + text + "' is no motor: write left or right");
  return text == "left" ? Zlac8015d::left : Zlac8015d::right;
}

}  // namespace

std::optional<std::string> ask_em2rs(Em2rs& drive, const ControlWords& words) {
  const std::string& command = words[0];
  if (command == "position") return " " + std::to_string(drive.position());
  if (command == "restarts") return " " + std::to_string(drive.restarts());
  if (command == "state") {
    const std::string state = drive.booting()   ? " booting"
                              : drive.running() ? " running"
                              : drive.enabled() ? " enabled"
                                                : " disabled";
    return state + (drive.fault() == 0 ? "" : " fault " + std::to_string(drive.fault()));
  }
  if (command == "input") {
    need_words(words, 4, "input LINE/UNIT NUMBER on|off");
    const std::int64_t input = number_in(words[2]);
    if (input < 1 || input > Em2rs::inputs) refuse_word("this drive has no input " + words[2]);
    drive.set_input(static_cast<int>(input), on_or_off(words[3]));
    return "";
  }
  if (command == "jam") {
    need_words(words, 3, "jam LINE/UNIT on|off");
    drive.jam(on_or_off(words[2]));
    return "";
  }
  if (command == "fault") {
    need_words(words, 3, "fault LINE/UNIT CODE");
    drive.inject_fault(register_in(words[2]));
    return "";
  }
  if (command == "clear") {
    need_words(words, 3, "clear LINE/UNIT, or clear LINE/UNIT CODE");
    if (drive.fault() != number_in(words[2])) refuse_word("the drive has no fault " + words[2]);
    drive.clear_fault_cause();
    return "";
  }
  return ask_registers(drive, words);
}

std::optional<std::string> ask_zlac8015d(Zlac8015d& drive, const ControlWords& words) {
  const std::string& command = words[0];
  if (command == "position") {
    need_words(words, 3, "position LINE/UNIT left|right");
    return " " + std::to_string(drive.position(wheel_in(words[2])));
  }
  if (command == "restarts") return " " + std::to_string(drive.restarts());
  if (command == "state") {
    const char* const names[] = {" released", " enabled", " stopping", " quick_stopped"};
    if (drive.booting()) return " booting";
    return names[static_cast<int>(drive.state())] + std::string(drive.faulted() ? " fault" : "");
  }
  if (command == "jam") {
    need_words(words, 4, "jam LINE/UNIT left|right on|off");
    drive.jam(wheel_in(words[2]), on_or_off(words[3]));
    return "";
  }
  if (command == "fault") {
    need_words(words, 4, "fault LINE/UNIT left|right BITS");
    drive.inject_fault(wheel_in(words[2]), register_in(words[3]));
    return "";
  }
  if (command == "clear") {
    drive.clear_fault_cause();
    return "";
  }
  return ask_registers(drive, words);
}

}  // namespace axisgate::simulated
