#include "tests/sim/can_invariants.hpp"

#include <algorithm>

namespace axisgate::test {
namespace {

namespace cob = simulated::cob;

constexpr std::uint16_t kControlword = 0x6040, kProfileVelocity = 0x6081, kFirstTpdoMap = 0x1A00;
constexpr Byte kWriteFour = 0x23, kWriteTwo = 0x2B, kAbort = 0x80;
constexpr std::uint8_t kUpload = 2, kDownload = 1;  ///< command specifiers that name an object (CiA 301 7.2.4.3)
constexpr std::size_t kSdoSize = 8;
constexpr std::uint32_t kNodeBits = 0x7F;
/// One and a half heartbeats of 1000 ms, or three guarding frames each 500 ms, with what the two watches are slow by.
constexpr Duration kLongestSilence = std::chrono::milliseconds(2200);

bool between(std::uint32_t id, std::uint32_t base) { return id > base && id <= base + kNodeBits; }

bool is_sdo_request(const can::CanFrame& frame) { return !frame.remote && between(frame.id, cob::sdo_request); }

bool is_boot_up(const can::CanFrame& frame) {
  return !frame.remote && between(frame.id, cob::error_control) && frame.size == 1 && frame.data[0] == 0;
}

/// A recorded frame: identifier, low byte first, and data.
constexpr std::size_t kRecordedSdo = 2 + kSdoSize;
Bytes data_in(Bytes recorded) { return recorded.subspan(2); }

/// What an expedited frame carries (CiA 301 7.2.4.3.3): all four bytes where it does not say how many.
std::optional<std::uint32_t> carried(Bytes sdo) {
  const std::size_t unused = (sdo[0] & 1) != 0 ? (sdo[0] >> 2) & 3U : 0U;
  const std::size_t width = 4 - unused;
  if (sdo.size() < 4 + width) return std::nullopt;
  return load_le(sdo, 4, width);
}

}  // namespace

CanCableWatch::CanCableWatch(CanLinkSim& link, Runtime& runtime, Duration timeout,
                             std::function<void(std::string)> violated)
    : runtime_(runtime), timeout_(timeout), violated_(std::move(violated)) {
  link.on_unplugged = [this] { sent_at_ = kLongAgo; };  // the loss ends what was outstanding
  link.on_traffic = [this](bool towards_drive, const can::CanFrame& frame) {
    hash_ = mix(hash_, frame.id);
    for (const Byte b : frame.bytes()) hash_ = mix(hash_, b);
    hash_ = mix(hash_, static_cast<std::uint64_t>(runtime_.now().time_since_epoch().count()));
    if (towards_drive)
      to_drive(frame);
    else
      to_host(frame);
    for (const OnCanFrame& tell : tell_) tell(towards_drive, frame);
  };
}

bool CanCableWatch::over() const { return sent_at_ == kLongAgo || runtime_.now() >= sent_at_ + timeout_; }

void CanCableWatch::to_drive(const can::CanFrame& frame) {
  if (frame.id == cob::nmt && !over()) violated_("I1: an NMT command while a request was outstanding");
  if (!is_sdo_request(frame)) return;
  if (frame.size != kSdoSize) violated_("I1: an SDO request that has not eight bytes");
  if (frame.data[0] != kAbort) return request(frame);
  // Nobody answers it; a node that is gone is not waited for.
  if (frame.id == request_.id) sent_at_ = kLongAgo;
}

void CanCableWatch::request(const can::CanFrame& frame) {
  if (!over()) violated_("I1: a request while another was outstanding");
  request_ = frame;
  sent_at_ = runtime_.now();
  const std::uint16_t index = load_le16(frame.data, 1);
  const std::uint32_t data = load_le(frame.data, 4, 4);
  if (frame.data[0] == kWriteFour && index == kProfileVelocity && ++profile_velocities_[{frame.id, data}] > 1)
    violated_("I5: a value was written twice");
  if (frame.data[0] == kWriteTwo && index == kControlword && (data == 0x3F || data == 0x5F)) ++starts_;
}

// Segments name no object; an abort ends whatever is open.
bool CanCableWatch::answers(const can::CanFrame& frame) const {
  if (frame.size < 4) return false;
  const int specifier = request_.data[0] >> 5;
  const bool names_object = specifier == kUpload || specifier == kDownload;
  if (!names_object && frame.data[0] != kAbort) return true;
  return std::equal(frame.data.begin() + 1, frame.data.begin() + 4, request_.data.begin() + 1) || !names_object;
}

void CanCableWatch::to_host(const can::CanFrame& frame) {
  if (sent_at_ == kLongAgo || frame.remote || (frame.id & kNodeBits) != (request_.id & kNodeBits)) return;
  const bool reply = between(frame.id, cob::sdo_reply) && answers(frame);
  if (reply || is_boot_up(frame)) sent_at_ = kLongAgo;  // a node that starts anew owes nothing
}

CanDriveWatch::CanDriveWatch(const app::Gateway& gateway, CanLinkSim& link, std::size_t position, AxisNumber axis,
                             const Asked& asked, Runtime& runtime, std::function<void(std::string)> violated)
    : gateway_(gateway),
      link_(link),
      position_(position),
      axis_(axis),
      runtime_(runtime),
      violated_(std::move(violated)),
      watch_(gateway, axis, asked, runtime, violated_),
      seen_(gateway.drive_of(axis)->model().objects.size(), {0, kLongAgo}) {
  watch_.set_period([this](drive::ObjectId object) { return period_of(object); });
}

const std::deque<simulated::Transition>& CanDriveWatch::transitions() const {
  if (simulated::KincoDrive* kinco = link_.line().kinco(position_)) return kinco->transitions();
  return link_.line().leadshine(position_)->transitions();
}

bool CanDriveWatch::enabled() const {
  simulated::KincoDrive* kinco = link_.line().kinco(position_);
  const simulated::Cia402State state = kinco != nullptr ? kinco->state() : link_.line().leadshine(position_)->state();
  return state == simulated::Cia402State::operation_enabled;
}

void CanDriveWatch::check() {
  check_values();
  check_presence();
  watch_.check_validity();
  watch_.check_enables(transitions(), [&](simulated::Time at) { return link_.time_of(runtime_.now()) - at; });
}

void CanDriveWatch::on_frame(bool towards_drive, const can::CanFrame& frame) {
  if (towards_drive) {
    if (frame.id == cob::nmt) check_command(frame);
    return;
  }
  const std::uint32_t node = gateway_.drive_of(axis_)->model().node;
  if ((frame.id & kNodeBits) != node || frame.remote) return;
  heard_at_ = runtime_.now();
  if (is_boot_up(frame)) started_at_ = runtime_.now();
  for (std::size_t tpdo = 0; tpdo < maps_.size(); ++tpdo)
    if (frame.id == cob::first_tpdo + tpdo * cob::next_pdo + node) take_process_data(tpdo, frame);
}

// Leaving the stopped state changes nothing in a drive; any other command may take a motor's process data from it.
void CanDriveWatch::check_command(const can::CanFrame& frame) {
  simulated::CanopenNode& node = link_.line().node(position_);
  const bool for_it = frame.data[1] == 0 || frame.data[1] == node.node();
  if (for_it && enabled() && node.state() != simulated::NmtState::stopped)
    violated("an NMT command to a node with an enabled motor");
}

void CanDriveWatch::take_process_data(std::size_t tpdo, const can::CanFrame& frame) {
  simulated::CanopenNode& node = link_.line().node(position_);
  const auto entry = [&](std::uint8_t sub) {
    const auto index = static_cast<std::uint16_t>(kFirstTpdoMap + tpdo);
    const auto bytes = node.peek({index, sub}, link_.time_of(runtime_.now()));
    return bytes ? simulated::little_endian(*bytes) : 0U;
  };
  // One that has just restarted has none; what it sent before was by the mapping before.
  if (const std::uint32_t count = entry(0); count != 0) {
    maps_[tpdo].clear();
    for (std::uint8_t sub = 1; sub <= count; ++sub) maps_[tpdo].push_back(entry(sub));
  }
  std::size_t at = 0;
  for (const std::uint32_t mapped : maps_[tpdo]) {
    const std::size_t width = (mapped & 0xFF) / 8;
    if (at + width > frame.size) return;
    received_.push_back({runtime_.now(), static_cast<std::uint16_t>(mapped >> 16), static_cast<Byte>(mapped >> 8),
                         load_le(frame.data, at, width)});
    at += width;
  }
}

void CanDriveWatch::check_values() {
  const drive::Drive& drive = *gateway_.drive_of(axis_);
  look_for_doubles();
  for (std::size_t id = 0; id < seen_.size(); ++id) {
    const drive::ObjectState& state = drive.store()[static_cast<drive::ObjectId>(id)];
    const std::pair<std::uint64_t, Instant> now_seen{state.exchange, state.sent_at};
    if (!state.known || state.made || seen_[id] == now_seen) continue;
    seen_[id] = now_seen;
    const drive::ObjectDef& object = drive.model().object(static_cast<drive::ObjectId>(id));
    if (came_by_tpdo(object, state)) {
      ++by_tpdo_;
    } else if (came_by_sdo(object, state)) {
      ++by_sdo_;
    } else if (!object.trigger && keeps_its_word() && !said_twice(state)) {
      violated("I2: " + object.name + " holds " + std::to_string(state.number) + ", which was not sent for it");
    }
  }
  received_.clear();
}

bool CanDriveWatch::came_by_tpdo(const drive::ObjectDef& object, const drive::ObjectState& state) const {
  return std::any_of(received_.begin(), received_.end(), [&](const Value& value) {
    return value.at == state.sent_at && value.index == object.address.index && value.sub == object.address.sub &&
           object.number(value.raw) == state.number;
  });
}

// One exchange at a time is on the bus: the first request for it that the node heard after it was sent is the one.
bool CanDriveWatch::came_by_sdo(const drive::ObjectDef& object, const drive::ObjectState& state) const {
  const simulated::CanExchange* exchange = nullptr;
  const auto& journal = link_.line().journal().entries();
  for (auto entry = journal.rbegin(); entry != journal.rend(); ++entry) {
    if (entry->received < link_.time_of(state.sent_at)) break;
    if (entry->request.size() != kRecordedSdo || entry->station != gateway_.drive_of(axis_)->model().node) continue;
    const Bytes request = data_in(entry->request);
    const bool same = load_le16(request, 1) == object.address.index && request[3] == object.address.sub;
    if (same && request[0] != kAbort) exchange = &*entry;
  }
  if (exchange == nullptr) return false;
  const Bytes request = data_in(exchange->request);
  if (request[0] >> 5 == kDownload) {
    const auto written = carried(request);
    return written && object.number(*written) == state.number;
  }
  if (exchange->sent.size() < 2 + 4) return false;
  const Bytes reply = data_in(exchange->sent);
  const auto read = reply[0] >> 5 == kUpload ? carried(reply) : std::nullopt;
  return read && object.number(*read) == state.number;
}

// A reply that comes twice may be taken for that to the next request for the same object: nothing in it tells. A drive
// that answers once to each request, in order, is what the promise is given for.
void CanDriveWatch::look_for_doubles() {
  const std::uint32_t id = cob::sdo_reply + gateway_.drive_of(axis_)->model().node;
  for (; looked_through_ < link_.received.size(); ++looked_through_) {
    const CanLinkSim::Received& heard = link_.received[looked_through_];
    if (heard.frame.id != id || heard.tag == 0) continue;
    if (heard.tag == newest_reply_) doubled_at_ = heard.at;
    newest_reply_ = heard.tag;
  }
}

bool CanDriveWatch::said_twice(const drive::ObjectState& state) const {
  return state.sent_at <= doubled_at_ && doubled_at_ - state.sent_at <= gateway_.drive_of(axis_)->model().timeout;
}

// "Within worst_reply_ms" is part of the promise: a drive that is later than the timeout and the silence together may
// be taken at its late word.
bool CanDriveWatch::keeps_its_word() const {
  const drive::DriveModel& model = gateway_.drive_of(axis_)->model();
  const auto& journal = link_.line().journal().entries();
  return std::none_of(journal.begin(), journal.end(), [&](const simulated::CanExchange& exchange) {
    return exchange.station == model.node &&
           exchange.reply_ready - exchange.received > model.timeout + model.fence.worst_reply;
  });
}

// A value may also be confirmed by reads alone, where the node does not take the event timer.
Duration CanDriveWatch::period_of(drive::ObjectId object) const {
  const drive::Drive& drive = *gateway_.drive_of(axis_);
  const drive::CanopenFacts& facts = drive.model().canopen;
  for (const drive::TpdoFacts& tpdo : facts.tpdos) {
    if (std::find(tpdo.map.begin(), tpdo.map.end(), object) == tpdo.map.end()) continue;
    const Duration event = std::chrono::milliseconds(tpdo.event_ms.value_or(std::uint16_t{0}));
    return std::min(drive.store().period(object), std::max(event, facts.confirm));
  }
  return {};
}

void CanDriveWatch::check_presence() {
  const AxisImage& image = *const_cast<app::Gateway&>(gateway_).image().find(axis_);
  const bool silent = runtime_.now() - heard_at_ > kLongestSilence;
  if (silent && image.reachable()) violated("I6: it counts as there, and has said nothing for long");
  if (!image.reachable()) return;
  for (const drive::Binding& binding : gateway_.drive_of(axis_)->model().axes.front().bindings) {
    const Sample& sample = image[binding.quantity];
    if (sample.valid && sample.at < started_at_)
      violated("I6: " + std::string(row(binding.quantity).name) + " is valid and of before its restart");
  }
}

}  // namespace axisgate::test
