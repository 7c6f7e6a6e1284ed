// SPDX-License-Identifier: Apache-2.0
// Scripts for simulated drives (scripts/*.txt): what is done to them and what is then true, in manual time. A name at
// the margin begins a script; behind it stand the lines it plays on, as `--line` has them. The steps, behind a colon or
// below, one a line or with ';' between them, are played on each:
//   6083 := 50000         writes, and the drive takes it; "6060 := 2 -> 0x06090030": refuses it with this code
//   6041 & 0x6F = 0x27    reads and compares: = != < > and "606C ~ 200 5", within 5; "6041 silent": no answer
//   pass 20ms             time goes on; "until 6041 & 0x400 = 0x400": as long as it takes, at most 60 s
//   > 01 40 < 01 4B       sends, and this comes back at once; "<" alone: nothing; "<" on its own line: until now
//   keep 6063             remembers a value, which is then called kept
//   repeat 3 pass 1s      the rest of the step so often
//   state is booting      a word of axisgate-sim's control socket, without the drive, and its answer; a number of
//                         such an answer can be compared like an object
// Other steps are words of the scene. "for 1, 2 / 3, 4" plays the script once for each row between '/', with $1 and $2
// standing for its parts. Promises to name the step that fails. Never knows a drive.
#pragma once

#include <map>

#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {

using Row = std::vector<std::string>;

Row words_of(const std::string& text, const char* parted_by = " ");
inline std::string without_spaces(std::string text) {
  std::erase(text, ' ');
  return text;
}
inline std::int64_t whole(const std::string& text) { return std::stoll(text, nullptr, 0); }

struct Script {
  std::string name;
  std::vector<std::string> lines;
  std::string steps;
  std::vector<Row> rows{};
};

std::vector<Script> all_scripts();

// An object or register, how wide it is written, and whose: "60F9.19:2@3" as the sheets print it, a Kinco's register as
// "r3200" or "r3700L" (two words), an iD286pro's as "323".
struct Name {
  explicit Name(const std::string& text);
  ObjectKey key() const;
  std::string word;
  std::uint8_t station = 1;
  std::size_t width = 0;
};

// What a script plays in: drives on a line, driven by their own protocol. Nothing from read and write: no answer, or
// refused.
class Scene {
 public:
  explicit Scene(const std::string& line) : bench(line) {}
  virtual ~Scene() = default;

  virtual std::optional<std::int64_t> read(const Name&) { return std::nullopt; }
  virtual std::optional<std::uint32_t> write(const Name&, std::int64_t) { return std::nullopt; }
  virtual void send(const std::string& hex) { bench.exchange(from_hex(hex)); }
  virtual std::string received() { return to_hex(bench.received()); }  // since the last send() or "listen"
  virtual std::int64_t fact(const std::string& name);                  // what is no object
  virtual bool act(const Row& words);                                  // false: it is no word of this scene

  std::map<std::string, std::string> phrases{{"reboot", "restart; pass 2s"}};  // words that stand for several steps
  Bench bench;

 private:
  std::optional<bool> stands(const std::string& word) const;
  Bytes remembered_;
};

// On a line as spec_of() has it.
std::unique_ptr<Scene> scene_on(const std::string& line);

void play(Scene& scene, const std::string& steps);

}  // namespace axisgate::simulated
