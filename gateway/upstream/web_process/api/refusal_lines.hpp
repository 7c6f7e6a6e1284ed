// SPDX-License-Identifier: Apache-2.0
// Which refusals a person should read of in the log, in what words: one line a minute of each reason.
// Promises that nobody outside can fill the log, and that what was left out is counted in the next line. Never tells
// what only the asker can mend.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "gateway/upstream/web_process/http/address.hpp"
#include "gateway/upstream/web_process/http/refusals.hpp"
#include "gateway/upstream/web_process/time/utc.hpp"

namespace axisgate::web {

class RefusalLines {
 public:
  static constexpr SteadyNs kEach = 60 * kSecond;
  /// The line to write; none.
  [[nodiscard]] std::optional<std::string> on(Refusal refusal, const Address& who, SteadyNs now);

 private:
  struct Lines {
    SteadyNs at = 0;  ///< 0: never
    std::uint64_t left_out = 0;
  };
  std::array<Lines, kRefusals> written_{};
};

}  // namespace axisgate::web
