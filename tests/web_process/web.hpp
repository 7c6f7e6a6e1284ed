// SPDX-License-Identifier: Apache-2.0
// The real axisgate-web, started by a test as the gateway starts it. The test is the gateway.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "gateway/upstream/web_link/records.hpp"

namespace axisgate::web::test {

/// Against hanging; nothing is ever expected to take this long.
inline constexpr std::chrono::seconds kPatience{60};

class Web {
 public:
  /// @param settings further members of --settings, as JSON without braces: "\"max_streams\": 1"
  /// @param listen at a port that the system gives, or at this one
  explicit Web(const std::string& settings = "", const std::string& listen = "127.0.0.1:0");
  ~Web();
  Web(const Web&) = delete;
  Web& operator=(const Web&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] bool confined() const { return confined_; }

  void tell(const Record& record);
  /// hello, its axes from 1 on and its bus.
  void tell_of_the_gateway(std::uint16_t axes = 1);
  /// The axis stands at so many turns.
  void tell_position(double turns);
  void send_bytes(const std::vector<Byte>& packet);
  /// The next line for the log; none: the socket is closed.
  [[nodiscard]] std::optional<LogRecord> next_line();
  void close_link();
  /// Waits for its end: its exit code, or minus the signal.
  [[nodiscard]] int exit_code();
  /// A line of /proc/PID/status behind its name.
  [[nodiscard]] std::string status(const std::string& name) const;

 private:
  std::optional<Record> receive();
  void wait_ready();

  pid_t pid_ = -1;
  int link_ = -1;
  std::uint16_t port_ = 0;
  bool confined_ = false;
};

[[nodiscard]] SteadyNs now();

}  // namespace axisgate::web::test
