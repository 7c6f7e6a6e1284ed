// SPDX-License-Identifier: Apache-2.0
// What a drive held when its parameters were saved, as a JSON file for a person and for the drive that takes its place.
// Pure: text in, text out. Promises that what is written is read again as the same, and every mistake of a file that
// somebody has edited, each with its place. Never judges whether a drive may have it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gateway/commands/parameters/plan/parameter_list.hpp"
#include "gateway/profile/json/json_schema.hpp"

namespace axisgate::commands {

/// Whose parameters they are.
struct DriveFacts {
  std::string profile, title, protocol;
  unsigned node = 0;
  std::array<std::optional<std::uint32_t>, 4> identity{};  ///< 1018h: vendor, product, revision, serial
  std::string firmware{};                                  ///< 100Ah; empty: it does not say
};

/// A number as the drive counts, or why there is none.
struct Reading {
  std::optional<std::int64_t> number{};  ///< of a REAL32 by real32.hpp
  std::string why{};
  bool answered = true;  ///< false: the drive said nothing at all; of what was just read
};

struct SavedParameter {
  ObjectAddress address;
  std::string name;
  std::string type;  ///< "u16"
  Reading reading{};
};

struct ParameterFile {
  std::string version, at;  ///< of axisgate; when it was saved, in UTC
  unsigned axis = 0;
  std::string axis_name{};
  DriveFacts drive;
  std::vector<SavedParameter> objects{};  ///< by address, each once
};

/// "2010.03"; of Modbus RTU "296".
[[nodiscard]] std::string place_text(const std::string& protocol, ObjectAddress address);
/// Of what was saved: the bytes and the sign of its number.
[[nodiscard]] std::string type_text(const model::ObjectDef& object);
/// A number for a person: "-12", of a REAL32 "0.25".
[[nodiscard]] std::string number_text(const model::ObjectDef& object, std::int64_t number);

[[nodiscard]] std::string json_text(const ParameterFile& file);
[[nodiscard]] std::variant<ParameterFile, std::vector<profile::SchemaFault>> parse_parameter_file(
    const std::string& text);

}  // namespace axisgate::commands
