// SPDX-License-Identifier: Apache-2.0
// Where in a JSON text something stands: line and column, by JSON pointer. Pure.
// Promises one pass over the text for all pointers, and a place for each: of a key its name's, of a list's entry its
// own, and of what is not there that of the nearest thing around it. Never judges a text: parse_json() has done so.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::profile {

struct JsonPlace {
  std::size_t line = 0;    ///< from 1; 0: no place is known
  std::size_t column = 0;  ///< from 1, in characters: a tab is one, and what UTF-8 writes in several bytes is one
  friend bool operator==(const JsonPlace&, const JsonPlace&) = default;
};

/// Of a byte, counted from 0; at most the text's end.
[[nodiscard]] JsonPlace place_at(std::string_view text, std::size_t byte);

/// In the order of `pointers` (RFC 6901). Of the whole document, and of what has nothing but that around it: no place.
[[nodiscard]] std::vector<JsonPlace> places_of(std::string_view text, const std::vector<std::string>& pointers);

/// The first byte of the text, key, number, word or bracket that was read as far as `end`.
[[nodiscard]] std::size_t beginning_of_token(std::string_view text, std::size_t end);

/// Where that ends: of a number the parser has read one character more, if there is one.
[[nodiscard]] std::size_t end_of_token(std::string_view text, std::size_t read, bool number);

/// What the parser reads, and how far it has: it calls its handler right behind what it tells of, and does not say
/// where that is.
class ReadSoFar {
 public:
  using iterator_category = std::forward_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  /// `read`: how many bytes before `at` were taken.
  ReadSoFar(const char* at, std::size_t* read) : at_(at), read_(read) {}
  const char& operator*() const { return *at_; }
  ReadSoFar& operator++() {
    ++at_;
    ++*read_;
    return *this;
  }
  friend bool operator==(const ReadSoFar& a, const ReadSoFar& b) { return a.at_ == b.at_; }

 private:
  const char* at_;
  std::size_t* read_;
};

}  // namespace axisgate::profile
