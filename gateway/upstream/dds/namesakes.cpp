// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds/namesakes.hpp"

namespace axisgate::dds {

void Namesakes::on_record(const NamesakeRecord& record) {
  if (record.gone) {
    others_.erase(record.writer);
    return;
  }
  if (image_.find(record.axis) == nullptr) return;  // it has axes of its own: nobody can mistake them
  if (const auto known = others_.find(record.writer); known != others_.end()) {
    known->second.seen = true;
  } else if (others_.size() < kMaxNamesakes) {
    others_[record.writer] = {record.axis, record.where};
  }
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
  if (others_.empty()) return {};
  const Other& first = others_.begin()->second;
  return "axis " + std::to_string(first.axis) + (first.where.empty() ? "" : " of " + first.where);
}

}  // namespace axisgate::dds
