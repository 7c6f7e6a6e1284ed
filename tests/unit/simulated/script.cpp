// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/simulated/script.hpp"
#include "tests/places.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace axisgate::simulated {
namespace {

constexpr Time longest_wait = seconds(60);

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \n");
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \n") - begin + 1);
}

Time time_of(const std::string& text) {
  const std::map<std::string, Time> units{
      {"us", microseconds(1)}, {"ms", milliseconds(1)}, {"s", seconds(1)}, {"min", std::chrono::minutes(1)}};
  std::size_t used = 0;
  const long long number = std::stoll(text, &used);
  return number * units.at(text.substr(used));
}

// `""` is an empty one.
std::string cell_of(const std::string& text) { return trimmed(text) == "\"\"" ? "" : trimmed(text); }

// 6041, 60F9.19 and r3200 are objects; all else is a fact.
bool is_object(const std::string& name) {
  return std::isdigit(name[0]) != 0 || (name[0] == 'r' && name.size() > 1 && std::isdigit(name[1]) != 0);
}

class Play {
 public:
  explicit Play(Scene& scene) : scene_(scene) {}

  void steps(const std::string& script) {
    for (const std::string& part : words_of(script, "\n;")) {
      const std::string one = trimmed(part);
      if (one.empty()) continue;
      SCOPED_TRACE(one);
      step(one);
      if (testing::Test::HasFatalFailure()) return;
    }
  }

 private:
  void step(const std::string& text) {
    const Row words = words_of(text);
    const std::string rest = trimmed(text.substr(words[0].size()));
    const std::size_t is = text.find(" is ");
    if (words[0] == ">") {
      const std::size_t back = rest.find('<');
      scene_.send(trimmed(rest.substr(0, back)));
      if (back != std::string::npos) came(rest.substr(back + 1));
    } else if (words[0] == "<") {
      came(rest);
    } else if (words[0] == "pass") {
      scene_.bench.pass(time_of(words.at(1)));
    } else if (words[0] == "until") {
      wait_for(rest);
    } else if (words[0] == "keep") {
      kept_ = look(words.at(1)).value();
    } else if (words[0] == "repeat") {
      const std::string repeated = trimmed(rest.substr(words.at(1).size()));
      for (int i = std::stoi(words[1]); i > 0; --i) steps(repeated);
    } else if (is != std::string::npos) {
      EXPECT_EQ(scene_.bench.tell(words_of(text.substr(0, is))), trimmed(text.substr(is + 4)));
    } else if (words.size() >= 3 && words[1] == ":=") {
      write(words);
    } else if (words.size() == 2 && words[1] == "silent") {
      EXPECT_EQ(scene_.read(Name(words[0])), std::nullopt);
    } else if (words.size() >= 3 && std::string("=!<>~&").find(words[1][0]) != std::string::npos) {
      std::ostringstream found;
      EXPECT_TRUE(holds(words, found)) << found.str();
    } else if (const auto phrase = scene_.phrases.find(words[0]); phrase != scene_.phrases.end()) {
      steps(phrase->second);
    } else if (!scene_.act(words)) {
      EXPECT_EQ(scene_.bench.tell(words), "");
    }
  }

  void came(const std::string& wanted) const { EXPECT_EQ(without_spaces(scene_.received()), without_spaces(wanted)); }

  void write(const Row& words) {
    const auto wanted = words.size() == 5 ? static_cast<std::uint32_t>(number(words[4])) : 0U;
    const auto code = scene_.write(Name(words[0]), number(words[2]));
    if (words.size() == 4 && words[3] == "silent") {
      EXPECT_EQ(code, std::nullopt);
      return;
    }
    ASSERT_TRUE(code.has_value()) << "no answer";
    EXPECT_EQ(*code, wanted) << std::hex << *code;
  }

  void wait_for(const std::string& text) {
    const Row words = words_of(text);
    std::ostringstream found;
    for (Time waited{}; waited < longest_wait && !holds(words, found); waited += milliseconds(1)) {
      found.str("");
      scene_.bench.pass(milliseconds(1));
    }
    ASSERT_TRUE(holds(words, found)) << found.str();
  }

  // NAME [& MASK] COMPARED VALUE [TOLERANCE]
  bool holds(const Row& words, std::ostream& found) {
    const auto read = look(words[0]);
    if (!read) {
      found << "no answer";
      return false;
    }
    const bool masked = words[1] == "&";
    const std::int64_t left = masked ? *read & number(words.at(2)) : *read;
    const std::string& compared = words.at(masked ? 3 : 1);
    const std::int64_t right = number(words.at(masked ? 4 : 2));
    found << words[0] << " is " << *read << std::hex << " 0x" << *read;
    if (compared == "=") return left == right;
    if (compared == "!=") return left != right;
    if (compared == "<") return left < right;
    if (compared == ">") return left > right;
    return std::abs(left - right) <= number(words.at(3));
  }

  std::optional<std::int64_t> look(const std::string& name) {
    return is_object(name) ? scene_.read(Name(name)) : scene_.fact(name);
  }

  std::int64_t number(const std::string& text) const {
    if (text == "kept") return kept_;
    std::size_t used = 0;
    const std::int64_t found = std::stoll(text, &used, 0);
    return text.substr(used) == "rpm" ? speed_dec(found, scene_.bench.kinco()->model().encoder_counts) : found;
  }

  Scene& scene_;
  std::int64_t kept_ = 0;
};

}  // namespace

Row words_of(const std::string& text, const char* parted_by) {
  Row words;
  for (std::size_t at = text.find_first_not_of(parted_by); at != std::string::npos;) {
    const std::size_t end = text.find_first_of(parted_by, at);
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(parted_by, end);
  }
  return words;
}

Name::Name(const std::string& text) {
  const std::size_t at = text.find('@');
  if (at != std::string::npos) station = static_cast<std::uint8_t>(std::stoi(text.substr(at + 1)));
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) width = std::stoul(text.substr(colon + 1));
  word = text.substr(0, std::min(at, colon));
}

ObjectKey Name::key() const {
  const std::size_t point = word.find('.');
  const int sub = point == std::string::npos ? 0 : std::stoi(word.substr(point + 1), nullptr, 16);
  return {static_cast<std::uint16_t>(std::stoi(word, nullptr, 16)), static_cast<std::uint8_t>(sub)};
}

std::vector<Script> all_scripts() {
  std::vector<Script> scripts;
  for (const char* file : {"kinco", "rtu", "id286pro", "keya", "leadshine", "eds", "canopen", "adapters", "faults"}) {
    std::ifstream input(test::source_path("tests/unit/simulated/scripts/") + file + ".txt");
    if (!input) throw std::runtime_error(std::string("no scripts of ") + file);
    for (std::string line; std::getline(input, line);) {
      const std::string text = trimmed(line);
      if (text.empty() || text[0] == '#') continue;
      if (line[0] != ' ') {
        const std::size_t end = text.find(": ");
        const Row words = words_of(text.substr(0, end));
        const std::string name = std::string(file) + "_" + words[0];
        scripts.push_back({name, {words.begin() + 1, words.end()}, end == text.npos ? "" : text.substr(end + 1)});
      } else if (text.starts_with("for ")) {
        for (const std::string& row : words_of(text.substr(4), "/")) {
          scripts.back().rows.emplace_back();
          for (const std::string& cell : words_of(row, ",")) scripts.back().rows.back().push_back(cell_of(cell));
        }
      } else {
        scripts.back().steps += text + '\n';
      }
    }
  }
  return scripts;
}

void play(Scene& scene, const std::string& steps) { Play(scene).steps(steps); }

}  // namespace axisgate::simulated
