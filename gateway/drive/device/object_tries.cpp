// SPDX-License-Identifier: Apache-2.0
#include "gateway/drive/device/object_tries.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace axisgate::drive {

void ObjectTries::restart() {
  for (Entry& e : entries_) e = {.reported = e.reported};
  given_up_.clear();
}

void ObjectTries::keep_given_up(model::ObjectId object, Instant now) {
  entries_[object] = {.tries = kTries, .pause = kFirstPause, .again = now + kFirstPause, .reported = true};
}

bool ObjectTries::in_vain(model::ObjectId object, const Refusal& refusal, bool needed, Instant now) {
  Entry& e = entries_[object];
  e.refusal = refusal;
  const bool was_given_up = e.tries == kTries;
  if (!was_given_up && ++e.tries < kTries) {
    if (refusal) e.again = now + kRefusedPause;
    return false;
  }
  const Duration longest = needed ? kLongestNeeded : kLongestPause;
  e.pause = e.pause == Duration{} ? kFirstPause : std::min(2 * e.pause, longest);
  e.again = now + e.pause;
  if (!was_given_up) given_up_.push_back({object, !std::exchange(e.reported, true)});
  return true;
}

bool ObjectTries::answered(model::ObjectId object) {
  const bool was_given_up = given_up(object);
  entries_[object] = {};
  std::erase_if(given_up_, [object](const GivenUp& g) { return g.object == object; });
  if (!was_given_up) return false;
  for (Entry& e : entries_) {
    e.again = kLongAgo;
    e.pause = {};
  }
  return true;
}

std::vector<ObjectTries::GivenUp> ObjectTries::take_given_up() { return std::exchange(given_up_, {}); }

namespace {

void add_uses(const model::DriveModel& model, model::ObjectId object, std::vector<std::string>& uses) {
  const auto has = [](const auto& list, const auto& what) { return std::ranges::find(list, what) != list.end(); };
  const auto add = [&](std::string use) {
    if (!has(uses, use)) uses.push_back(std::move(use));
  };
  for (const model::AxisModel& axis : model.axes) {
    if (axis.needs_for_state(object)) add(fmt::format("the state of axis {}", axis.number));
    for (const model::Binding& binding : axis.bindings) {
      const bool of_bits = std::ranges::find(binding.bits, object, &model::BitField::object) != binding.bits.end();
      if (binding.object == object || of_bits) add(std::string(row(binding.quantity).name));
    }
    if (has(axis.fault_words, object)) add("the causes of faults");
  }
  for (const model::Check& check : model.checks)
    if (check.bad.object == object) add("the check " + check.name);
  if (has(model.loss_objects, object)) add("what stops the drive when the gateway dies");
  for (const model::ObjectWrite& setup : model.setup)
    if (setup.object == object) add("the set-up");
  if (has(model::constant_objects(model), object)) add("the axis's scales");
}

}  // namespace

std::string uses_of(const model::DriveModel& model, model::ObjectId object) {
  std::vector<std::string> uses;
  for (const model::ObjectId id : model.with_parts(object)) add_uses(model, id, uses);
  if (uses.empty()) uses.emplace_back("its commands");
  return fmt::format("{}", fmt::join(uses, ", "));
}

}  // namespace axisgate::drive
