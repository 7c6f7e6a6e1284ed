// SPDX-License-Identifier: Apache-2.0
// The corpus of every fuzz target, as it is and changed at random by a seed: what a fuzzer once found stays mended.
// Files *.hex hold bytes in hexadecimal, with comments behind #; all others are the input itself. A file `also` names
// folders whose files are of the corpus as well.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "gateway/core/random.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/places.hpp"

namespace axisgate::fuzz {
namespace {

namespace fs = std::filesystem;
using Row = std::vector<Byte>;

constexpr std::size_t kLongest = 8192;

/// What is being played, as text.
std::string played;
/// Leaves it in a file that may become one of the corpus.
void keep_input(const std::string& target) {
  const std::string file = test::build_path("fuzz-") + target + ".hex";
  std::ofstream(file) << "# found by the changes of a seed\n" << played << "\n";
  std::cerr << "its input: " << file << "\n";
}
std::string playing;
void tell_and_end(int) {
  keep_input(playing);
  std::signal(SIGABRT, SIG_DFL);
  std::abort();
}

Row from_hex_text(std::istream& in) {
  Row bytes;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    for (std::string word; words >> word;) bytes.push_back(static_cast<Byte>(std::stoul(word, nullptr, 16)));
  }
  return bytes;
}

std::vector<Row> corpus_of(const std::string& target) {
  const fs::path root(test::source_path(""));
  std::vector<fs::path> files, folders{root / "tests/fuzz/corpus" / target};
  std::ifstream also(folders.front() / "also");
  for (std::string folder; std::getline(also, folder);) folders.push_back(root / folder);
  for (const fs::path& folder : folders)
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.is_regular_file() && entry.path().filename() != "also") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Row> all;
  for (const fs::path& path : files) {
    std::ifstream in(path, std::ios::binary);
    all.push_back(path.extension() == ".hex"
                      ? from_hex_text(in)
                      : Row(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()));
  }
  return all;
}

/// A few changes of the kinds that a fuzzer makes.
Row changed(Row bytes, const std::vector<Row>& corpus, Random& random) {
  const auto place = [&] { return static_cast<std::ptrdiff_t>(random.below(bytes.size() + 1)); };
  for (std::uint64_t i = random.below(4) + 1; i > 0; --i) {
    const Row& other = corpus[random.below(corpus.size())];
    switch (random.below(6)) {
      case 0:
        if (!bytes.empty()) bytes[random.below(bytes.size())] ^= static_cast<Byte>(1U << random.below(8));
        break;
      case 1:
        if (!bytes.empty()) bytes[random.below(bytes.size())] = static_cast<Byte>(random.below(256));
        break;
      case 2:
        bytes.insert(bytes.begin() + place(), static_cast<Byte>(random.below(256)));
        break;
      case 3:
        if (!bytes.empty()) {
          const auto from = static_cast<std::ptrdiff_t>(random.below(bytes.size()));
          const auto count = static_cast<std::ptrdiff_t>(random.below(8)) + 1;
          bytes.erase(
              bytes.begin() + from,
              bytes.begin() + std::min<std::ptrdiff_t>(from + count, static_cast<std::ptrdiff_t>(bytes.size())));
        }
        break;
      case 4:
        bytes.resize(random.below(bytes.size() + 1));
        break;
      default:
        if (!other.empty()) {
          const auto from = static_cast<std::ptrdiff_t>(random.below(other.size()));
          bytes.insert(bytes.begin() + place(), other.begin() + from, other.end());
        }
        break;
    }
  }
  if (bytes.size() > kLongest) bytes.resize(kLongest);
  return bytes;
}

class Fuzzed : public testing::TestWithParam<Target> {};

TEST_P(Fuzzed, EndsWellWithTheCorpusAndWithChangesOfIt) {
  constexpr std::uint64_t kChanges = 600;
  std::signal(SIGABRT, tell_and_end);
  const std::vector<Row> corpus = corpus_of(GetParam().name);
  ASSERT_FALSE(corpus.empty());
  playing = GetParam().name;
  const auto play = [&](const Row& bytes) {
    played = hex_text(bytes);
    try {
      EXPECT_EQ(GetParam().run(bytes.data(), bytes.size()), 0);
    } catch (const std::exception& fault) {
      keep_input(playing);
      FAIL() << fault.what();
    }
  };
  for (const Row& bytes : corpus) play(bytes);
  Random random(1);
  for (std::uint64_t i = 0; i < kChanges && !HasFatalFailure(); ++i)
    play(changed(corpus[random.below(corpus.size())], corpus, random));
}

INSTANTIATE_TEST_SUITE_P(Each, Fuzzed, testing::ValuesIn(kTargets),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace axisgate::fuzz
