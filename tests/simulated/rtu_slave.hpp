// SPDX-License-Identifier: Apache-2.0
// A drive on a Modbus RTU line as the line sees it, whatever it is: PDUs and times in, PDUs out.
// Promises that answer() acts at once and tells what the drive holds at that instant; when the answer leaves is the
// line's part. Never sees a CRC, a gap or another slave.
#pragma once

#include <string>

#include "tests/simulated/rtu_frame.hpp"
#include "tests/simulated/time.hpp"

namespace axisgate::simulated {

class RtuSlave {
 public:
  RtuSlave() = default;
  RtuSlave(const RtuSlave&) = delete;
  RtuSlave& operator=(const RtuSlave&) = delete;
  virtual ~RtuSlave() = default;

  virtual RtuBytes answer(RtuView pdu, std::uint64_t tag, Time now) = 0;
  // The error reply this drive gives to this request.
  virtual RtuBytes refusal(RtuView pdu, RtuException code) const = 0;
  virtual void advance(Time now) = 0;
  virtual void restart(Time now) = 0;
  virtual bool listens() const = 0;  // not while it boots, nor while its port speaks another protocol
  virtual std::uint8_t unit() const = 0;
  virtual bool obeys_broadcast(std::uint8_t address) const = 0;
  virtual Time answer_delay() const = 0;  // from the request's last byte to the answer's first
  // A pause inside a frame that is longer, in tenths of a character, aborts it.
  virtual int longest_pause() const = 0;
  virtual std::string describe() const = 0;  // "jd@1"
};

}  // namespace axisgate::simulated
