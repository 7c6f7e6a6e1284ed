// SPDX-License-Identifier: Apache-2.0
// What this process can do from here on: answer on the sockets that it has, and, where it has a folder, make and remove
// files in that one alone. Promises that the system refuses all else (EPERM, beyond the folder EACCES), and ends it at
// once for what only an intruder would ask: another socket or program, a look into another process. Never to be undone,
// not by a program that it would start either.
#pragma once

namespace axisgate::web {

struct Confinement {
  bool confined = false;  ///< false: the kernel has no filter of system calls, and nothing is refused
  /// Files can be made in the folder. False: there is none, or the kernel cannot keep their names inside it (Landlock).
  bool writes = false;
};

/// With them a call makes a new file, and never opens a device or what is there.
inline constexpr unsigned kNewFileMode = 0640;
[[nodiscard]] int new_file_flags();

/// @param folder descriptor of the one where files are made; -1: none
[[nodiscard]] Confinement confine(int folder = -1);

}  // namespace axisgate::web
