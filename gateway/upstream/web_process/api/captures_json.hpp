// SPDX-License-Identifier: Apache-2.0
// Captures as the web shows them: what a list says of one, and all of it with its lines and events.
// Promises the times and names of its own day, whatever the gateway is by now. Never changes one.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gateway/upstream/web_process/api/history_json.hpp"
#include "gateway/upstream/web_process/capture/recorder.hpp"
#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

/// {id, cause, axis, name, at, from, to, text, times, samples, complete}
[[nodiscard]] nlohmann::ordered_json capture_json(const Capture& capture);
/// {captures: [...]}
[[nodiscard]] nlohmann::ordered_json captures_json(const Recorder& recorder);
/// That of one, with axes, series and events. None: it would be longer than kMaxJson.
[[nodiscard]] std::optional<std::string> whole_capture_json(const Capture& capture, const std::vector<Series>& series,
                                                            std::size_t points, const Picture& picture);

/// From its begin to its end. Of one without length it is not empty either.
[[nodiscard]] Span span_of(const Capture& capture);
/// What its times are in UTC.
[[nodiscard]] Now day_of(const Capture& capture);

}  // namespace axisgate::web
