// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/drive_process.hpp"

#include <poll.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "tests/axisgate_sim/can_socket.hpp"
#include "tests/axisgate_sim/pty.hpp"
#include "tests/bench/answering_line.hpp"

namespace axisgate::bench {
namespace {

using simulated::Time;

std::unique_ptr<simulated::Port> opened(const std::string& device, LineProtocol protocol) {
  if (protocol == LineProtocol::vcan) return std::make_unique<simulated::CanSocket>(device);
  return std::make_unique<simulated::Pty>(device);
}

struct Line {
  std::unique_ptr<simulated::Port> port;
  std::unique_ptr<AnsweringLine> drives;
  std::optional<Answer> answer;  // waits for its time
};

class Responder {
 public:
  Responder(std::vector<Line> lines, const DriveLines& shape, ExchangeTap& tap)
      : lines_(std::move(lines)), reply_after_(shape.reply_after), turn_every_(shape.turn_every), tap_(tap) {}

  [[noreturn]] void serve() {
    std::vector<pollfd> watched;
    for (const Line& line : lines_) watched.push_back({line.port->readable(), POLLIN, 0});
    for (;;) {
      const timespec wait = until_next_deed();
      static_cast<void>(::ppoll(watched.data(), watched.size(), &wait, nullptr));
      if (turn_every_ > Time{} && steady_now() >= next_turn_) turn();
      for (std::size_t i = 0; i < lines_.size(); ++i) {
        if (watched[i].revents != 0) hear(lines_[i], i);
        if (lines_[i].answer && steady_now() >= due(lines_[i]))
          answer(lines_[i]);
        else
          send(lines_[i], lines_[i].drives->unasked(steady_now()));
      }
    }
  }

 private:
  [[nodiscard]] Time due(const Line& line) const { return Time(line.answer->exchange.asked_at) + reply_after_; }

  [[nodiscard]] timespec until_next_deed() const {
    Time wait = std::chrono::milliseconds(100);
    const Time now = steady_now();
    for (const Line& line : lines_)
      if (line.answer) wait = std::min(wait, std::max(due(line) - now, Time{}));
    if (turn_every_ > Time{}) wait = std::min(wait, std::max(next_turn_ - now, Time{}));
    return {wait / std::chrono::seconds(1), (wait % std::chrono::seconds(1)).count()};
  }

  void hear(Line& line, std::size_t number) {
    const auto bytes = line.port->read();
    const Time now = steady_now();
    auto answer = line.drives->hear(bytes, tap_.mute(), now);
    if (!answer) return;
    line.answer = std::move(answer);
    line.answer->exchange.asked_at = now.count();
    line.answer->exchange.line = static_cast<std::uint8_t>(number);
  }

  void turn() {
    constexpr int kMostTurns = 20'000;  // what the position's register can show
    turns_ = turns_ % kMostTurns + 1;
    next_turn_ = steady_now() + turn_every_;
    for (Line& line : lines_) {
      const auto bytes = line.drives->turned(turns_);
      if (bytes.empty()) continue;
      const std::int64_t at = steady_now().count();
      tap_.record({.asked_at = at, .answered_at = at, .object = static_cast<std::uint16_t>(turns_)});
      send(line, bytes);
    }
  }

  static void send(const Line& line, const std::vector<std::uint8_t>& bytes) {
    if (!bytes.empty()) line.port->write(bytes);
  }

  void answer(Line& line) {
    auto bytes = line.drives->unasked(steady_now());
    bytes.insert(bytes.end(), line.answer->bytes.begin(), line.answer->bytes.end());
    line.answer->exchange.answered_at = steady_now().count();
    tap_.record(line.answer->exchange);
    send(line, bytes);
    line.answer.reset();
  }

  std::vector<Line> lines_;
  Time reply_after_;
  Time turn_every_;
  Time next_turn_{};
  int turns_ = 0;
  ExchangeTap& tap_;
};

}  // namespace

DriveProcess::DriveProcess(const DriveLines& shape, const std::string& folder) : shape_(shape) {
  for (int i = 0; i < shape.lines; ++i)
    devices_.push_back((shape.protocol == LineProtocol::vcan ? "vcan" : folder + "/line") + std::to_string(i));
  const auto serve = [this](const ServerProcess::Ready& ready) {
    ::prctl(PR_SET_TIMERSLACK, 1UL);  // else replies would come 50 us late
    std::vector<Line> lines;
    for (const std::string& device : devices_)
      lines.push_back({opened(device, shape_.protocol),
                       make_answering_line(shape_.protocol, shape_.drives_per_line, steady_now()), std::nullopt});
    ready(0);
    Responder(std::move(lines), shape_, *tap_.operator->()).serve();
  };
  process_.emplace(serve, shape.processor);
}

DriveProcess::~DriveProcess() {
  process_.reset();
  for (const std::string& device : devices_)
    if (device.find('/') != std::string::npos) static_cast<void>(::unlink(device.c_str()));
}

}  // namespace axisgate::bench
