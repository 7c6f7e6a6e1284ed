// SPDX-License-Identifier: Apache-2.0
// Events as the web shows them, with what causes them and what helps where a word says so.
// Promises ids that no restart of the gateway gives twice: boot.number. Never leaves the newest out.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/image/events.hpp"
#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

[[nodiscard]] std::optional<EventKind> event_kind_named(std::string_view name);

struct EventFilter {
  std::uint64_t after = 0;
  std::size_t limit = 200;
  std::optional<std::uint16_t> axis{};  ///< 0: of the gateway
  std::optional<EventKind> kind{};
};

/// An id of this boot, or a number alone; of another boot 0: everything is newer. None: it is neither.
[[nodiscard]] std::optional<std::uint64_t> event_number(std::string_view id, const Picture& picture);
[[nodiscard]] std::string event_id(const Picture& picture, std::uint64_t number);
[[nodiscard]] nlohmann::ordered_json event_json(const Picture& picture, const EventRecord& event, const Now& now);
/// {events: [...]}
[[nodiscard]] nlohmann::ordered_json events_json(const Picture& picture, const EventFilter& filter, const Now& now);

}  // namespace axisgate::web
