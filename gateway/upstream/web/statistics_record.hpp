// SPDX-License-Identifier: Apache-2.0
// The gateway, its buses and its programs as a record.
// Promises the numbers that the registers of the gateway and of the buses show, gathered when it is called.
// Never changes the image.
#pragma once

#include <vector>

#include "gateway/image/process_image.hpp"
#include "gateway/upstream/web_link/records.hpp"

namespace axisgate::web {

/// What only whoever runs the gateway knows.
struct ProcessFigures {
  Duration worst_turn{};  ///< how late the loop was at most, since it was asked last
  std::uint32_t modbus_clients = 0;
  std::uint32_t modbus_refused = 0;
  std::vector<ProgramStatistics> programs{};
};

[[nodiscard]] StatisticsRecord statistics_record(const ProcessImage& image, ProcessFigures figures,
                                                 std::uint32_t events_lost, Instant now);

}  // namespace axisgate::web
