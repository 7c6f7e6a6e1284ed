// SPDX-License-Identifier: Apache-2.0
// What the store says of when something became of an object: whoever made anything of the object looks again.
#include "gateway/drive/state/object_store.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "tests/unit/drive/alone.hpp"

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;

constexpr model::ObjectId kPlain = 0, kAlias = 1, kWhole = 2, kPart = 3, kMagnitude = 4, kWay = 5, kDirected = 6;

std::vector<model::ObjectDef> objects() {
  std::vector<model::ObjectDef> out(7);
  out[kPlain].aliases = {kAlias};
  out[kAlias].aliases = {kPlain};
  out[kPart].part = {.whole = kWhole, .from = 0, .count = 4};
  out[kDirected].part = {.whole = kMagnitude, .sign = kWay, .positive = 1, .negative = 2};
  return out;
}

struct Become {
  const char* what;
  std::function<void(ObjectStore&, model::ObjectId)> make;
};

const Become kBecome[] = {
    {"read", [](ObjectStore& s, model::ObjectId id) { s.read(id, 1, kStart); }},
    {"read as before", [](ObjectStore& s, model::ObjectId id) { s.read(id, 0, kStart); }},
    {"received", [](ObjectStore& s, model::ObjectId id) { s.received(id, 1, kStart); }},
    {"acknowledged", [](ObjectStore& s, model::ObjectId id) { s.acknowledged(id, 1, kStart); }},
    {"asked", [](ObjectStore& s, model::ObjectId id) { s.asked(id, 1, kStart); }},
    {"made", [](ObjectStore& s, model::ObjectId id) { s.make(id, 1); }},
    {"refused", [](ObjectStore& s, model::ObjectId id) { s.refused(id); }},
    {"unresponsive", [](ObjectStore& s, model::ObjectId id) { s.unresponsive(id); }},
    {"unlike", [](ObjectStore& s, model::ObjectId id) { s.unlike(id); }},
    {"invalidated", [](ObjectStore& s, model::ObjectId id) { s.invalidate(id); }},
    {"all invalidated", [](ObjectStore& s, model::ObjectId) { s.invalidate_all(); }},
    {"out of contact", [](ObjectStore& s, model::ObjectId) { s.lose_contact(); }},
    {"outdated", [](ObjectStore& s, model::ObjectId id) { s.outdate(id); }},
    {"forgotten", [](ObjectStore& s, model::ObjectId id) { s.forget(id); }},
    {"all forgotten", [](ObjectStore& s, model::ObjectId) { s.forget_all(); }},
    {"confirmed as often", [](ObjectStore& s, model::ObjectId id) { s.set_period(id, 1s); }},
};

TEST(ObjectStore, SaysThatSomethingBecameOfAnObject) {
  for (const Become& each : kBecome) {
    ObjectStore store(objects());
    const auto before = store.changed(kPlain);
    each.make(store, kPlain);
    EXPECT_NE(store.changed(kPlain), before) << each.what;
  }
}

TEST(ObjectStore, SaysSoOfAnAliasAPartAndWhatHasADirection) {
  ObjectStore store(objects());
  const auto steps = [&](model::ObjectId read, model::ObjectId looked_at) {
    const auto before = store.changed(looked_at);
    store.read(read, 1, kStart);
    return store.changed(looked_at) != before;
  };
  EXPECT_TRUE(steps(kPlain, kAlias));
  EXPECT_TRUE(steps(kWhole, kPart));
  EXPECT_TRUE(steps(kMagnitude, kDirected));
  EXPECT_TRUE(steps(kWay, kDirected));
  EXPECT_FALSE(steps(kPlain, kWhole)) << "nothing became of it";
}

}  // namespace
}  // namespace axisgate::drive
