#include "tests/unit/simulated/scene.hpp"

#include <algorithm>
#include <sstream>

namespace axisgate::simulated {
namespace {

constexpr Time longest_wait = std::chrono::seconds(60);

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \n");
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \n") - begin + 1);
}

Time time_of(const std::string& text) {
  const std::map<std::string, Time> units{{"us", std::chrono::microseconds(1)},
                                          {"ms", std::chrono::milliseconds(1)},
                                          {"s", std::chrono::seconds(1)},
                                          {"min", std::chrono::minutes(1)}};
  std::size_t used = 0;
  const long long number = std::stoll(text, &used);
  return number * units.at(text.substr(used));
}

class Run {
 public:
  explicit Run(Scene& scene) : scene_(scene) {}

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
    if (words[0] == ">") {
      const std::size_t back = rest.find('<');
      scene_.send(trimmed(rest.substr(0, back)));
      if (back != std::string::npos) came(rest.substr(back + 1));
    } else if (words[0] == "<") {
      came(rest);
    } else if (words[0] == "pass") {
      scene_.pass(time_of(words.at(1)));
    } else if (words[0] == "until") {
      wait_for(rest);
    } else if (words[0] == "keep") {
      kept_ = value(words.at(1));
    } else if (words[0] == "repeat") {
      const std::string repeated = trimmed(rest.substr(words.at(1).size()));
      for (int i = std::stoi(words[1]); i > 0; --i) steps(repeated);
    } else if (words.size() >= 3 && words[1] == ":=") {
      write(words);
    } else if (words.size() == 2 && words[1] == "silent") {
      EXPECT_EQ(scene_.read(words[0]), std::nullopt);
    } else if (words.size() >= 3 && std::string("=!<>~&").find(words[1][0]) != std::string::npos) {
      std::ostringstream found;
      EXPECT_TRUE(holds(words, found)) << found.str();
    } else if (const auto phrase = scene_.phrases.find(words[0]); phrase != scene_.phrases.end()) {
      steps(phrase->second);
    } else {
      ASSERT_TRUE(scene_.acts.contains(words[0])) << "no such word";
      scene_.acts.at(words[0])({words.begin() + 1, words.end()});
    }
  }

  void came(const std::string& wanted) const { EXPECT_EQ(without_spaces(scene_.received()), without_spaces(wanted)); }

  void write(const Row& words) {
    const auto wanted = words.size() == 5 ? static_cast<std::uint32_t>(number(words[4])) : 0U;
    const auto code = scene_.write(words[0], number(words[2]));
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
      scene_.pass(milliseconds(1));
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
    const auto fact = scene_.facts.find(name);
    return fact == scene_.facts.end() ? scene_.read(name) : fact->second();
  }

  std::int64_t value(const std::string& name) {
    const auto read = look(name);
    EXPECT_TRUE(read.has_value()) << name << " has no value";
    return read.value_or(0);
  }

  std::int64_t number(const std::string& text) const {
    if (text == "kept") return kept_;
    std::size_t used = 0;
    const std::int64_t found = std::stoll(text, &used, 0);
    return text.substr(used) == "rpm" ? scene_.rpm(found) : found;
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

void run(Scene& scene, const std::string& script) { Run(scene).steps(script); }

TEST_P(Scripts, comes_true) {
  for (const Maker& make : GetParam().makers) {
    for (const Row& row : GetParam().rows) {
      std::string script = GetParam().script;
      for (std::size_t i = row.size(); i > 0; --i) {
        const std::string mark = "$" + std::to_string(i);
        for (std::size_t at = script.find(mark); at != std::string::npos; at = script.find(mark)) {
          script.replace(at, mark.size(), row[i - 1]);
        }
      }
      SCOPED_TRACE(script);
      Scene scene = make(row);
      run(scene, script);
    }
  }
}

}  // namespace axisgate::simulated
