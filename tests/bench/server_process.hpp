// A server in a process of its own, on a processor of its own, so that it shares nothing with the clients that load it.
// Promises to end with the object. Never outlives the benchmark: it ends when its pipe does.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>

namespace axisgate::bench {

class ServerProcess {
 public:
  /// `serve` runs in the child: it calls its argument with the port it listens on, and then serves until it is killed.
  explicit ServerProcess(const std::function<void(const std::function<void(std::uint16_t)>& listening)>& serve);
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  pid_t process_ = -1;
  std::uint16_t port_ = 0;
};

/// The calling process runs on this processor alone from now on, where the machine has it.
void stay_on_processor(unsigned number);

/// The calling thread goes before all others from now on, where the system allows it (CAP_SYS_NICE): what stands for a
/// wire or a drive must not wait for the clients that share its processor, or its answers come too late.
void go_before_others();

}  // namespace axisgate::bench
