// SPDX-License-Identifier: Apache-2.0
// The lone half of a 32-bit row that a panel with function 6 alone has written ("halves": "staged"), until the other
// half comes. Promises that it is kept for kHalfKept at most, and changes nothing but what is written with the other
// half. Never reads a clock, and never knows what the row means.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "gateway/core/clock.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/upstream/modbus_tcp/read/unit_view.hpp"
#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"

namespace axisgate::modbus_tcp {

inline constexpr Duration kHalfKept = std::chrono::seconds(1);

/// What one request of function 6 writes where it is half of a 32-bit row that can be written.
struct HalfWrite {
  AxisNumber axis = 0;
  std::uint16_t row = 0;      ///< offset of its first register in the axis's block
  std::uint16_t address = 0;  ///< of that register, as the request counts
  bool second = false;        ///< the register behind it
  std::uint16_t word = 0;
};
/// No value: the request is none.
[[nodiscard]] std::optional<HalfWrite> half_write(const Request& request, const UnitView& view,
                                                  const ProcessImage& image);

/// Both registers of the row by one request of function 6; `other`: what the other half holds.
[[nodiscard]] Request whole_write(const HalfWrite& half, std::uint16_t other);

class StagedHalf {
 public:
  [[nodiscard]] const std::optional<HalfWrite>& waiting() const { return waiting_; }
  /// When the half that waits has waited long enough; kNever where none does.
  [[nodiscard]] Instant until() const { return waiting_ ? until_ : kNever; }
  void keep(const HalfWrite& half, Instant now);
  /// The half that waits, where it is the other one of this row; it waits no longer.
  [[nodiscard]] std::optional<HalfWrite> take_other(const HalfWrite& half);
  /// The half that waited; it waits no longer.
  [[nodiscard]] std::optional<HalfWrite> take();

 private:
  std::optional<HalfWrite> waiting_{};
  Instant until_ = kNever;
};

}  // namespace axisgate::modbus_tcp
