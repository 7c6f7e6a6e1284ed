// SPDX-License-Identifier: Apache-2.0
// Reading JSON files (declared in json_schema.hpp): bounded, with comments, and strict about what JSON leaves open.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "gateway/profile/json/json_schema.hpp"
#include "gateway/profile/json/syntax_mistake.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

/// Watches the parser: what JSON allows and a hand-written file never means, a key twice, ends the reading.
class Watch {
 public:
  explicit Watch(std::string_view text) : text_(text) {}

  bool operator()(int depth, json::parse_event_t event, const json& parsed) {
    reached_.accepted = end_of_token(text_, reached_.read, parsed.is_number());
    if (event == json::parse_event_t::object_start || event == json::parse_event_t::array_start)
      reached_.open.push_back(reached_.read - 1);
    if (event == json::parse_event_t::object_end || event == json::parse_event_t::array_end) reached_.open.pop_back();
    if (static_cast<std::size_t>(depth) > kMaxJsonDepth) return refuse("nested more than 32 levels deep");
    if (event == json::parse_event_t::object_start) {
      levels_.emplace_back();
    } else if (event == json::parse_event_t::object_end) {
      levels_.pop_back();
    } else if (event == json::parse_event_t::key) {
      const std::string& key = parsed.get_ref<const std::string&>();
      if (key.size() > kMaxJsonString) return refuse("a key of more than 4096 characters");
      if (!levels_.back().keys.insert(key).second)
        return refuse("key \"" + key + "\" is given twice" + (levels_.size() > 1 ? " under " + where() : ""));
      levels_.back().current = key;
    } else if (event == json::parse_event_t::value && parsed.is_string()) {
      if (parsed.get_ref<const std::string&>().size() > kMaxJsonString)
        return refuse("a text of more than 4096 characters");
    }
    return true;
  }
  [[nodiscard]] const std::optional<SchemaFault>& refused() const { return refused_; }
  [[nodiscard]] Reached& reached() { return reached_; }

 private:
  bool refuse(std::string why) {
    if (!refused_)
      refused_ = SchemaFault{"", std::move(why), place_at(text_, beginning_of_token(text_, reached_.read))};
    return true;  // the rest is still read, so that brackets stay in step; the fault stands
  }
  /// The keys that lead here; an array's index is not known to the parser.
  [[nodiscard]] std::string where() const {
    std::string out;
    for (std::size_t i = 0; i + 1 < levels_.size(); ++i) out += "/" + levels_[i].current;
    return out;
  }
  struct Level {
    std::set<std::string> keys;
    std::string current;
  };
  std::string_view text_;
  std::vector<Level> levels_;
  Reached reached_;
  std::optional<SchemaFault> refused_;
};

/// JSON has one kind of number: 38400.0 is an integer (draft-7, 6.1.1), for who reads it here too.
void make_whole(json& value) {
  constexpr double kExact = 9007199254740992.0;  // 2^53
  if (!value.is_number_float()) return;
  const double number = value.get<double>();
  if (std::abs(number) <= kExact && std::trunc(number) == number) value = static_cast<std::int64_t>(number);
}

/// Not much more than `most` bytes.
std::string beginning_of(std::istream& stream, std::size_t most) {
  std::string text;
  std::array<char, 4096> piece{};
  while (text.size() < most && (stream.read(piece.data(), piece.size()) || stream.gcount() > 0))
    text.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
  return text;
}

}  // namespace

bool is_utf16(std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return true;
  return text.size() >= 2 && (text[0] == '\0') != (text[1] == '\0');
}

std::variant<json, SchemaFault> parse_json(std::string_view text) {
  if (is_utf16(text))
    return SchemaFault{
        "", "is UTF-16: save it as UTF-8 (an editor asks for the encoding where it saves; or iconv -t UTF-8)", {1, 1}};
  Watch watch(text);
  Reached& reached = watch.reached();
  try {
    json document = json::parse(
        ReadSoFar(text.data(), &reached.read), ReadSoFar(text.data() + text.size(), nullptr),
        [&](int depth, json::parse_event_t event, json& parsed) {
          if (event == json::parse_event_t::value) make_whole(parsed);
          return watch(depth, event, parsed);
        },
        true, true);
    if (watch.refused()) return *watch.refused();
    return document;
  } catch (const json::parse_error& error) {
    reached.read = std::min(error.byte, text.size());
    const SyntaxMistake mistake = syntax_mistake(text, reached, error.what());
    return SchemaFault{"", mistake.words, place_at(text, mistake.at)};
  } catch (const json::exception& error) {  // a number beyond every range
    return SchemaFault{"", parsers_words(error.what()), place_at(text, beginning_of_token(text, reached.read))};
  }
}

FileRead read_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {path};
  std::ifstream stream(path, std::ios::binary);
  return {path, beginning_of(stream, kMaxWatchedBytes)};
}

std::variant<json, SchemaFault> load_json(const std::filesystem::path& path, std::vector<FileRead>& read, Pipes pipes) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  const bool readable =
      std::filesystem::is_regular_file(status) || (pipes == Pipes::allowed && std::filesystem::is_fifo(status));
  if (!readable) {
    if (!error && !std::filesystem::exists(status)) error = std::make_error_code(std::errc::no_such_file_or_directory);
    return SchemaFault{"", "cannot be read: " + (error ? error.message() : "it is no regular file")};
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) return SchemaFault{"", "cannot be read: " + std::string(std::strerror(errno))};
  std::string text = beginning_of(file, kMaxJsonFileBytes + 1);
  if (file.bad()) return SchemaFault{"", "cannot be read"};
  if (text.size() > kMaxJsonFileBytes) return SchemaFault{"", "is larger than 1 MiB"};
  read.push_back({path.string(), std::move(text)});
  return parse_json(*read.back().text);
}

}  // namespace axisgate::profile
