// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/register_slave.hpp"

#include <algorithm>

namespace axisgate::simulated {
namespace {

constexpr std::uint16_t most_registers = 100;  // of one request: both makers print frames of 200 bytes at most

std::int64_t number_in(const RegisterRow& row, std::uint16_t word) {
  return row.minimum < 0 ? static_cast<std::int16_t>(word) : static_cast<std::int64_t>(word);
}

}  // namespace

void RegisterSlave::advance(Time now) {
  const std::int64_t until = now / one_millisecond;
  while (ticks_ < until) {
    ticks_ = !booting() && at_rest() ? until : ticks_ + 1;
    if (booting() && ticks_ * one_millisecond >= *boot_until_) {
      boot_until_.reset();
      power_up();
    }
    step();
  }
}

void RegisterSlave::restart(Time now) {
  advance(now);
  ++restarts_;
  boot_until_ = now + boot_time_;
}

void RegisterSlave::forget() {
  for (const auto& [number, row] : rows_) values_[number] = row.initial;
}

std::int64_t RegisterSlave::held_pair(std::uint16_t high) const {
  const std::int64_t raw = low_of(held(high)) << 16 | low_of(held(static_cast<std::uint16_t>(high + 1)));
  return static_cast<std::int32_t>(raw);
}

RtuBytes RegisterSlave::refusal(RtuView pdu, RtuException code) const {
  return exception_pdu(static_cast<std::uint8_t>(pdu[0] | 0x80U), code);
}

RtuBytes RegisterSlave::answer(RtuView pdu, std::uint64_t tag, Time now) {
  advance(now);
  const std::uint8_t asked = pdu[0];
  if (asked != function::read && asked != function::write_one && asked != function::write_several)
    return refusal(pdu, RtuException::function);
  const auto request = register_request(pdu);
  if (!request || request->count == 0 || request->count > most_registers) return refusal(pdu, RtuException::value);
  for (std::uint32_t number = request->start; number < std::uint32_t{request->start} + request->count; ++number) {
    const auto key = static_cast<std::uint16_t>(number);
    if (number > 0xFFFF || !rows_.contains(key) || lacks_.contains(key)) return refusal(pdu, RtuException::address);
  }
  if (asked == function::read) {
    std::vector<std::uint16_t> words;
    for (std::uint16_t i = 0; i < request->count; ++i) {
      const auto number = static_cast<std::uint16_t>(request->start + i);
      words.push_back(static_cast<std::uint16_t>(*peek(number)));
      was_read(number);
    }
    return read_reply(words);
  }
  const RtuException refused = write(*request, tag);
  return refused == RtuException::none ? write_reply(*request) : refusal(pdu, refused);
}

RtuException RegisterSlave::write(const RegisterRequest& request, std::uint64_t tag) {
  std::vector<std::pair<std::uint16_t, std::int64_t>> changes;
  for (std::size_t i = 0; i < request.values.size(); ++i) {
    const auto number = static_cast<std::uint16_t>(request.start + i);
    const RegisterRow& row = rows_.at(number);
    const std::int64_t value = number_in(row, request.values[i]);
    if (!row.writable) return RtuException::address;
    if (value < row.minimum || value > row.maximum) return RtuException::value;
    changes.emplace_back(number, value);
  }
  for (const auto& [number, value] : changes) {
    hold(number, value);
    ++writes_[number];
  }
  for (const auto& [number, value] : changes) written(number, value, tag);
  return RtuException::none;
}

std::optional<std::int64_t> RegisterSlave::peek(std::uint16_t number) const {
  if (!rows_.contains(number)) return std::nullopt;
  const auto value = shown(number);
  return value ? *value : held(number);
}

RtuException RegisterSlave::poke(std::uint16_t number, std::int64_t value) {
  const auto found = rows_.find(number);
  if (found == rows_.end() || !found->second.writable) return RtuException::address;
  if (value < found->second.minimum || value > found->second.maximum) return RtuException::value;
  hold(number, value);
  written(number, value, 0);
  return RtuException::none;
}

std::uint64_t RegisterSlave::writes(std::uint16_t number) const {
  const auto found = writes_.find(number);
  return found == writes_.end() ? 0 : found->second;
}

}  // namespace axisgate::simulated
