// SPDX-License-Identifier: Apache-2.0
// The real axisgate-dds, started by a test as the gateway starts it.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::dds::test {

/// Against hanging; nothing is ever expected to take this long.
inline constexpr std::chrono::seconds kPatience{30};

/// Another one for each test program that runs now, so that tests beside each other do not meet. All their ports are
/// below those that the system gives to others.
[[nodiscard]] std::uint32_t test_domain();

class Child {
 public:
  /// `axisgate-dds serve --link-fd N --domain D` and `more`.
  explicit Child(const std::vector<std::string>& more = {}, bool ready = true);
  /// Any command line: nobody is at the other end of its socket.
  static std::pair<int, std::string> run(const std::vector<std::string>& arguments);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void send(const Record& record);
  void send_bytes(const std::vector<Byte>& packet);
  [[nodiscard]] std::optional<Record> receive(std::chrono::milliseconds within = kPatience);
  /// The next record of this kind; others are dropped. None: the socket was closed, or the test's patience is over.
  template <typename Kind>
  std::optional<Kind> next() {
    const auto until = std::chrono::steady_clock::now() + kPatience;
    // Beats never end: what is waited for may still never come.
    while (std::chrono::steady_clock::now() < until) {
      std::optional<Record> record = receive();
      if (!record) break;
      if (Kind* kind = std::get_if<Kind>(&*record)) return *kind;
    }
    return std::nullopt;
  }
  void close_link();
  /// The other end of the socket is closed.
  [[nodiscard]] bool hung_up() const;
  /// Waits for its end: its exit code, or minus the signal.
  [[nodiscard]] int exit_code();
  /// Once it has ended.
  [[nodiscard]] std::string error_output();
  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] int link() const { return link_; }

 private:
  void wait_ready();

  pid_t pid_ = -1;
  int link_ = -1;
  int errors_ = -1;
};

}  // namespace axisgate::dds::test
