// SPDX-License-Identifier: Apache-2.0
// A drive behind a CAN node: the node speaks CiA 301, the drive holds the objects and moves.
// Promises that reads and writes act at once. Never sees a frame.
#pragma once

#include <string>

#include "tests/simulated/can_frames.hpp"
#include "tests/simulated/object_dictionary.hpp"

namespace axisgate::simulated {

// SDO abort codes that are no Refusal (CiA 301 7.2.4.3.17; LD2 appendix D).
namespace sdo_abort {
inline constexpr std::uint32_t toggle = 0x05030000;
inline constexpr std::uint32_t command = 0x05040001;
inline constexpr std::uint32_t block_size = 0x05040002;
inline constexpr std::uint32_t crc = 0x05040004;
inline constexpr std::uint32_t out_of_memory = 0x05040005;
inline constexpr std::uint32_t unsupported_access = 0x06010000;
inline constexpr std::uint32_t no_mapping = 0x06040041;
inline constexpr std::uint32_t mapping_too_long = 0x06040042;
inline constexpr std::uint32_t too_long = 0x06070012;
inline constexpr std::uint32_t no_such_sub = 0x06090011;
}  // namespace sdo_abort

constexpr std::uint32_t abort_of(Refusal refusal) { return static_cast<std::uint32_t>(refusal); }

struct ObjectReply {
  std::uint32_t abort = 0;  // 0: here it is
  CanBytes bytes{};
};

class ObjectAccess {
 public:
  ObjectAccess() = default;
  ObjectAccess(const ObjectAccess&) = delete;
  ObjectAccess& operator=(const ObjectAccess&) = delete;
  virtual ~ObjectAccess() = default;
  virtual ObjectReply read(ObjectKey key, Time now) = 0;
  // An abort code, or 0.
  virtual std::uint32_t write(ObjectKey key, CanView bytes, std::uint64_t tag, Time now) = 0;
};

enum class PdoDirection : std::uint8_t { from_drive, to_drive };
enum class MasterLoss : std::uint8_t { heartbeat, guarding };

class CanDevice : public ObjectAccess {
 public:
  // The number that a PDO carries of it; none: there is no such object. read() says the same, at the price of a buffer:
  // a PDO asks in each millisecond.
  virtual std::optional<std::uint32_t> mapped(ObjectKey key, Time now) {
    const ObjectReply reply = read(key, now);
    return reply.abort == 0 ? std::optional(little_endian(reply.bytes)) : std::nullopt;
  }
  virtual bool may_be_mapped(ObjectKey key, PdoDirection direction) const = 0;
  // As another port would write it, measured values that nothing computes too; an abort code or 0.
  virtual std::uint32_t poke(ObjectKey key, std::int64_t value) = 0;
  virtual void advance(Time now) = 0;
  virtual void restart(Time now) = 0;
  virtual bool booting() const = 0;
  virtual void connect() = 0;  // the communication begins anew: boot, NMT reset of it, a master that was gone
  virtual void lose_master(MasterLoss how, Time now) = 0;
  virtual std::uint16_t error_code() const = 0;  // what an EMCY would tell; 0: none
  virtual std::uint8_t error_register() const = 0;
  virtual std::uint64_t stores() const = 0;  // saves done so far; the node's settings are saved with them
  virtual std::string describe() const = 0;  // "jd@1"
};

}  // namespace axisgate::simulated
