// SPDX-License-Identifier: Apache-2.0
#include "gateway/profile/json/syntax_mistake.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "gateway/profile/json/json_places.hpp"

namespace axisgate::profile {
namespace {

constexpr std::size_t kLongestShown = 40;
using Found = std::optional<SyntaxMistake>;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// `known` is of small letters.
bool is_in_any_letters(std::string_view word, std::string_view known) {
  return std::ranges::equal(word, known, {}, [](char c) { return std::tolower(static_cast<unsigned char>(c)); });
}

/// Of the keys and words that people write without quotes.
std::string_view word_at(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && (is_letter(text[end]) || is_digit(text[end]) || text[end] == '-')) ++end;
  return text.substr(at, end - at);
}

std::string place_text(std::string_view text, std::size_t at) {
  const JsonPlace place = place_at(text, at);
  return "line " + std::to_string(place.line) + ", column " + std::to_string(place.column);
}

struct Separator {
  char sign = 0;  ///< ',' or ':'; 0: there is none
  std::size_t at = 0;
};
/// The last one between two bytes between which there is nothing else but blanks and comments.
Separator separator_between(std::string_view text, std::size_t from, std::size_t to) {
  Separator out;
  for (std::size_t at = from; at < to; ++at) {
    if (text.substr(at, 2) == "//")
      at = std::min(text.find('\n', at), to);
    else if (text.substr(at, 2) == "/*")
      at = std::min(text.find("*/", at), to) + 1;
    else if (text[at] == ',' || text[at] == ':')
      out = {text[at], at};
  }
  return out;
}

/// The first line that says something is one of YAML.
Found yaml(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
    const bool empty = std::ranges::all_of(line, is_space);
    if (!empty && !line.starts_with('#')) {
      const std::size_t word = word_at(line, 0).size();
      const bool key = word > 0 && is_letter(line[0]) && line.substr(word).starts_with(':');
      if (!key && !line.starts_with("---") && !line.starts_with("- ") && !line.starts_with("%YAML")) return {};
      return SyntaxMistake{at,
                           "is YAML, and JSON is wanted: { } around keys, [ ] around lists, a comma between two of "
                           "them, keys and texts in double quotes: {\"key\": \"text\"}"};
    }
    at = end + 1;
  }
  return {};
}

struct Sign {
  std::string_view bytes;
  std::string_view words;
};
/// What stands where JSON has no such thing, by how it begins.
constexpr std::array kSigns{
    Sign{"#", "a comment begins with // or stands between /* and */: write // for #"},
    Sign{"'", "keys and texts stand in double quotes: write \" for '"},
    Sign{"`", "keys and texts stand in double quotes: write \" for `"},
    Sign{"\xE2\x80\x98", "a typographic quote, as text programs make it: write \""},
    Sign{"\xE2\x80\x99", "a typographic quote, as text programs make it: write \""},
    Sign{"\xE2\x80\x9C", "a typographic quote, as text programs make it: write \""},
    Sign{"\xE2\x80\x9D", "a typographic quote, as text programs make it: write \""},
    Sign{"\xE2\x80\x9E", "a typographic quote, as text programs make it: write \""},
    Sign{"\xC2\xA0", "looks like a space and is none (U+00A0), as copied from a web page: write a space"},
    Sign{"\xE2\x80\x8B", "a character without width (U+200B), as copied from a web page: remove it"},
    Sign{"\xEF\xBB\xBF", "a byte-order mark (U+FEFF), which only a file's beginning may have: remove it"},
    Sign{"=", "a colon stands between a key and its value: write : for ="},
    Sign{"~", "write null for ~"},
    Sign{";", "a comma stands between two entries: write , for ;"},
};

class Judge {
 public:
  Judge(std::string_view text, const Reached& reached, std::string_view what)
      : text_(text), reached_(reached), what_(what) {
    at_ = beginning_of_token(text, reached.read);
    if (says("invalid literal") && at_ + 1 == reached.read && at_ > 0 && !is_letter(sign()) && is_letter(text[at_ - 1]))
      at_ = beginning_of_token(text, at_);  // the parser noticed behind the word
    at_ = std::max(at_, reached.accepted);
    before_ = separator_between(text, reached.accepted, at_);
  }

  [[nodiscard]] SyntaxMistake mistake() const {
    for (const auto look : {&Judge::of_the_whole, &Judge::of_a_text, &Judge::of_a_sign, &Judge::of_a_comma,
                            &Judge::of_a_word, &Judge::of_a_bracket, &Judge::of_what_is_missing})
      if (Found found = (this->*look)()) return *found;
    return {at_, parsers_words(what_)};
  }

 private:
  [[nodiscard]] bool says(std::string_view words) const { return what_.find(words) != std::string_view::npos; }
  [[nodiscard]] char sign() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  /// "the { of line 3, column 5": the bracket that is open.
  [[nodiscard]] std::string open_text() const {
    const std::size_t open = reached_.open.back();
    return std::string("the ") + text_[open] + " of " + place_text(text_, open);
  }
  [[nodiscard]] char closing() const { return text_[reached_.open.back()] == '{' ? '}' : ']'; }

  [[nodiscard]] Found of_the_whole() const {
    if (says("unexpected end of input")) {
      if (reached_.open.empty()) return SyntaxMistake{text_.size(), "has no JSON in it: it begins with {"};
      return SyntaxMistake{text_.size(),
                           "the file ends, and " + open_text() + " is still open: " + closing() + " is missing"};
    }
    if (reached_.accepted == 0)
      if (Found found = yaml(text_)) return found;
    return {};
  }

  [[nodiscard]] Found of_a_text() const {
    if (says("ill-formed UTF-8"))
      return SyntaxMistake{reached_.read - 1,
                           "is no UTF-8: save the file as UTF-8 (an editor asks for the encoding "
                           "where it saves; or iconv -f LATIN1 -t UTF-8)"};
    if (says("forbidden character after backslash"))
      return SyntaxMistake{reached_.read - 2, "a backslash within a text is written twice: \\\\"};
    if (says("U+0009 (HT)")) return SyntaxMistake{reached_.read - 1, "a tab within a text is written \\t"};
    if (says("missing closing '*/'")) return SyntaxMistake{text_.rfind("/*"), "this comment has no end: add */"};
    if (says("invalid comment"))
      return SyntaxMistake{std::min(reached_.read, text_.find('/', reached_.accepted)),
                           "a comment begins with // or stands between /* and */"};
    if (!says("missing closing quote") && !says("U+000A (LF)") && !says("U+000D (CR)")) return {};
    std::size_t quote = reached_.read - 1;
    while (quote > 0 && (text_[quote] != '"' || text_[quote - 1] == '\\')) --quote;
    return SyntaxMistake{quote, "this text has no end on its line: a \" is missing"};
  }

  [[nodiscard]] Found of_a_sign() const {
    for (const Sign& each : kSigns)
      if (text_.substr(at_).starts_with(each.bytes)) return SyntaxMistake{at_, std::string(each.words)};
    return {};
  }

  [[nodiscard]] Found of_a_comma() const {
    if (before_.sign != ',') return {};
    if (sign() == '}' || sign() == ']')
      return SyntaxMistake{before_.at, std::string("nothing follows this comma but ") + sign() + ": remove the comma"};
    if (sign() == ',') return SyntaxMistake{at_, "two commas, and nothing between them: remove one"};
    const bool decimal = before_.at > 0 && is_digit(text_[before_.at - 1]) && at_ == before_.at + 1 && is_digit(sign());
    if (!decimal || !says("parsing object")) return {};
    std::size_t from = before_.at;
    while (from > 0 && is_digit(text_[from - 1])) --from;
    const std::string number(text_.substr(from, before_.at - from));
    return SyntaxMistake{from, "a number has a decimal point: write " + number + "." +
                                   std::string(word_at(text_, at_).substr(0, kLongestShown))};
  }

  [[nodiscard]] Found of_a_word() const {
    const bool after_number = before_.sign == 0 && at_ > 0 && at_ == reached_.accepted && is_digit(text_[at_ - 1]);
    if (after_number && is_digit(sign()))
      return SyntaxMistake{beginning_of_token(text_, at_), "a number has no zeros before it: remove them"};
    if (!is_letter(sign()) && sign() != '$') return {};
    const bool dollar = sign() == '$';
    const std::string word =
        (dollar ? "$" : "") + std::string(word_at(text_, at_ + (dollar ? 1 : 0)).substr(0, kLongestShown));
    if (after_number && (sign() == 'x' || sign() == 'X'))
      return SyntaxMistake{at_ - 1, "numbers are written in decimal, without 0x"};
    if (after_number && sign() == '_')
      if (Found found = of_grouped_digits()) return found;
    if (after_number)
      return SyntaxMistake{at_, "a number stands alone: write it without \"" + word + "\", in the unit of its key"};
    if (before_.sign == ':') {
      for (const std::string_view known : {"true", "false", "null"})
        if (is_in_any_letters(word, known))
          return SyntaxMistake{at_, "write " + std::string(known) + ", in small letters"};
      if (word == "None") return SyntaxMistake{at_, "write null for None"};
      if (Found found = of_a_switch(word)) return found;
    }
    if (!says("invalid literal") && !says("object key")) return {};
    return SyntaxMistake{at_, "keys and texts stand in double quotes: write \"" + word + "\""};
  }

  /// 3_000_000
  [[nodiscard]] Found of_grouped_digits() const {
    const std::size_t from = beginning_of_token(text_, at_);
    std::string number(text_.substr(from, at_ - from));
    std::size_t end = at_;
    for (; end < text_.size() && (is_digit(text_[end]) || text_[end] == '_' || text_[end] == '.'); ++end)
      if (text_[end] != '_') number += text_[end];
    if ((end < text_.size() && is_letter(text_[end])) || number.size() > kLongestShown) return {};
    return SyntaxMistake{from, "a number has no _ in it: write " + number};
  }

  /// What is a truth value in YAML. "on" and "off" are texts that some keys take.
  [[nodiscard]] Found of_a_switch(const std::string& word) const {
    struct Switch {
      std::string_view word, written;
    };
    for (const Switch& each :
         {Switch{"yes", "true"}, Switch{"no", "false"}, Switch{"on", "true"}, Switch{"off", "false"}}) {
      if (!is_in_any_letters(word, each.word)) continue;
      std::string message = "write " + std::string(each.written) + " for " + word;
      if (each.word.starts_with('o'))
        message += ", or \"" + std::string(each.word) + "\" in quotes where the key takes this word";
      return SyntaxMistake{at_, std::move(message)};
    }
    return {};
  }

  [[nodiscard]] Found of_a_bracket() const {
    if (says("expected end of input") && sign() == ':') return SyntaxMistake{0, "a { is missing before the first key"};
    if (says("expected end of input"))
      return SyntaxMistake{at_,
                           "the first bracket of the file is closed before this: remove a bracket above, or what "
                           "follows here"};
    if (reached_.open.empty() || before_.sign != 0 || sign() == closing()) return {};
    if (sign() == '}' || sign() == ']')
      return SyntaxMistake{at_, "would close " + open_text() + ": write " + closing() + " for " + sign()};
    return {};
  }

  [[nodiscard]] Found of_what_is_missing() const {
    const bool begins_something =
        sign() == '"' || sign() == '{' || sign() == '[' || sign() == '-' || is_digit(sign()) || is_letter(sign());
    if (says("parsing object separator"))
      return SyntaxMistake{reached_.accepted, "a colon is missing between a key and its value"};
    if (before_.sign == ':' && (sign() == '}' || sign() == ',' || sign() == ']'))
      return SyntaxMistake{at_, "a value is missing behind the colon"};
    if (sign() == ':' && !reached_.open.empty() && text_[reached_.open.back()] == '[')
      return SyntaxMistake{at_, "a list has no keys: put { } around key and value"};
    if (before_.sign == 0 && begins_something && reached_.accepted > 0 && !says("object key"))
      return SyntaxMistake{reached_.accepted, "a comma is missing here"};
    return {};
  }

  std::string_view text_;
  const Reached& reached_;
  std::string_view what_;
  std::size_t at_ = 0;  ///< where what could not be taken begins
  Separator before_;    ///< what stands between that and what was taken before it
};

}  // namespace

SyntaxMistake syntax_mistake(std::string_view text, const Reached& reached, std::string_view what) {
  return Judge(text, reached, what).mistake();
}

std::string parsers_words(std::string_view what) {
  for (const std::string_view before : {" - ", "] "})
    if (const std::size_t at = what.find(before); at != std::string_view::npos)
      return std::string(what.substr(at + before.size()));
  return std::string(what);
}

}  // namespace axisgate::profile
