// SPDX-License-Identifier: Apache-2.0
// A duty of a drive, as its Drive walks over them: DriveCore is what all of them share, a DriveTask is one. Promises
// that a turn on the wire is the first task's that takes it, and that a task has one bus job of its own at most. Never
// decides: what there is to decide is pure, and a task asks it (DriveReads, BringUp, DriveControl, DriveEnd and so on).
#pragma once

#include <boost/noncopyable.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adapters/bus/bus.hpp"
#include "gateway/drive/axis/axis.hpp"
#include "gateway/drive/device/bring_up.hpp"
#include "gateway/drive/device/drive_reads.hpp"
#include "gateway/drive/device/node_presence.hpp"
#include "gateway/drive/device/requests.hpp"
#include "gateway/drive/plan/write_exchange.hpp"

namespace axisgate::drive {

/// What the tasks of one drive share, and what its axes need of it.
struct DriveCore final : AxisHost {
  DriveCore(model::DriveModel its, DriveSlot at, bus::Bus& line, EventRing& ring)
      : model(std::move(its)), slot(at), bus(line), events(ring) {}

  [[nodiscard]] bool brought_up() const { return turn.link == LinkState::online || turn.link == LinkState::suspect; }
  /// It is not there, and looked for.
  [[nodiscard]] bool sought() const { return turn.link == LinkState::unknown || turn.link == LinkState::offline; }
  /// What `next` asks for: a read, or a write in the width that the drive answered with last.
  [[nodiscard]] bus::Exchange exchange(const auto& next) const {
    if (!next.write) return read_of(model, next.object);
    bus::Exchange exchange = write_of(model, next.object, next.number);
    if (exchange.mask == 0) exchange.size = reads.width(next.object);
    return exchange;
  }
  void set_alarm(AxisAlarm alarm, bool on) {
    for (auto& axis : axes) axis->set_alarm(alarm, on);
  }
  void tell_all(EventKind kind, std::uint32_t code, const std::string& text) {
    for (const model::AxisModel& axis : model.axes) event(axis.number, kind, code, text);
  }

  // AxisHost
  [[nodiscard]] Queued queue(bus::BusJob job) override {
    job.drive = slot;
    const auto submission = bus.submit(job);
    return {submission.code, submission.id, submission.joined};
  }
  void job_waits(bus::JobId id, Instant until) override { bus.wait(id, until); }
  void job_done(bus::JobId id) override { bus.finish(id); }
  bool job_goes_on_as(bus::JobId id, const bus::BusJob& rest) override { return bus.go_on_as(id, rest); }
  void event(AxisNumber axis, EventKind kind, std::uint32_t code, std::string text) override {
    events.add(turn.now, axis, kind, code, std::move(text));
  }

  model::DriveModel model;  ///< its own: constants that are read from the drive change scales and limits
  DriveSlot slot;
  bus::Bus& bus;
  EventRing& events;
  Turn turn{.now = kLongAgo, .link = LinkState::link_down};
  ObjectStore store{model.objects};
  DriveReads reads{model, store};
  BringUp bring_up{model, bus.settings().timeout};
  NodePresence presence{model::is_canopen(model), bus.settings().timeout};
  std::vector<std::unique_ptr<Axis>> axes{};
};

/// The turn on the wire, and who asked for the exchange that it became.
struct OnWire {
  bus::JobId job = 0;    ///< 0: a poll or probe
  Axis* axis = nullptr;  ///< whose bus job it is; null: the drive's own
  bus::Priority priority = bus::Priority::poll;
  DriveReads::Asked read{};
  std::optional<AxisSlot> keeps_alive{};  ///< a repetition for this axis, or the look before it
  /// The bus job keeps its turn; this exchange is the drive's own.
  void becomes_own() {
    job = 0;
    axis = nullptr;
  }
};

/// An exchange that has ended.
struct Ended {
  const bus::Exchange& exchange;
  const bus::ExchangeResult& result;
  const OnWire& asked;
  bool trusted = false;                        ///< its reply can be no late one
  model::ObjectId written = model::kNoObject;  ///< none: it was no write of an object of the model
};

class DriveTask : boost::noncopyable {
 public:
  explicit DriveTask(DriveCore& core) : core_(core) {}
  virtual ~DriveTask() = default;

  [[nodiscard]] bool owns(bus::JobId job) const { return job != 0 && job == job_; }
  [[nodiscard]] virtual bool takes(const OnWire& turn) { return owns(turn.job); }
  /// What is sent in a turn that it takes; none: nothing after all.
  [[nodiscard]] virtual std::optional<bus::Exchange> next(OnWire& /*turn*/) { return std::nullopt; }
  /// Of each exchange of this drive.
  virtual void on_result(const Ended& /*ended*/) {}
  /// Its bus job was ended: the link or the drive is lost.
  virtual void on_lost() { job_ = 0; }
  /// Something has happened: it takes or gives up its place in the queue. When it must be asked again.
  [[nodiscard]] virtual Instant deadline() { return kNever; }
  /// Its bus job, if it has one, is over.
  void finish() {
    if (job_ != 0) core_.bus.finish(std::exchange(job_, 0));
  }

 protected:
  /// It neither waits for the bus jobs of axes nor is joined or superseded by one. False: there is no room for it.
  bool queue(bus::Priority priority) {
    bus::BusJob job;
    job.priority = priority;
    const AxisHost::Queued queued = core_.queue(job);
    job_ = queued.code == Errc::ok ? queued.id : 0;
    return job_ != 0;
  }
  [[nodiscard]] bus::JobId job() const { return job_; }

  DriveCore& core_;

 private:
  bus::JobId job_ = 0;  ///< 0: none
};

}  // namespace axisgate::drive
