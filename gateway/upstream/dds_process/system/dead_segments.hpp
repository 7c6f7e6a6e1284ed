// SPDX-License-Identifier: Apache-2.0
// Files of shared memory that a killed process has left behind: Fast DDS removes them in good order alone, two a
// participant, half a megabyte each time. Promises to remove what no process holds any more, as `fastdds shm clean`
// does: the owner of a segment keeps a lock on its file as long as it lives. Never touches another user's, nor one that
// is being made.
#pragma once

#include <string>

namespace axisgate::dds {

void remove_dead_segments(const std::string& folder);

}  // namespace axisgate::dds
