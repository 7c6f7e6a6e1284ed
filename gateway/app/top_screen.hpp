// Where `axisgate top` writes: a terminal that is redrawn in place, or plain lines for pipes and logs.
// Promises to leave the terminal as it was found, however the command ends.
// Never decides what is shown.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace axisgate::app {

/// One frame of a redrawn terminal: `text` cut to the window and what was there before wiped. Pure.
[[nodiscard]] std::string terminal_frame(std::string_view text, std::size_t columns, std::size_t rows);

class TopScreen {
 public:
  explicit TopScreen(bool plain);
  ~TopScreen();
  TopScreen(const TopScreen&) = delete;
  TopScreen& operator=(const TopScreen&) = delete;

  void show_table(const std::string& table);
  /// On a terminal above the last table; in plain output only when it changes, so that a log is not filled with it.
  void show_notice(const std::string& notice);

 private:
  void draw(const std::string& text);

  bool redraws_;
  std::string last_table_;
  std::string last_notice_;
};

}  // namespace axisgate::app
