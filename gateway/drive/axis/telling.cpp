// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/axis/telling.hpp"

#include <algorithm>
#include <utility>

#include "gateway/drive/plan/admission.hpp"

namespace axisgate::drive {
namespace {

// Each one is something of its own: a move to a new target is no refreshed set-point.
bool is_one_shot(const WriteBatch& batch) {
  const bool refreshes = batch.command == Command::run_velocity || batch.command == Command::run_torque;
  return (batch.command != Command::none && !refreshes) || batch.controlword || batch.mode;
}

std::optional<std::uint64_t> taken(LineBucket& bucket, Instant now) {
  if (!bucket.takes(now)) return std::nullopt;
  return bucket.left_out();
}

}  // namespace

Telling::Request request_of(const WriteBatch& batch, Errc refused) {
  Telling::Request out{batch.client, refused, batch.command};
  for (const Setpoint& setpoint : batch.setpoints) out.quantities |= bit(setpoint.quantity);
  if (batch.mode) out.quantities |= bit(Quantity::mode);
  if (batch.controlword) out.quantities |= bit(Quantity::controlword);
  // The rows that are no quantities stand where those are that nobody can write.
  if (batch.set_position_value) out.quantities |= bit(Quantity::position_actual);
  if (batch.jog_velocity) out.quantities |= bit(Quantity::velocity_actual);
  constexpr unsigned kSubBits = 8;
  if (batch.object) out.object = (std::uint32_t{batch.object->index} << kSubBits | batch.object->subindex) + 1U;
  return out;
}

std::optional<std::uint64_t> Telling::asked(const WriteBatch& batch, Instant now) {
  if (holds_stop(batch)) return taken(stops_, now);
  if (is_one_shot(batch)) return taken(commands_, now);
  return of_stream(request_of(batch, Errc::ok), kStreamPause, values_, now);
}

std::optional<std::uint64_t> Telling::owner(Instant now) { return taken(owners_, now); }

std::optional<std::uint64_t> Telling::refused(const WriteBatch& batch, Errc code, Instant now) {
  return of_stream(request_of(batch, code), kRefusalPause, refusals_, now);
}

std::optional<std::uint64_t> Telling::of_stream(const Request& request, Duration pause, LineBucket& bucket,
                                                Instant now) {
  auto stream = std::ranges::find_if(streams_, [&](const Stream& s) { return s.request == request; });
  if (stream == streams_.end()) {
    if (streams_.size() < streams_.capacity()) {
      stream = streams_.insert(streams_.end(), Stream{});
    } else {
      stream = std::ranges::min_element(streams_, [](const Stream& a, const Stream& b) { return a.newest < b.newest; });
      *stream = {};
    }
    stream->request = request;
  }
  const bool goes_on =
      stream->newest != kLongAgo && now - stream->newest < pause && now - stream->logged_at < kStreamRepeat;
  stream->newest = now;
  if (goes_on || !bucket.takes(now)) {
    ++stream->left_out;
    return std::nullopt;
  }
  stream->logged_at = now;
  return std::exchange(stream->left_out, 0);
}

}  // namespace axisgate::drive
