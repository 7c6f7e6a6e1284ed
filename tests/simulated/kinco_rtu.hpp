// SPDX-License-Identifier: Apache-2.0
// A Kinco JD or MD on its RS485 port speaking Modbus RTU (JD 2.2, MD 3): the same drive, reached by registers.
// Promises functions 3, 6 and 16 over the registers the sheet gives, one object per request, low word first, and the
// error replies both manuals print. Never reaches an object without a printed base, nor half of a 32-bit one.
#pragma once

#include "tests/simulated/kinco_drive.hpp"
#include "tests/simulated/kinco_registers.hpp"
#include "tests/simulated/rtu_slave.hpp"

namespace axisgate::simulated {

// What the sheets leave open (JD 10.2, MD 12.2), so tests may choose.
struct KincoRtuOptions {
  std::uint8_t read_error_function = 0x81;  // both manuals print it for function 3; the standard's is 0x83 (K1, C9)
  bool serves_derived = true;               // registers that follow from the rule but are not printed
  bool refuses_out_of_range = true;         // so JD 2.2; of all ports the manual says that values are clamped (K43)
  bool sign_extends_bytes = true;           // how a negative 8-bit value reads: 0xFFFD or 0x00FD
  std::uint16_t second_register = 0;        // what a 16-bit object gives when it is asked for two registers (K37)
  Time answer_delay{};
};

struct KincoRtuDrive {
  DriveOptions drive;
  KincoRtuOptions rtu;
};

class KincoRtu final : public RtuSlave {
 public:
  // An MD is taken to be set to Modbus and stored: it leaves the factory with 6510:0C = 1 (MD 3.1).
  explicit KincoRtu(const KincoRtuDrive& options);

  KincoDrive& drive() { return drive_; }
  const KincoDrive& drive() const { return drive_; }
  const KincoRegisters& registers() const { return registers_; }

  RtuBytes answer(RtuView pdu, std::uint64_t tag, Time now) override;
  RtuBytes refusal(RtuView pdu, RtuException code) const override;
  void advance(Time now) override { drive_.advance(now); }
  void restart(Time now) override { drive_.restart(now); }
  bool listens() const override { return !drive_.booting() && drive_.rs485_speaks_modbus(); }
  std::uint8_t unit() const override { return drive_.station(); }
  bool obeys_broadcast(std::uint8_t address) const override { return address == 0; }
  Time answer_delay() const override { return options_.answer_delay; }
  int longest_pause() const override { return 35; }  // the sheets know the gap between frames only
  std::string describe() const override;

 private:
  const ObjectEntry* entry_at(std::uint16_t number) const;
  RtuBytes read(const RegisterRequest& request, Time now);
  RtuException write(const RegisterRequest& request, std::uint64_t tag, Time now);

  const KincoRtuOptions options_;
  KincoDrive drive_;
  KincoRegisters registers_;
};

}  // namespace axisgate::simulated
