// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/stored_watch.hpp"

#include <algorithm>

namespace axisgate::test::judged {
namespace {

namespace cob = simulated::cob;

constexpr std::uint16_t kFirstTpdoMap = 0x1A00;
/// One and a half heartbeats of 1000 ms, or three guarding frames each 500 ms, with what the two watches are slow by.
constexpr Duration kLongestSilence = std::chrono::milliseconds(2200);

/// What an expedited frame carries (CiA 301 7.2.4.3.3): all four bytes where it does not say how many.
std::optional<std::uint32_t> carried(Bytes sdo) {
  const std::size_t width = 4 - ((sdo[0] & 1) != 0 ? (sdo[0] >> 2) & 3U : 0U);
  if (sdo.size() < 4 + width) return std::nullopt;
  return load_le(sdo, 4, width);
}

std::size_t width_of(Byte response) { return response == 0x43 ? 4 : response == 0x4B ? 2 : response == 0x4F ? 1 : 0; }

/// Whether such an answer, or such a write, gave the object this number.
bool kinco_says(const simulated::Exchange& exchange, const model::ObjectDef& object, std::int64_t number) {
  using namespace simulated;
  if (index_of(exchange.request) != object.address.index || sub_of(exchange.request) != object.address.sub)
    return false;
  if (command_of(exchange.request) != FrameCommand::read) return object.number(data_of(exchange.request)) == number;
  for (std::size_t at = 0; at + frame_length <= exchange.sent.size(); ++at) {
    TenByteFrame window{};
    std::copy_n(exchange.sent.begin() + static_cast<std::ptrdiff_t>(at), frame_length, window.begin());
    const std::size_t width = width_of(window[1]);
    if (width != 0 && sums_to_zero(window) && object.number(load_le(window, 5, width)) == number) return true;
  }
  return false;
}

bool can_says(const simulated::CanExchange& exchange, const model::ObjectDef& object, std::int64_t number) {
  constexpr std::size_t kId = 2, kRecordedSdo = kId + 8;
  if (exchange.request.size() != kRecordedSdo) return false;
  const Bytes request = Bytes(exchange.request).subspan(kId);
  if (request[0] == sdo::kAbort || load_le16(request, 1) != object.address.index || request[3] != object.address.sub)
    return false;
  const bool write = request[0] >> 5 == sdo::kDownload;
  if (!write && exchange.sent.size() < kId + 4) return false;
  const Bytes said = write ? request : Bytes(exchange.sent).subspan(kId);
  const auto value = write || said[0] >> 5 == sdo::kUpload ? carried(said) : std::nullopt;
  return value && object.number(*value) == number;
}

/// Whether such an answer gave the object this number: index and sub-index with what motor A and B have each, or a
/// query's code. What is written to a Keya is a trigger.
bool keya_says(Tongue tongue, Bytes request, Bytes sent, const model::ObjectDef& object, std::int64_t number) {
  const auto holds = [&](Bytes data) {
    const std::size_t from = object.address.byte;
    return from + object.size <= data.size() &&
           object.number(simulated::big_endian(data.subspan(from, object.size))) == number;
  };
  if (tongue == Tongue::keya_can) {
    constexpr std::size_t kId = 4, kHead = 4, kRecorded = kId + can::kMaxFrameBytes;
    if (request.size() != kRecorded || sent.size() != kRecorded ||
        !std::ranges::equal(request.subspan(kId + 1, 3), sent.subspan(kId + 1, 3)))
      return false;
    const bool from_it =
        load_le(sent, 0, kId) - simulated::keya_can::reply == load_le(request, 0, kId) - simulated::keya_can::command;
    return from_it && load_le16(request, kId + 1) == object.address.index && request[kId + 3] == object.address.sub &&
           holds(sent.subspan(kId + kHead));
  }
  constexpr std::uint16_t kQueryIndex = 0x2100;
  const bool rs485 = tongue == Tongue::keya_rs485;
  const std::size_t head = rs485 ? 3 : 2;
  if (request[0] != simulated::keya_start::query || kQueryIndex + request[head - 1] != object.address.index)
    return false;
  for (std::size_t at = 0; at + simulated::keya_frame_length <= sent.size(); ++at) {
    simulated::KeyaFrame window{};
    std::ranges::copy(sent.subspan(at, window.size()), window.begin());
    const bool same = std::ranges::equal(Bytes(window).first(head), request.first(head));
    const std::size_t end = window.size() - (rs485 ? 1 : 0);
    if (same && (!rs485 || window.back() == simulated::keya_sum(window)) &&
        holds(Bytes(window).subspan(head, end - head)))
      return true;
  }
  return false;
}

}  // namespace

void StoredWatch::begin() {
  for (const auto& axis : plant_.stage.gateway().image().axes()) {
    if (axis->number == obey::kAxisOfOtherBus) continue;
    const drive::Drive* drive = plant_.stage.gateway().drive_of(axis->number);
    if (drives_.empty() || drives_.back().drive != drive) {
      drives_.push_back({.drive = drive, .seen = std::vector<Entry>(drive->model().objects.size())});
      take_as_seen(drives_.back());
      if (tongue_of(plant_.subject) == Tongue::rtu)
        drives_.back().truth =
            std::make_unique<RtuTruth>(plant_.stage.gateway(), plant_.stage.rtu_link(0), axis->number);
      if (drives_.back().truth) static_cast<void>(drives_.back().truth->lie());
      drives_.back().heard_at = plant_.stage.runtime().now();
    }
    drives_.back().axes.push_back(axis->number);
  }
}

void StoredWatch::on_frame(const CableFrame& frame) {
  constexpr std::uint32_t kNodeBits = 0x7F;
  const Tongue tongue = tongue_of(plant_.subject);
  if (frame.to_drive || !on_can(tongue) || frame.can->remote) return;
  if (tongue == Tongue::keya_can) return take_heartbeat(*frame.can);
  for (std::size_t d = 0; d < drives_.size(); ++d) {
    Watched& watched = drives_[d];
    const std::uint8_t node = watched.drive->model().node;
    if ((frame.can->id & kNodeBits) != node) continue;
    watched.heard_at = plant_.stage.runtime().now();
    // One of the node's babble is as good as any, and too many frames are not looked at.
    if (booted(Tongue::canopen, frame) == node && !plant_.still_strikes(obey::Strike::babble))
      watched.started_at = plant_.stage.runtime().now();
    for (std::size_t tpdo = 0; tpdo < watched.maps.size(); ++tpdo)
      if (frame.can->id == cob::first_tpdo + tpdo * cob::next_pdo + node) take_process_data(d, tpdo, *frame.can);
  }
}

// KYDAS4860-2E 3.5: the electrical angles of both motors, the faults of motor A, two bytes of state.
void StoredWatch::take_heartbeat(const can::CanFrame& frame) {
  constexpr std::uint16_t kIndex = 0x7000;  // as the profiles number it
  constexpr std::array<std::pair<std::uint8_t, std::size_t>, 5> kFields{{{0, 2}, {2, 2}, {4, 2}, {6, 1}, {7, 1}}};
  for (Watched& watched : drives_)
    for (const auto& [at, width] : kFields)
      if (frame.id == simulated::keya_can::heartbeat + watched.drive->model().node && frame.size == can::kMaxFrameBytes)
        watched.received.push_back({plant_.stage.runtime().now(),
                                    {kIndex, 0, at},
                                    simulated::big_endian(Bytes(frame.data).subspan(at, width))});
}

void StoredWatch::take_process_data(std::size_t position, std::size_t tpdo, const can::CanFrame& frame) {
  CanLinkSim& link = plant_.stage.can_link(0);
  Watched& watched = drives_[position];
  const Instant now = plant_.stage.runtime().now();
  const auto entry = [&](std::uint8_t sub) {
    const auto index = static_cast<std::uint16_t>(kFirstTpdoMap + tpdo);
    const auto bytes = link.line().node(position).peek({index, sub}, link.time_of(now));
    return bytes ? simulated::little_endian(*bytes) : 0U;
  };
  // One that has just restarted has none; what it sent before was by the mapping before.
  std::vector<std::uint32_t>& map = watched.maps[tpdo];
  if (const std::uint32_t count = entry(0); count != 0) {
    map.clear();
    for (std::uint8_t sub = 1; sub <= count; ++sub) map.push_back(entry(sub));
  }
  std::size_t at = 0;
  for (const std::uint32_t mapped : map) {
    const std::size_t width = (mapped & 0xFF) / 8;
    if (at + width > frame.size) return;
    watched.received.push_back({now,
                                {static_cast<std::uint16_t>(mapped >> 16), static_cast<std::uint8_t>(mapped >> 8)},
                                load_le(frame.data, at, width)});
    at += width;
  }
}

void StoredWatch::look(bool twice) {
  if (!plant_.stage.gateway_runs()) return;
  if (drives_.empty()) begin();
  for (Watched& watched : drives_) {
    if (watched.truth) {
      const auto lie = watched.truth->lie();
      if (lie && !twice && keeps_its_word(watched.drive->model())) violated(*lie);
    } else if (twice) {
      take_as_seen(watched);
    } else {
      check_values(watched);
    }
    watched.received.clear();
    for (const model::AxisModel& axis : watched.drive->model().axes) check_axis(watched, axis);
  }
}

void StoredWatch::take_as_seen(Watched& watched) {
  for (std::size_t id = 0; id < watched.seen.size(); ++id) {
    const drive::ObjectState& state = watched.drive->store()[static_cast<model::ObjectId>(id)];
    watched.seen[id] = {state.exchange, state.sent_at};
  }
}

void StoredWatch::check_values(Watched& watched) {
  for (std::size_t id = 0; id < watched.seen.size(); ++id) {
    const drive::ObjectState& state = watched.drive->store()[static_cast<model::ObjectId>(id)];
    const Entry now_seen{state.exchange, state.sent_at};
    if (!state.known || state.emulated || watched.seen[id] == now_seen) continue;
    watched.seen[id] = now_seen;
    if (state.sent_at == axisgate::kLongAgo) continue;  // nothing confirms it any more, and it is shown to nobody
    const model::ObjectDef& object = watched.drive->model().object(static_cast<model::ObjectId>(id));
    if (!object.trigger && !was_sent(watched, object, state) && keeps_its_word(watched.drive->model()))
      violated(object.name + " holds " + std::to_string(state.number) + ", which was not sent for it");
  }
}

// One exchange at a time is on the line: the first request for it that the drive heard after it was sent is the one.
bool StoredWatch::was_sent(Watched& watched, const model::ObjectDef& object, const drive::ObjectState& state) {
  const bool by_process_data = std::ranges::any_of(watched.received, [&](const Value& value) {
    return value.at == state.sent_at && value.place == object.address && object.number(value.raw) == state.number;
  });
  if (by_process_data) return true;
  return plant_.stage.at_link(0, [&](auto& link) {
    bool found = false;
    const Tongue tongue = tongue_of(plant_.subject);
    if constexpr (!std::is_same_v<decltype(link), RtuLinkSim&>) {
      const auto& journal = link.line().journal().entries();
      for (auto entry = journal.rbegin(); entry != journal.rend() && !found; ++entry) {
        if (entry->received < link.time_of(state.sent_at)) break;
        if (entry->station != watched.drive->model().node) continue;
        if constexpr (std::is_same_v<decltype(link), SimLink&>)
          found = kinco_says(*entry, object, state.number);
        else if (tongue != Tongue::canopen)
          found = keya_says(tongue, entry->request, entry->sent, object, state.number);
        else if constexpr (std::is_same_v<decltype(link), CanLinkSim&>)
          found = can_says(*entry, object, state.number);
      }
    }
    return found;
  });
}

// "Within worst_reply_ms" is part of the promise: a drive that is later than the timeout and the silence together may
// be taken at its late word.
bool StoredWatch::keeps_its_word(const model::DriveModel& model) {
  return plant_.stage.at_link(0, [&](auto& link) {
    return std::ranges::none_of(link.line().journal().entries(), [&](const auto& exchange) {
      return exchange.station == model.node &&
             exchange.reply_ready - exchange.received > model.timeout + model.resync.worst_reply;
    });
  });
}

// A value may also be confirmed by reads alone, where the node does not take the event timer.
Duration StoredWatch::period(const drive::Drive& drive, model::ObjectId object) const {
  const model::CanopenProperties& facts = drive.model().canopen;
  for (const model::TpdoProperties& tpdo : facts.tpdos) {
    if (std::ranges::find(tpdo.map, object) == tpdo.map.end()) continue;
    const Duration event = std::chrono::milliseconds(tpdo.event_ms.value_or(std::uint16_t{0}));
    return std::min(drive.store().period(object), std::max(event, facts.confirm));
  }
  return {};
}

Duration StoredWatch::stale_after(const Watched& watched, const model::AxisModel& axis,
                                  const model::Binding& binding) const {
  Duration longest = watched.drive->model().poll_period[static_cast<std::size_t>(binding.poll)];
  const auto look = [&](model::ObjectId object) {
    if (object != model::kNoObject) longest = std::max(longest, period(*watched.drive, object));
  };
  look(binding.object);
  for (const model::BitField& field : binding.bits) look(field.object);
  if (binding.quantity == Quantity::error_code) std::ranges::for_each(axis.fault_words, look);
  return std::max<Duration>(std::chrono::milliseconds(300), 3 * longest);
}

void StoredWatch::check_axis(Watched& watched, const model::AxisModel& axis) {
  const AxisImage& image = plant_.stage.axis(axis.number);
  const Instant now = plant_.stage.runtime().now();
  const bool canopen = tongue_of(plant_.subject) == Tongue::canopen;
  const auto name = [&] { return "axis " + std::to_string(axis.number) + " "; };
  if (canopen && image.reachable() && now - watched.heard_at > kLongestSilence)
    violated(name() + "counts as there, and has said nothing for long");
  for (const model::Binding& binding : axis.bindings) {
    const Sample& sample = image[binding.quantity];
    if (!sample.valid) continue;
    const auto is_valid = [&](const std::string& and_yet) {
      violated(name() + std::string(axisgate::row(binding.quantity).name) + " is valid " + and_yet);
    };
    if (!image.reachable()) is_valid("of a drive that is not there");
    if (canopen && sample.at < watched.started_at) is_valid("and of before its restart");
    if (binding.poll == model::PollClass::once) continue;
    if (now - sample.at > stale_after(watched, axis, binding) + std::chrono::milliseconds(2))
      is_valid("and " + std::to_string((now - sample.at) / std::chrono::milliseconds(1)) + " ms old");
  }
}

}  // namespace axisgate::test::judged
