// SPDX-License-Identifier: Apache-2.0
// The frames of the drive sheets (tests/vectors).
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/places.hpp"
#include "tests/unit/bus/wire_stage.hpp"

namespace axisgate::test {

/// "0x6041" or 24641.
inline std::uint32_t number(const nlohmann::json& value) {
  return value.is_string() ? static_cast<std::uint32_t>(std::stoul(value.get<std::string>(), nullptr, 16))
                           : static_cast<std::uint32_t>(value.get<std::int64_t>());
}

struct SheetVector {
  std::string name;  ///< "sheet/id"
  nlohmann::json row;
  ByteRow printed;
  ByteRow bytes;  ///< as it must be sent: padded, or what a misprint was meant to be

  [[nodiscard]] const nlohmann::json& decoded() const { return row.at("decoded"); }
  [[nodiscard]] std::string protocol() const { return row.at("protocol"); }
  [[nodiscard]] bool request() const { return row.at("direction") == "request"; }
  /// What the sheet says of it; null where it says nothing.
  [[nodiscard]] nlohmann::json says(const char* what) const { return decoded().value(what, nlohmann::json()); }
  [[nodiscard]] std::uint32_t value(const char* what) const { return number(decoded().at(what)); }
};
inline void PrintTo(const SheetVector& vector, std::ostream* out) { *out << vector.name; }

template <typename Which>
std::vector<SheetVector> sheet_vectors(std::initializer_list<const char*> sheets, Which which) {
  std::vector<SheetVector> all;
  for (const std::string sheet : sheets) {
    std::ifstream file(test::source_path("tests/vectors/") + sheet + ".json");
    const nlohmann::json parsed = nlohmann::json::parse(file);
    for (const auto& row : parsed.at("vectors")) {
      const std::string hex = row.at("hex");
      const std::string meant = row.value("hex_corrected", row.value("hex_padded", hex));
      SheetVector vector{sheet + "/" + row.at("id").get<std::string>(), row, from_hex(hex), from_hex(meant)};
      if (which(vector)) all.push_back(std::move(vector));
    }
  }
  return all;
}

inline std::string vector_name(const testing::TestParamInfo<SheetVector>& info) {
  std::string name = info.param.name;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

}  // namespace axisgate::test
