// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/dds_session.hpp"

#include <algorithm>
#include <utility>

#include "gateway/upstream/dds/dds_requests.hpp"
#include "gateway/upstream/dds/gateway_record.hpp"
#include "gateway/upstream/dds/ros_requests.hpp"
#include "gateway/upstream/dds/state_record.hpp"
#include "gateway/upstream/dds/stop_order.hpp"
#include "gateway/upstream/feed/axis_feed.hpp"
#include "gateway/upstream/feed/event_feed.hpp"

namespace axisgate::dds {
namespace {

UnitsOfAxes units_of(const std::vector<AxisUnits>& axes) {
  UnitsOfAxes units;
  for (const AxisUnits& each : axes) units.emplace(each.axis, DdsUnits(each));
  return units;
}

EventRecord event_record(const Event& event) {
  return {event.axis,   event.at == kLongAgo ? 0 : event.at.time_since_epoch().count(),
          event.number, static_cast<std::uint8_t>(event.kind),
          event.code,   event.text};
}

}  // namespace

struct DdsSession::Impl {
  Impl(DdsSettings with, ProcessImage& of, const EventRing& ring, CommandPort& commands, std::function<void()> on_wake,
       DdsDomainReports to_tell)
      : settings(std::move(with)),
        image(of),
        units(units_of(settings.units)),
        wake(std::move(on_wake)),
        reports(std::move(to_tell)),
        signs(settings.max_age, settings.start_deadline),
        identities(settings),
        clients(identities, signs, image, commands),
        namesakes(image),
        requests({settings, units, image, commands, signs, namesakes, stop_order, reports.line}, clients, replies,
                 [this] { wake_up(); }),
        ros({settings, units, image, commands, signs, namesakes, stop_order, reports.line}, identities),
        events(ring),
        states(settings.min_period, settings.max_period),
        changes(image.changes, [this] { wake_up(); }) {
    add_axes(kLongAgo);
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
    changes.take([&](std::size_t axis) { states.changed(static_cast<AxisNumber>(axis), now); });
  }
  void look_at_name() {
    if (namesakes.taken() == name_taken) return;
    name_taken = namesakes.taken();
    if (reports.name_taken) reports.name_taken(name_taken, namesakes.text());
  }
  [[nodiscard]] Record gateway_sample(Instant now) {
    gateway_due = now + kGatewayPeriod;
    return gateway_record(image, events.lost());
  }

  DdsSettings settings;
  ProcessImage& image;
  UnitsOfAxes units;
  std::function<void()> wake;
  DdsDomainReports reports;
  SignsOfLife signs;
  Identities identities;
  DdsClients clients;
  Namesakes namesakes;
  bool name_taken = false;  ///< as it was told last
  StopOrder stop_order;
  ReplyQueue replies{kMaxRepliesWaiting};
  DdsRequests requests;
  RosRequests ros;
  feed::EventFeed events;
  feed::AxisFeed states;
  ChangeBoard::Reader changes;
  Instant gateway_due = kLongAgo;
  bool link_up = false;
};

DdsSession::DdsSession(DdsSettings settings, ProcessImage& image, const EventRing& events, CommandPort& commands,
                       std::function<void()> wake, DdsDomainReports reports)
    : impl_(std::make_unique<Impl>(std::move(settings), image, events, commands, std::move(wake), std::move(reports))) {
}

DdsSession::~DdsSession() = default;

void DdsSession::take_axes(const std::vector<AxisUnits>& units, Instant now) {
  impl_->units = units_of(units);
  impl_->add_axes(now);
  impl_->states.all_due(now);
  impl_->look_at_name();
  impl_->wake_up();
}

void DdsSession::on_link_up(Instant now) {
  Impl& it = *impl_;
  it.link_up = true;
  it.replies.open();
  it.clients.on_link_up(now);
  it.namesakes.on_link_up(now + kReturnsWithin);
  it.events.restart();
  it.states.all_due(now);
  it.gateway_due = now;
}

void DdsSession::on_link_down(Instant now) {
  Impl& it = *impl_;
  it.link_up = false;
  it.replies.close();
  it.clients.on_link_down(now);
  it.ros.on_link_down(now);
}

void DdsSession::on_record(const Record& record, Instant now) {
  Impl& it = *impl_;
  if (const auto* const writer = std::get_if<WriterRecord>(&record)) {
    const std::string line = it.clients.on_writer(*writer);
    const auto& tell = it.reports.once ? it.reports.once : it.reports.line;
    if (!line.empty() && tell) tell(line);
  }
  if (const auto* const heartbeat = std::get_if<HeartbeatRecord>(&record)) it.clients.on_heartbeat(*heartbeat, now);
  if (const auto* const namesake = std::get_if<NamesakeRecord>(&record)) {
    it.namesakes.on_record(*namesake);
    it.look_at_name();
  }
  if (const auto* const identity = std::get_if<IdentityRecord>(&record)) it.identities.on_record(*identity);
  if (const auto* const beats = std::get_if<BeatRecord>(&record)) it.clients.on_beats(*beats, now);
  if (const auto* const command = std::get_if<CommandRecord>(&record)) it.requests.on_command(*command, now);
  if (const auto* const object = std::get_if<ObjectRequestRecord>(&record)) it.requests.on_object(*object, now);
  if (const auto* const joints = std::get_if<JointCommandsRecord>(&record)) it.ros.on_joint_commands(*joints, now);
  if (const auto* const action = std::get_if<RosActionRecord>(&record)) it.ros.on_action(*action, now);
}

bool DdsSession::has_room() const { return impl_->replies.has_room(); }

std::optional<Record> DdsSession::next(Instant now) {
  Impl& it = *impl_;
  if (!it.link_up) return std::nullopt;
  it.clients.on_time(now);
  it.namesakes.on_time(now);
  it.look_at_name();
  if (auto reply = it.replies.next()) return reply;
  if (const Event* const event = it.events.next()) return event_record(*event);
  it.take_changes(now);
  // Where the reader is so slow that some axis is always due, this one would never come.
  if (it.gateway_due + kGatewayPeriod <= now) return it.gateway_sample(now);
  if (const auto axis = it.states.next(now)) return it.state_of(*axis);
  if (it.gateway_due <= now) return it.gateway_sample(now);
  return std::nullopt;
}

Instant DdsSession::wake_at() const {
  const Impl& it = *impl_;
  if (!it.link_up) return kNever;
  if (!it.replies.empty() || it.events.waiting()) return kLongAgo;
  return std::min({it.states.due(), it.gateway_due, it.clients.deadline(), it.namesakes.deadline()});
}

}  // namespace axisgate::dds
