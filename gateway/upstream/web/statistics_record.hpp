// SPDX-License-Identifier: Apache-2.0
// The gateway, its buses and its programs as a record, and what buses and axes have counted.
// Promises the numbers that the registers of the gateway and of the buses show, gathered when it is called.
// Never changes the image.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "gateway/image/events.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/upstream/web_link/records.hpp"

namespace axisgate::web {

/// What only whoever runs the gateway knows.
struct ProcessFigures {
  Duration worst_turn{};  ///< how late the loop was at most, since it was asked last
  std::uint32_t modbus_clients = 0;
  std::uint32_t modbus_refused = 0;
  std::vector<ProgramStatistics> programs{};
  // Since its start.
  std::uint64_t modbus_requests = 0;
  std::array<std::uint64_t, kExceptionsShown> modbus_exceptions{};
  TimeCounts modbus_took{};
  TimeCounts loop_late{};
  struct Dds {
    std::uint64_t sent = 0;
    std::uint64_t received = 0;
  };
  std::optional<Dds> dds{};  ///< none: it is not configured
};

/// Events as they are counted where they are made.
struct EventFigures {
  std::uint32_t lost = 0;  ///< that no page was ever sent
  EventRing::ByKind added{};
};

[[nodiscard]] StatisticsRecord statistics_record(const ProcessImage& image, ProcessFigures figures,
                                                 const EventFigures& events, Instant now);
[[nodiscard]] BusCounts bus_counts(const BusImage& bus, std::size_t place);
[[nodiscard]] AxisCountsRow axis_counts(const AxisImage& axis);

}  // namespace axisgate::web
