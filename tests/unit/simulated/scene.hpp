// Scripts for simulated drives: what is done to them and what is then true, step by step, in manual time. One step a
// line, or several with ';' between them:
//   6083 := 50000                  writes; the drive takes it. "6060 := 2 -> 0x06090030": it refuses it with this code
//   6041 & 0x6F = 0x27             reads and compares: = != < > and "606C ~ 200 5", within 5; "6041 silent": no answer
//   pass 20ms                      time goes on; "until 6041 & 0x400 = 0x400": as long as it takes, at most 60 s
//   > 01 40 41 60 < 01 4B          sends, and this comes back at once; "<" alone: nothing; "<" on its own line: until
//   now keep 6063                      remembers a value, which is then called kept repeat 3 pass 1s               the
//   rest of the step so often
// All other steps are words of the scene. $1, $2, ... stand for the words of the row that is run.
#pragma once

#include <gmock/gmock.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

using Bytes = std::vector<std::uint8_t>;
using Row = std::vector<std::string>;
using std::chrono::milliseconds;

inline std::string without_spaces(std::string text) {
  std::erase(text, ' ');
  return text;
}

inline Bytes from_hex(std::string_view text) {
  const std::string digits = without_spaces(std::string(text));
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

inline std::string to_hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += {"0123456789ABCDEF"[byte >> 4], "0123456789ABCDEF"[byte & 15]};
  return text;
}

Row words_of(const std::string& text, const char* parted_by = " ");

struct Scene {
  // By the drive's own protocol. Nothing: refused, or silent. Facts come first.
  std::function<std::optional<std::int64_t>(const std::string& name)> read;
  std::function<std::optional<std::uint32_t>(const std::string& name, std::int64_t value)> write;
  std::function<void(const std::string& frame)> send;
  std::function<std::string()> received;  // since the last send() or "listen"
  std::function<void(Time)> pass;
  std::function<std::int64_t(std::int64_t)> rpm = [](std::int64_t number) { return number; };  // "300rpm" as a value
  std::map<std::string, std::function<std::int64_t()>> facts{};  // what only the world can see
  std::map<std::string, std::function<void(const Row& arguments)>> acts{};
  std::map<std::string, std::string> phrases{};  // words that stand for several steps
};

using Maker = std::function<Scene(const Row&)>;

struct Case {
  const char* name;
  std::vector<Maker> makers;  // each runs the script
  const char* script;
  std::vector<Row> rows = {{}};  // and each row
};

void run(Scene& scene, const std::string& script);

class Scripts : public testing::TestWithParam<Case> {};

inline std::string name_of_case(const testing::TestParamInfo<Case>& info) { return info.param.name; }

// gtest prints a failing case by its name.
inline void PrintTo(const Case& it, std::ostream* out) { *out << it.name; }

}  // namespace axisgate::simulated
