#include "tests/axisgate_sim/control.hpp"

#include <charconv>
#include <cstdio>
#include <sstream>
#include <stdexcept>

namespace axisgate::simulated {
namespace {

constexpr std::string_view help =
    "LINE/STATION: mute lose corrupt split duplicate noise noise-before noise-after wrong-station babble on|off|next "
    "[N]|RATE; late MS [on|next [N]|RATE]|off; restart [next [N]|RATE|off]; clear [2601|2602 BITS]; fault 2601|2602 "
    "BITS; get|writes INDEX.SUB; set INDEX.SUB VALUE; state; stores; restarts; transitions; input NUMBER on|off; jam "
    "on|off. LINE: unplug; plug; reply-delay MS; exchanges. lines; help";

[[noreturn]] void refuse(const std::string& why) { throw std::invalid_argument(why); }

std::int64_t number(const std::string& text) {
  const bool negative = text.starts_with('-');
  std::string_view digits = std::string_view(text).substr(negative ? 1 : 0);
  const bool hex = digits.starts_with("0x");
  if (hex) digits.remove_prefix(2);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, hex ? 16 : 10);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size()) {
    refuse("'" + text + "' is no number: write 123, -123 or 0x7B");
  }
  return negative ? -value : value;
}

double rate(const std::string& text) {
  std::size_t used = 0;
  double value = -1;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used != text.size() || used == 0 || value < 0 || value > 1) {
    refuse("'" + text + "' is none of on, off, next and a rate from 0 to 1");
  }
  return value;
}

bool on_or_off(const std::string& text) {
  if (text != "on" && text != "off") refuse("'" + text + "' is neither on nor off");
  return text == "on";
}

ObjectKey object(const std::string& text) {
  unsigned index = 0;
  unsigned sub = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%4x.%2x%c", &index, &sub, &rest) != 2) {
    refuse("'" + text + "' is no object: write INDEX.SUB in hex, for example 6041.00");
  }
  return {static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(sub)};
}

std::string hex(std::int64_t value) {
  char text[24];
  (void)std::snprintf(text, sizeof text, "0x%08X", static_cast<unsigned>(static_cast<std::uint32_t>(value)));
  return text;
}

int error_word(const std::string& text) {
  if (text != "2601" && text != "2602") refuse("'" + text + "' is no error word: write 2601 or 2602");
  return text == "2601" ? 1 : 2;
}

// on, off, next [N] or a rate, from words[at] on.
void set_switch(DriveFaults& faults, DriveFault fault, const std::vector<std::string>& words, std::size_t at) {
  const std::string how = words.size() > at ? words[at] : "on";
  if (how == "next") {
    faults.next(fault, words.size() > at + 1 ? static_cast<std::uint64_t>(number(words[at + 1])) : 1);
  } else if (how == "off") {
    faults.set_rate(fault, 0);
    faults.next(fault, 0);
  } else {
    faults.set_rate(fault, how == "on" ? 1 : rate(how));
  }
}

std::string transitions(const KincoDrive& drive) {
  std::ostringstream text;
  const auto& log = drive.transitions();
  for (std::size_t i = log.size() > 8 ? log.size() - 8 : 0; i < log.size(); ++i) {
    text << ' ' << log[i].at / one_millisecond << "ms:#" << log[i].tag << ':' << name_of(log[i].to);
  }
  return text.str();
}

}  // namespace

PortLine& Control::port_named(const std::string& name) {
  PortLine* port = simulator_.find(name);
  if (port == nullptr) refuse("no line is called '" + name + "': `lines` lists them");
  return *port;
}

Control::Target Control::target_named(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) refuse("'" + text + "' is no drive: write LINE/STATION, for example lift/1");
  PortLine& port = port_named(text.substr(0, slash));
  const std::int64_t station = number(text.substr(slash + 1));
  for (std::size_t i = 0; i < port.spec.drives.size(); ++i) {
    if (port.spec.drives[i].station == station) return {port, i};
  }
  refuse("line '" + port.spec.name + "' has no station " + std::to_string(station) + ": it has " +
         describe(port.spec.drives));
}

std::string Control::answer(std::string_view line) {
  std::istringstream stream{std::string(line)};
  Words words;
  for (std::string word; stream >> word;) words.push_back(word);
  try {
    (void)simulator_.advance();
    return "ok" + carry_out(words);
  } catch (const std::exception& error) {
    return std::string("error ") + error.what();
  }
}

void Control::set_fault(std::string_view text) {
  const std::size_t at = text.find('@');
  const std::size_t equals = text.find('=');
  if (at == std::string_view::npos) {
    refuse("fault '" + std::string(text) +
           "': write NAME@LINE/STATION or NAME@LINE/STATION=RATE, for example mute@lift/1");
  }
  const std::string target(text.substr(at + 1, equals == std::string_view::npos ? equals : equals - at - 1));
  const std::string how(equals == std::string_view::npos ? "on" : text.substr(equals + 1));
  const Words words{std::string(text.substr(0, at)), target, how};
  (void)switch_fault(words, target_named(target));
}

std::string Control::carry_out(const Words& words) {
  if (words.empty() || words[0] == "help") return " " + std::string(help);
  if (words[0] == "lines") {
    std::string text;
    for (const auto& [name, port] : simulator_.lines()) {
      text += " " + name + ":" + describe(port.spec.drives) + (port.pty ? "" : "(unplugged)");
    }
    return text;
  }
  if (words.size() < 2) refuse("'" + words[0] + "' needs a LINE or LINE/STATION; `help` lists the commands");
  return words[1].find('/') == std::string::npos ? on_line(words) : on_drive(words);
}

std::string Control::on_line(const Words& words) {
  PortLine& port = port_named(words[1]);
  if (words[0] == "unplug") {
    simulator_.unplug(port);
  } else if (words[0] == "plug") {
    if (port.pty) refuse("line '" + words[1] + "' is plugged in already");
    simulator_.plug(port);
  } else if (words[0] == "reply-delay" && words.size() > 2) {
    port.line->set_reply_delay(std::chrono::milliseconds(number(words[2])));
  } else if (words[0] == "exchanges") {
    return " " + std::to_string(port.line->journal().recorded());
  } else {
    refuse("'" + words[0] + "' is no command for a line; `help` lists them");
  }
  return "";
}

std::string Control::switch_fault(const Words& words, const Target& target) {
  DriveFaults& faults = target.faults();
  if (words[0] == "noise") {
    set_switch(faults, DriveFault::noise_before, words, 2);
    set_switch(faults, DriveFault::noise_after, words, 2);
    return "";
  }
  const auto fault = drive_fault_named(words[0]);
  if (!fault) refuse("'" + words[0] + "' is no command for a drive; `help` lists them");
  const bool has_delay =
      *fault == DriveFault::late && words.size() > 2 && words[2].find_first_not_of("0123456789") == std::string::npos;
  if (has_delay) faults.late_by = std::chrono::milliseconds(number(words[2]));
  set_switch(faults, *fault, words, has_delay ? 3 : 2);
  return "";
}

std::string Control::on_drive(const Words& words) {
  const Target target = target_named(words[1]);
  KincoDrive& drive = target.drive();
  const std::string& command = words[0];
  const auto needs = [&](std::size_t count, const char* form) {
    if (words.size() != count) refuse(std::string("write ") + form);
  };
  if (command == "state") {
    return " " + std::string(drive.booting() ? "booting" : name_of(drive.state()));
  }
  if (command == "stores") return " " + std::to_string(drive.stores());
  if (command == "restarts") return " " + std::to_string(drive.restarts());
  if (command == "transitions") return transitions(drive);
  if (command == "get") {
    needs(3, "get LINE/STATION INDEX.SUB");
    const auto value = drive.peek(object(words[2]));
    if (!value) refuse("this drive has no object " + words[2]);
    return " " + std::to_string(*value) + " " + hex(*value);
  }
  if (command == "set") {
    needs(4, "set LINE/STATION INDEX.SUB VALUE");
    const Refusal refusal = drive.poke(object(words[2]), number(words[3]));
    if (refusal != Refusal::none) refuse("the drive refuses " + words[2] + " with " + hex(static_cast<int>(refusal)));
    return "";
  }
  if (command == "writes") {
    needs(3, "writes LINE/STATION INDEX.SUB");
    return " " + std::to_string(drive.writes(object(words[2])));
  }
  if (command == "fault") {
    needs(4, "fault LINE/STATION 2601|2602 BITS");
    drive.inject_fault(error_word(words[2]), static_cast<std::uint16_t>(number(words[3])));
    return "";
  }
  if (command == "clear") {
    if (words.size() == 2) {
      target.faults().clear();
      return "";
    }
    needs(4, "clear LINE/STATION, or clear LINE/STATION 2601|2602 BITS");
    drive.clear_fault_cause(error_word(words[2]), static_cast<std::uint16_t>(number(words[3])));
    return "";
  }
  if (command == "input") {
    needs(4, "input LINE/STATION NUMBER on|off");
    const std::int64_t input = number(words[2]);
    if (input < 1 || input > drive.model().digital_inputs) refuse("this drive has no input " + words[2]);
    drive.set_input(static_cast<int>(input), on_or_off(words[3]));
    return "";
  }
  if (command == "jam") {
    needs(3, "jam LINE/STATION on|off");
    drive.jam(on_or_off(words[2]));
    return "";
  }
  if (command == "restart" && words.size() == 2) {
    target.port.line->restart(target.position, simulator_.now());
    return "";
  }
  return switch_fault(words, target);
}

}  // namespace axisgate::simulated
