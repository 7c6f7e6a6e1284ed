// SPDX-License-Identifier: Apache-2.0
// /history and /history.csv: what was, of up to sixteen lines.
// Promises that a bound that is met is named with what to ask instead. Never keeps anything of a request.
#pragma once

#include "gateway/upstream/web_process/api/asked.hpp"

namespace axisgate::web {

[[nodiscard]] Answer history_answer(const Asked& asked, Query& query);
[[nodiscard]] Answer history_csv_answer(const Asked& asked, Query& query);

/// A table that is made while it is taken.
[[nodiscard]] Answer csv_answer(const Asked& asked, CsvRequest request, EachPoint each);

}  // namespace axisgate::web
