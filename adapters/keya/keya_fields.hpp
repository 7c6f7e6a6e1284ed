// SPDX-License-Identifier: Apache-2.0
// The data of a Keya answer, cut into the fields that an exchange asks for; all three protocols carry them big-endian.
// Promises that no field outside the data is cut, and the fields in the order of the exchange.
// Never knows a frame: where its data begin is the codecs' question.
#pragma once

#include "adapters/bus/exchange.hpp"
#include "gateway/core/bytes.hpp"

namespace axisgate::keya {

// The protocols have no error answer. What they cannot say is refused before it is sent, in the words of CiA 301
// section 7.2.4.3.17, which the mailbox speaks too.
inline constexpr std::uint32_t kUnsupportedAccess = 0x06010000;  ///< the object cannot be written alone
inline constexpr std::uint32_t kWriteOnly = 0x06010001;
inline constexpr std::uint32_t kReadOnly = 0x06010002;
inline constexpr std::uint32_t kNoObject = 0x06020000;
inline constexpr std::uint32_t kWrongLength = 0x06070010;
inline constexpr std::uint32_t kNoSubIndex = 0x06090011;
inline constexpr std::uint32_t kWrongValue = 0x06090030;

[[nodiscard]] bus::ExchangeResult refused(std::uint32_t detail);

/// `size` bytes (1..4), most significant first.
[[nodiscard]] std::uint32_t load_be(Bytes from, std::size_t at, std::size_t size);
void store_be32(std::span<Byte> to, std::size_t at, std::uint32_t value);

/// Whether all that the read asks for lies within `available` bytes of data, in fields of 1, 2 or 4 bytes.
[[nodiscard]] bool within(const bus::Exchange& read, std::size_t available);

/// Only where within() holds. Size 0 stands for the four bytes from there.
[[nodiscard]] bus::ReplyFields cut(const bus::Exchange& read, Bytes data);

}  // namespace axisgate::keya
