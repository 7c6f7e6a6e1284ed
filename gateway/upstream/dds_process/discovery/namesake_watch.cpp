// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/discovery/namesake_watch.hpp"

#include <string_view>
#include <utility>

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
  if (others_.size() < kMaxNamesakesKnown || others_.contains(writer)) others_[writer].where = where;
}

void NamesakeWatch::on_removed(const Guid& writer) {
  const std::lock_guard lock(mutex_);
  const auto found = others_.find(writer);
  if (found == others_.end()) return;
  if (!found->second.axes.empty()) changes_.push_back({writer, 0, found->second.where, true});
  others_.erase(found);
}

void NamesakeWatch::on_gateway(const Guid& writer, std::uint32_t key) {
  const std::lock_guard lock(mutex_);
  if (key == key_ && gateways_.size() < kMaxNamesakesKnown) gateways_.insert(writer);
}

void NamesakeWatch::on_gateway_gone(const Guid& writer) {
  const std::lock_guard lock(mutex_);
  gateways_.erase(writer);
}

void NamesakeWatch::on_state(const Guid& writer, std::uint32_t key, std::uint16_t axis) {
  const std::lock_guard lock(mutex_);
  const auto found = others_.find(writer);
  if (key != key_ || axis > kMaxAxisNumber || found == others_.end()) return;
  if (found->second.axes.insert(axis).second) changes_.push_back({writer, axis, found->second.where, false});
}

bool NamesakeWatch::any() const {
  const std::lock_guard lock(mutex_);
  return !others_.empty() || !gateways_.empty();
}

std::vector<NamesakeRecord> NamesakeWatch::take(std::size_t most) {
  const std::lock_guard lock(mutex_);
  std::vector<NamesakeRecord> taken;
  for (; !changes_.empty() && most > 0; changes_.pop_front(), --most) taken.push_back(std::move(changes_.front()));
  return taken;
}

}  // namespace axisgate::dds
