// SPDX-License-Identifier: Apache-2.0
#include "tests/stage/transcript.hpp"

#include <array>
#include <cstdio>
#include <type_traits>

namespace axisgate::test {

void listen(GatewayStage& stage, std::size_t line, const std::function<void(const CableFrame&)>& on_frame) {
  stage.at_link(line, [&](auto& link) {
    if constexpr (std::is_same_v<decltype(link), CanLinkSim&>)
      link.on_traffic = [on_frame](bool to_drive, const can::CanFrame& frame) {
        on_frame({to_drive, frame.bytes(), &frame});
      };
    else
      link.on_traffic = [on_frame](bool to_drive, Bytes bytes) { on_frame({to_drive, bytes, nullptr}); };
  });
}

std::string number_text(const char* format, std::int64_t number) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, static_cast<long long>(number));
  return buffer.data();
}

std::string transcript_line(Duration since_begin, const std::string& who, const std::string& what) {
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(since_begin).count();
  std::array<char, 32> time{};
  std::snprintf(time.data(), time.size(), "%9.3f ms  ", static_cast<double>(us) / 1000.0);
  return time.data() + who + " " + what;
}

std::string transcript_line(Duration since_begin, const CableFrame& frame) {
  std::string what = frame.can != nullptr ? number_text("%03llX ", frame.can->id) : "";
  what += frame.can != nullptr && frame.can->remote ? "remote" : hex_text(frame.bytes);
  return transcript_line(since_begin, frame.to_drive ? "bus    ->" : "bus    <-", what);
}

}  // namespace axisgate::test
