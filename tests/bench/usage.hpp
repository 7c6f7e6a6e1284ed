// SPDX-License-Identifier: Apache-2.0
// What a process has taken of the machine until now, as proc(5) tells it.
// Promises figures of any process that still runs. Never waits, and never looks at its threads one by one.
#pragma once

#include <sys/types.h>

namespace axisgate::bench {

struct Usage {
  double processor_s = 0;
  double resident_mib = 0;
};
[[nodiscard]] Usage usage_of(pid_t pid);

}  // namespace axisgate::bench
