// SPDX-License-Identifier: Apache-2.0
// A table of mistakes (mistakes.txt): what is changed in a right file, and the words that this must cause.
// Promises that each line was understood and each change changed something; a table that is wrong throws, with its
// line. Never judges a file: that is up to the test.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::test {

struct Mistake {
  std::string name;
  std::string base;   ///< the right file's name, without ".json"
  std::string right;  ///< its content
  std::string file;   ///< the wrong file's content
  std::string words;  ///< a line for each fault: "/pointer: message"
};
/// gtest shows the name instead of bytes.
void PrintTo(const Mistake& mistake, std::ostream* out);

/// The cases of `table`, whose bases are in the folder `bases`.
[[nodiscard]] std::vector<Mistake> mistakes(std::string_view table, const std::filesystem::path& bases);
/// Those of FOLDER/mistakes.txt, with the bases in FOLDER/valid, read once.
[[nodiscard]] const std::vector<Mistake>& mistakes_of(const std::filesystem::path& folder);
/// The right files that are changed, each once: no base may have a mistake of its own. Their words are empty.
[[nodiscard]] std::vector<Mistake> bases_of(const std::filesystem::path& folder);

/// "axis-name-twice" -> "axis_name_twice", as gtest wants names.
[[nodiscard]] std::string as_test_name(const std::string& name);

/// A folder of this object alone, removed with it.
class OwnFolder {
 public:
  OwnFolder();
  ~OwnFolder();
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// The path of a new file of this content.
  std::filesystem::path write(const std::string& name, const std::string& content) const;

 private:
  std::filesystem::path path_;
};

[[nodiscard]] std::string content(const std::filesystem::path& file);

}  // namespace axisgate::test
