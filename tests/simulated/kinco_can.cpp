// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/kinco_can.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::uint16_t first_word = 0x0006;
constexpr std::uint16_t unknown_alarm = 0x1000;  // CiA 301's "generic error"

// DS402 codes of error word 1 (MD 9, §4.7); bit 0 only tells that word 2 has one.
constexpr std::array<std::uint16_t, 16> codes_of_word_1{0,      0x7331, 0x7320, 0x7330, 0x4210, 0x3210, 0x3220, 0x2320,
                                                        0x7110, 0x8611, 0x5112, 0x2350, 0x8A80, 0x4310, 0x7331, 0x6310};

}  // namespace

CommunicationFacts communication_of(const KincoCanDrive& options) {
  const bool md = options.drive.type == KincoType::md;
  CommunicationFacts facts;
  facts.sdo.segmented = options.can.segmented;
  facts.sdo.block = options.can.block;
  facts.sdo.echoes_written = options.can.echoes_written;
  facts.sdo.short_frames = options.can.short_frames;
  facts.sdo.takes_short_frames = true;
  facts.pdo.count = md ? 4 : 8;
  facts.pdo.event_timer = md;
  facts.pdo.inhibit_unit = md ? one_millisecond : std::chrono::microseconds(100);
  facts.guarding_objects = md;
  facts.leaves_operational_on_loss = options.can.leaves_operational_on_loss;
  facts.sends_emergencies = options.can.sends_emergencies;
  facts.identity = {options.can.vendor, options.can.product, options.can.revision, options.can.serial};
  facts.name = md ? "MD60" : "JD620";
  facts.hardware = "1.0";
  facts.software = "simulated";
  return facts;
}

KincoCan::KincoCan(const KincoCanDrive& options) : options_(options.can), drive_(options.drive) { connect(); }

void KincoCan::connect() { waits_for_first_word_ = options_.first_word_needed && drive_.model().type == KincoType::jd; }

std::string KincoCan::describe() const {
  return std::string(drive_.model().name) + '@' + std::to_string(drive_.options().station);
}

ObjectReply KincoCan::read(ObjectKey key, Time now) {
  drive_.advance(now);
  const ObjectEntry* entry = drive_.entry(key);
  if (entry == nullptr) return {abort_of(Refusal::no_such_object)};
  const auto width = static_cast<std::size_t>(simulated::bytes_of(entry->type));
  return {0, little_endian(static_cast<std::uint32_t>(drive_.value_of(*entry)), width)};
}

std::optional<std::uint32_t> KincoCan::mapped(ObjectKey key, Time now) {
  drive_.advance(now);
  const ObjectEntry* entry = drive_.entry(key);
  return entry == nullptr ? std::nullopt : std::optional(static_cast<std::uint32_t>(drive_.value_of(*entry)));
}

std::uint32_t KincoCan::write(ObjectKey key, CanView bytes, std::uint64_t tag, Time now) {
  if (key == KincoDrive::controlword && bytes.size() == 2 && waits_for_first_word_) {
    if (little_endian(bytes) != first_word) return 0;  // ignored: neither obeyed nor refused
    waits_for_first_word_ = false;
  }
  if (bytes.size() > 4) return sdo_abort::too_long;
  return abort_of(drive_.write(key, static_cast<int>(bytes.size()), little_endian(bytes), tag, now));
}

bool KincoCan::may_be_mapped(ObjectKey key, PdoDirection direction) const {
  const ObjectEntry* entry = drive_.entry(key);
  if (entry == nullptr || options_.unmappable.contains(key)) return false;
  if (direction == PdoDirection::to_drive && entry->access == Access::ro) return false;
  // Cyclic data; the manuals' parameters are for SDO (JD 2.3).
  return key.index >= 0x6000 || key.index == 0x2601 || key.index == 0x2602 || key.index == 0x2010;
}

void KincoCan::lose_master(MasterLoss how, Time now) {
  drive_.advance(now);
  connect();
  if (how == MasterLoss::guarding || options_.stops_without_master) drive_.trip(0, options_.loss_alarm);
}

std::uint16_t KincoCan::error_code() const {
  if (drive_.state() != Cia402State::fault && drive_.state() != Cia402State::fault_reaction_active) return 0;
  for (std::size_t bit = 1; bit < codes_of_word_1.size(); ++bit) {
    if ((drive_.error_word(1) >> bit & 1) != 0) return codes_of_word_1.at(bit);
  }
  return unknown_alarm;
}

}  // namespace axisgate::simulated
