// SPDX-License-Identifier: Apache-2.0
// The control commands of drives on CAN: the node's own, those of a Leadshine, and of a drive known by its EDS.
#include "tests/axisgate_sim/control.hpp"

namespace axisgate::simulated {
namespace {

std::string in_decimal_and_hex(CanView bytes) {
  const std::uint32_t raw = little_endian(bytes);
  std::int64_t value = raw;
  if (bytes.size() == 4) value = static_cast<std::int32_t>(raw);
  if (bytes.size() == 2) value = static_cast<std::int16_t>(raw);
  if (bytes.size() == 1) value = static_cast<std::int8_t>(raw);
  return " " + std::to_string(value) + " " + in_hex(raw);
}

// A Leadshine, or a drive that is known by its EDS alone.
template <class Drive>
std::optional<std::string> ask_coded(Drive& drive, const ControlWords& words) {
  const std::string& command = words[0];
  if (command == "fault") {
    need_words(words, 3, "fault LINE/NODE CODE, of its EMCY");
    drive.inject_fault(static_cast<std::uint16_t>(number_in(words[2])));
    return "";
  }
  if (command == "clear") {
    need_words(words, 3, "clear LINE/NODE, or clear LINE/NODE CODE");
    drive.clear_fault_cause();
    return "";
  }
  return ask_cia402(drive, words);
}

// Of one object alone, where one is named.
void spoil_answers(SdoFaults& faults, const ControlWords& words) {
  constexpr const char* form =
      "sdo LINE/NODE unsized|wide|wide-sign|unnamed-abort|other-object [INDEX.SUB] on|off|next [N]|RATE";
  if (words.size() < 4) refuse_word(std::string("write ") + form);
  const auto fault = sdo_fault_named(words[2]);
  if (!fault) refuse_word("'" + words[2] + "' is nothing that an SDO server does: write " + form);
  // A rate has a point too: 0.25, which is no object.
  const bool one = words.size() > 4 && words[3] != "next";
  const auto only = one ? std::optional(object_in(words[3])) : std::nullopt;
  const Strikes strikes = strikes_in(words, one ? 4 : 3);
  faults.next(*fault, strikes.next.value_or(0), only);
  if (!strikes.next) faults.set_rate(*fault, strikes.rate, only);
}

std::optional<std::string> ask_node(CanopenNode& node, const ControlWords& words, Time now) {
  const std::string& command = words[0];
  if (command == "nmt") return " " + std::string(name_of(node.state()));
  if (command == "get") {
    need_words(words, 3, "get LINE/NODE INDEX.SUB");
    const auto found = node.peek(object_in(words[2]), now);
    if (!found) refuse_word("this drive has no object " + words[2]);
    if (found->size() > 4) return " " + std::string(found->begin(), found->end());
    return in_decimal_and_hex(*found);
  }
  if (command == "set") {
    need_words(words, 4, "set LINE/NODE INDEX.SUB VALUE");
    const std::uint32_t refused = node.poke(object_in(words[2]), number_in(words[3]), now);
    if (refused != 0) refuse_word("the drive refuses " + words[2] + " with " + in_hex(refused));
    return "";
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> ask_can(Simulator& simulator, PortLine& port, std::size_t position,
                                   const ControlWords& words) {
  CanLine& bus = port.can->bus();
  const Time now = simulator.now();
  const std::string& command = words[0];
  if (command == "emergency") {
    need_words(words, 3, "emergency LINE/NODE CODE");
    bus.send_emergency(position, static_cast<std::uint16_t>(number_in(words[2])), now);
    return "";
  }
  if (command == "connect" || command == "duplicate-node") {
    need_words(words, 3, "connect|duplicate-node LINE/NODE on|off");
    const bool on = on_or_off(words[2]);
    if (command == "connect") bus.connect(position, on);
    if (command == "duplicate-node") simulator.set_duplicate(port, position, on);
    return "";
  }
  if (command == "sdo" && bus.canopen(position) != nullptr) {
    spoil_answers(bus.faults(position).sdo, words);
    return "";
  }
  if (KeyaDrive* keya = bus.keya(position)) {
    if (auto told = ask_keya(*keya, words, now)) return told;
  }
  CanopenNode* node = bus.canopen(position);
  if (node == nullptr) return std::nullopt;
  if (auto told = ask_node(*node, words, now)) return told;
  if (KincoDrive* kinco = bus.kinco(position)) return ask_kinco(*kinco, words);
  if (LeadshineDrive* leadshine = bus.leadshine(position)) return ask_coded(*leadshine, words);
  EdsDrive* eds = bus.eds_drive(position);
  return eds != nullptr ? ask_coded(*eds, words) : std::nullopt;
}

}  // namespace axisgate::simulated
