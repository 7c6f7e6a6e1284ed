// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/top/top_screen.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace axisgate::commands {
namespace {

// ECMA-48: the alternate screen keeps what the user had on the terminal; its cursor is hidden while we redraw.
constexpr std::string_view kEnter = "\x1b[?1049h\x1b[?25l";
constexpr std::string_view kLeave = "\x1b[?25h\x1b[?1049l";
constexpr std::string_view kHome = "\x1b[H";
constexpr std::string_view kWipeLine = "\x1b[K";
constexpr std::string_view kRed = "\x1b[31m", kYellow = "\x1b[33m", kPlain = "\x1b[0m";
constexpr std::string_view kWipeBelow = "\x1b[J";
constexpr std::size_t kUsualColumns = 160;
constexpr std::size_t kUsualRows = 50;

void put(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

struct Window {
  std::size_t columns = kUsualColumns, rows = kUsualRows;
};

Window window() {
  winsize size{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0;
  return known ? Window{size.ws_col, size.ws_row} : Window{};
}

/// no-color.org; and a terminal that knows none says so.
bool wants_colours() {
  const char* none = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return (none == nullptr || *none == '\0') && terminal != nullptr && std::string_view(terminal) != "dumb";
}

}  // namespace

std::string terminal_frame(std::span<const TopLine> lines, std::size_t columns, std::size_t rows, bool colours) {
  std::string frame(kHome);
  for (std::size_t i = 0; i < std::min(lines.size(), rows); ++i) {
    if (i != 0) frame += "\r\n";
    const std::string_view text = std::string_view(lines[i].text).substr(0, columns);
    const Attention asks = colours ? lines[i].asks : Attention::none;
    const std::size_t plain = asks == Attention::none ? text.size() : std::min(lines[i].asks_from, text.size());
    frame += text.substr(0, plain);
    if (plain < text.size()) {
      frame += asks == Attention::act ? kRed : kYellow;
      frame += text.substr(plain);
      frame += kPlain;
    }
    frame += kWipeLine;
  }
  frame += kWipeBelow;
  return frame;
}

TopScreen::TopScreen(bool plain) : redraws_(!plain && isatty(STDOUT_FILENO) == 1), colours_(wants_colours()) {
  if (redraws_) put(kEnter);
}

TopScreen::~TopScreen() {
  if (redraws_) put(kLeave);
}

void TopScreen::show_table(const std::vector<TopLine>& table) {
  last_message_.clear();
  last_table_ = table;
  if (redraws_) {
    draw(table);
  } else {
    put(text_of(table));
  }
}

void TopScreen::show_message(const std::string& message) {
  if (redraws_) {
    // The message comes first: of a long table the end may be outside the window.
    std::vector<TopLine> shown{{message}};
    if (!last_table_.empty()) shown.push_back({"last table:"});
    shown.insert(shown.end(), last_table_.begin(), last_table_.end());
    draw(shown);
  } else if (message != last_message_) {
    put(message + "\n");
  }
  last_message_ = message;
}

std::size_t TopScreen::columns() const { return redraws_ ? window().columns : 0; }

void TopScreen::draw(std::span<const TopLine> lines) {
  const Window shown = window();
  put(terminal_frame(lines, shown.columns, shown.rows, colours_));
}

}  // namespace axisgate::commands
