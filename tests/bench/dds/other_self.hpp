// SPDX-License-Identifier: Apache-2.0
// This program once more, as a process of its own, with a socket pair between the two. Promises that it has ended when
// its owner is gone. Never knows what is said over the socket.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace axisgate::bench {

class OtherSelf {
 public:
  /// Its end of the socket pair, in the other process.
  static constexpr int kSocket = 3;

  /// Starts /proc/self/exe as `mode DOMAIN`. `type`: of the socket pair, SOCK_STREAM or SOCK_SEQPACKET.
  OtherSelf(std::string mode, std::uint32_t domain, int type);
  ~OtherSelf();
  OtherSelf(const OtherSelf&) = delete;
  OtherSelf& operator=(const OtherSelf&) = delete;

  [[nodiscard]] int socket() const { return socket_; }

 private:
  pid_t pid_ = -1;
  int socket_ = -1;
};

}  // namespace axisgate::bench
