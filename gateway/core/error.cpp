// SPDX-License-Identifier: Apache-2.0
#include "gateway/core/error.hpp"

#include <array>
#include <cassert>

namespace axisgate {
namespace {

struct Row {
  Errc code;
  std::string_view text;
  ModbusException exception;
  CommandResult result;
};

using enum ModbusException;
// The table of design 3.3 Outcomes, one row a code, in the order of the enumeration.
constexpr std::array<Row, kErrcCount> kRows{{
    {Errc::ok, "done", none, CommandResult::done},
    {Errc::illegal_function, "function not available", illegal_function, CommandResult::none},
    {Errc::not_supported, "not available on this drive", illegal_data_address, CommandResult::none},
    {Errc::bad_value, "value outside limits", illegal_data_value, CommandResult::none},
    {Errc::role_forbidden, "role may not do this", illegal_function, CommandResult::none},
    {Errc::state_unsuitable, "axis state unsuitable", server_device_failure, CommandResult::state_unsuitable},
    {Errc::stop_owed, "a stop is owed first", server_device_busy, CommandResult::state_unsuitable},
    {Errc::busy, "not possible now", server_device_busy, CommandResult::state_unsuitable},
    {Errc::queue_full, "queue full", server_device_busy, CommandResult::none},
    {Errc::superseded, "superseded before it was sent", server_device_busy, CommandResult::superseded},
    {Errc::never_started, "not started in time", server_device_busy, CommandResult::never_started},
    {Errc::dropped_by_stop, "dropped by a stop", server_device_busy, CommandResult::never_started},
    {Errc::stopped_by_other, "stopped by another client", server_device_busy, CommandResult::stopped_by_other},
    {Errc::still_in_setup, "axis still in setup", server_device_busy, CommandResult::never_started},
    {Errc::identity_mismatch, "drive is not the configured one", server_device_busy, CommandResult::never_started},
    {Errc::not_owner, "another client owns the axis", server_device_busy, CommandResult::not_owner},
    {Errc::offline, "bus down or axis offline, nothing sent", gateway_path_unavailable, CommandResult::never_started},
    {Errc::no_path, "no such unit or axis", gateway_path_unavailable, CommandResult::none},
    {Errc::refused_by_drive, "refused by the drive", server_device_failure, CommandResult::refused_by_drive},
    {Errc::timed_out, "no acknowledgement, outcome unknown", gateway_target_failed, CommandResult::outcome_unknown},
    {Errc::link_lost, "link lost, outcome unknown", gateway_target_failed, CommandResult::outcome_unknown},
    {Errc::bad_reply, "reply does not fit the request", gateway_target_failed, CommandResult::outcome_unknown},
    {Errc::not_reached, "the state was not reached in time", server_device_failure, CommandResult::not_reached},
    {Errc::not_new, "not new: write 0 first", server_device_busy, CommandResult::not_new},
}};

constexpr bool rows_in_order() {
  for (std::size_t i = 0; i < kRows.size(); ++i)
    if (static_cast<std::size_t>(kRows[i].code) != i) return false;
  return true;
}
static_assert(rows_in_order(), "every Errc needs its row, in the order of the enumeration");

const Row& row(Errc code) {
  const auto index = static_cast<std::size_t>(code);
  assert(index < kRows.size());
  return kRows[index];
}

}  // namespace

std::string_view text(Errc code) { return row(code).text; }
ModbusException modbus_exception(Errc code) { return row(code).exception; }
CommandResult command_result(Errc code) { return row(code).result; }

std::uint8_t dds_result(Errc code) {
  if (row(code).result != CommandResult::none) return static_cast<std::uint8_t>(row(code).result);
  switch (row(code).exception) {
    case illegal_data_address:
      return 16;
    case illegal_data_value:
      return 17;
    case illegal_function:
      return 18;
    case server_device_busy:
      return 19;
    default:
      return 20;
  }
}

}  // namespace axisgate
