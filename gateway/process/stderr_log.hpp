// SPDX-License-Identifier: Apache-2.0
// The log of the product: one line an event on stderr, with the time of day; where stderr is systemd's journal, to it,
// with fields. Promises a line that is written whole or not at all; a journal and a person read the same. Never waits
// for a disk: stderr is a pipe or a terminal. What the journal does not take goes to stderr with its priority.
#pragma once

#include <string>

#include "gateway/core/log.hpp"
#include "gateway/process/journal.hpp"

namespace axisgate::process {

[[nodiscard]] Log stderr_log(LogLevel most_detailed, const std::string& journal_socket = std::string(kJournalSocket));

}  // namespace axisgate::process
