// SPDX-License-Identifier: Apache-2.0
// How a program of the gateway's own ended, or why it did not start, and the words for it.
// Promises that each way has words of its own, with what to change where that is known.
// Never asks the system: the status was read by child_process.
#pragma once

#include <cstdint>
#include <string>

#include "gateway/upstream/host/hosted_program.hpp"

namespace axisgate::host {

struct ProcessEnd {
  enum class How : std::uint8_t {
    exited,                 ///< number: its exit code (link/exit_codes.hpp)
    killed,                 ///< number: the signal
    unknown,                ///< somebody else has taken its status
    not_found,              ///< there is no such program; detail: where it was looked for
    not_started,            ///< number: errno of what the system refused
    not_ready,              ///< ended by us: not ready in time
    stuck,                  ///< ended by us: took nothing for too long
    not_a_record,           ///< ended by us: what it sent was none; detail: why
    closed,                 ///< ended by us: it closed its socket and went on
    another_configuration,  ///< ended by us: it is to run otherwise, or not at all
  };
  How how = How::unknown;
  int number = 0;
  std::string detail{};
  friend bool operator==(const ProcessEnd&, const ProcessEnd&) = default;
};

/// It waits for the network, and not for somebody who mends something.
[[nodiscard]] bool has_no_address(const ProcessEnd& end);

/// "axisgate-dds crashed: signal 11 (SEGV)".
[[nodiscard]] std::string text(const HostedProgram& program, const ProcessEnd& end);

}  // namespace axisgate::host
