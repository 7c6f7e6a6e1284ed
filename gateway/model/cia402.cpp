// SPDX-License-Identifier: Apache-2.0
#include "gateway/model/cia402.hpp"

#include <array>

namespace axisgate::model {
namespace {

struct StateRow {
  std::uint16_t mask;
  std::uint16_t value;
  State402 state;
  std::string_view text;
};

// CiA 402-2 table 30. x in the standard is a 0 in the mask.
constexpr std::array<StateRow, 8> kStates{{
    {0x4F, 0x00, State402::not_ready_to_switch_on, "not ready to switch on"},
    {0x4F, 0x40, State402::switch_on_disabled, "switch on disabled"},
    {0x6F, 0x21, State402::ready_to_switch_on, "ready to switch on"},
    {0x6F, 0x23, State402::switched_on, "switched on"},
    {0x6F, 0x27, State402::operation_enabled, "operation enabled"},
    {0x6F, 0x07, State402::quick_stop_active, "quick stop active"},
    {0x4F, 0x0F, State402::fault_reaction_active, "fault reaction active"},
    {0x4F, 0x08, State402::fault, "fault"},
}};

struct RequestRow {
  std::uint16_t mask;
  std::uint16_t value;
  Request402 request;
};

// CiA 402-2 table 28, first match wins.
constexpr std::array<RequestRow, 6> kRequests{{
    {0x02, 0x00, Request402::disable_voltage},
    {0x06, 0x02, Request402::quick_stop},
    {0x0F, 0x06, Request402::shutdown},
    {0x0F, 0x07, Request402::switch_on},
    {0x0F, 0x0F, Request402::enable_operation},
    {0x0F, 0x0E, Request402::other},
}};

}  // namespace

State402 state_of(std::uint16_t statusword) {
  for (const StateRow& row : kStates)
    if ((statusword & row.mask) == row.value) return row.state;
  // A fault bit beside an impossible rest is still a fault; anything else is no state in which torque may be asked for.
  return (statusword & 0x08) != 0 ? State402::fault : State402::not_ready_to_switch_on;
}

std::string_view text(State402 state) {
  for (const StateRow& row : kStates)
    if (row.state == state) return row.text;
  return "unknown";
}

Request402 request_of(std::uint16_t controlword) {
  for (const RequestRow& row : kRequests)
    if ((controlword & row.mask) == row.value) return row.request;
  return Request402::other;
}

}  // namespace axisgate::model
