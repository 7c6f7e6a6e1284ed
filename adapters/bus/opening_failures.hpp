// SPDX-License-Identifier: Apache-2.0
// Why a link could not be opened, as it logs it while it goes on trying each second. Promises that a reason is logged
// once, until another one comes or the link was open in between. Never opens or ends anything.
#pragma once

#include <string>

#include "gateway/core/log.hpp"

namespace axisgate::bus {

class OpeningFailures {
 public:
  void tell(const Log& log, const LogSource& source, const std::string& why) {
    if (why == last_) return;
    last_ = why;
    log.write(OpeningFailure{source, why});
  }
  /// The reason was reported in another way: as the loss of a link that was up.
  void was_reported(const std::string& why) { last_ = why; }
  void opened() { last_.clear(); }

 private:
  std::string last_;
};

}  // namespace axisgate::bus
