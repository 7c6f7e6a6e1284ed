// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/discovery/namesake_watch.hpp"

#include <algorithm>
#include <string_view>

namespace axisgate::dds {

std::vector<std::uint8_t> gateway_user_data(std::uint32_t key) {
  constexpr std::string_view kWhat = "axisgate gateway_key ";
  const std::string text = std::string(kWhat) + std::to_string(key);
  return {text.begin(), text.end()};
}

void NamesakeWatch::on_discovered(const Guid& writer, const std::vector<std::uint8_t>& user_data,
                                  const std::string& where) {
  if (user_data != gateway_user_data(key_)) return;
  const std::lock_guard lock(mutex_);
  if (others_.size() >= kMaxNamesakesKnown && !others_.contains(writer)) return;
  Other& other = others_[writer];
  other.where = where;
  other.gone = false;
}

void NamesakeWatch::on_removed(const Guid& writer) {
  const std::lock_guard lock(mutex_);
  const auto found = others_.find(writer);
  if (found == others_.end()) return;
  found->second.axes.reset();
  found->second.gone = true;
  if (found->second.reported.none()) others_.erase(found);
}

void NamesakeWatch::on_gateway(const Guid& writer, std::uint32_t key) {
  const std::lock_guard lock(mutex_);
  if (key == key_ && gateways_.size() < kMaxNamesakesKnown) gateways_.insert(writer);
}

void NamesakeWatch::on_gateway_gone(const Guid& writer) {
  const std::lock_guard lock(mutex_);
  gateways_.erase(writer);
}

void NamesakeWatch::on_state(const Guid& writer, std::uint32_t key, std::uint16_t axis, bool has) {
  const std::lock_guard lock(mutex_);
  const auto found = others_.find(writer);
  if (key != key_ || axis == 0 || axis > kMaxAxisNumber || found == others_.end() || found->second.gone) return;
  found->second.axes.set(axis, has);
}

bool NamesakeWatch::any() const {
  const std::lock_guard lock(mutex_);
  return !gateways_.empty() ||
         std::any_of(others_.begin(), others_.end(), [](const auto& each) { return !each.second.gone; });
}

std::vector<NamesakeRecord> NamesakeWatch::take(std::size_t most) {
  const std::lock_guard lock(mutex_);
  std::vector<NamesakeRecord> taken;
  for (auto each = others_.begin(); each != others_.end() && taken.size() < most;) {
    auto& [writer, other] = *each;
    if (other.gone) {
      taken.push_back({writer, 0, other.where, true});
      each = others_.erase(each);
      continue;
    }
    const auto changed = other.axes ^ other.reported;
    for (std::uint16_t axis = 1; axis <= kMaxAxisNumber && changed.any() && taken.size() < most; ++axis) {
      if (!changed.test(axis)) continue;
      other.reported.flip(axis);
      taken.push_back({writer, axis, other.where, !other.axes.test(axis)});
    }
    ++each;
  }
  return taken;
}

}  // namespace axisgate::dds
