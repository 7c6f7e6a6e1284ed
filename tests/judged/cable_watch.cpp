// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/cable_watch.hpp"

#include <algorithm>

namespace axisgate::test::judged {
namespace {

using namespace std::chrono_literals;
using namespace reference;

/// Design 3, G6: no motor starts later than the larger of start_deadline_ms (500) and reply_deadline_ms (900) after the
/// request that asked for it.
constexpr Duration kLatestStart = 900ms;
constexpr Duration kStory = 1s;

}  // namespace

CableWatch::CableWatch(obey::Plant& plant, Violated violated, std::function<void(const CableFrame&)> also_tell)
    : plant_(plant),
      violated_(std::move(violated)),
      also_tell_(std::move(also_tell)),
      tongue_(tongue_of(plant.subject)),
      timeout_(plant.stage.gateway().bus(0).settings().timeout),
      node_of_axis_1_(plant.stage.gateway().drive_of(1)->model().node) {
  if (tongue_ == Tongue::keya_rs232) node_of_axis_1_ = 0;  // its frames name none
  enabled_[node_of_axis_1_] = plant.motor().enabled.value_or(true);
  listen(plant.stage, 0, [this](const CableFrame& frame) { on_frame(frame); });
  plant.stage.at_link(0, [this](auto& link) { link.on_unplugged = [this] { request_.reset(); }; });
  plant.on_modbus([this](bool to_gateway, Bytes adu) {
    traffic_.requests += to_gateway ? 1 : 0;
    keep({plant_.stage.runtime().now(), true, to_gateway, {}, false, {adu.begin(), adu.end()}});
  });
}

void CableWatch::gateway_died() {
  request_.reset();
  for (Credit& credit : credits_) credit.until = plant_.stage.runtime().now();
}

void CableWatch::asked(int request, const Write& write) {
  constexpr std::int64_t kLadder = 0xF, kStartBit = 0x10;
  Credit credit{.request = request, .until = plant_.stage.runtime().now() + kLatestStart};
  const bool stepper = plant_.subject == Subject::id286pro;  // a run's new speed is a command anew
  if (stepper && half_row(write) == row::target_velocity) ++credit.starts;
  for (std::size_t i = 0; write.coils() && i < write.words.size(); ++i) {
    if (write.words[i] == 0) continue;
    (write.first + i == coil::enable ? credit.enables : credit.starts) += 1;
  }
  for (const auto& [offset, value] : write.coils() ? Rows{} : rows_of(write)) {
    const bool enabling = offset == row::controlword && (value & kLadder) == kLadder;
    if (offset == row::command && value == kEnable) ++credit.enables;
    const bool jogs = value == kJogForward || value == kJogReverse;
    if (offset == row::command && ((value >= kMove && value < kRelease) || jogs)) ++credit.starts;
    if (enabling) ++credit.enables;
    if (enabling && ((value & kStartBit) != 0 || stepper)) ++credit.starts;
    if (offset == row::target_velocity && stepper) ++credit.starts;
  }
  credits_.push_back(credit);
}

void CableWatch::answered(int request) {
  std::erase_if(credits_, [&](const Credit& credit) { return credit.request == request; });
}

void CableWatch::on_frame(const CableFrame& frame) {
  ++traffic_.frames;
  const auto mix = [this](std::uint64_t value) { traffic_.hash = (traffic_.hash ^ value) * 0x100000001B3U; };  // FNV-1a
  for (const Byte byte : frame.bytes) mix(byte);
  mix(static_cast<std::uint64_t>(plant_.stage.runtime().now().time_since_epoch().count()));
  keep({plant_.stage.runtime().now(),
        false,
        frame.to_drive,
        frame.can != nullptr ? *frame.can : can::CanFrame{},
        frame.can != nullptr,
        {frame.bytes.begin(), frame.bytes.end()}});
  if (frame.to_drive)
    to_drive(frame);
  else
    to_gateway(frame);
  also_tell_(frame);
}

void CableWatch::keep(Kept frame) {
  while (!kept_.empty() && (kept_.front().at + kStory < frame.at || kept_.size() >= kMostKept)) kept_.pop_front();
  kept_.push_back(std::move(frame));
}

bool CableWatch::outstanding() const {
  if (!request_ || plant_.stage.runtime().now() >= sent_at_ + timeout_) return false;
  return on_can(tongue_) || !is_over(*request_, {false, heard_, nullptr});
}

void CableWatch::to_drive(const CableFrame& frame) {
  const bool plugged = plant_.stage.at_link(0, [](const auto& link) { return link.plugged(); });
  if (!plugged || plant_.dead()) return;  // it was not told yet; its last words may be cut short
  if (!is_whole(tongue_, frame)) return violated_("what was sent is not one whole frame");
  if (is_nmt_command(tongue_, frame)) check_command(frame);
  if (request_ && is_abort_of(*request_, frame)) return request_.reset();
  std::optional<Request> request = request_in(tongue_, frame);
  if (!request) return;
  if (outstanding()) violated_("a request while another was outstanding: " + hex_text(frame.bytes));
  pay(*request);
  request_ = std::move(request);
  if (!request_->answered) request_.reset();
  sent_at_ = plant_.stage.runtime().now();
  heard_.clear();
}

// Leaving the stopped state changes nothing in a drive; any other command may take a motor's process data from it.
void CableWatch::check_command(const CableFrame& frame) {
  if (outstanding()) violated_("an NMT command while a request was outstanding");
  const bool for_axis_1 = frame.bytes[1] == 0 || frame.bytes[1] == node_of_axis_1_;
  const bool stopped = plant_.stage.can_node(0).state() == simulated::NmtState::stopped;
  const bool anothers = plant_.stage.runtime().now() < anothers_until_;  // whose enable a bring-up has not seen yet
  if (for_axis_1 && !stopped && !anothers && plant_.motor().enabled.value_or(false))
    violated_("an NMT command to a node with an enabled motor");
}

void CableWatch::to_gateway(const CableFrame& frame) {
  if (!request_) return;
  if (!on_can(tongue_)) {
    if (heard_.size() < kMostHeard) heard_.insert(heard_.end(), frame.bytes.begin(), frame.bytes.end());
  } else if (is_over(*request_, frame)) {
    request_.reset();
  }
}

void CableWatch::pay(const Request& request) {
  const Deeds deeds = deeds_of(plant_.subject, request, enabled_[request.node]);
  enabled_[request.node] = deeds.enabled_after;
  const std::string frame = hex_text(request.bytes);
  if (lies_in_wait() && (deeds.starts || deeds.enables)) {
    plant_.strike(obey::Strike::lose_reply);
    in_wait_until_ = axisgate::kLongAgo;
  }
  const bool beside = request.node != node_of_axis_1_ && (deeds.starts || deeds.enables);
  if (deeds.of_motor_b || beside) return violated_("sent to what nobody commands: " + frame);
  if (deeds.starts && !take(&Credit::starts)) violated_("a start for which no request is open: " + frame);
  // What was sent to disable it before may not have come: a word to an enabled motor enables nothing.
  const bool enables = deeds.enables && !plant_.motor().enabled.value_or(false);
  if (enables && !take(&Credit::enables)) violated_("an enable for which no request is open: " + frame);
}

bool CableWatch::take(int Credit::*kind) {
  std::erase_if(credits_, [&](const Credit& credit) { return credit.until <= plant_.stage.runtime().now(); });
  for (Credit& credit : credits_)
    if (credit.*kind > 0) return --(credit.*kind), true;
  return false;
}

void CableWatch::look() {
  if (!plant_.stage.gateway_runs()) return;
  const compose::Gateway& gateway = plant_.stage.gateway();
  const std::size_t axes = plant_.stage.gateway().image().axes().size();
  const std::size_t most = axes * (bus::kMaxJobsPerAxis + bus::kMaxStopsPerAxis + bus::kMaxSetupsPerDrive);
  if (plant_.stage.gateway().bus(0).queue_depth() > most) violated_("the queue is over its bound");
  if (gateway.events().events().size() > kMaxEvents) violated_("there are more events than their ring has places");
}

std::vector<std::string> CableWatch::last_second() const {
  std::vector<std::string> out;
  for (const Kept& kept : kept_) {
    const Duration since = kept.at - kept_.front().at;
    if (kept.modbus)
      out.push_back(transcript_line(since, kept.to_drive ? "modbus ->" : "modbus <-", hex_text(kept.bytes)));
    else
      out.push_back(transcript_line(since, CableFrame{kept.to_drive, kept.bytes, kept.is_can ? &kept.can : nullptr}));
  }
  return out;
}

}  // namespace axisgate::test::judged
