// SPDX-License-Identifier: Apache-2.0
// What an axis needs of its drive: a place in the queue of its bus, and somewhere to tell what happened. Promises that
// nothing of the axis is called from inside. Never shows a bus or a wire.
#pragma once

#include <boost/noncopyable.hpp>
#include <string>

#include "adapters/bus/bus_job.hpp"
#include "gateway/image/events.hpp"

namespace axisgate::drive {

class AxisHost : boost::noncopyable {
 public:
  virtual ~AxisHost() = default;
  struct Queued {
    Errc code = Errc::ok;  ///< ok or queue_full
    bus::JobId id = 0;
    bool joined = false;
  };
  [[nodiscard]] virtual Queued queue(bus::BusJob job) = 0;
  virtual void job_waits(bus::JobId id, Instant until) = 0;
  virtual void job_done(bus::JobId id) = 0;
  /// A stop's bus job goes on as another: the rest of its write batch. False: there is no room for it.
  [[nodiscard]] virtual bool job_goes_on_as(bus::JobId id, const bus::BusJob& rest) = 0;
  virtual void event(AxisNumber axis, EventKind kind, std::uint32_t code, std::string text) = 0;
};

}  // namespace axisgate::drive
