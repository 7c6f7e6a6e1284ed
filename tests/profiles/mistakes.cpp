// SPDX-License-Identifier: Apache-2.0
#include "tests/profiles/mistakes.hpp"

#include <unistd.h>

#include <cctype>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

namespace axisgate::test {
namespace {

using nlohmann::json;

/// A line of the table, with those that continue it.
struct Line {
  std::size_t number = 0;
  std::string text;
};

bool take(std::string& text, std::string_view beginning) {
  if (!text.starts_with(beginning)) return false;
  text.erase(0, beginning.size());
  return true;
}

std::vector<Line> lines_of(std::string_view table) {
  std::vector<Line> out;
  std::istringstream in{std::string(table)};
  std::string text;
  for (std::size_t number = 1; std::getline(in, text); ++number) {
    if (text.empty() || text.starts_with('#')) continue;
    if (take(text, "    ") && !out.empty()) {
      out.back().text += " " + text;
    } else {
      out.push_back({number, text});
    }
  }
  return out;
}

std::string cut_word(std::string& text) {
  const std::size_t space = text.find(' ');
  std::string word = text.substr(0, space);
  text.erase(0, space == std::string::npos ? space : space + 1);
  return word;
}

json parsed(const std::string& text) { return json::parse(text, nullptr, true, true); }

/// `file` without what follows the only place of `old`, or with `replacement` in that place.
std::string with_text(const std::string& file, const std::string& old, const std::string* replacement) {
  const std::size_t at = file.find(old);
  if (at == std::string::npos || file.find(old, at + 1) != std::string::npos)
    throw std::runtime_error("is not in the base exactly once: " + old);
  if (replacement == nullptr) return file.substr(0, at + old.size());
  return file.substr(0, at) + *replacement + file.substr(at + old.size());
}

/// One change: "replace /objects/mode/type 16".
std::string changed(const std::string& file, std::string change) {
  const std::string verb = cut_word(change);
  if (verb == "end-after") return with_text(file, change, nullptr);
  if (verb == "text") {
    const std::size_t arrow = change.find(" => ");
    if (arrow == std::string::npos) throw std::runtime_error("needs \" => \"");
    const std::string replacement = change.substr(arrow + 4);
    return with_text(file, change.substr(0, arrow), &replacement);
  }
  const json before = parsed(file);
  json after;
  if (verb == "become") {
    after = parsed(change);
  } else {
    const std::string path = cut_word(change);
    json operation{{"op", verb}, {"path", path}};
    if (verb == "move") {
      operation["from"] = path;
      operation["path"] = change;
    } else if (verb != "remove") {
      operation["value"] = parsed(change);
    }
    after = before.patch(json::array({operation}));
  }
  if (after == before) throw std::runtime_error("changes nothing");
  return after.dump(2);
}

class Reader {
 public:
  explicit Reader(std::filesystem::path bases) : bases_(std::move(bases)) {}

  void read(Line line) {
    if (take(line.text, "base ")) {
      const std::filesystem::path file = bases_ / (line.text + ".json");
      base_ = file.stem().string();
      right_ = content(file);
      if (right_.empty()) throw std::runtime_error("there is no such base");
    } else if (take(line.text, "  > ")) {
      last().words += line.text + "\n";
    } else if (take(line.text, "  ")) {
      if (!last().words.empty()) throw std::runtime_error("changes come before the words");
      last().file = changed(last().file, line.text);
    } else {
      end_case();
      const std::size_t colon = line.text.find(": ");
      if (colon == std::string::npos) throw std::runtime_error("is neither a base nor a case");
      if (!names_.insert(line.text.substr(0, colon)).second) throw std::runtime_error("is a name that was used");
      out_.push_back({line.text.substr(0, colon), base_, right_, changed(right_, line.text.substr(colon + 2)), ""});
    }
  }

  std::vector<Mistake> end() {
    end_case();
    return std::move(out_);
  }

 private:
  Mistake& last() {
    if (out_.empty()) throw std::runtime_error("belongs to no case");
    return out_.back();
  }
  void end_case() {
    if (out_.empty()) return;
    if (out_.back().words.empty()) throw std::runtime_error("no words for " + out_.back().name);
    const auto [same, is_new] = files_.emplace(out_.back().file, out_.back().name);
    if (!is_new) throw std::runtime_error(out_.back().name + " is the same file as " + same->second);
  }

  std::filesystem::path bases_;
  std::string base_;
  std::string right_;
  std::vector<Mistake> out_;
  std::set<std::string> names_;
  std::map<std::string, std::string> files_;  ///< wrong files -> whose they are
};

}  // namespace

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name << " in " << mistake.base; }

std::vector<Mistake> mistakes(std::string_view table, const std::filesystem::path& bases) {
  Reader reader(bases);
  Line at;
  try {
    for (const Line& line : lines_of(table)) reader.read(at = line);
    return reader.end();
  } catch (const std::exception& error) {
    throw std::runtime_error("line " + std::to_string(at.number) + ": " + at.text + ": " + error.what());
  }
}

const std::vector<Mistake>& mistakes_of(const std::filesystem::path& folder) {
  static std::map<std::filesystem::path, std::vector<Mistake>> known;
  std::vector<Mistake>& out = known[folder];
  if (out.empty()) out = mistakes(content(folder / "mistakes.txt"), folder / "valid");
  return out;
}

std::vector<Mistake> bases_of(const std::filesystem::path& folder) {
  std::vector<Mistake> out;
  for (const Mistake& mistake : mistakes_of(folder)) {
    if (!out.empty() && out.back().base == mistake.base) continue;
    // Written as the changed ones are.
    out.push_back({mistake.base, mistake.base, mistake.right, parsed(mistake.right).dump(2), ""});
  }
  return out;
}

std::string as_test_name(const std::string& name) {
  std::string out = name;
  for (char& c : out)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return out;
}

OwnFolder::OwnFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "axisgate-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder " + name);
  path_ = name;
}

OwnFolder::~OwnFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path OwnFolder::write(const std::string& name, const std::string& content) const {
  std::ofstream(path_ / name) << content;
  return path_ / name;
}

std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace axisgate::test
