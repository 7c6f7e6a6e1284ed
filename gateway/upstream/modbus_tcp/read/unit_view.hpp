// SPDX-License-Identifier: Apache-2.0
// The unit view: what part of the map a unit id shows (design 3.1 Unit id).
// Promises that every address of a request is placed by the same rule, for registers, coils and inputs alike.
// Never reads or writes anything there.
#pragma once

#include <cstdint>
#include <optional>

#include "gateway/image/process_image.hpp"
#include "gateway/image/register_map.hpp"
#include "gateway/upstream/modbus_tcp/client/listener_settings.hpp"

namespace axisgate::modbus_tcp {

/// With "unit_ids": "per-axis", the unit that shows the flat map.
inline constexpr std::uint8_t kFlatUnit = 255;

class UnitView {
 public:
  /// No value: no such unit here (0x0A). Flat listeners: any unit id shows the whole map.
  [[nodiscard]] static std::optional<UnitView> of(std::uint8_t unit, const ListenerSettings& settings,
                                                  const ProcessImage& image);

  /// Where a register is; no value: outside every block, or in the block of an axis or bus that is not configured. In
  /// the overview only addresses beyond the last axis are outside: a gap in the axis numbers must not spoil a read over
  /// it.
  [[nodiscard]] std::optional<RegisterPlace> place_register(std::uint32_t address, const ProcessImage& image) const;

  struct BitPlace {
    AxisImage* axis;
    std::uint16_t offset;  ///< 0..99
  };
  /// Coils and discrete inputs exist in the blocks of axes only.
  [[nodiscard]] std::optional<BitPlace> place_bit(std::uint32_t address, const ProcessImage& image) const;

  /// The axis that function 43/13 names by its node number; nullptr: there is none here. In a view of one axis, node 0
  /// is that axis too.
  [[nodiscard]] const AxisImage* axis_of_node(std::uint16_t node, const ProcessImage& image) const;

 private:
  explicit UnitView(AxisNumber only_axis) : only_axis_(only_axis) {}
  AxisNumber only_axis_;  ///< 0: the flat map
};

}  // namespace axisgate::modbus_tcp
