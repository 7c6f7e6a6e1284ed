// SPDX-License-Identifier: Apache-2.0
// The program at work: from its sockets, which are open, to the end of the gateway's.
// Promises to say `bye` to every page and to free its port when the gateway is gone. Never asks the gateway for
// anything.
#pragma once

#include "gateway/upstream/program/record_link.hpp"
#include "gateway/upstream/web_link/records.hpp"
#include "gateway/upstream/web_process/capture/capture_settings.hpp"
#include "gateway/upstream/web_process/http/settings.hpp"

namespace axisgate::web {

using Link = program::RecordLink<Record, decode>;

/// The exit code. Throws program::StartError where it cannot begin.
[[nodiscard]] int serve(const Settings& settings, const CaptureSettings& captures, Link& link);

}  // namespace axisgate::web
