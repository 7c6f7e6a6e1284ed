// SPDX-License-Identifier: Apache-2.0
// What goes over a cable of the stage, whichever kind it is, and the lines of a transcript (tests/golden). Promises
// that equal frames at equal times are equal text. Never changes what it tells of.
#pragma once

#include <functional>
#include <string>

#include "tests/stage/gateway_stage.hpp"

namespace axisgate::test {

struct CableFrame {
  bool to_drive = false;
  Bytes bytes;
  const can::CanFrame* can = nullptr;  ///< none: a line that carries bytes
};

/// The only listener of this line from now on.
void listen(GatewayStage& stage, std::size_t line, const std::function<void(const CableFrame&)>& on_frame);

/// "    2.570 ms  bus    <- 581 60 60 60 00 01 00 00 00"
[[nodiscard]] std::string transcript_line(Duration since_begin, const std::string& who, const std::string& what);
[[nodiscard]] std::string transcript_line(Duration since_begin, const CableFrame& frame);
/// A number by one of printf's formats for long long.
[[nodiscard]] std::string number_text(const char* format, std::int64_t number);

}  // namespace axisgate::test
