// SPDX-License-Identifier: Apache-2.0
// What an SDO transfer wants done next, and how it says that an exchange is over.
// Promises room for everything one exchange can send at once.
// Never holds more than one exchange's worth of frames.
#pragma once

#include <boost/container/static_vector.hpp>
#include <optional>

#include "adapters/canopen/sdo/sdo_codec.hpp"

namespace axisgate::canopen {

/// A whole block; or the abort of a chain and the request that ended it.
inline constexpr std::size_t kMaxSdoFrames = kMaxBlockSegments + 2;
using SdoFrames = boost::container::static_vector<SdoFrame, kMaxSdoFrames>;

/// Objects of up to so many bytes go in segments, not blocks: three segments take no more frames than a block of them.
inline constexpr std::size_t kBlockThreshold = 3 * kSegmentBytes;
/// Blocks in a row of which not one segment came through; then the transfer is aborted.
inline constexpr int kMaxBarrenBlocks = 3;

struct SdoStep {
  SdoFrames frames{};                         ///< to be sent now, in this order
  std::optional<bus::ExchangeResult> over{};  ///< the exchange has ended; with `more` the transfer has not
};

[[nodiscard]] inline bus::ExchangeResult refused(std::uint32_t code) {
  bus::ExchangeResult result;
  result.code = Errc::refused_by_drive;
  result.detail = code;
  result.for_now = bus::abort_may_pass(code);
  return result;
}

[[nodiscard]] inline SdoStep over(bus::ExchangeResult result) {
  SdoStep step;
  step.over = std::move(result);
  return step;
}

/// Goes on with Part::next.
[[nodiscard]] inline SdoStep paused() {
  bus::ExchangeResult result;
  result.more = true;
  return over(std::move(result));
}

/// The server is sent an abort with `code`.
[[nodiscard]] inline SdoStep aborting(ObjectAddress object, std::uint32_t code, bus::ExchangeResult result) {
  SdoStep step = over(std::move(result));
  step.frames.push_back(abort_frame(object, code));
  return step;
}

/// The server's data contradict themselves: what they were meant to be is unknown.
[[nodiscard]] inline SdoStep broken(ObjectAddress object, std::uint32_t code) {
  bus::ExchangeResult result;
  result.code = Errc::bad_reply;
  result.detail = code;
  return aborting(object, code, std::move(result));
}

}  // namespace axisgate::canopen
