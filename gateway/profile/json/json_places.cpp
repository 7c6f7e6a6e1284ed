// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/json/json_places.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "gateway/profile/json/json_schema.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The pointer of what is around: "/a/0" -> "/a" -> "".
std::string_view around(std::string_view pointer) {
  const std::size_t slash = pointer.rfind('/');
  return pointer.substr(0, slash == std::string_view::npos ? 0 : slash);
}

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.'; }

/// Counts lines and characters up to one byte after another; each is behind the one before.
class Counter {
 public:
  explicit Counter(std::string_view text) : text_(text), at_(text.starts_with(kByteOrderMark) ? 3 : 0) {}

  JsonPlace to(std::size_t byte) {
    for (; at_ < std::min(byte, text_.size()); ++at_) {
      if (text_[at_] == '\n') {
        ++place_.line;
        place_.column = 1;
      } else if ((static_cast<unsigned char>(text_[at_]) & 0xC0U) != 0x80U) {  // UTF-8: no byte that continues one
        ++place_.column;
      }
    }
    return place_;
  }

 private:
  std::string_view text_;
  std::size_t at_;
  JsonPlace place_{1, 1};
};

/// Follows the parser, and keeps where those begin that are looked for.
class Finder final : public json::json_sax_t {
 public:
  using Wanted = std::map<std::string, std::optional<std::size_t>, std::less<>>;
  Finder(std::string_view text, Wanted& wanted, const std::size_t& read) : text_(text), wanted_(wanted), read_(read) {}

  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(std::int64_t) override { return number(); }
  bool number_unsigned(std::uint64_t) override { return number(); }
  bool number_float(double, const std::string&) override { return number(); }
  bool string(std::string&) override { return value(); }
  bool binary(json::binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(false); }
  bool start_array(std::size_t) override { return open(true); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t, const std::string&, const json::exception&) override { return false; }
  bool key(std::string& name) override {
    path_.resize(levels_.back().path);
    path_ = pointer_to(path_, name);
    note(read_);
    return true;
  }

 private:
  struct Level {
    bool is_array = false;
    std::size_t entries = 0;
    std::size_t path = 0;  ///< how long its own pointer is
  };

  void note(std::size_t end) {
    if (const auto at = wanted_.find(path_); at != wanted_.end() && !at->second)
      at->second = beginning_of_token(text_, end);
  }
  bool value(std::size_t end) {
    if (levels_.empty() || !levels_.back().is_array) return true;  // its key was noted
    path_.resize(levels_.back().path);
    path_ = pointer_to(path_, levels_.back().entries++);
    note(end);
    return true;
  }
  bool value() { return value(read_); }
  bool number() { return value(end_of_token(text_, read_, true)); }
  bool open(bool is_array) {
    value();
    levels_.push_back({is_array, 0, path_.size()});
    return levels_.size() <= kMaxJsonDepth;
  }
  bool close() {
    path_.resize(levels_.back().path);
    levels_.pop_back();
    return true;
  }

  std::string_view text_;
  Wanted& wanted_;
  const std::size_t& read_;
  std::vector<Level> levels_;
  std::string path_;
};

}  // namespace

JsonPlace place_at(std::string_view text, std::size_t byte) { return Counter(text).to(byte); }

std::size_t end_of_token(std::string_view text, std::size_t read, bool number) {
  return number && std::isdigit(static_cast<unsigned char>(text[read - 1])) == 0 ? read - 1 : read;
}

std::size_t beginning_of_token(std::string_view text, std::size_t end) {
  if (end == 0) return 0;
  std::size_t at = end - 1;
  if (text[at] == '"') {
    // No quote within a text stands without a backslash, and none that begins one behind a backslash.
    while (at > 0 && (text[--at] != '"' || (at > 0 && text[at - 1] == '\\'))) continue;
  } else if (is_word(text[at])) {
    while (at > 0 && is_word(text[at - 1])) --at;
  }
  return at;
}

std::vector<JsonPlace> places_of(std::string_view text, const std::vector<std::string>& pointers) {
  Finder::Wanted wanted;
  for (std::string_view pointer : pointers)
    for (; !pointer.empty(); pointer = around(pointer)) wanted.try_emplace(std::string(pointer));
  std::size_t read = 0;
  Finder finder(text, wanted, read);
  static_cast<void>(json::sax_parse(ReadSoFar(text.data(), &read), ReadSoFar(text.data() + text.size(), nullptr),
                                    &finder, json::input_format_t::json, true, true));
  std::map<std::size_t, JsonPlace> places;
  for (const auto& [pointer, byte] : wanted)
    if (byte) places[*byte];
  Counter counter(text);
  for (auto& [byte, place] : places) place = counter.to(byte);

  std::vector<JsonPlace> out;
  for (std::string_view pointer : pointers) {
    JsonPlace& place = out.emplace_back();
    for (; !pointer.empty() && place.line == 0; pointer = around(pointer))
      if (const auto& byte = wanted.find(pointer)->second) place = places[*byte];
  }
  return out;
}

}  // namespace axisgate::profile
