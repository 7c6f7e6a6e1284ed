// SPDX-License-Identifier: Apache-2.0
// What an SDO server of a small stack does otherwise than CiA 301 7.2.4.3 has it: answers without a size, in four bytes
// whatever the object has, aborts that name no object, answers that name another one.
// Promises that of an answer nothing is changed but that, and that a switch which is off draws no random number.
// Never makes or drops an answer.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "tests/simulated/can_frames.hpp"
#include "tests/simulated/object_entry.hpp"
#include "tests/simulated/random.hpp"

namespace axisgate::simulated {

enum class SdoFault : std::uint8_t {
  unsized,        // e = 1, s = 0; above the object stands what was in the buffer before
  wide,           // four bytes, zeros above the object
  wide_sign,      // four bytes, the object's highest bit above it
  unnamed_abort,  // an abort names 0000h:00
  other_object,   // the answer names the object's neighbour
};

inline constexpr std::size_t sdo_fault_count = 5;

std::string_view name_of(SdoFault fault);
std::optional<SdoFault> sdo_fault_named(std::string_view name);

class SdoFaults {
 public:
  // Of answers to requests for `only`; none: for any object.
  void set_rate(SdoFault fault, double probability, std::optional<ObjectKey> only = {}) {
    switch_of(fault, only).rate = probability;
  }
  void next(SdoFault fault, std::uint64_t times = 1, std::optional<ObjectKey> only = {}) {
    switch_of(fault, only).next = times;
  }
  void clear() { switches_.clear(); }

  // The answer as this server gives it.
  CanBytes spoil(CanBytes answer, Random& random);

 private:
  struct Switch {
    SdoFault fault;
    std::optional<ObjectKey> only;
    double rate = 0;
    std::uint64_t next = 0;
  };
  Switch& switch_of(SdoFault fault, std::optional<ObjectKey> only);
  bool strikes(SdoFault fault, ObjectKey object, Random& random);

  std::vector<Switch> switches_;
  CanBytes buffer_ = CanBytes(longest_can_frame);  // the answer before
};

}  // namespace axisgate::simulated
