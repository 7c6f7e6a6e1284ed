#include "gateway/app/stderr_log.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdio>

namespace axisgate::app {

Log stderr_log(LogLevel most_detailed) {
  return Log(
      [](LogLevel level, std::string_view source, std::string_view message) {
        const auto now = std::chrono::system_clock::now();
        const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
        const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
        const std::string line = fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03} {} {}: {}\n", fmt::localtime(seconds), ms,
                                             text(level), source, message);
        // One call, so that lines of two processes on one terminal do not mix.
        std::fwrite(line.data(), 1, line.size(), stderr);
      },
      most_detailed);
}

}  // namespace axisgate::app
