#include "tests/sim/invariants.hpp"

#include <algorithm>

namespace axisgate::test {
namespace {

constexpr std::size_t kFrame = 10;

bool sums_to_zero(Bytes window) {
  unsigned sum = 0;
  for (const Byte b : window) sum += b;
  return (sum & 0xFF) == 0;
}

std::size_t width_of(Byte response) { return response == 0x43 ? 4 : response == 0x4B ? 2 : response == 0x4F ? 1 : 0; }

}  // namespace

CableWatch::CableWatch(SimLink& link, Runtime& runtime, Duration timeout, std::function<void(std::string)> violated)
    : link_(link), runtime_(runtime), timeout_(timeout), violated_(std::move(violated)) {
  link_.on_unplugged = [this] { sent_at_ = kLongAgo; };  // the loss ends what was outstanding
  link_.on_traffic = [this](bool towards_drive, Bytes bytes) {
    for (const Byte b : bytes) hash_ = mix(hash_, b);
    hash_ = mix(hash_, static_cast<std::uint64_t>(runtime_.now().time_since_epoch().count()));
    if (towards_drive)
      to_drive(bytes);
    else
      to_host(bytes);
  };
}

// Some window of what was heard is an answer to the request: same station, object and a response command.
bool CableWatch::answered() const {
  for (std::size_t at = 0; at + kFrame <= heard_.size(); ++at) {
    const Bytes window = Bytes(heard_).subspan(at, kFrame);
    const bool same =
        window[0] == request_[0] && std::equal(window.begin() + 2, window.begin() + 5, request_.begin() + 2);
    const bool response = window[1] == 0x60 || window[1] == 0x80 || width_of(window[1]) != 0;
    if (same && response && sums_to_zero(window)) return true;
  }
  return false;
}

void CableWatch::to_drive(Bytes bytes) {
  if (bytes.size() != kFrame || !sums_to_zero(bytes)) violated_("I1: what was sent is not one whole frame");
  const bool over = sent_at_ == kLongAgo || runtime_.now() >= sent_at_ + timeout_ || answered();
  if (!over) violated_("I1: a request while another was outstanding");
  request_.assign(bytes.begin(), bytes.end());
  heard_.clear();
  sent_at_ = runtime_.now();
  const std::uint16_t index = load_le16(bytes, 2);
  const std::uint32_t data = load_le(bytes, 5, 4);
  if (bytes[1] == 0x23 && index == 0x6081 && ++profile_velocities_[{bytes[0], data}] > 1)
    violated_("I5: a value was written twice");
  if (bytes[1] == 0x2B && index == 0x6040 && (data == 0x3F || data == 0x5F)) ++starts_;
}

void CableWatch::to_host(Bytes bytes) { heard_.insert(heard_.end(), bytes.begin(), bytes.end()); }

DriveWatch::DriveWatch(const app::Gateway& gateway, SimLink& link, std::size_t position, AxisNumber axis,
                       const Asked& asked, Runtime& runtime, std::function<void(std::string)> violated)
    : gateway_(gateway),
      link_(link),
      position_(position),
      axis_(axis),
      runtime_(runtime),
      violated_(std::move(violated)),
      watch_(gateway, axis, asked, runtime, violated_),
      seen_(gateway.drive_of(axis)->model().objects.size()) {}

void DriveWatch::check() {
  check_values();
  watch_.check_enables(link_.line().drive(position_).transitions(),
                       [&](simulated::Time at) { return link_.time_of(runtime_.now()) - at; });
  watch_.check_validity();
}

// The line's journal ties each reply to its request; a value in the store must be the one sent for the request that
// asked.
void DriveWatch::check_values() {
  const drive::Drive& drive = *gateway_.drive_of(axis_);
  const auto& journal = link_.line().journal().entries();
  for (std::size_t id = 0; id < seen_.size(); ++id) {
    const drive::ObjectState& state = drive.store()[static_cast<drive::ObjectId>(id)];
    if (!state.known || state.exchange == seen_[id]) continue;
    seen_[id] = state.exchange;
    const drive::ObjectDef& object = drive.model().object(static_cast<drive::ObjectId>(id));
    bool found = false;
    for (auto entry = journal.rbegin(); entry != journal.rend() && !found; ++entry) {
      if (entry->received < link_.time_of(state.sent_at)) break;
      if (entry->station != drive.model().node || simulated::index_of(entry->request) != object.address.index ||
          simulated::sub_of(entry->request) != object.address.sub)
        continue;
      if (simulated::command_of(entry->request) != simulated::FrameCommand::read) {
        found = object.number(simulated::data_of(entry->request)) == state.number;
        continue;
      }
      for (std::size_t at = 0; at + kFrame <= entry->sent.size() && !found; ++at) {
        const Bytes window = Bytes(entry->sent).subspan(at, kFrame);
        const std::size_t width = width_of(window[1]);
        if (width == 0 || !sums_to_zero(window)) continue;
        found = object.number(load_le(window, 5, width)) == state.number;
      }
    }
    if (!found)
      violated_("I2: axis " + std::to_string(axis_) + " " + object.name + " holds a value nobody sent for it");
  }
}

AxisWatch::AxisWatch(const app::Gateway& gateway, AxisNumber axis, const Asked& asked, Runtime& runtime,
                     std::function<void(std::string)> violated)
    : gateway_(gateway),
      axis_(axis),
      asked_(asked),
      runtime_(runtime),
      violated_(std::move(violated)),
      enables_seen_until_(runtime.now()) {}

bool AxisWatch::enable_was_asked(Instant at) const {
  return std::any_of(asked_.enables.begin(), asked_.enables.end(),
                     [&](const Asked::Enable& e) { return e.axis == axis_ && e.at <= at && at - e.at <= kLongestWay; });
}

void AxisWatch::check_enables(const std::deque<simulated::Transition>& transitions,
                              const std::function<Duration(simulated::Time)>& age) {
  for (const simulated::Transition& t : transitions) {
    const Instant at = runtime_.now() - age(t.at);
    if (at <= enables_seen_until_ || t.to != simulated::Cia402State::operation_enabled) continue;
    if (!enable_was_asked(at) || t.tag == 0)
      violated_("I10: axis " + std::to_string(axis_) + " was enabled although nobody asked");
  }
  enables_seen_until_ = runtime_.now();
}

Duration AxisWatch::stale_after(const drive::Binding& binding) const {
  const drive::AxisModel& axis = gateway_.drive_of(axis_)->model().axes.front();
  Duration period = gateway_.drive_of(axis_)->model().poll_period[static_cast<std::size_t>(binding.poll)];
  const auto look = [&](drive::ObjectId object) {
    if (object != drive::kNoObject) period = std::max(period, period_(object));
  };
  look(binding.object);
  for (const drive::BitField& field : binding.bits) look(field.object);
  if (binding.quantity == Quantity::error_code) std::for_each(axis.fault_words.begin(), axis.fault_words.end(), look);
  return std::max<Duration>(std::chrono::milliseconds(300), 3 * period);
}

void AxisWatch::check_validity() const {
  const drive::Drive& drive = *gateway_.drive_of(axis_);
  const AxisImage& image = *const_cast<app::Gateway&>(gateway_).image().find(axis_);
  for (const drive::Binding& binding : drive.model().axes.front().bindings) {
    const Sample& sample = image[binding.quantity];
    if (!sample.valid) continue;
    if (!image.reachable()) violated_("I6: a valid value of a drive that is not there");
    if (binding.poll == drive::PollClass::once) continue;
    if (runtime_.now() - sample.at > stale_after(binding) + std::chrono::milliseconds(2))
      violated_("I6: axis " + std::to_string(axis_) + " " + std::string(row(binding.quantity).name) +
                " is stale but valid");
  }
}

}  // namespace axisgate::test
