// SPDX-License-Identifier: Apache-2.0
// A line with simulated drives as the host's end of the cable sees it, whatever is spoken on it: bytes in, bytes out,
// time pushed in. Promises to deliver nothing outside from_host() and advance(), and the same bytes at the same times
// for the same seed and calls. Never reads a clock.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "tests/simulated/drive_faults.hpp"

namespace axisgate::simulated {

enum class ByteOrigin : std::uint8_t { echo, reply, noise };

struct ToHost {
  Time at;            // when the last of the bytes has arrived
  std::uint64_t tag;  // of the request that caused a reply; 0 for echo and noise
  ByteOrigin origin;
  std::span<const std::uint8_t> bytes;
};

// An adapter that hears itself brings back what the host sends; one that is looped brings back that alone.
enum class AdapterEcho : std::uint8_t { off, on, only };

using ToHostSink = std::function<void(const ToHost&)>;  // may call from_host()

class DriveLine {
 public:
  DriveLine() = default;
  DriveLine(const DriveLine&) = delete;
  DriveLine& operator=(const DriveLine&) = delete;
  virtual ~DriveLine() = default;

  virtual std::size_t size() const = 0;
  virtual DriveFaults& faults(std::size_t position) = 0;
  virtual bool has(DriveFault fault) const = 0;              // can this fault strike on such a line?
  virtual void set_reply_delay(Time delay) = 0;              // of every drive on it
  virtual void restart(std::size_t position, Time now) = 0;  // with it go the replies it had not sent yet

  virtual void from_host(std::span<const std::uint8_t> bytes, Time now) = 0;
  virtual void advance(Time now) = 0;
  virtual std::optional<Time> next_event() const = 0;
  virtual void cut() = 0;  // the cable is pulled: bytes under way are gone
  virtual std::uint64_t requests_heard() const = 0;

  void set_echo(AdapterEcho echo) { adapter_echo_ = echo; }  // serial lines alone

 protected:
  AdapterEcho adapter_echo_ = AdapterEcho::off;
};

}  // namespace axisgate::simulated
