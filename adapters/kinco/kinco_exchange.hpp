// SPDX-License-Identifier: Apache-2.0
// How an exchange is said in Kinco frames, and which frame answers it.
// Promises that a reply is matched by all it says: station, kind of answer, index and sub-index.
// Never looks at anything but its arguments.
#pragma once

#include "adapters/bus/exchange.hpp"
#include "adapters/kinco/kinco_codec.hpp"

namespace axisgate::kinco {

/// Stations a drive may have: 127 is the PC tool's broadcast (kinco-md.md 2.1).
inline constexpr std::uint8_t kFirstStation = 1;
inline constexpr std::uint8_t kLastStation = 126;

/// `exchange.node` kFirstStation..kLastStation; a write's size 1, 2 or 4.
[[nodiscard]] Frame request_of(const bus::Exchange& exchange);

/// A read is answered by a value of any width or by an error; a write by its acknowledgement, with or without an echo
/// of the data (JD K5), or by an error.
[[nodiscard]] bool answers(const Frame& frame, const bus::Exchange& exchange);

/// Of a frame that answers: ok, or refused_by_drive with the drive's 32-bit code. A value comes with the width that the
/// drive sent, also where the exchange asked for another: the sheet itself contradicts the width of objects (606Ch, JD
/// K7), and whether the width is a fault is for the profile's type to say. The data bytes beyond the width are cut off.
[[nodiscard]] bus::ExchangeResult result_of(const Frame& frame);

/// Time on the wire of an exchange without the drive's own: ten bytes each way and, in a chain of drives (6510:0B = 1),
/// ten of echo. `baud` above 0; `bits_per_byte` 10 for 8N1, 11 with parity.
[[nodiscard]] Duration wire_time(std::uint32_t baud, bool cascade, int bits_per_byte = 10);

}  // namespace axisgate::kinco
