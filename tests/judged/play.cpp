// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/playing.hpp"

#include <algorithm>

#include "tests/judged/outages.hpp"

namespace axisgate::test::judged {

using namespace reference;
using obey::Plant;
using obey::PlantOptions;

namespace {

constexpr std::int64_t kComebackMs = 150'000;  // from the end of the last fault to an axis online (7.3: 60 s and more)
constexpr std::int64_t kOnlineMs = 1'200;      // so long online: what was late has come
constexpr std::int64_t kTailMs = 6'000;        // after the last step

/// Of the longest ones some are longer.
std::int64_t length_of_outage(const Step& step) {
  constexpr std::array<std::int64_t, 2> kVeryLong{30'000, 60'000};
  const bool longer = step.length + 1U == kLengths.size() && step.id < kVeryLong.size();
  return longer ? kVeryLong.at(step.id) : kLengths.at(step.length);
}

}  // namespace

PlantOptions Play::options_of(const Program& program, std::uint64_t seed) {
  PlantOptions options;
  if (program.leases) options.lease = lease_of(program, seed);
  options.seed = seed;
  options.neighbour = seed % 2 == 0;
  options.neighbour_first = seed % 4 == 2;
  if (seed % 3 == 0) options.open_points = seed;
  // What a listener may be told, each in some of the runs.
  options.listener.client_is_address = seed % 4 == 1;
  options.listener.low_word_first = seed % 3 == 2;
  if (seed % 6 == 2) options.listener.rearm = std::chrono::milliseconds(seed % 12 == 2 ? 300 : 3000);
  options.listener.per_axis_units = seed % 5 == 3;
  options.listener.posted_writes = seed % 7 % 3 == 2;
  options.listener.staged_halves = seed % 3 == 0;
  // A half of a float is none of an integer: obey's panels have both.
  options.listener.float_numbers = seed % 5 == 1 && !options.listener.staged_halves;
  options.listener.offline_reads_fail = seed % 5 == 2;
  options.other_bus = seed % 4 == 3;
  options.velocity_limit = velocity_limit(program.subject, seed);
  return options;
}

std::string Play::stamp() {
  const Truth truth = plant_.motor();
  return std::to_string(now_ms()) + " ms, at " + std::to_string(truth.position) +
         (truth.velocity != 0 ? " turning at " + std::to_string(truth.velocity) : "") +
         (truth.enabled ? *truth.enabled ? "" : " (off)" : "") + (truth.faulted ? " (faulted)" : "") +
         (online() ? "" : " (not online)");
}

void Play::violated(std::string what) {
  if (over()) return;
  outcome_.violation = stamp() + ": " + std::move(what);
}

void Play::begin() {
  Beginning beginning = judged::begin(plant_, program_, seed_);
  watches_.emplace(plant_, neighbour_, other_bus_, [this](std::string what) { violated(std::move(what)); });
  clients_.connect();
  std::ranges::copy(clients_.ranks(), beginning.options.ranks.begin());
  beginning.options.operators = clients_.operators();
  beginning.options.strengths = kStrengths.at(seed_ % kStrengths.size());
  writers_.emplace(program_, plant_.profile_rows(), beginning.parameters, beginning.commands);
  began_ = plant_.stage.runtime().now();
  const Truth truth = plant_.motor();
  contract_.emplace(beginning.options, beginning.world);
  const Sight sight{0, truth.position, truth.velocity, truth.enabled, truth.faulted, truth.torque};
  seen_.add(sight);
  static_cast<void>(contract_->see(sight));
}

Outcome Play::run() {
  begin();
  if (program_.flavour != Flavour::both && has_positions(program_.subject) && has_speeds(program_.subject))
    send(0, one(row::mode, program_.flavour == Flavour::moves ? 1 : kVelocityMode), false);
  for (const Step& step : program_.steps) {
    if (over()) break;
    act(step);
  }
  while (!over() && now_ms() < program_.nemesis.until_ms) pass(kStepMs);
  mend();
  for (const obey::Strike how : obey::kStrikes) plant_.strike(how, 0);
  for (std::int64_t waited = 0;
       !over() && (contract_->in_trouble() || !watches_->neighbours_online() || waited < kTailMs); waited += kStepMs) {
    pass(kStepMs);
    if (waited > kComebackMs + kTailMs) violated("an axis never came back online");
  }
  outcome_.virtual_ms = now_ms();
  outcome_.lost_count = contract_->lost_count();
  outcome_.traffic = watches_->cable.traffic();
  plague_.count_strikes();
  outcome_.injected = plague_.injected();
  if (!over()) return std::move(outcome_);
  outcome_.story.push_back(*outcome_.violation);
  outcome_.last_second = watches_->cable.last_second();
  return std::move(outcome_);
}

void Play::look() {
  const Truth truth = plant_.motor();
  const Sight sight{now_ms(), truth.position, truth.velocity, truth.enabled, truth.faulted, truth.torque};
  seen_.add(sight);
  if (!contract_->see(sight))
    violated("the motor does what nobody asked for: velocity " + std::to_string(truth.velocity) +
             "; the contract: " + contract_->expected());
  watches_->look();
}

void Play::watch_trouble() {
  if (!wire_whole_) return;
  const bool online = this->online();
  if (!contract_->in_trouble()) {
    if (online) return;
    // What was adopted is brought up as soon as it is disabled (section 7, point 7); else nothing takes an axis away.
    if (!had_outage_) violated("the axis is not online any more, and nothing has happened to it");
    begin_trouble();
    return;
  }
  const bool strikes =
      std::ranges::any_of(obey::kStrikes, [this](obey::Strike how) { return plant_.still_strikes(how); });
  if (!online || strikes || plague_.strikes_now() || watches_->cable.lies_in_wait()) {
    online_since_ms_ = -1;
    return;
  }
  if (online_since_ms_ < 0) online_since_ms_ = now_ms();
  if (now_ms() - std::max(online_since_ms_, whole_since_ms_) < kOnlineMs) return;
  outcome_.story.push_back(stamp() + ": all is well again");
  contract_->trouble_ends();
  watches_->all_is_well();
}

void Play::begin_trouble() {
  had_outage_ = true;
  contract_->trouble_begins();
  online_since_ms_ = -1;
}

void Play::pass(std::int64_t ms) {
  for (std::int64_t gone = 0; gone < ms && !over(); gone += kStepMs) {
    be_haunted();
    plant_.run(std::chrono::milliseconds(kStepMs));
    look();
    watch_trouble();
    watch_acceptance();
    collect();
  }
}

void Play::be_haunted() {
  const bool began = plague_.began();
  if (const auto wrong = plague_.rage(now_ms())) violated(*wrong);
  if (!began && plague_.began()) outcome_.story.push_back(stamp() + ": " + text(program_.nemesis));
  if (plague_.strikes_now()) {
    watches_->line_is_troubled(program_.nemesis.says_twice());
    if (!contract_->in_trouble()) begin_trouble();
  }
  if (const Duration stall = plague_.stalls_now(); stall > Duration{}) {
    outcome_.story.push_back(stamp() + ": the event loop stands for " +
                             std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(stall).count()) +
                             " ms");
    begin_trouble();
    watches_->loop_stood();
    plant_.stage.runtime().stall(stall);
  }
}

// It lives until what it may still send has left it.
void Play::die(const Step& step) {
  constexpr std::int64_t kLongestWord = 100;
  begin_to_die(plant_, step);
  for (std::int64_t gone = 0; gone < kLongestWord && !plant_.dead(); gone += kStepMs) pass(kStepMs);
  wire_whole_ = false;
  watches_->line_is_troubled();
  watches_->gateway_died();
  contract_->gateway_died();
  open_.clear();
  clients_.gateway_died();
  told_ = {};
  plant_.crash_gateway();
}

void Play::outage(const Step& step) {
  const std::int64_t length = length_of_outage(step);
  outcome_.story.push_back(stamp() + ": " + text(step) + " " + std::to_string(length) + " ms");
  const bool once_more = step.deed == Deed::restart || step.deed == Deed::trip || step.deed == Deed::crash;
  if (!plant_.stage.gateway_runs() || (!wire_whole_ && !once_more)) return;
  if (step.deed == Deed::cut && step.number % 4 == 3 && is_cia402(program_.subject)) return be_nearly_right(step);
  begin_trouble();
  switch (step.deed) {
    case Deed::cut:
      wire_whole_ = false;
      if (!step.on) watches_->line_is_troubled();
      plant_.cut_wire(step.on);
      break;
    case Deed::unplug:
      wire_whole_ = false;
      watches_->line_is_troubled();
      plant_.unplug(step.on);
      break;
    case Deed::lose:
    case Deed::late:
    case Deed::twice:
      strike(plant_, *watches_, step);
      break;
    case Deed::restart:
      contract_->drive_restarted();
      plant_.restart_drive(std::chrono::milliseconds(step.on ? length : 0));
      if (!step.on && step.number % 3 != 0) return go_on_unaware(step);
      break;
    case Deed::trip:
      contract_->drive_tripped();
      plant_.trip_drive();
      break;
    default:
      die(step);
  }
  if (step.at_once && step.deed != Deed::crash) return;
  pass(length);
}

void Play::act(const Step& step) {
  switch (step.deed) {
    case Deed::wait:
      if (step.on && tongue_of(program_.subject) == Tongue::canopen) {
        constexpr std::uint16_t kDeviceName = 0x1008;  // in several exchanges
        contract_->asked(step.client);
        clients_.modbus(step.client).ask_for_object(kDeviceName, 0);
        told_.at(step.client).reset();
      }
      break;
    case Deed::look_up:
      look_up(step.client);
      break;
    case Deed::halves:
      write_halves(step);
      break;
    case Deed::read:
      read(step.client);
      break;
    case Deed::sample:
      send(kModbus + step.client, writers_->write_of(step), step.at_once);
      break;
    case Deed::once_more:
      say_once_more(step);
      break;
    case Deed::new_writer:
      replace(kModbus + step.client, step.on);
      break;
    case Deed::masters:
      follow_each_other(step);
      break;
    case Deed::dds_dies:
      kill_dds(step);
      break;
    case Deed::dds_jog:
      jog_by_dds(step);
      break;
    case Deed::bystander:
      if (!over() && plant_.stage.gateway_runs())
        if (const auto wrong = clients_.bystand(step)) violated(*wrong);
      break;
    case Deed::insist:
      insist(step);
      break;
    case Deed::reconnect:
    case Deed::vanish:
      if (step.on) writers_->started_anew(step.client);
      replace(step.client, step.deed == Deed::vanish);
      break;
    case Deed::cross:
      send_crossed(step);
      break;
    case Deed::tool:
      use_tool(step);
      break;
    case Deed::monitor:
      use_monitor(step);
      break;
    case Deed::rival:
      take_away(step);
      break;
    case Deed::lost:
      press_out_of_sight(step);
      break;
    case Deed::scan:
      scan(step);
      break;
    case Deed::button:
      hold_button(step);
      break;
    case Deed::other_master:
      be_commanded_by_another(step);
      break;
    default:
      if (step.deed >= Deed::cut)
        outage(step);
      else
        send(step.client, writers_->write_of(step), step.at_once);
  }
  pass(kPauses.at(step.pause));
  if (step.number % 3 == 0 || !step.at_once) mend();
}

void Play::mend() {
  if (wire_whole_ || over()) return;
  plant_.plug();
  plant_.mend_wire();
  if (was_nearly_right_) ignore_quick_stop(plant_.stage, program_.subject, false);
  if (!plant_.stage.gateway_runs()) {
    plant_.start_gateway();
    clients_.connect();
    contract_->gateway_started();
  }
  wire_whole_ = true;
  whole_since_ms_ = now_ms();
  outcome_.story.push_back(stamp() + ": it is mended");
}

Outcome play(const Program& program, std::uint64_t seed) { return Play(program, seed).run(); }

}  // namespace axisgate::test::judged
