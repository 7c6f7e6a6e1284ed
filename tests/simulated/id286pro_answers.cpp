// SPDX-License-Identifier: Apache-2.0
// Requests to the iD286pro's registers, and what a write leads to (iD286pro 2, 3, 4).
#include <algorithm>

#include "tests/simulated/id286pro.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::uint16_t user_command = 206;
constexpr std::uint16_t control_command = 323;
constexpr std::uint16_t target = 313;

}  // namespace

RtuBytes Id286pro::refusal(RtuView pdu, RtuException code) const {
  return exception_pdu(static_cast<std::uint8_t>(pdu[0] | 0x80U), code);
}

RtuBytes Id286pro::answer(RtuView pdu, std::uint64_t tag, Time now) {
  advance(now);
  const std::uint8_t asked = pdu[0];
  if (asked != function::read && asked != function::write_one && asked != function::write_several) {
    return refusal(pdu, RtuException::function);
  }
  const auto request = register_request(pdu);
  if (!request || request->count == 0 || request->count > options_.most_registers) {
    return refusal(pdu, RtuException::value);
  }
  if (asked == function::read) return read(*request, pdu);
  const RtuException refused = write(*request, tag);
  return refused == RtuException::none ? write_reply(*request) : refusal(pdu, refused);
}

RtuBytes Id286pro::read(const RegisterRequest& request, RtuView pdu) {
  for (const Id286proRow& row : id286pro_rows()) {
    if (const auto value = measured(row.number)) registers_.set(row.number, *value);
  }
  const auto asked_for = [&](std::uint16_t row) { return row >= request.start && row < request.start + request.count; };
  if (std::ranges::any_of(lacks_, asked_for)) return refusal(pdu, RtuException::address);
  const auto words = registers_.words(request.start, request.count, options_.holes_read_zero);
  return words ? read_reply(*words) : refusal(pdu, RtuException::address);
}

RtuException Id286pro::write(const RegisterRequest& request, std::uint64_t tag) {
  const auto checked = registers_.check(request.start, request.values);
  if (const auto* refused = std::get_if<RtuException>(&checked)) return *refused;
  const auto& changes = std::get<Id286proRegisters::Changes>(checked);
  const bool all = std::all_of(changes.begin(), changes.end(), [this](const auto& change) { return may_act(change); });
  if (!all && options_.refuses_what_cannot_act) return RtuException::device;
  for (const auto& change : changes) {
    registers_.apply(change);
    written(change, tag);
  }
  return RtuException::none;
}

bool Id286pro::may_act(const Id286proRegisters::Change& change) const {
  if (change.row == nullptr) return true;
  if (change.number == control_command) return can_obey(static_cast<std::uint16_t>(change.value));
  return change.number != user_command || !motion_.running();
}

void Id286pro::written(const Id286proRegisters::Change& change, std::uint64_t tag) {
  if (change.row == nullptr) return;
  switch (change.number) {
    case user_command:
      if (!motion_.running()) obey_user_command(change.value);
      break;
    case target:  // "changing the target while moving takes effect", of an absolute move alone
      if (!numb_ && motion_.task() == Id286proMotion::Task::absolute) motion_.retarget(change.value * fine_per_count);
      break;
    case 307:
      if (options_.speed_follows_register && motion_.task() == Id286proMotion::Task::speed) obey(3, tag);
      break;
    case control_command:
      obey(static_cast<std::uint16_t>(change.value), tag);
      if (!options_.command_reads_back) registers_.set(control_command, 0);
      break;
    default:
      if (change.number >= 400 && change.number <= 412) {
        inputs_.configure(registers_);
        inputs_.follow(options_.mechanics, axis_.physical());
        scan_inputs();
      }
  }
}

std::int64_t Id286pro::motor_current() const {
  if (!enabled()) return 0;
  const bool idle = !motion_.running() && now_ - moved_at_ >= registers_.get(245) * one_millisecond;
  return idle ? registers_.get(241) * registers_.get(213) / 100 : registers_.get(241);
}

std::optional<std::int64_t> Id286pro::measured(std::uint16_t row) const {
  const std::int64_t revolution = registers_.get(242) * fine_per_count;
  switch (row) {
    case 100:
      return motor_current();
    case 101:
      return voltage_;
    case 104:
      return registers_.get(242);
    case 106:
      return registers_.get(244);
    case 108:
      return fault_;
    case 109:
      return static_cast<std::int64_t>(run_state());
    case 117:
      return position();
    case 119:
      return divide_rounded(axis_.speed() * 100'000, revolution);
    default:
      return std::nullopt;
  }
}

RtuException Id286pro::poke(std::uint16_t row, std::int64_t value) {
  const Id286proRow* found = registers_.row_at(row);
  if (found == nullptr || found->number != row) return RtuException::address;
  if (row == 101) {
    voltage_ = value;
    return RtuException::none;
  }
  if (found->saved == Saved::read_only) return RtuException::address;
  if (value < found->minimum || value > found->maximum) return RtuException::value;
  if (found->saved == Saved::no) {
    registers_.set(row, value);
  } else {
    registers_.set_stored(row, value);
  }
  written({found, row, value}, 0);
  return RtuException::none;
}

std::optional<std::int64_t> Id286pro::peek(std::uint16_t row) const {
  const Id286proRow* found = registers_.row_at(row);
  if (found == nullptr || found->number != row) return std::nullopt;
  const auto value = measured(row);
  return value ? *value : registers_.get(row);
}

}  // namespace axisgate::simulated
