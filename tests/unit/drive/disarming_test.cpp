// SPDX-License-Identifier: Apache-2.0
// A drive's watch over the gateway at the end on purpose: each step with each outcome, against three entries and two
// motors.
#include "gateway/drive/device/disarming.hpp"

#include <gtest/gtest.h>

#include <map>

namespace axisgate::drive {
namespace {

constexpr model::ObjectId kStatusA = 0, kStatusB = 1, kGuardTime = 2, kLifeFactor = 3, kReaction = 4, kElse = 5;
constexpr std::int64_t kDisabled = 0x250, kEnabled = 0x237, kQuickStop = 0x217, kFault = 0x218, kFaultReaction = 0x21F;

model::DriveModel two_motors() {
  model::DriveModel model;
  for (const char* name : {"status a", "status b", "guard time", "life factor", "reaction", "else"}) {
    model::ObjectDef object;
    object.name = name;
    object.address = {static_cast<std::uint16_t>(0x2000 + model.objects.size()), 0};
    object.size = 2;
    model.objects.push_back(object);
  }
  for (const model::ObjectId status : {kStatusA, kStatusB}) {
    model::AxisModel axis;
    axis.statusword = status;
    axis.state_sources = {status};
    model.axes.push_back(axis);
  }
  model.setup = {{kElse, 7, ""}, {kGuardTime, 200, ""}, {kLifeFactor, 3, ""}, {kReaction, 1, ""}};
  model.loss_objects = {kGuardTime, kLifeFactor, kReaction};
  return model;
}

enum class Befalls : std::uint8_t { nothing, lost_request, lost_reply, refused, late };
constexpr std::array kAllThatBefalls{Befalls::nothing, Befalls::lost_request, Befalls::lost_reply, Befalls::refused,
                                     Befalls::late};

struct Played {
  std::map<model::ObjectId, std::int64_t> drive{{kStatusA, kDisabled}, {kStatusB, kDisabled}, {kGuardTime, 200},
                                                {kLifeFactor, 3},      {kReaction, 1},        {kElse, 7}};
  std::map<int, Befalls> befalls;
  std::function<void(Played&, int step)> meanwhile = [](Played&, int) {};
  std::optional<int> brought_up_to{};  ///< so many of its entries are written; the store knows what was there before
  std::vector<model::ObjectId> written{};
  int steps = 0;
  Disarming::Outcome outcome{};

  [[nodiscard]] bool armed() const {
    return drive.at(kGuardTime) == 200 && drive.at(kLifeFactor) == 3 && drive.at(kReaction) == 1;
  }
  [[nodiscard]] bool disarmed() const {
    return drive.at(kGuardTime) == 0 && drive.at(kLifeFactor) == 0 && drive.at(kReaction) == 0;
  }

  void play() {
    const model::DriveModel model = two_motors();
    ObjectStore store(model.objects);
    for (const auto& [id, number] : drive) store.read(id, brought_up_to ? 0 : number, {});
    Disarming disarming(model);
    disarming.begin(store, brought_up_to.has_value());
    constexpr int kMost = 100;
    for (auto next = disarming.next(); next && steps < kMost; next = disarming.next(), ++steps) {
      meanwhile(*this, steps);
      const Befalls how = befalls[steps];
      bus::ExchangeResult result;
      if (next->write && (how == Befalls::nothing || how == Befalls::lost_reply || how == Befalls::late)) {
        drive[next->object] = next->number;
        written.push_back(next->object);
      }
      if (how == Befalls::lost_request || how == Befalls::lost_reply) result.code = Errc::timed_out;
      if (how == Befalls::refused) result.code = Errc::refused_by_drive;
      if (!next->write && how == Befalls::nothing) store.read(next->object, drive[next->object], {});
      disarming.on_result(result, how != Befalls::late, store);
    }
    ASSERT_LT(steps, kMost);
    outcome = disarming.outcome();
  }
};

TEST(Disarming, ClearsTheReactionFirstWhereNoMotorHasTorque) {
  Played played;
  played.drive[kStatusB] = kFault;
  played.play();
  EXPECT_EQ(played.outcome, Disarming::Outcome::disarmed);
  EXPECT_TRUE(played.disarmed());
  EXPECT_EQ(played.written, (std::vector<model::ObjectId>{kReaction, kLifeFactor, kGuardTime}));
  EXPECT_EQ(played.drive[kElse], 7) << "no part of the watch";
}

TEST(Disarming, WritesNothingWhereAMotorHasTorque) {
  for (const model::ObjectId motor : {kStatusA, kStatusB}) {
    for (const std::int64_t state : {kEnabled, kQuickStop, kFaultReaction}) {
      Played played;
      played.drive[motor] = state;
      played.play();
      EXPECT_EQ(played.outcome, Disarming::Outcome::enabled);
      EXPECT_TRUE(played.written.empty());
    }
  }
}

// By its keypad, by another master: before the first look, between two writes, behind the last one.
TEST(Disarming, PutsBackWhatItClearedFromADriveThatIsEnabledMeanwhile) {
  Played quiet;
  quiet.play();
  for (int enabled_at = 0; enabled_at < quiet.steps; ++enabled_at) {
    for (const model::ObjectId motor : {kStatusA, kStatusB}) {
      Played played;
      played.meanwhile = [&](Played& p, int step) {
        if (step == enabled_at) p.drive[motor] = kEnabled;
      };
      played.play();
      const bool too_late = enabled_at == quiet.steps - 1 && motor == kStatusA;  // it was read already
      EXPECT_EQ(played.disarmed(), too_late) << enabled_at;
      EXPECT_EQ(played.armed(), !too_late) << enabled_at;
    }
  }
}

TEST(Disarming, LeavesAnEntryThatHoldsAnotherNumber) {
  Played played;
  played.drive[kGuardTime] = 100;
  played.play();
  EXPECT_EQ(played.drive[kGuardTime], 100);
  EXPECT_EQ(played.drive[kReaction], 0);
  Played nothing;
  nothing.drive[kGuardTime] = nothing.drive[kLifeFactor] = nothing.drive[kReaction] = 0;
  nothing.play();
  EXPECT_EQ(nothing.outcome, Disarming::Outcome::nothing_to_do);
  EXPECT_EQ(nothing.steps, 0);
}

// Which of its entries a bring-up has written before it was broken off nobody knows: they are read.
TEST(Disarming, ReadsWhatABrokenOffBringUpHasWritten) {
  for (int written = 0; written <= 3; ++written) {
    SCOPED_TRACE(written);
    Played played;
    played.brought_up_to = written;
    constexpr std::array kInOrder{kGuardTime, kLifeFactor, kReaction};
    for (std::size_t i = static_cast<std::size_t>(written); i < kInOrder.size(); ++i) played.drive[kInOrder[i]] = 0;
    played.play();
    EXPECT_TRUE(played.disarmed());
    EXPECT_EQ(played.written.size(), static_cast<std::size_t>(written));
    EXPECT_EQ(played.outcome, written == 0 ? Disarming::Outcome::nothing_to_do : Disarming::Outcome::disarmed);
  }
  Played lost;
  lost.brought_up_to = 3;
  lost.befalls[0] = Befalls::lost_reply;
  lost.play();
  EXPECT_EQ(lost.outcome, Disarming::Outcome::unknown);
  EXPECT_TRUE(lost.armed());
}

// Whatever befalls any two of its exchanges, beside a drive that is enabled at any moment or never: what it says is so.
TEST(Disarming, IsTrueWhateverBefallsTwoExchanges) {
  constexpr int kSteps = 12;
  int seen = 0;
  for (int first = 0; first < kSteps; ++first) {
    for (int second = first + 1; second < kSteps; ++second) {
      for (const Befalls how : kAllThatBefalls) {
        for (const Befalls then : kAllThatBefalls) {
          for (int enabled_at = -1; enabled_at < kSteps; ++enabled_at) {
            Played played;
            played.befalls = {{first, how}, {second, then}};
            played.meanwhile = [&](Played& p, int step) {
              if (step == enabled_at) p.drive[kStatusB] = kEnabled;
            };
            played.play();
            ++seen;
            const auto refused = [&](int step) { return played.befalls[step] == Befalls::refused; };
            const bool a_write_refused = refused(first) || refused(second);
            SCOPED_TRACE(testing::Message() << first << ' ' << static_cast<int>(how) << ' ' << second << ' '
                                            << static_cast<int>(then) << ' ' << enabled_at);
            switch (played.outcome) {
              case Disarming::Outcome::disarmed:
                EXPECT_TRUE(played.disarmed() || a_write_refused);
                break;
              case Disarming::Outcome::enabled:
              case Disarming::Outcome::unknown:
                EXPECT_TRUE(played.armed() || a_write_refused);
                break;
              case Disarming::Outcome::uncertain:
              case Disarming::Outcome::nothing_to_do:
              case Disarming::Outcome::disabled:
                FAIL() << "two failures are no three, and it was not only to look";
            }
          }
        }
      }
    }
  }
  EXPECT_EQ(seen, kSteps * (kSteps - 1) / 2 * 25 * (kSteps + 1));
}

TEST(Disarming, SaysSoWhenWhatItClearedCannotBePutBack) {
  Played played;
  for (int step = 3; step < 20; ++step) played.befalls[step] = Befalls::lost_request;
  played.play();
  EXPECT_EQ(played.outcome, Disarming::Outcome::uncertain);
}

}  // namespace
}  // namespace axisgate::drive
