// SPDX-License-Identifier: Apache-2.0
// A bound on this process's own memory: beyond it the process ends at once, instead of the host's other programs.
// Promises exit code kExitMemory and one line on stderr when an allocation fails.
// Never tries to go on without the memory.
#pragma once

#include <cstdint>

namespace axisgate::program {

void limit_memory(std::uint32_t mib);
/// Ends the process where nearly all is taken: the library lives on with allocations that fail, but takes no sample any
/// more.
void check_memory();
/// Says so on stderr and ends the process.
[[noreturn]] void end_for_memory();

}  // namespace axisgate::program
