// SPDX-License-Identifier: Apache-2.0
// The listing as a PLC's source: IEC 61131-3 structured text, constants of all addresses and declarations at %M.
#include <cctype>

#include "gateway/listing/map_listing.hpp"

namespace axisgate::listing {
namespace {

/// "axis1_position_actual", "bus0_link", "gateway_uptime_s": letters, digits and single underlines (IEC
/// 61131-3, 6.1.2).
std::string identifier(const MapEntry& entry) {
  std::string owner = "gateway";
  if (entry.axis) owner = "axis" + std::to_string(*entry.axis);
  if (entry.bus) owner = "bus" + std::to_string((entry.address - kBusBlocks) / kBusBlock);
  const std::string_view table = entry.table == "coil" ? "_coil_" : entry.table == "discrete" ? "_input_" : "_";
  return owner + std::string(table) + entry.name;
}

/// A comment ends where it says so, whatever a bus is called, and stands on one line.
std::string comment(const std::string& text) {
  std::string out;
  for (const char each : text) {
    const bool ends = each == ')' && !out.empty() && out.back() == '*';
    const bool plain = each != '\n' && each != '\r';
    out += ends ? std::string(" )") : std::string(1, plain ? each : ' ');
  }
  return "(* " + out + " *)";
}

std::string_view data_type(const MapEntry& entry) {
  if (entry.type == "i16") return "INT";
  if (entry.type == "i32") return "DINT";
  if (entry.type == "u32") return "UDINT";
  return entry.type == "f32" ? "REAL" : "UINT";
}

std::string about(const MapEntry& entry) {
  std::string out = reference_of(entry) + ", " + std::string(entry.access);
  if (!entry.supported) out += ", not on this drive";
  if (!entry.unit.empty()) out += ", " + entry.unit;
  out += ": " + std::string(entry.meaning);
  if (!entry.note.empty()) out += "; " + std::string(entry.note);
  return comment(out);
}

/// Rows of 32 bits stand at even addresses, so that %MD counts pairs of %MW.
std::string place(const MapEntry& entry) {
  return entry.count == 2 ? "%MD" + std::to_string(entry.address / 2) : "%MW" + std::to_string(entry.address);
}

}  // namespace

std::string map_st(const ListedMap& map, const std::vector<MapEntry>& entries) {
  std::string out = comment("axisgate, register map version " + std::to_string(kMapVersion) + ", 32-bit values " +
                            (map.low_word_first ? "low" : "high") +
                            " word first, addresses count from 0, the numbers in comments from 40001") +
                    "\n";
  for (const ListedAxis& axis : map.axes)
    out += comment("axis" + std::to_string(axis.number) + ": " + axis.name +
                   (axis.bus.empty() ? "" : ", on " + axis.bus)) +
           "\n";
  for (std::size_t b = 0; b < map.buses.size(); ++b)
    out += comment("bus" + std::to_string(b) + ": " + map.buses[b]) + "\n";
  out += "\nVAR_GLOBAL CONSTANT\n";
  for (const MapEntry& entry : entries)
    out += "  " + identifier(entry) + "_adr : UINT := " + std::to_string(entry.address) + ";\n";
  out += "END_VAR\n\n";
  out += comment("for a controller that keeps register n of the gateway in %MWn, with the word order above") +
         "\nVAR_GLOBAL\n";
  for (const MapEntry& entry : entries) {
    if (entry.table != "holding") continue;
    out += "  " + identifier(entry) + " AT " + place(entry) + " : " + std::string(data_type(entry)) + ";  " +
           about(entry) + "\n";
  }
  return out + "END_VAR\n";
}

}  // namespace axisgate::listing
