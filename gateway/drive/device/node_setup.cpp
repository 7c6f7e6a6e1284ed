// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/node_setup.hpp"

#include <fmt/format.h>

#include <array>

namespace axisgate::drive {
namespace {

// CiA 301 section 7.5.2.35 to 7.5.2.38.
constexpr std::uint16_t kFirstParameter = 0x1800;
constexpr std::uint16_t kFirstMapping = 0x1A00;
constexpr std::uint16_t kIdentity = 0x1018;
constexpr std::uint8_t kCobId = 1, kType = 2, kInhibit = 3, kEvent = 5;
constexpr std::uint32_t kInvalid = 0x80000000;  // bit 31: the PDO does not exist
constexpr std::uint32_t kIdBits = 0x1FFFFFFF;
constexpr std::array<std::uint32_t, 4> kPredefined{0x180, 0x280, 0x380, 0x480};

constexpr const char* kOtherMapping = "does not read back as it was mapped";

std::uint32_t predefined_cob_id(std::uint8_t number, std::uint8_t node) { return kPredefined.at(number - 1U) + node; }

std::uint32_t raw_of(const bus::ExchangeResult& result) { return result.fields.empty() ? 0 : result.fields[0].raw; }

bool refused(const bus::ExchangeResult& result) { return result.code != Errc::ok; }

}  // namespace

bus::Exchange nmt(std::uint8_t node, NmtCommand command) {
  bus::Exchange exchange;
  exchange.node = node;
  exchange.access = bus::Access::command;
  exchange.raw = static_cast<std::uint32_t>(command);
  return exchange;
}

// --- Identity ------------------------------------------------------------------------------------------------------

void IdentityCheck::begin() {
  at_ = 0;
  mismatch_.clear();
  skip();
}

void IdentityCheck::skip() {
  while (at_ < model_.canopen.identity.size() && !model_.canopen.identity[at_]) ++at_;
}

std::optional<bus::Exchange> IdentityCheck::next() const {
  if (at_ >= model_.canopen.identity.size()) return std::nullopt;
  const auto sub = static_cast<std::uint8_t>(at_ + 1);
  return bus::Exchange{model_.node, bus::Access::read, {kIdentity, sub}, 4, 0};
}

void IdentityCheck::on_result(const bus::ExchangeResult& result) {
  if (at_ >= model_.canopen.identity.size()) return;
  constexpr std::array kNames{"vendor", "product", "revision", "serial"};
  const std::uint32_t configured = *model_.canopen.identity[at_];
  if (!mismatch_.empty() && (refused(result) || raw_of(result) != configured)) mismatch_ += ", ";
  if (refused(result))
    mismatch_ +=
        fmt::format("{} is not told (abort 0x{:08X}), configured 0x{:X}", kNames.at(at_), result.detail, configured);
  else if (raw_of(result) != configured)
    mismatch_ += fmt::format("{} is 0x{:X}, configured 0x{:X}", kNames.at(at_), raw_of(result), configured);
  ++at_;
  skip();
}

// --- TPDO mapping and NMT ------------------------------------------------------------------------------------------

void NodeSetup::begin() {
  mapped_.clear();
  notes_.clear();
  step_ = Step::pre_operational;
}

std::uint8_t NodeSetup::number() const {
  if (step_ == Step::read_unused || step_ == Step::switch_off) return model_.canopen.unused_tpdos[at_];
  return tpdo().number;
}

bus::Exchange NodeSetup::parameter(bus::Access access, std::uint8_t sub, std::uint8_t size, std::uint32_t raw) const {
  return {model_.node, access, {static_cast<std::uint16_t>(kFirstParameter + number() - 1), sub}, size, raw};
}

bus::Exchange NodeSetup::mapping(bus::Access access, std::uint8_t sub, std::uint8_t size, std::uint32_t raw) const {
  return {model_.node, access, {static_cast<std::uint16_t>(kFirstMapping + number() - 1), sub}, size, raw};
}

std::uint32_t NodeSetup::mapping_entry(model::ObjectId object) const {
  const model::ObjectDef& def = model_.object(object);
  return std::uint32_t{def.address.index} << 16 | std::uint32_t{def.address.sub} << 8 | def.size * 8U;
}

std::optional<bus::Exchange> NodeSetup::next() const {
  using enum bus::Access;
  switch (step_) {
    case Step::pre_operational:
      return nmt(model_.node, NmtCommand::enter_pre_operational);
    case Step::read_unused:
    case Step::read_cob_id:
    case Step::read_enabled:
      return parameter(read, kCobId, 4);
    case Step::switch_off:
    case Step::disable:
      return parameter(write, kCobId, 4, cob_id_ | kInvalid);
    case Step::clear_count:
      return mapping(write, 0, 1, 0);
    case Step::entry:
      return mapping(write, static_cast<std::uint8_t>(taken_.objects.size() + 1), 4,
                     mapping_entry(tpdo().map[entry_at_]));
    case Step::count:
      return mapping(write, 0, 1, static_cast<std::uint32_t>(taken_.objects.size()));
    case Step::type:
      return parameter(write, kType, 1, tpdo().type);
    case Step::inhibit:
      return parameter(write, kInhibit, 2, *tpdo().inhibit);
    case Step::event:
      return parameter(write, kEvent, 2, *tpdo().event_ms);
    case Step::enable:
      return parameter(write, kCobId, 4, cob_id_);
    case Step::read_count:
      return mapping(read, 0, 1);
    case Step::read_entry:
      return mapping(read, static_cast<std::uint8_t>(entry_at_ + 1), 4);
    case Step::start:
      return nmt(model_.node, NmtCommand::start);
    case Step::over:
      break;
  }
  return std::nullopt;
}

void NodeSetup::begin_unused(std::size_t at) {
  at_ = at;
  if (at_ == model_.canopen.unused_tpdos.size()) return begin_tpdo(0);
  step_ = Step::read_unused;
}

void NodeSetup::begin_tpdo(std::size_t at) {
  at_ = at;
  entry_at_ = 0;
  step_ = at_ == model_.canopen.tpdos.size() ? Step::start : Step::read_cob_id;
  if (step_ != Step::start) taken_ = {tpdo().number, {}, std::nullopt};
}

void NodeSetup::give_up(const std::string& why) {
  note(why + ": what it would carry is polled");
  begin_tpdo(at_ + 1);
}

void NodeSetup::on_result(const bus::ExchangeResult& result) {
  const auto why = [&](const std::string& what) { return fmt::format("{} (abort 0x{:08X})", what, result.detail); };
  const auto after_inhibit = [&] { return tpdo().event_ms ? Step::event : Step::enable; };
  // What does not hold costs this TPDO.
  const auto must = [&](bool holds, const std::string& otherwise, Step next) {
    if (!holds) return give_up(otherwise);
    step_ = next;
  };
  switch (step_) {
    case Step::pre_operational:
      return begin_unused(0);
    case Step::read_unused:
      // One that is not there, or off, needs nothing.
      if (refused(result) || (raw_of(result) & kInvalid) != 0) return begin_unused(at_ + 1);
      cob_id_ = raw_of(result);
      step_ = Step::switch_off;
      return;
    case Step::switch_off:
      if (refused(result)) note(why("cannot be switched off, though it is not used"));
      return begin_unused(at_ + 1);
    case Step::read_cob_id:
      if (refused(result)) return give_up(why("is not there"));
      // Bit 30 (no remote frames) stays as the drive has it: some refuse to change it.
      cob_id_ = (raw_of(result) & ~(kInvalid | kIdBits)) | predefined_cob_id(tpdo().number, model_.node);
      step_ = Step::disable;
      return;
    case Step::disable:
      return must(!refused(result), why("cannot be disabled"), Step::clear_count);
    case Step::clear_count:
      return must(!refused(result), why("cannot be mapped anew"), Step::entry);
    case Step::entry:
      if (refused(result))
        note(why("does not take " + model_.object(tpdo().map[entry_at_]).name) + ": it is polled");
      else
        taken_.objects.push_back(tpdo().map[entry_at_]);
      if (++entry_at_ < tpdo().map.size()) return;
      return must(!taken_.objects.empty(), "takes none of its objects", Step::count);
    case Step::count:
      return must(!refused(result), why("does not take its mapping"), Step::type);
    case Step::type:
      return must(!refused(result), why("does not take its transmission type"),
                  tpdo().inhibit ? Step::inhibit : after_inhibit());
    case Step::inhibit:
      if (refused(result)) note(why("takes no inhibit time"));
      step_ = after_inhibit();
      return;
    case Step::event:
      if (refused(result))
        note(why("takes no event timer") + ": its values are confirmed by reads");
      else
        taken_.event_ms = tpdo().event_ms;
      step_ = Step::enable;
      return;
    case Step::enable:
      return must(!refused(result), why("cannot be enabled"), Step::read_count);
    case Step::read_count:
      if (refused(result) || raw_of(result) != taken_.objects.size()) return give_up(kOtherMapping);
      entry_at_ = 0;
      step_ = Step::read_entry;
      return;
    case Step::read_entry:
      if (refused(result) || raw_of(result) != mapping_entry(taken_.objects[entry_at_])) return give_up(kOtherMapping);
      if (++entry_at_ == taken_.objects.size()) step_ = Step::read_enabled;
      return;
    case Step::read_enabled:
      if (refused(result) || (raw_of(result) & kInvalid) != 0 || (raw_of(result) & kIdBits) != (cob_id_ & kIdBits))
        return give_up("does not read back as enabled");
      mapped_.push_back(taken_);
      return begin_tpdo(at_ + 1);
    case Step::start:
    case Step::over:
      step_ = Step::over;
      return;
  }
}

}  // namespace axisgate::drive
