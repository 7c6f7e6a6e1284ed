// SPDX-License-Identifier: Apache-2.0
// Each command line of axisgate that a page shows is one that its parser takes: those in blocks, indented ones too, and
// those in a sentence.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "gateway/commands/command_line.hpp"
#include "tests/places.hpp"

namespace axisgate {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> pages() {
  const fs::path root(test::source_path(""));
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(root))
    if (entry.path().extension() == ".md" && entry.path().filename() != "CHANGELOG.md") found.push_back(entry.path());
  for (const char* folder : {"docs", "deploy", "schemas"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".md") found.push_back(entry.path());
  return found;
}

/// What stands behind the name of the program, to the end of that command. `code`: a line of a block, or what stands in
/// backquotes.
std::vector<std::string> command_lines(const std::string& code) {
  static const std::regex kCall(R"((?:^|bin/|localhost/|[\s;&|])axisgate( +[^|&;>#\s][^|&;>#]*))");
  std::vector<std::string> found;
  for (auto at = std::sregex_iterator(code.begin(), code.end(), kCall); at != std::sregex_iterator(); ++at)
    found.push_back((*at)[1].str());
  return found;
}

std::vector<std::string> code_of(const std::string& page) {
  std::vector<std::string> found;
  bool fenced = false;
  bool is_shell = false;
  std::string joined;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      fenced = !fenced;
      is_shell = line == "```sh";
      continue;
    }
    if (fenced ? is_shell : line.starts_with("    ")) {
      const std::string begun = std::exchange(joined, {}) + line;
      if (begun.ends_with('\\')) {
        joined = begun.substr(0, begun.size() - 1);
      } else {
        found.push_back(begun);
      }
    }
  }
  static const std::regex kInline("`(axisgate [^`]*)`");
  const std::string one_line = std::regex_replace(page, std::regex("\n"), " ");
  for (auto at = std::sregex_iterator(one_line.begin(), one_line.end(), kInline); at != std::sregex_iterator(); ++at)
    found.push_back((*at)[1].str());
  return found;
}

/// Empty: taken.
std::string complaint(const std::string& rest) {
  std::vector<std::string> words{"axisgate"};
  std::istringstream in(rest);
  for (std::string word; in >> word;) words.push_back(word == "AXIS" ? "1" : word);
  // A command by its name alone, in a sentence: is there such a one?
  if (words.size() == 2 && !words[1].starts_with('-')) words.emplace_back("--help");
  std::vector<const char*> arguments;
  for (const std::string& word : words) arguments.push_back(word.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const commands::CommandLine line = commands::parse_command_line(static_cast<int>(arguments.size()), arguments.data());
  const std::string said = testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
  return line.run != nullptr || line.exit_code == 0 ? std::string() : said;
}

TEST(Manual, EachCommandLineInItIsOneThatTheProgramTakes) {
  int counted = 0;
  for (const fs::path& page : pages()) {
    std::ifstream file(page);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    for (const std::string& code : code_of(text)) {
      for (const std::string& rest : command_lines(code)) {
        EXPECT_EQ(complaint(rest), "") << page << ": axisgate" << rest;
        ++counted;
      }
    }
  }
  EXPECT_GT(counted, 100);
}

TEST(Manual, AWrongCommandLineWouldBeFound) {
  const auto code = code_of(
      "x `axisgate explain  stop_latched`\n    sudo axisgate top HOST --wrong # why\n```sh\naxisgate nothing | "
      "less\n```\n");
  ASSERT_EQ(code.size(), 3U);
  EXPECT_NE(complaint(command_lines(code[0]).at(0)), "");
  EXPECT_NE(complaint(command_lines(code[1]).at(0)), "");
  EXPECT_EQ(complaint(command_lines(code[2]).at(0)), "");
}

}  // namespace
}  // namespace axisgate
