// SPDX-License-Identifier: Apache-2.0
// Read Device Identification (function 43, MEI type 14): who made this server and what it is (V1.1b3 6.21).
// Promises that every answer fits one PDU: longer lists are continued by "more follows" and "next object id".
// Never tells anything that a viewer may not know.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/image/process_image.hpp"
#include "gateway/upstream/modbus_tcp/client/listener_settings.hpp"
#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"

namespace axisgate::modbus_tcp {

/// Objects 0x00..0x02 are basic, to 0x7F regular, from 0x80 extended. In ascending order of id.
struct IdentificationObject {
  std::uint8_t id = 0;
  std::string value;  ///< at most 245 bytes: one object must fit one answer
};

/// All three levels, and each object alone.
inline constexpr std::uint8_t kConformity = 0x83;
inline constexpr std::uint8_t kAxisCountObject = 0x80;
inline constexpr std::uint8_t kMapVersionObject = 0x81;
inline constexpr std::uint8_t kWordOrderObject = 0x82;
inline constexpr std::uint8_t kUnitIdsObject = 0x83;
inline constexpr std::uint8_t kNumbersObject = 0x84;
inline constexpr std::uint8_t kHalvesObject = 0x85;
/// From here on, without a gap: what the axes are called, one line "3 lift" each, by number. Of more than fits, the
/// last ones are left out.
inline constexpr std::uint8_t kNamesObject = 0x90, kLastNamesObject = 0xFF;

[[nodiscard]] std::vector<IdentificationObject> identification_objects(const ProcessImage& image,
                                                                       const ListenerSettings& settings);

/// Stream access (codes 1 to 3) begins at `request.object`, or at the first where that is none; individual access (4)
/// of an unknown object: exception 0x02.
[[nodiscard]] Pdu answer_identification(const Request& request, const std::vector<IdentificationObject>& objects);

}  // namespace axisgate::modbus_tcp
