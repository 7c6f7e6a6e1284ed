// SPDX-License-Identifier: Apache-2.0
// The makers' sheets as tests read them: every vector and row of tests/vectors.
// Promises to skip nothing but what a sheet itself calls malformed. Never knows a drive.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/places.hpp"
#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {

// "vectors", "objects", "conversions" of a sheet.
inline nlohmann::json sheet_of(const std::string& name, const std::string& part_of_it) {
  std::ifstream file(test::source_path("tests/vectors/") + name + ".json");
  return nlohmann::json::parse(file).at(part_of_it);
}

// Every vector of a sheet for this protocol and direction; how many there are.
template <class Visit>
int each_vector(const std::string& sheet, const std::string& protocol, const std::string& direction, Visit visit) {
  int visited = 0;
  const auto vectors = sheet_of(sheet, "vectors");
  for (const auto& vector : vectors) {
    if (vector.at("protocol") != protocol || vector.at("direction") != direction) continue;
    if (!vector.value("well_formed", true)) continue;
    SCOPED_TRACE(vector.at("id").template get<std::string>());
    visit(vector);
    ++visited;
  }
  return visited;
}

inline std::uint32_t hex_number(const nlohmann::json& text) {
  return static_cast<std::uint32_t>(std::stoul(text.get<std::string>(), nullptr, 16));
}

inline ObjectKey key_in(const nlohmann::json& row) {
  return {static_cast<std::uint16_t>(hex_number(row.at("index"))),
          row.at("sub").is_null() ? std::uint8_t{0} : row.at("sub").get<std::uint8_t>()};
}

inline std::int64_t value_in(const nlohmann::json& decoded) {
  return decoded.value("value_signed", decoded.value("value", std::int64_t{0}));
}

// As it is on the wire: with the bytes a print leaves out, and without its misprints.
inline Bytes bytes_in(const nlohmann::json& vector) {
  for (const char* name : {"hex_padded", "hex_corrected"}) {
    if (vector.contains(name) && vector.at(name).is_string()) return from_hex(vector.at(name).get<std::string>());
  }
  return from_hex(vector.at("hex").get<std::string>());
}

inline std::uint8_t node_in(const nlohmann::json& vector, std::uint32_t base) {
  return static_cast<std::uint8_t>(hex_number(vector.at("can_id")) - base);
}

inline bool is_read_reply(std::uint8_t command) { return command == 0x43 || command == 0x4B || command == 0x4F; }

}  // namespace axisgate::simulated
