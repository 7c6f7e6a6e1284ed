#include "gateway/upstream/dds/dds_face.hpp"

#include <algorithm>
#include <utility>

#include "gateway/upstream/dds/dds_requests.hpp"
#include "gateway/upstream/dds/event_feed.hpp"
#include "gateway/upstream/dds/gateway_record.hpp"
#include "gateway/upstream/dds/state_feed.hpp"
#include "gateway/upstream/dds/state_record.hpp"

namespace axisgate::dds {
namespace {

UnitsOfAxes units_of(const std::vector<AxisUnits>& axes) {
  UnitsOfAxes units;
  for (const AxisUnits& each : axes) units.emplace(each.axis, DdsUnits(each));
  return units;
}

}  // namespace

struct DdsFace::Impl {
  Impl(DdsSettings with, ProcessImage& of, const EventRing& ring, CommandPort& commands, std::function<void()> on_wake,
       TellLine tell)
      : settings(std::move(with)),
        image(of),
        units(units_of(settings.units)),
        wake(std::move(on_wake)),
        clients(settings.role, image, commands),
        requests(
            settings, units, image, commands, clients, replies, [this] { wake_up(); }, std::move(tell)),
        events(ring),
        states(settings.min_period, settings.max_period) {
    add_axes(kLongAgo);
    image.changes.wake = [this] { wake_up(); };
  }

  void add_axes(Instant now) {
    for (const auto& axis : image.axes()) {
      units.try_emplace(axis->number);
      states.add(axis->number, now);
    }
  }
  [[nodiscard]] StateRecord state_of(AxisNumber axis) {
    if (const AxisImage* const there = image.find(axis)) return state_record(*there, units.at(axis));
    states.remove(axis);
    AxisImage gone;
    gone.number = axis;
    return state_record(gone, DdsUnits());
  }

  void wake_up() const {
    if (link_up) wake();
  }
  void take_changes(Instant now) {
    image.changes.take([&](std::size_t axis) { states.changed(static_cast<AxisNumber>(axis), now); });
  }
  [[nodiscard]] Record gateway_sample(Instant now) {
    gateway_due = now + kGatewayPeriod;
    return gateway_record(image, events.lost());
  }

  DdsSettings settings;
  ProcessImage& image;
  UnitsOfAxes units;
  std::function<void()> wake;
  DdsClients clients;
  ReplyQueue replies{kMaxRepliesWaiting};
  DdsRequests requests;
  EventFeed events;
  StateFeed states;
  Instant gateway_due = kLongAgo;
  bool link_up = false;
};

DdsFace::DdsFace(DdsSettings settings, ProcessImage& image, const EventRing& events, CommandPort& commands,
                 std::function<void()> wake, std::function<void(const std::string&)> tell)
    : impl_(std::make_unique<Impl>(std::move(settings), image, events, commands, std::move(wake), std::move(tell))) {}

DdsFace::~DdsFace() {
  impl_->image.changes.wake = [] {};
}

void DdsFace::take_axes(const std::vector<AxisUnits>& units, Instant now) {
  impl_->units = units_of(units);
  impl_->add_axes(now);
  impl_->states.all_due(now);
  impl_->wake_up();
}

void DdsFace::on_link_up(Instant now) {
  Impl& it = *impl_;
  it.link_up = true;
  it.replies.open();
  it.clients.on_link_up(now);
  it.events.restart();
  it.states.all_due(now);
  it.gateway_due = now;
}

void DdsFace::on_link_down(Instant) {
  Impl& it = *impl_;
  it.link_up = false;
  it.replies.close();
  it.clients.on_link_down();
}

void DdsFace::on_record(const Record& record, Instant now) {
  Impl& it = *impl_;
  if (const auto* const writer = std::get_if<WriterRecord>(&record)) it.clients.on_writer(*writer, now);
  if (const auto* const beats = std::get_if<BeatRecord>(&record)) it.clients.on_beats(*beats, now);
  if (const auto* const command = std::get_if<CommandRecord>(&record)) it.requests.on_command(*command, now);
  if (const auto* const object = std::get_if<ObjectRequestRecord>(&record)) it.requests.on_object(*object, now);
}

bool DdsFace::has_room() const { return impl_->replies.has_room(); }

std::optional<Record> DdsFace::next(Instant now) {
  Impl& it = *impl_;
  if (!it.link_up) return std::nullopt;
  it.clients.on_time(now);
  if (auto reply = it.replies.next()) return reply;
  if (auto event = it.events.next()) return Record(std::move(*event));
  it.take_changes(now);
  // Where the reader is so slow that some axis is always due, this one would never come.
  if (it.gateway_due + kGatewayPeriod <= now) return it.gateway_sample(now);
  if (const auto axis = it.states.next(now)) return it.state_of(*axis);
  if (it.gateway_due <= now) return it.gateway_sample(now);
  return std::nullopt;
}

Instant DdsFace::wake_at() const {
  const Impl& it = *impl_;
  if (!it.link_up) return kNever;
  if (!it.replies.empty() || it.events.waiting()) return kLongAgo;
  return std::min({it.states.due(), it.gateway_due, it.clients.deadline()});
}

}  // namespace axisgate::dds
