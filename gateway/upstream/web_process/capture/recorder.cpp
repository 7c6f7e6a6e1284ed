// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/capture/recorder.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "gateway/image/events.hpp"

namespace axisgate::web {
namespace {

/// Of the bytes of all captures, what one may take for other axes than its own; with its own it may take twice of it.
constexpr std::size_t kShareOfOne = 8;

/// What a fault is, the drive says a moment before or behind the sample that shows it.
void name_fault(Capture& capture, const EventRecord& event) {
  if (event.kind != static_cast<std::uint8_t>(EventKind::fault) || event.code == 0) return;
  for (CauseSeen& cause : capture.causes)
    if (cause.cause == Cause::fault && cause.axis == event.axis && cause.text == kFaultUnnamed &&
        event.at >= cause.at - kSecond)
      cause.text = event.text;
}

/// When it began, on a clock that goes on beyond the end of this computer's.
std::int64_t of_day(const Capture& capture) { return capture.first().at + capture.to_utc; }

}  // namespace

// --- What comes in ---------------------------------------------------------------------------------------------------

void Recorder::begin(const History& history, const Now& now) {
  for (Running& running : std::exchange(running_, {})) {
    running.capture->to = std::min(running.capture->to, now.at);
    copy(running, running.capture->to, history);
    finish(running.capture);
  }
  causes_.begin(now.at);
}

void Recorder::take(const SamplesRecord& record, Picture& picture, const History& history, const Now& now) {
  for (const CauseSeen& seen : causes_.in(record, picture)) on(seen, picture, history, now);
  // What a fault is captured in is looked for once, as it is seen first: by us, or by one of us that was before.
  for (const AxisSample& sample : record.axes)
    if (const AxisPicture* axis = picture.find(sample.axis); axis != nullptr && axis->fault == record.at)
      picture.captured(sample.axis, of_fault(sample.axis, picture));
}

void Recorder::take(const EventRecord& record, Picture& picture, const History& history, const Now& now) {
  const auto seen = causes_.in(record);
  if (seen) on(*seen, picture, history, now);
  for (const Running& running : running_) {
    Capture& capture = *running.capture;
    const bool there = !capture.events.empty() && capture.events.back().number >= record.number;
    if (!there && record.at >= capture.from && record.at <= capture.to && capture.events.size() < kMostEvents)
      capture.events.push_back(record);
    name_fault(capture, record);
  }
}

Recorder::Running* Recorder::running_with(const CauseSeen& seen) {
  const auto takes = [&](const Running& each) {
    return seen.at <= each.capture->to && seen.at <= each.capture->first().at + kLongest;
  };
  const auto same = std::ranges::find_if(
      running_, [&](const Running& each) { return each.capture->first().axis == seen.axis && takes(each); });
  if (same != running_.end()) return &*same;
  return running_.size() < kMostRunning ? nullptr : &running_.back();
}

void Recorder::on(const CauseSeen& seen, const Picture& picture, const History& history, const Now& now) {
  Again& last = last_[{seen.axis, seen.cause, seen.cause == Cause::trigger ? seen.text : std::string()}];
  const bool again = !last.id.empty() && seen.at - last.at < std::max(settings_.before, kQuiet);
  last.at = seen.at;
  Running* running = again ? nullptr : running_with(seen);
  if (!again && running == nullptr) {
    begin_capture(seen, picture, history, now);
    last.id = running_.back().capture->id;
    return;
  }
  if (!again) last.id = running->capture->id;
  const auto capture = find_any(last.id);
  if (!capture) return;
  ++capture->times;
  if (again) return;
  capture->to = std::max(capture->to, std::min(seen.at + settings_.after, capture->first().at + kLongest));
  if (capture->causes.size() < kMostCauses) capture->causes.push_back(seen);
  for (const EventRecord& event : capture->events) name_fault(*capture, event);
}

// --- What is under way -----------------------------------------------------------------------------------------------

void Recorder::begin_capture(const CauseSeen& seen, const Picture& picture, const History& history, const Now& now) {
  auto capture = std::make_shared<Capture>();
  // An id is given once, even where this program starts again while the gateway runs on.
  const auto age_ms = static_cast<std::uint64_t>(ms_since(picture.hello().started, now.at));
  number_ = std::max(number_ + 1, age_ms);
  capture->id = std::to_string(picture.hello().boot) + "." + std::to_string(number_);
  capture->from = std::max({seen.at - settings_.before, history.oldest(), SteadyNs{0}});
  capture->from = std::min(capture->from, seen.at);
  capture->to = seen.at + settings_.after;
  capture->to_utc = now.to_utc;
  capture->causes = {seen};
  capture->times = 1;
  for (const auto& [number, axis] : picture.axes()) {
    AxisInfoRecord& info = capture->axes.emplace_back();
    info.axis = number;
    info.name = axis.info.name;
    info.profile = axis.info.profile;
    info.units_numerator = axis.info.units_numerator;
    info.units_denominator = axis.info.units_denominator;
  }
  for (const EventRecord& event : picture.events())
    if (event.at >= capture->from && event.at <= capture->to) capture->events.push_back(event);
  for (const EventRecord& event : capture->events) name_fault(*capture, event);
  running_.push_back({capture, capture->from});
  // At once: what is oldest may be gone before it has ended.
  copy(running_.back(), std::min(capture->to, now.at - kBehind), history);
  note_change(capture, false);
}

// Behind `copied` up to `until`. Slices of other axes end where a copy ends.
void Recorder::copy(Running& running, SteadyNs until, const History& history) const {
  Capture& capture = *running.capture;
  if (until != capture.to) until -= until % Thinned::kSlice;
  if (until <= running.copied) return;
  const SteadyNs from = std::max(running.copied, std::min(history.oldest(), until));
  const bool missed = from > running.copied && running.copied > capture.from;
  std::size_t size = capture.bytes();
  const auto copy_line = [&](Series series, bool thinned) {
    PackedPoints points;
    const auto found = capture.lines.find(series);
    if (found != capture.lines.end()) points = std::move(found->second);
    const std::size_t before = points.bytes();
    if (missed) points.add({running.copied + kMillisecond, 0, false});
    Thinned thin(points);
    history.each(series, from, until, [&](const Point& point) {
      if (point.at == from && from != capture.from) return true;  // the copy before has it
      thinned ? thin.add(point) : points.add(point);
      return true;
    });
    thin.flush();
    size += points.bytes() - before;
    if (found != capture.lines.end())
      found->second = std::move(points);
    else if (points.size() != 0)
      capture.lines.emplace(series, std::move(points));
  };
  const auto copy_axis = [&](std::uint16_t axis, bool thinned, std::size_t most) {
    for (std::uint8_t name = 0; name < kSeriesNames; ++name) {
      if (size >= most) return void(capture.cut = true);
      copy_line({axis, name}, thinned);
    }
  };
  const std::uint16_t own = capture.first().axis;
  copy_axis(own, false, 2 * bytes_ / kShareOfOne);
  for (const AxisInfoRecord& axis : capture.axes)
    if (axis.axis != own) copy_axis(axis.axis, true, bytes_ / kShareOfOne);
  running.copied = until;
}

Recorder::Turn Recorder::turn(Picture& picture, const History& history, const Now& now) {
  for (Running& running : std::exchange(running_, {})) {
    copy(running, std::min(running.capture->to, now.at - kBehind), history);
    if (now.at >= running.capture->to + kBehind)
      finish(running.capture);
    else
      running_.push_back(std::move(running));
  }
  for (const std::string& id : done_.gone) picture.forget_capture(id);
  return std::exchange(done_, {});
}

// --- What is kept ----------------------------------------------------------------------------------------------------

void Recorder::finish(const std::shared_ptr<Capture>& capture) {
  capture->complete = true;
  kept_.push_back(capture);
  done_.completed.push_back(capture);
  note_change(capture, true);
  make_room();
}

void Recorder::restore(Capture capture) {
  const auto later =
      std::ranges::upper_bound(kept_, of_day(capture), {}, [](const auto& each) { return of_day(*each); });
  kept_.insert(later, std::make_shared<Capture>(std::move(capture)));
  make_room();
}

void Recorder::make_room() {
  const auto bytes = [&] {
    return std::accumulate(kept_.begin(), kept_.end(), std::size_t{0},
                           [](std::size_t sum, const auto& each) { return sum + each->bytes(); });
  };
  while (kept_.size() > settings_.keep || (kept_.size() > 1 && bytes() > bytes_)) {
    done_.gone.push_back(kept_.front()->id);
    kept_.pop_front();
  }
}

std::shared_ptr<Capture> Recorder::find_any(std::string_view id) const {
  for (const Running& running : running_)
    if (running.capture->id == id) return running.capture;
  const auto found = std::ranges::find(kept_, id, [](const auto& each) { return std::string_view(each->id); });
  return found == kept_.end() ? nullptr : *found;
}

std::vector<Recorder::Kept> Recorder::all() const {
  std::vector<Kept> out;
  for (auto each = running_.rbegin(); each != running_.rend(); ++each) out.push_back(each->capture);
  out.insert(out.end(), kept_.rbegin(), kept_.rend());
  return out;
}

std::string Recorder::of_fault(std::uint16_t axis, const Picture& picture) const {
  const std::string boot = std::to_string(picture.hello().boot) + ".";
  for (const Kept& each : all())
    if (each->first().at >= causes_.began() && each->id.starts_with(boot) && each->has(Cause::fault, axis))
      return each->id;
  return {};
}

void Recorder::note_change(Kept capture, bool complete) {
  changes_.push_back({++changed_, std::move(capture), complete});
  if (changes_.size() > kMostChanges) changes_.pop_front();
}

}  // namespace axisgate::web
