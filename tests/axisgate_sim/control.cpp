// SPDX-License-Identifier: Apache-2.0
#include "tests/axisgate_sim/control.hpp"

#include <sstream>
#include <stdexcept>

namespace axisgate::simulated {
namespace {

constexpr std::string_view help =
    "LINE/STATION: unresponsive lose corrupt split duplicate noise noise-before noise-after wrong-station babble "
    "on|off|next [N]|RATE, on Modbus RTU half wrong-length glued too; late MS [on|next [N]|RATE]|off; exception CODE "
    "[on|next "
    "[N]|RATE]|off (Modbus RTU); glitch 0x00|0xFF BYTES LEAD_MS [on|next [N]|RATE]|off (serial lines; LEAD_MS 0: glued "
    "to "
    "the reply); restart [next [N]|RATE|off]; clear; state; position; restarts; input NUMBER on|off; "
    "jam on|off; get|writes OBJECT; set OBJECT VALUE; mute OBJECT on|off; refuse OBJECT CODE|off (reads of it; "
    "INDEX.SUB, the register on Modbus RTU, the query code of a Keya on a serial line). A Kinco: fault "
    "2601|2602 BITS; clear 2601|2602 BITS; ignore-quick-stop on|off (an ld2 too: it shows quick stop active and turns "
    "on); stores; transitions. An id286pro: fault CODE [hardware]; clear CODE; "
    "enable on|off; eeprom; starts. An em2rs or a zlac8015d (its motors left and right): fault [left|right] CODE; "
    "clear CODE; jam, position of left|right. On CAN: unresponsive lose duplicate wrong-station wrong-length "
    "emergencies "
    "on|off|next [N]|RATE; babble [0xID] ...; exception ABORTCODE ...; restart before|after [next [N]]; nmt; "
    "emergency CODE; connect on|off; duplicate-node on|off; sdo unsized|wide|wide-sign|unnamed-abort|other-object "
    "[INDEX.SUB] on|off|next [N]|RATE; an ld2: fault CODE; clear CODE; stores; transitions. A "
    "Keya, motors A and B: state, faults, enabled, position, speed, moves (each of both motors); last-command; "
    "commands; trips; fault|"
    "clear A|B BITS; jam A|B on|off; set voltage|temperature|version VALUE; set count|current|motor-temperature A|B "
    "VALUE; heartbeat MS; heartbeat-twice on|off|next [N]|RATE. LINE: unplug; "
    "plug; reply-delay MS; exchanges; on serial lines echo on|off|only; on CAN bus-off on|off; no-ack; overlaps. "
    "lines; help";

// The number that a fault may come with.
void set_number(DriveFaults& faults, DriveFault fault, std::int64_t number) {
  switch (fault) {
    case DriveFault::late:
      faults.late_by = std::chrono::milliseconds(number);
      break;
    case DriveFault::exception:
      faults.exception_code = static_cast<std::uint8_t>(number);
      faults.abort_code = static_cast<std::uint32_t>(number);
      break;
    case DriveFault::babble:
      faults.babble_id = static_cast<std::uint32_t>(number);
      break;
    case DriveFault::emergencies:
      faults.emergency_code = static_cast<std::uint16_t>(number);
      break;
    default:
      refuse_word("'" + std::string(name_of(fault)) + "' takes no number");
  }
}

// glitch LINE/STATION 0x00|0xFF BYTES LEAD_MS
void set_glitch(DriveFaults& faults, const ControlWords& words) {
  const std::int64_t value = number_in(words[2]);
  const std::int64_t bytes = number_in(words[3]);
  constexpr std::int64_t most = 64;  // more is no glitch
  if (value < 0 || value > 0xFF) refuse_word("'" + words[2] + "' is no byte");
  if (bytes < 1 || bytes > most) refuse_word("'" + words[3] + "' bytes: write 1 to " + std::to_string(most));
  faults.glitch_value = static_cast<std::uint8_t>(value);
  faults.glitch_bytes = static_cast<std::size_t>(bytes);
  faults.glitch_lead = std::chrono::milliseconds(number_in(words[4]));
}

}  // namespace

PortLine& Control::port_named(const std::string& name) {
  PortLine* port = simulator_.find(name);
  if (port == nullptr) refuse_word("no line is called '" + name + "': `lines` lists them");
  return *port;
}

Control::Target Control::target_named(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) refuse_word("'" + text + "' is no drive: write LINE/STATION, for example lift/1");
  PortLine& port = port_named(text.substr(0, slash));
  const std::int64_t station = number_in(text.substr(slash + 1));
  const auto stations = port.spec.stations();
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (stations[i] == station) return {port, i};
  }
  refuse_word("line '" + port.spec.name + "' has no station " + std::to_string(station) + ": it has " +
              port.spec.describe());
}

std::string Control::answer(std::string_view line) {
  std::istringstream stream{std::string(line)};
  ControlWords words;
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
    refuse_word("fault '" + std::string(text) +
                "': write NAME@LINE/STATION or NAME@LINE/STATION=RATE, for example unresponsive@lift/1");
  }
  const std::string target(text.substr(at + 1, equals == std::string_view::npos ? equals : equals - at - 1));
  const std::string how(equals == std::string_view::npos ? "on" : text.substr(equals + 1));
  const ControlWords words{std::string(text.substr(0, at)), target, how};
  (void)switch_fault(words, target_named(target));
}

std::string Control::carry_out(const ControlWords& words) {
  if (words.empty() || words[0] == "help") return " " + std::string(help);
  if (words[0] == "lines") {
    std::string text;
    for (const auto& [name, port] : simulator_.lines()) {
      text += " " + name + ":" + port.spec.describe() + (port.port ? "" : "(unplugged)");
    }
    return text;
  }
  if (words.size() < 2) refuse_word("'" + words[0] + "' needs a LINE or LINE/STATION; `help` lists the commands");
  return words[1].find('/') == std::string::npos ? on_line(words) : on_drive(words);
}

std::string Control::on_line(const ControlWords& words) {
  PortLine& port = port_named(words[1]);
  if (words[0] == "unplug") {
    simulator_.unplug(port);
  } else if (words[0] == "plug") {
    if (port.port) refuse_word("line '" + words[1] + "' is plugged in already");
    simulator_.plug(port);
  } else if (words[0] == "reply-delay" && words.size() > 2) {
    port.line->set_reply_delay(std::chrono::milliseconds(number_in(words[2])));
  } else if (words[0] == "exchanges") {
    return " " + std::to_string(port.line->requests_heard());
  } else if (port.can == nullptr && words[0] == "echo") {
    need_words(words, 3, "echo LINE on|off|only");
    const bool only = words[2] == "only";
    port.line->set_echo(only ? AdapterEcho::only : on_or_off(words[2]) ? AdapterEcho::on : AdapterEcho::off);
  } else if (port.can != nullptr && words[0] == "overlaps") {
    return " " + std::to_string(port.can->bus().overlapping_requests());
  } else if (port.can != nullptr && words[0] == "no-ack") {
    port.can->miss_acknowledge(simulator_.now());
  } else if (port.can != nullptr && words[0] == "bus-off") {
    need_words(words, 3, "bus-off LINE on|off");
    port.can->set_bus_off(on_or_off(words[2]), simulator_.now());
  } else {
    refuse_word("'" + words[0] + "' is no command for a line; `help` lists them");
  }
  return "";
}

std::string Control::switch_fault(const ControlWords& words, const Target& target) {
  DriveFaults& faults = target.faults();
  if (words[0] == "noise") {
    set_fault_switch(faults, DriveFault::noise_before, words, 2);
    set_fault_switch(faults, DriveFault::noise_after, words, 2);
    return "";
  }
  const auto fault = drive_fault_named(words[0]);
  if (!fault) refuse_word("'" + words[0] + "' is no command for a drive; `help` lists them");
  const bool can = target.port.can != nullptr;
  if (!target.port.line->has(*fault)) {
    const bool bus = *fault == DriveFault::emergencies;
    const bool life = *fault == DriveFault::heartbeat_twice;
    refuse_word("'" + words[0] +
                (can    ? "' cannot happen on CAN"
                 : bus  ? "' is for drives on CAN alone"
                 : life ? "' is for drives that send heartbeats"
                        : "' is for drives on Modbus RTU alone"));
  }
  if (*fault == DriveFault::glitch && words.size() > 4) {
    set_glitch(faults, words);
    set_fault_switch(faults, *fault, words, 5);
    return "";
  }
  const bool counted = *fault == DriveFault::late || *fault == DriveFault::exception;
  const bool hex = can && words.size() > 2 && words[2].starts_with("0x");
  const bool has_number = words.size() > 2 && (hex || (counted && is_whole_number(words[2])));
  if (has_number) set_number(faults, *fault, number_in(words[2]));
  std::size_t at = has_number ? 3 : 2;
  if (can && *fault == DriveFault::restart && words.size() > 2 && (words[2] == "before" || words[2] == "after")) {
    faults.restart_acts = words[2] == "after";
    at = 3;
    if (words.size() == at) {
      faults.next(DriveFault::restart, 1);
      return "";
    }
  }
  set_fault_switch(faults, *fault, words, at);
  return "";
}

// `mute DRIVE OBJECT on|off`, `refuse DRIVE OBJECT CODE|off`: reads of it.
std::string Control::spoil(const ControlWords& words, const Target& target) {
  const bool mute = words[0] == "mute";
  need_words(words, 4, mute ? "mute LINE/STATION OBJECT on|off" : "refuse LINE/STATION OBJECT CODE|off");
  const bool by_index = words[2].find('.') != std::string::npos;
  const ObjectKey key = by_index ? object_in(words[2]) : ObjectKey{static_cast<std::uint16_t>(number_in(words[2])), 0};
  const DriveFaults::Place place{key.index, key.sub};
  if (words[3] == "off") {
    target.faults().mend(place);
  } else if (mute) {
    if (on_or_off(words[3])) target.faults().spoil(place, {});
  } else {
    target.faults().spoil(place, {.refused_with = static_cast<std::uint32_t>(number_in(words[3]))});
  }
  return "";
}

std::string Control::on_drive(const ControlWords& words) {
  const Target target = target_named(words[1]);
  const std::string& command = words[0];
  if (command == "mute" || command == "refuse") return spoil(words, target);
  if (command == "clear" && words.size() == 2) {
    target.faults().clear();
    return "";
  }
  if (command == "restart" && words.size() == 2) {
    target.port.line->restart(target.position, simulator_.now());
    return "";
  }
  const auto answer = ask_drive(target.port, target.position, words);
  return answer ? *answer : switch_fault(words, target);
}

std::optional<std::string> Control::ask_drive(PortLine& port, std::size_t position, const ControlWords& words) {
  if (port.can != nullptr) return ask_can(simulator_, port, position, words);
  if (port.keya != nullptr) {
    if (words[0] != "heartbeat") return ask_keya(port.keya->drive(position), words, simulator_.now());
    need_words(words, 3, "heartbeat LINE/NODE MS, 0 for none");
    port.keya->set_heartbeat(position, std::chrono::milliseconds(number_in(words[2])));
    return "";
  }
  if (port.rtu == nullptr) return ask_kinco(port.serial->drive(position), words);
  if (KincoDrive* kinco = port.rtu->kinco(position)) return ask_kinco(*kinco, words);
  if (Em2rs* em2rs = port.rtu->em2rs(position)) return ask_em2rs(*em2rs, words);
  if (Zlac8015d* zlac = port.rtu->zlac8015d(position)) return ask_zlac8015d(*zlac, words);
  return ask_id286pro(*port.rtu->id286pro(position), words);
}

}  // namespace axisgate::simulated
