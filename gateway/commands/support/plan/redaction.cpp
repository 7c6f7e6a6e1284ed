// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/support/plan/redaction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>

#include "gateway/config/config_schema.hpp"
#include "gateway/profile/json/json_schema.hpp"

namespace axisgate::commands::support {
namespace {

using nlohmann::json;

/// Keys of a configuration whose values stay at the plant. All others are numbers, words of a choice, names of axes and
/// buses, devices and network addresses; a test goes through the schema for keys that nobody has decided about.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kPrivate = {
    {{"hosts", "a name of the plant's network"},
     {"qos_file", "a file of DDS, which may name keys and their passwords"},
     {"certificate", "a certificate of DDS-Security"}}};
constexpr std::string_view kUnknown = "no key of a configuration";
/// A text of fewer characters is no secret, and taking it out everywhere would leave nothing to read.
constexpr std::size_t kShortest = 3;

std::string_view private_reason(std::string_view key) {
  const auto* const found = std::ranges::find(kPrivate, key, [](const auto& row) { return row.first; });
  return found == kPrivate.end() ? std::string_view() : found->second;
}

/// "27.5", "10000/60": what a constant is, whose key may be any.
bool is_number_text(const std::string& text) { return text.find_first_not_of("0123456789.+-/eE") == std::string::npos; }

class Walk {
 public:
  explicit Walk(Redaction& out) : out_(out), schema_(json::parse(config::gateway_schema_text())) {}
  void run(json& document) { visit(document, &schema_, "", {}); }

 private:
  /// `schema`: null where the schema has no such place. `reason`: why what is below stays here; empty: it may go.
  void visit(json& value, const json* schema, const std::string& pointer, std::string_view reason) {
    if (schema == nullptr && reason.empty()) reason = kUnknown;
    if (!reason.empty()) return leave_out(value, pointer, reason);
    schema = resolved(schema);
    if (value.is_object()) {
      for (auto& [key, below] : value.items())
        visit(below, of_key(*schema, key), profile::pointer_to(pointer, key), private_reason(key));
    } else if (value.is_array()) {
      const json* const items = schema->contains("items") ? &schema->at("items") : nullptr;
      for (std::size_t i = 0; i < value.size(); ++i) visit(value[i], items, profile::pointer_to(pointer, i), {});
    } else if (pointer.empty() || (value.is_string() && !may_be_text(*schema, value.get_ref<const std::string&>()))) {
      leave_out(value, pointer, kUnknown);
    }
  }
  /// Of a key that may be called anything only numbers are known to be no secret; and where the schema has an object or
  /// a list, nobody knows what a text was meant to be.
  [[nodiscard]] static bool may_be_text(const json& schema, const std::string& text) {
    return schema.empty() ? is_number_text(text) : !schema.contains("properties") && !schema.contains("items");
  }
  [[nodiscard]] const json* resolved(const json* schema) const {
    const auto reference = schema->find("$ref");
    return reference == schema->end() ? schema
                                      : &schema_.at(json::json_pointer(reference->get<std::string>().substr(1)));
  }
  /// Of keys that may be called anything the empty schema.
  [[nodiscard]] static const json* of_key(const json& schema, const std::string& key) {
    static const json kAnything = json::object();
    if (const auto all = schema.find("properties"); all != schema.end() && all->contains(key)) return &all->at(key);
    const auto others = schema.find("additionalProperties");
    return others != schema.end() && others->is_object() ? &kAnything : nullptr;
  }

  void leave_out(json& value, const std::string& pointer, std::string_view reason) {
    gather(value);
    value = kLeftOut;
    ++count_;
    if (count_ <= kMostNamed)
      out_.left_out.push_back(fmt::format("{}: {}", pointer, reason));
    else
      out_.left_out.back() = fmt::format("and {} more", count_ - kMostNamed + 1);
  }
  void gather(const json& value) {
    if (value.is_structured()) {
      for (const json& below : value) gather(below);
    } else if (value.is_string() && value.get_ref<const std::string&>().size() >= kShortest) {
      out_.words.push_back(value.get<std::string>());
      // As it stands in the page's answers.
      const std::string quoted = value.dump();
      if (const std::string escaped = quoted.substr(1, quoted.size() - 2); escaped != out_.words.back())
        out_.words.push_back(escaped);
    }
  }

  Redaction& out_;
  const json schema_;
  std::size_t count_ = 0;
};

bool continues_a_word(char c) { return (std::isalnum(static_cast<unsigned char>(c)) != 0) || c == '_' || c == '-'; }

std::string without(std::string_view word, const std::string& text) {
  std::string out;
  std::size_t from = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at)) {
    const std::size_t end = at + word.size();
    const bool is_part = (at > 0 && continues_a_word(text[at - 1]) && continues_a_word(word.front())) ||
                         (end < text.size() && continues_a_word(text[end]) && continues_a_word(word.back()));
    if (is_part) {
      ++at;
      continue;
    }
    out += text.substr(from, at - from);
    out += kLeftOut;
    from = at = end;
  }
  return out + text.substr(from);
}

/// From `begins` to the first of `ends`, or to the end of the text: replaced.
std::string without_between(std::string_view begins, std::string_view ends, std::string_view instead,
                            const std::string& text) {
  std::string out;
  std::size_t from = 0;
  for (std::size_t at = text.find(begins); at != std::string::npos; at = text.find(begins, from)) {
    out += text.substr(from, at - from);
    out += begins;
    out += instead;
    from = std::min(text.find_first_of(ends, at + begins.size()), text.size());
  }
  return out + text.substr(from);
}

}  // namespace

Redaction redact(std::string_view configuration) {
  Redaction out;
  auto parsed = profile::parse_json(configuration);
  if (const auto* const fault = std::get_if<profile::SchemaFault>(&parsed)) {
    // Its words show some of the text: the place alone.
    out.why_none = "it is no JSON";
    if (fault->place.line > 0)
      out.why_none += fmt::format(": line {}, column {}", fault->place.line, fault->place.column);
    return out;
  }
  auto& document = std::get<json>(parsed);
  Walk(out).run(document);
  std::ranges::sort(out.words, [](const std::string& a, const std::string& b) {
    return std::pair(b.size(), std::string_view(a)) < std::pair(a.size(), std::string_view(b));
  });
  out.words.erase(std::unique(out.words.begin(), out.words.end()), out.words.end());
  out.json = document.dump(2) + "\n";
  return out;
}

std::string scrubbed(std::string text, const Redaction& redaction) {
  for (const std::string& word : redaction.words) text = without(word, text);
  text = without_between("; last read: ", "\n", kLeftOut, text);
  return without_between("/home/", "/ \t\n\"',:;)", "(user)", text);
}

}  // namespace axisgate::commands::support
