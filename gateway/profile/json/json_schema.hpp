// SPDX-License-Identifier: Apache-2.0
// JSON files and JSON Schema, for profiles and configurations alike: reads a file, checks it against a schema.
// Promises all faults of a document at once, each with the JSON pointer of the place and words a person can act on.
// Never throws on what a file says, and never shows the validator library behind it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gateway/profile/json/json_places.hpp"

namespace axisgate::profile {

struct SchemaFault {
  std::string pointer;  ///< RFC 6901; empty: the whole document
  std::string message;
  JsonPlace place{};  ///< of what parse_json() refuses; others' places_of() tells
  friend bool operator==(const SchemaFault&, const SchemaFault&) = default;
};

inline constexpr std::size_t kMaxJsonFileBytes = 1U << 20U;
/// Deeper nesting and longer strings than any profile or configuration has are refused before anything recurses over
/// them.
inline constexpr std::size_t kMaxJsonDepth = 32;
inline constexpr std::size_t kMaxJsonString = 4096;

/// What was read, or that there was nothing to read.
struct FileRead {
  std::string file;
  std::optional<std::string> text{};  ///< none: no file of this name, where one would have been taken
  friend bool operator==(const FileRead&, const FileRead&) = default;
};

/// Of a file that is watched: what is beyond is not looked at.
inline constexpr std::size_t kMaxWatchedBytes = 4U << 20U;
/// As far as kMaxWatchedBytes. What is no regular file is not opened: a pipe would hold its reader for ever.
[[nodiscard]] FileRead read_file(const std::string& path);

/// Whether what is read once may come from a pipe, as a shell's <(...) is. What runs is read again at a reload.
enum class Pipes : std::uint8_t { refused, allowed };

/// The document, or why there is none, with its place, and without a pointer. Comments are allowed; a key given twice
/// is a fault; a number without a fraction is an integer, however it is written. Adds to `read` what was read.
[[nodiscard]] std::variant<nlohmann::json, SchemaFault> load_json(const std::filesystem::path& path,
                                                                  std::vector<FileRead>& read,
                                                                  Pipes pipes = Pipes::refused);
/// The same for text already in memory (an embedded schema, a test).
[[nodiscard]] std::variant<nlohmann::json, SchemaFault> parse_json(std::string_view text);

/// As editors on Windows may save it: with a byte order mark, or each character of the first two beside a zero.
[[nodiscard]] bool is_utf16(std::string_view text);

/// A JSON Schema (draft-7), made ready once; it is part of the program: a bad one throws. Beside draft-7 it may say, at
/// a "pattern", "expects": in words what the text must be (at "patternProperties": what a key must be); beside
/// "properties", "renamed": the names that keys had before, each with that of today (an old name is a fault that tells
/// the new one); and beside "type", "instead": for values of another type, by its name, what to write, $ being what
/// stands there. Not for several threads at once.
class JsonSchema {
 public:
  explicit JsonSchema(std::string_view text);
  [[nodiscard]] std::vector<SchemaFault> faults_in(const nlohmann::json& document) const;

 private:
  struct Rules;
  std::shared_ptr<Rules> rules_;
};

/// One more step of a JSON pointer, escaped.
[[nodiscard]] std::string pointer_to(std::string_view parent, std::string_view key);
[[nodiscard]] std::string pointer_to(std::string_view parent, std::size_t index);

}  // namespace axisgate::profile
