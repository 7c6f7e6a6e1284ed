// SPDX-License-Identifier: Apache-2.0
// What this process can do from here on: answer on the sockets that it has. Promises that the system refuses all else
// (EPERM), and ends it at once for what only an intruder would ask: another socket or program, a look into another
// process. Never to be undone, not by a program that it would start either.
#pragma once

namespace axisgate::web {

/// False: the kernel has no filter of system calls, and nothing is refused.
[[nodiscard]] bool confine();

}  // namespace axisgate::web
