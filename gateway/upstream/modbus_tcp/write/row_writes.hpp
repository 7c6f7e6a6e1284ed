// SPDX-License-Identifier: Apache-2.0
// A register write resolved into rows of the map, and the checks of it: role, then addresses, then values (design 3.3).
// Promises that a long value is written whole or not at all, and that rows the drive already holds, or
// its client has not changed, ask no role.
// Never changes anything: what passed is carried out by plan_register_write().
#pragma once

#include <boost/container/static_vector.hpp>

#include "gateway/upstream/modbus_tcp/read/row_values.hpp"
#include "gateway/upstream/modbus_tcp/read/unit_view.hpp"
#include "gateway/upstream/modbus_tcp/wire/pdu.hpp"

namespace axisgate::modbus_tcp {

struct RowWrite {
  const RegisterRow* row;
  const AxisImage* axis;                    ///< nullptr: of the gateway block
  std::int64_t value;                       ///< in register units
  std::optional<std::uint32_t> as_float{};  ///< where it was written as IEEE 754: its bits
  bool ignored = false;  ///< in a block: this drive does not have it, or its 0 means "leave as it is"
  bool cached = false;   ///< in a block: the drive holds it already, so no role and no range is asked
  bool held = false;     ///< in a block: its client wrote the same there last, so no role is asked
  [[nodiscard]] bool skipped() const { return ignored || cached; }
};

struct RowWrites {
  boost::container::static_vector<RowWrite, kMaxWriteRegisters> rows;
  const AxisImage* axis = nullptr;  ///< nullptr: the gateway block
  bool outside = false;             ///< something in it is no whole writable row
  bool masks = false;               ///< FC 22 with bits that stay as they are
  bool block = false;               ///< more than one row, or FC 23
  bool zeros = false;               ///< a block that covers 40..54 and is 0 in all of it: a scanner's image before its
                                    ///< program runs
  /// Where something is that is no whole writable row, of `outside`: its row's offset, or its own.
  std::uint16_t outside_at = 0;
  bool several = false;  ///< more than one row is touched, whole or not: what is refused is a block write
  [[nodiscard]] const RowWrite* of(Source source) const;
};

/// Rows 41 to 79 that are values; not controlword, command, its id and the heartbeat, which have rules of their own.
[[nodiscard]] bool is_remembered(const RegisterRow& row);

[[nodiscard]] RowWrites resolve_rows(const Request& request, const UnitView& view, const Onlooker& onlooker);
/// Role, then addresses, then values: what is wrong first, and the first row of which it is. Axis limits are the
/// command port's to check.
struct WrongRow {
  Errc code = Errc::ok;
  std::uint16_t row = 0;
};
[[nodiscard]] WrongRow check_rows(const RowWrites& writes, Role role);
/// The same but for the values.
[[nodiscard]] WrongRow check_role_and_addresses(const RowWrites& writes, Role role);
/// `wrong`, or an earlier row that the axis would refuse with the same answer, for its limits.
[[nodiscard]] WrongRow first_refused(const RowWrites& writes, const WrongRow& wrong);

}  // namespace axisgate::modbus_tcp
