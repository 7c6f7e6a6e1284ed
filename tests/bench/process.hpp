// SPDX-License-Identifier: Apache-2.0
// Processes of a bench: the programs it measures and the servers it measures them with.
// Promises that each ends with its object, and with the bench that is killed.
// Never shares anything with the bench but what its starter hands over.
#pragma once

#include <sys/types.h>

#include <csignal>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace axisgate::bench {

class Process {
 public:
  /// `body` runs in a child on this processor, and the child ends when it returns or throws. `end_by`: the signal that
  /// ends it at last.
  Process(unsigned processor, const std::function<void()>& body, int end_by = SIGKILL);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  [[nodiscard]] pid_t id() const { return id_; }
  [[nodiscard]] bool ended();

 private:
  pid_t id_;
  int end_by_;
  bool ended_ = false;
};

/// The body that becomes another program, which says its words into a file.
[[noreturn]] void become(const std::string& program, const std::vector<std::string>& arguments,
                         const std::string& output);

/// A server in a process of its own: `serve` calls its argument with the port it listens on, or any other number when
/// it is ready, and then serves until it is killed.
class ServerProcess {
 public:
  using Ready = std::function<void(std::uint16_t)>;
  explicit ServerProcess(const std::function<void(const Ready& ready)>& serve, unsigned processor = 0);
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  struct Pipe {
    Pipe();
    ~Pipe();
    int ends[2];
  };
  Pipe pipe_;
  Process process_;
  std::uint16_t port_ = 0;
};

/// The calling process runs on this processor alone from now on, where the machine has it.
void stay_on_processor(unsigned number);

/// The calling thread goes before all others from now on, where the system allows it (CAP_SYS_NICE): what stands for a
/// wire or a drive must not wait for the clients that share its processor, or its answers come too late.
void go_before_others();

}  // namespace axisgate::bench
