// SPDX-License-Identifier: Apache-2.0
#include "gateway/manual/configuration_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "gateway/manual/roff.hpp"

namespace axisgate::manual {
namespace {

using nlohmann::ordered_json;

/// What numbers count, where a key's name ends in it.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kUnits{
    {{"_ms", "ms"}, {"_s", "s"}, {"_mb", "MiB"}}};

std::string unit_of(const std::string& key, const ordered_json& said) {
  if (said.contains("unit")) return said["unit"];
  for (const auto& [ending, unit] : kUnits)
    if (key.ends_with(ending)) return std::string(unit);
  return "";
}

std::string range_text(const std::string& kind, const std::string& unit, const ordered_json& said) {
  std::string out = kind;
  if (said.contains("exclusiveMinimum")) out += " above " + said["exclusiveMinimum"].dump();
  if (said.contains("minimum")) out += " " + said["minimum"].dump();
  if (said.contains("maximum")) out += " to " + said["maximum"].dump();
  return unit.empty() ? out : out + ", " + unit;
}

/// As people write it: with a blank behind each comma and colon that stands in no text.
std::string spaced(const ordered_json& value) {
  std::string out;
  bool in_text = false;
  for (const char c : value.dump()) {
    out += c;
    if (c == '"') in_text = !in_text;
    if (!in_text && (c == ',' || c == ':')) out += ' ';
  }
  return out;
}

/// What may stand there, in words.
std::string kinds(const std::string& key, const ordered_json& said) {
  std::vector<std::string> out;
  if (said.contains("enum")) {
    std::vector<std::string> words;
    for (const ordered_json& word : said["enum"]) words.push_back(word.dump());
    out.push_back(fmt::format("{}", fmt::join(words, ", ")));
  }
  const ordered_json types = !said.contains("type")     ? ordered_json::array()
                             : said["type"].is_string() ? ordered_json::array({said["type"]})
                                                        : said["type"];
  for (const std::string type : types) {
    if (type == "integer") out.push_back(range_text("a whole number", unit_of(key, said), said));
    if (type == "number") out.push_back(range_text("a number", unit_of(key, said), said));
    if (type == "string" && !said.contains("enum")) out.push_back(said.value("expects", "a text"));
    if (type == "boolean") out.emplace_back("true or false");
    if (type == "array") out.emplace_back("a list");
    if (type == "object") out.emplace_back("an object");
    if (type == "null") out.emplace_back("null");
  }
  return fmt::format("{}", fmt::join(out, ", or "));
}

class Writer {
 public:
  explicit Writer(const ordered_json& schema) : schema_(schema) {}

  /// And, behind it, all that is in it.
  void object(const std::string& path, const ordered_json& said) {
    out += ".SS \"" + plain(path.empty() ? "The file" : path) + "\"\n";
    for (const auto& [key, value] : said["properties"].items())
      if (!key.starts_with('$')) entry(key, resolved(value), is_required(said, key));
    for (const auto& [key, value] : said["properties"].items()) below(path.empty() ? key : path + "." + key, value);
  }

  std::string out;

 private:
  [[nodiscard]] static bool is_required(const ordered_json& said, const std::string& key) {
    const auto is_it = [&](const ordered_json& name) { return name == key; };
    return said.contains("required") && std::ranges::any_of(said["required"], is_it);
  }

  /// What stands beside a reference counts first.
  [[nodiscard]] ordered_json resolved(const ordered_json& said) const {
    if (!said.contains("$ref")) return said;
    const std::string name = said["$ref"];
    ordered_json whole = schema_["definitions"][name.substr(name.rfind('/') + 1)];
    whole.update(said);
    return whole;
  }

  void below(const std::string& path, const ordered_json& value) {
    const ordered_json said = resolved(value);
    if (said.contains("properties")) object(path, said);
    if (said.contains("items")) below(path + "[]", said["items"]);
  }

  void entry(const std::string& key, const ordered_json& said, bool required) {
    out += ".TP\n" + bold(key) + " (" + plain(kinds(key, said)) + ")\n";
    out += plain(said.value("description", "")) + "\n";
    if (required)
      out += "Required.\n";
    else if (said.contains("default") && said.value("description", "").find("Default: ") == std::string::npos)
      out += "Default: " + plain(said["default"].dump()) + ".\n";
    else if (said.contains("otherwise"))
      out += "Without it: " + plain(said["otherwise"]) + ".\n";
    if (said.contains("examples"))
      out += ".br\nExample: " + bold(fmt::format("\"{}\": {}", key, spaced(said["examples"][0]))) + "\n";
  }

  const ordered_json& schema_;
};

}  // namespace

std::string configuration_page(std::string_view schema, const std::string& version) {
  const ordered_json said = ordered_json::parse(schema);
  Writer keys(said);
  keys.object("", said);
  return ".\\\" Made from the schema of a configuration.\n.TH GATEWAY.JSON 5 \"\" \"axisgate " + version +
         "\" \"axisgate\"\n.nh\n.ad l\n.SH NAME\ngateway.json \\- configuration of the gateway axisgate\n"
         ".SH SYNOPSIS\n.I /etc/axisgate/gateway.json\n.SH DESCRIPTION\n" +
         plain(said.value("description", "")) +
         "\nComments (// and /* */) are allowed. A key that is not known is a mistake, and so is a key given twice.\n"
         ".PP\nThe service axisgate.service reads this file. No package writes it: begin with a copy of the example, "
         "and let\n.B axisgate check\nsay what is wrong with it and what to expect of it.\n.SH KEYS\n" +
         keys.out +
         ".SH FILES\n.TP\n.I /usr/share/doc/axisgate/docs/configuration.md\nThe same as tables, with limits, units and "
         "gears of an example.\n.TP\n.I /usr/share/doc/axisgate/examples/gateway.json\nAn example with a bus of each "
         "kind.\n.TP\n.I /usr/share/axisgate/schemas/gateway.schema.json\nThe schema, for editors that know JSON "
         "Schema "
         "as well.\n.TP\n.I /usr/share/axisgate/schemas/drives/\nThe drive profiles.\n.SH SEE "
         "ALSO\n\\fBaxisgate\\fR(1)\n";
}

}  // namespace axisgate::manual
