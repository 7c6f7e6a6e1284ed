// SPDX-License-Identifier: Apache-2.0
// The communication objects of CanopenNode (CiA 301 7.5.2), 1000h to 1FFFh and MD's 6007h.
#include "tests/simulated/canopen_node.hpp"

namespace axisgate::simulated {
namespace {

constexpr ObjectKey error_register{0x1001, 0};
constexpr std::uint16_t error_history = 0x1003;

// Objects of the communication's range that are the drive's: a Kinco's node number, and saving.
bool of_drive(ObjectKey key) { return key.index >= 0x2000 || key == ObjectKey{0x100B, 0} || key.index == 0x1010; }

}  // namespace

void CanopenNode::make_cells() {
  const std::uint32_t node = node_;
  const auto fixed = [this](std::uint16_t index, std::uint8_t sub, std::uint32_t value, std::uint8_t width) {
    cells_[{index, sub}] = {value, width, false};
  };
  const auto free = [this](std::uint16_t index, std::uint8_t sub, std::uint32_t value, std::uint8_t width) {
    cells_[{index, sub}] = {value, width, true};
  };
  fixed(0x1000, 0, facts_.device_type, 4);
  free(0x1005, 0, cob::sync, 4);
  if (facts_.guarding_objects) {
    free(0x100C, 0, 1000, 2);
    free(0x100D, 0, 3, 1);
    free(0x100E, 0, cob::error_control + node, 4);
    if (!facts_.drive_minds_guarding) free(0x6007, 0, 0, 2);
  }
  free(0x1014, 0, cob::emergency + node, 4);
  if (facts_.consumers > 0) fixed(consumer_entries, 0, static_cast<std::uint32_t>(facts_.consumers), 1);
  for (int i = 1; i <= facts_.consumers; ++i) free(consumer_entries, static_cast<std::uint8_t>(i), 0, 4);
  free(0x1017, 0, facts_.heartbeat, facts_.heartbeat_width);
  if (facts_.identity_object) fixed(0x1018, 0, 4, 1);
  for (std::uint8_t i = 0; facts_.identity_object && i < 4; ++i) {
    fixed(0x1018, static_cast<std::uint8_t>(i + 1), facts_.identity.at(i), 4);
  }
  if (facts_.version_numbers) {
    fixed(0x1009, 0, *facts_.version_numbers, 2);
    fixed(0x100A, 0, *facts_.version_numbers, 2);
  }
  fixed(0x1200, 0, 2, 1);
  fixed(0x1200, 1, cob::sdo_request + node, 4);
  fixed(0x1200, 2, cob::sdo_reply + node, 4);
  if (!facts_.name.empty()) facts_.texts.emplace(ObjectKey{0x1008, 0}, facts_.name);
  if (!facts_.hardware.empty()) facts_.texts.emplace(ObjectKey{0x1009, 0}, facts_.hardware);
  if (!facts_.software.empty()) facts_.texts.emplace(ObjectKey{0x100A, 0}, facts_.software);
}

std::uint32_t CanopenNode::cell(ObjectKey key) const {
  const auto found = cells_.find(key);
  return found == cells_.end() ? 0 : found->second.value;
}

bool CanopenNode::own_index(std::uint16_t index) const {
  return std::ranges::any_of(cells_, [index](const auto& cell) { return cell.first.index == index; });
}

namespace {

/// What a mapping entry names (CiA 301 7.5.2.38).
std::optional<ObjectKey> mapped_by(ObjectKey key, CanView bytes) {
  if (key.index < 0x1A00 || key.index > 0x1BFF || key.sub == 0 || bytes.size() != 4) return std::nullopt;
  return ObjectKey{static_cast<std::uint16_t>(bytes[2] | bytes[3] << 8), bytes[1]};
}

}  // namespace

ObjectReply CanopenNode::read(ObjectKey key, Time now) {
  if (facts_.lacks.contains(key)) return {abort_of(Refusal::no_such_object)};
  if (key == error_register) return {0, {device_->error_register()}};
  if (key.index == error_history) {
    if (key.sub == 0) return {0, {static_cast<std::uint8_t>(history_.size())}};
    if (key.sub > history_.size()) return {sdo_abort::no_such_sub};
    return {0, little_endian(history_[key.sub - 1U], 4)};
  }
  if (const auto text = facts_.texts.find(key); text != facts_.texts.end()) {
    return {0, {text->second.begin(), text->second.end()}};
  }
  if (const auto found = cells_.find(key); found != cells_.end()) {
    return {0, little_endian(found->second.value, found->second.width)};
  }
  if (own_index(key.index)) return {sdo_abort::no_such_sub};
  if (pdos_.has(key)) return pdos_.read(key);
  if (!of_drive(key)) return {abort_of(Refusal::no_such_object)};
  return device_->read(key, now);
}

std::uint32_t CanopenNode::write(ObjectKey key, CanView bytes, std::uint64_t tag, Time now) {
  if (facts_.lacks.contains(mapped_by(key, bytes).value_or(key))) return abort_of(Refusal::no_such_object);
  if (key.index == error_history && key.sub == 0 && bytes.size() == 1 && bytes[0] == 0) {
    history_.clear();
    return 0;
  }
  if (key == error_register || key.index == error_history) return abort_of(Refusal::read_only);
  if (const auto text = facts_.texts.find(key); text != facts_.texts.end()) {
    if (key.index < 0x1010) return abort_of(Refusal::read_only);
    text->second.assign(bytes.begin(), bytes.end());
    return 0;
  }
  if (const auto found = cells_.find(key); found != cells_.end()) return write_cell(found->second, key, bytes, now);
  if (own_index(key.index)) return sdo_abort::no_such_sub;
  if (pdos_.has(key)) return pdos_.write(key, bytes, state_ == NmtState::pre_operational, *device_, now);
  if (!of_drive(key)) return abort_of(Refusal::no_such_object);
  return device_->write(key, bytes, tag, now);
}

std::uint32_t CanopenNode::write_cell(Cell& cell, ObjectKey key, CanView bytes, Time now) {
  if (!cell.writable) return abort_of(Refusal::read_only);
  if (bytes.size() != cell.width) return abort_of(Refusal::wrong_width);
  cell.value = little_endian(bytes);
  if (key == heartbeat_time) next_heartbeat_ = now + cell.value * one_millisecond;
  // Watching begins anew with the next heartbeat (CiA 301 7.2.8.3.2.2).
  if (key.index == consumer_entries) consumers_.at(key.sub - 1U).deadline.reset();
  return 0;
}

std::optional<CanBytes> CanopenNode::peek(ObjectKey key, Time now) {
  ObjectReply found = read(key, now);
  if (found.abort != 0) return std::nullopt;
  return std::move(found.bytes);
}

std::uint32_t CanopenNode::poke(ObjectKey key, std::int64_t value, Time now) {
  const ObjectReply present = read(key, now);
  if (present.abort != 0) return present.abort;
  if (of_drive(key) && !cells_.contains(key)) return device_->poke(key, value);
  const std::size_t width = std::min<std::size_t>(present.bytes.size(), 4);
  return write(key, little_endian(static_cast<std::uint32_t>(value), width), 0, now);
}

}  // namespace axisgate::simulated
