// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/namesakes.hpp"

namespace axisgate::dds {

void Namesakes::on_record(const NamesakeRecord& record) {
  const auto known = others_.find(record.writer);
  if (record.gone) {
    if (known == others_.end()) return;
    if (record.axis <= kMaxAxisNumber) known->second.axes.reset(record.axis);
    if (record.axis == 0 || known->second.axes.none()) others_.erase(known);
    return;
  }
  if (record.axis == 0 || record.axis > kMaxAxisNumber) return;
  if (known == others_.end() && others_.size() >= kMaxNamesakes) return;
  Other& other = known == others_.end() ? others_[record.writer] : known->second;
  other.axes.set(record.axis);
  other.where = record.where;
  other.seen = true;
}

AxisNumber Namesakes::shared(const Other** whose) const {
  for (const auto& [writer, other] : others_) {
    for (const auto& axis : image_.axes()) {
      if (axis->number > kMaxAxisNumber || !other.axes.test(axis->number)) continue;
      if (whose != nullptr) *whose = &other;
      return axis->number;
    }
  }
  return 0;
}

void Namesakes::on_link_up(Instant until) {
  for (auto& [writer, other] : others_) other.seen = false;
  until_ = others_.empty() ? kNever : until;
}

void Namesakes::on_time(Instant now) {
  if (now < until_) return;
  until_ = kNever;
  std::erase_if(others_, [](const auto& each) { return !each.second.seen; });
}

std::string Namesakes::text() const {
  const Other* whose = nullptr;
  const AxisNumber axis = shared(&whose);
  if (axis == 0) return {};
  return "axis " + std::to_string(axis) + (whose->where.empty() ? "" : " of " + whose->where);
}

}  // namespace axisgate::dds
