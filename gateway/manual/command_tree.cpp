// SPDX-License-Identifier: Apache-2.0
#include "gateway/manual/command_tree.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

namespace axisgate::manual {
namespace {

bool accepted(CLI::Option& option, const std::string& word) {
  try {
    for (int i = 0;; ++i) {
      std::string value = word;
      const auto& validator = *option.get_validator(i);
      if (!validator(value).empty()) return false;
    }
  } catch (const CLI::OptionNotFound&) {
    return true;  // that was the last one
  }
}

/// The values of an option that takes few words. CLI11 does not tell them; they are those words of its description that
/// it accepts.
std::vector<std::string> accepted_words(CLI::Option& option) {
  std::vector<std::string> words;
  if (accepted(option, "no such word")) return words;
  std::string word;
  for (const char c : option.get_description() + " ") {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0 || (c == '-' && !word.empty())) {
      word += c;
      continue;
    }
    if (!word.empty() && accepted(option, word) && std::ranges::find(words, word) == words.end()) words.push_back(word);
    word.clear();
  }
  return words;
}

Takes taken(const std::string& value) {
  if (value.empty()) return Takes::nothing;
  if (value == "DIR") return Takes::folder;
  for (const char* const file : {"FILE", "CONFIG", "DEVICE", "PATH"})
    if (value == file) return Takes::file;
  return Takes::text;
}

/// CLI11 puts two types of one value beside each other, "D:UINT in [0 - 232]": the first is for people.
std::string value_name(const CLI::Option& option) {
  std::string name = option.get_type_name();
  const auto bounds = name.find(" in [");
  const auto colon = name.find(':');
  if (bounds != std::string::npos && colon < bounds) name.erase(colon, bounds - colon);
  return name.empty() ? "VALUE" : name;
}

Option described(CLI::Option& from) {
  Option out;
  const bool placed = from.get_positional();
  if (placed) {
    out.names.push_back(from.get_name(true));
    out.value = out.names.front();
  } else {
    for (const std::string& name : from.get_snames()) out.names.push_back("-" + name);
    for (const std::string& name : from.get_lnames()) out.names.push_back("--" + name);
    if (from.get_items_expected_max() > 0) out.value = value_name(from);
  }
  out.takes = taken(out.value);
  if (out.takes == Takes::text) out.words = accepted_words(from);
  out.initial = from.get_default_str();
  out.what = from.get_description();
  out.required = from.get_required();
  out.repeated = from.get_items_expected_max() > 1;
  return out;
}

}  // namespace

Command command_tree(CLI::App& app) {
  Command out{app.get_name(), app.get_description(), app.get_footer(), {}, {}, {}};
  for (CLI::Option* const option : app.get_options([](CLI::Option* one) { return !one->get_group().empty(); }))
    (option->get_positional() ? out.arguments : out.options).push_back(described(*option));
  for (CLI::App* const command : app.get_subcommands([](CLI::App* one) { return !one->get_group().empty(); }))
    out.commands.push_back(command_tree(*command));
  return out;
}

}  // namespace axisgate::manual
