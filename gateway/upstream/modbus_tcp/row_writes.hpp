// A register write resolved into rows of the map, and the checks of it: role, then addresses, then values (design 3.3).
// Promises that a long value is written whole or not at all, and that rows the drive already holds ask no role.
// Never changes anything: what passed is carried out by plan_register_write().
#pragma once

#include <boost/container/static_vector.hpp>

#include "gateway/upstream/modbus_tcp/pdu.hpp"
#include "gateway/upstream/modbus_tcp/row_values.hpp"
#include "gateway/upstream/modbus_tcp/unit_view.hpp"

namespace axisgate::modbus_tcp {

struct RowWrite {
  const RegisterRow* row;
  std::int64_t value;
  bool skipped = false;  ///< in a block: already held
};

struct RowWrites {
  boost::container::static_vector<RowWrite, kMaxWriteRegisters> rows;
  const AxisImage* axis = nullptr;  ///< nullptr: the gateway block
  bool outside = false;             ///< something in it is no whole writable row
  bool masks = false;               ///< FC 22 with bits that stay as they are
  [[nodiscard]] const RowWrite* of(Source source) const;
};

[[nodiscard]] RowWrites resolve_rows(const Request& request, const UnitView& view, const Onlooker& onlooker);
/// ok, role_forbidden, not_supported or bad_value, in this order; axis limits are the command port's to check.
[[nodiscard]] Errc check_rows(const RowWrites& writes, Role role);

}  // namespace axisgate::modbus_tcp
