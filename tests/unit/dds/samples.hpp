// SPDX-License-Identifier: Apache-2.0
// Records as axisgate-dds would send them, for tests of the gateway's half.
// Promises that each writer has a GUID of its own, and those of one participant its prefix. Never decides what is
// right.
#pragma once

#include "gateway/core/clock.hpp"
#include "gateway/upstream/dds_link/records.hpp"

namespace axisgate::test {

inline constexpr Instant kStart = kLongAgo + std::chrono::hours(1);

/// The `entity`-th writer of the `participant`-th participant.
[[nodiscard]] inline dds::Guid guid(std::uint8_t participant, std::uint8_t entity = 1) {
  dds::Guid out{0x01, 0x0F, participant};
  out[12] = 0x00;
  out[14] = entity;
  out[15] = 0x02;
  return out;
}

[[nodiscard]] inline dds::WriterRecord writer_there(const dds::Guid& writer, std::int32_t strength = 0) {
  return {writer, strength, false, "192.168.1.7"};
}
[[nodiscard]] inline dds::WriterRecord writer_gone(const dds::Guid& writer) { return {writer, 0, true, {}}; }
[[nodiscard]] inline dds::BeatRecord beat(const dds::Guid& writer, dds::SteadyNs said = 0) { return {{writer}, said}; }

[[nodiscard]] inline dds::CommandRecord command(const dds::Guid& writer, std::uint8_t number, std::uint64_t id,
                                                std::uint16_t axis = 1) {
  dds::CommandRecord out;
  out.writer = writer;
  out.axis = axis;
  out.request_id = id;
  out.command = number;
  return out;
}

}  // namespace axisgate::test
