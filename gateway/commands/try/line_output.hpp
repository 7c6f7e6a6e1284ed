// SPDX-License-Identifier: Apache-2.0
// Lines for a person, written as the terminal takes them. Promises that a terminal which is held (Ctrl-S) or a pipe
// that nobody empties makes nobody wait: what it does not take now is kept. Never loses a line while somebody reads.
#pragma once

#include <deque>
#include <functional>
#include <string>

namespace axisgate::commands {

class LineOutput {
 public:
  LineOutput(int descriptor, std::function<void()> on_gone) : descriptor_(descriptor), on_gone_(std::move(on_gone)) {}
  void say(std::string line) { lines_.push_back(std::move(line) + "\n"); }
  /// What it takes now. `on_gone` is called once, when nobody reads any more.
  void flush();
  [[nodiscard]] bool empty() const { return lines_.empty(); }

 private:
  int descriptor_;
  std::function<void()> on_gone_;
  std::deque<std::string> lines_;
  bool gone_ = false;
};

}  // namespace axisgate::commands
