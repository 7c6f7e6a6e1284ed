// SPDX-License-Identifier: Apache-2.0
// A drive on a Modbus RTU line as a table of 16-bit registers: functions 3, 6 and 16, ranges, holes (exception 2), and
// its power and boot, one millisecond after the other. Promises that a request is checked whole before any of it acts,
// and counts what the bus wrote to each register. Never gives a register a meaning: the drives do, by shown() and
// written().
#pragma once

#include <map>
#include <optional>
#include <set>

#include "tests/simulated/rtu_slave.hpp"

namespace axisgate::simulated {

struct RegisterRow {
  std::uint16_t number;
  bool writable = false;
  std::int64_t initial = 0;
  std::int64_t minimum = 0;  // below 0: a signed register
  std::int64_t maximum = 65535;
};

class RegisterSlave : public RtuSlave {
 public:
  RtuBytes answer(RtuView pdu, std::uint64_t tag, Time now) final;
  RtuBytes refusal(RtuView pdu, RtuException code) const final;
  void advance(Time now) final;
  void restart(Time now) override;
  bool listens() const final { return !booting(); }
  bool obeys_broadcast(std::uint8_t address) const final { return address == 0; }
  int longest_pause() const final { return 15; }  // 1.5 characters

  // What a world does to it and looks at.
  void lack(std::set<std::uint16_t> registers) { lacks_ = std::move(registers); }  // of another type: refused
  std::optional<std::int64_t> peek(std::uint16_t number) const;
  RtuException poke(std::uint16_t number, std::int64_t value);  // as the maker's tool would write it: not counted
  std::uint64_t writes(std::uint16_t number) const;
  const std::map<std::uint16_t, RegisterRow>& rows() const { return rows_; }
  bool booting() const { return boot_until_.has_value(); }
  std::uint64_t restarts() const { return restarts_; }

 protected:
  RegisterSlave(std::map<std::uint16_t, RegisterRow> rows, Time boot_time)
      : rows_(std::move(rows)), boot_time_(boot_time) {
    forget();
  }

  virtual void power_up() = 0;
  virtual void step() = 0;           // a millisecond
  virtual bool at_rest() const = 0;  // nothing becomes of it until a request comes

  // What a register shows that is not simply held.
  virtual std::optional<std::int64_t> shown(std::uint16_t number) const = 0;
  virtual void written(std::uint16_t number, std::int64_t value, std::uint64_t tag) = 0;
  virtual void was_read(std::uint16_t) {}

  std::int64_t held(std::uint16_t number) const { return values_.at(number); }
  void hold(std::uint16_t number, std::int64_t value) { values_.at(number) = value; }
  // Signed 32 bits, the high register first.
  std::int64_t held_pair(std::uint16_t high) const;
  void forget();  // everything as it was at first

  static std::int64_t high_of(std::int64_t value) { return value >> 16 & 0xFFFF; }
  static std::int64_t low_of(std::int64_t value) { return value & 0xFFFF; }

 private:
  RtuException write(const RegisterRequest& request, std::uint64_t tag);

  std::map<std::uint16_t, RegisterRow> rows_;
  std::map<std::uint16_t, std::int64_t> values_;
  std::map<std::uint16_t, std::uint64_t> writes_;
  std::set<std::uint16_t> lacks_;
  const Time boot_time_;
  std::int64_t ticks_ = 0;
  std::optional<Time> boot_until_;
  std::uint64_t restarts_ = 0;
};

}  // namespace axisgate::simulated
