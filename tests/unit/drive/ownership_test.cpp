// SPDX-License-Identifier: Apache-2.0
// Design 3.5 as rules: who owns an axis, who may take it, and when its lease runs out.
#include <gtest/gtest.h>

#include "gateway/drive/motion/jog.hpp"
#include "gateway/drive/motion/ownership.hpp"
#include "tests/unit/drive/alone.hpp"
#include "tests/unit/drive/clients.hpp"

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;
using test::client;
using Taken = Ownership::Taken;

struct Owned : testing::Test {
  Lease lease;
  LeaseRules rules{};
  std::shared_ptr<ClientLife> plc = client(1, "10.0.0.1");
  std::shared_ptr<ClientLife> panel = client(2, "10.0.0.2");
  Ownership of(LeaseRules with) { return Ownership(lease, with); }
  /// Owned by the PLC since `at`, and heard from then.
  Ownership owned(LeaseRules with, Instant at) {
    Ownership out = of(with);
    plc->last_request = at;
    out.set_armed(true);
    EXPECT_EQ(out.take(plc, at), Taken::free);
    return out;
  }
};

TEST_F(Owned, TheFirstClaimMakesAnOwnerAndOthersAreRefused) {
  Ownership o = owned(rules, kStart);
  EXPECT_TRUE(lease.owned_by(1));
  EXPECT_EQ(o.judge(plc, true), Errc::ok);
  EXPECT_EQ(o.judge(panel, true), Errc::not_owner);
  EXPECT_EQ(o.judge(panel, false), Errc::not_owner);
}

TEST_F(Owned, TheGatewayItselfIsNeverRefused) {
  const Ownership o = owned(rules, kStart);
  EXPECT_EQ(o.judge(nullptr, false), Errc::ok);
}

TEST_F(Owned, NobodyIsRefusedAndNothingRunsOutWhereLeasesAreOff) {
  rules.on = false;
  Ownership o = of(rules);
  EXPECT_EQ(o.take(plc, kStart), Taken::nothing);
  EXPECT_EQ(o.judge(panel, true), Errc::ok);
  EXPECT_EQ(o.until(), kNever);
  EXPECT_TRUE(o.live(kStart + 1h));
  EXPECT_EQ(o.may_take_over(panel), Errc::not_supported);
  EXPECT_EQ(o.release(plc, true, kStart), Errc::not_supported);
}

TEST_F(Owned, ARequestOfAnyKindRenewsALeaseThatAnyRequestRenews) {
  Ownership o = owned(rules, kStart);
  plc->last_request = kStart + 1500ms;
  EXPECT_FALSE(o.take_expired(kStart + 2000ms));
  EXPECT_EQ(o.until(), kStart + 3500ms);
  EXPECT_TRUE(o.live(kStart + 3499ms));
  EXPECT_FALSE(o.live(kStart + 3500ms));
  const auto expired = o.take_expired(kStart + 3500ms);
  ASSERT_TRUE(expired);
  EXPECT_EQ(expired->owner, plc);
  EXPECT_FALSE(lease.owner);
  EXPECT_FALSE(o.take_expired(kStart + 9s)) << "told once";
}

TEST_F(Owned, OnlyAWriteRenewsALeaseThatWritesRenew) {
  rules.renew = LeaseRenewal::write;
  Ownership o = owned(rules, kStart);
  plc->last_request = plc->heartbeat = kStart + 1900ms;
  o.wrote(panel, true, true, kStart + 1900ms);
  EXPECT_EQ(o.until(), kStart + 2000ms);
  o.wrote(plc, false, true, kStart + 1000ms);
  EXPECT_EQ(o.until(), kStart + 3000ms);
}

TEST_F(Owned, OnlyAChangedHeartbeatRenewsALeaseThatHeartbeatsRenew) {
  rules.renew = LeaseRenewal::heartbeat;
  Ownership o = owned(rules, kStart);
  plc->last_request = kStart + 1900ms;
  o.wrote(plc, false, true, kStart + 1900ms);
  EXPECT_EQ(o.until(), kStart + 2000ms) << "a PLC in STOP goes on scanning the same block";
  o.wrote(plc, true, true, kStart + 1000ms);
  EXPECT_EQ(o.until(), kStart + 3000ms) << "register 56";
  plc->heartbeat = kStart + 1800ms;
  EXPECT_EQ(o.until(), kStart + 3800ms) << "register 8 of the gateway";
}

TEST_F(Owned, AnOrphanIsTakenOverByItsOwnAddressAndRoleAlone) {
  Ownership o = owned(rules, kStart);
  plc->connected = false;
  const auto again = client(7, "10.0.0.1");
  const auto viewer = client(8, "10.0.0.1", Role::engineer);
  EXPECT_EQ(o.judge(panel, true), Errc::not_owner);
  EXPECT_EQ(o.judge(viewer, true), Errc::not_owner) << "another role";
  EXPECT_EQ(o.judge(again, false), Errc::ok) << "whatever it asks";
  EXPECT_TRUE(o.waits_for(again, true)) << "zeros are a write as well";
  EXPECT_FALSE(o.waits_for(panel, false));
  ASSERT_EQ(o.judge(again, true), Errc::ok);
  EXPECT_EQ(o.take(again, kStart + 1s), Taken::orphan);
  EXPECT_TRUE(lease.owned_by(7));
  EXPECT_EQ(o.until(), kStart + 3s);
}

TEST_F(Owned, AnOrphanIsNotTakenOverByAProgramThatWasThereWhileItsOwnerAsked) {
  Ownership o = owned(rules, kStart);
  plc->last_request = kStart + 500ms;
  plc->connected = false;
  const auto beside = client(7, "10.0.0.1");
  beside->opened = kStart + 499ms;
  EXPECT_EQ(o.judge(beside, true), Errc::not_owner);
  EXPECT_FALSE(o.waits_for(beside, false));
  EXPECT_EQ(o.may_take_over(beside), Errc::ok) << "by command 14, which is meant so";
  beside->opened = kStart + 500ms;
  EXPECT_EQ(o.judge(beside, true), Errc::ok);
  EXPECT_TRUE(o.waits_for(beside, false));
}

TEST_F(Owned, AProgramsOtherWriterMakesWayForItAndNobodyElseDoes) {
  Ownership o = owned(rules, kStart);
  const auto other = client(3, "10.0.0.1");
  EXPECT_EQ(o.judge(other, true), Errc::not_owner);
  other->goes_on_for = plc->id;
  EXPECT_EQ(o.judge(other, true), Errc::ok);
  EXPECT_EQ(o.judge(panel, true), Errc::not_owner);
  other->goes_on_for = 9;
  EXPECT_EQ(o.judge(other, true), Errc::not_owner);
}

TEST_F(Owned, AnOrphanRunsOutLikeAnyLease) {
  Ownership o = owned(rules, kStart);
  plc->connected = false;
  EXPECT_TRUE(o.live(kStart + 1999ms));
  EXPECT_TRUE(o.take_expired(kStart + 2s));
}

TEST_F(Owned, ASilentOwnersLeaseRunsOutAndIsNotTakenBefore) {
  Ownership o = owned(rules, kStart);
  const auto again = client(7, "10.0.0.1");
  EXPECT_EQ(o.judge(again, true), Errc::not_owner);
  EXPECT_FALSE(o.waits_for(again, false));
}

TEST_F(Owned, TakeOverBetweenConnectionsOfOneAddressAndRoleNeedsNoRank) {
  Ownership o = owned(rules, kStart);
  const auto again = client(7, "10.0.0.1");
  EXPECT_EQ(o.may_take_over(client(8, "10.0.0.1", Role::engineer)), Errc::not_owner) << "another role";
  EXPECT_EQ(o.may_take_over(again), Errc::ok);
  EXPECT_EQ(o.take(again, kStart + 10ms), Taken::same_origin_and_role);
  EXPECT_EQ(o.judge(plc, true), Errc::not_owner);
}

TEST_F(Owned, WhileDisabledOnlyWhatAsksRenewsWhicheverSignCountsElse) {
  for (const LeaseRenewal renew : {LeaseRenewal::any, LeaseRenewal::write, LeaseRenewal::heartbeat}) {
    rules.renew = renew;
    lease = {};
    plc->heartbeat = kLongAgo;
    Ownership o = owned(rules, kStart);
    o.set_armed(false);
    plc->last_request = plc->heartbeat = kStart + 1900ms;
    o.wrote(plc, true, false, kStart + 1900ms);
    EXPECT_EQ(o.until(), kStart + 2000ms) << "a scanner's block with a heartbeat asks for nothing";
    o.wrote(plc, false, true, kStart + 1000ms);
    EXPECT_EQ(o.until(), kStart + 3000ms);
  }
}

TEST_F(Owned, ALeaseThatReadsHaveKeptGoesOnFromTheLastWhenTheAxisIsDisabled) {
  Ownership o = owned(rules, kStart);
  plc->last_request = kStart + 60s;
  o.set_armed(false);
  EXPECT_EQ(o.until(), kStart + 62s);
  plc->last_request = kStart + 61s;
  EXPECT_EQ(o.until(), kStart + 62s);
  o.set_armed(true);
  EXPECT_EQ(o.until(), kStart + 63s);
}

TEST_F(Owned, AnAdoptedAxisWaitsForAnyWriteButABlockOfZeros) {
  Ownership o = of(rules);
  o.open(kStart);
  EXPECT_TRUE(o.waits_for(panel, false));
  EXPECT_FALSE(o.waits_for(panel, true));
  EXPECT_FALSE(o.waits_for(nullptr, false));
}

TEST_F(Owned, AReleasedAxisWaitsForWhoAsksForSomething) {
  Ownership o = owned(rules, kStart);
  ASSERT_EQ(o.release(plc, true, kStart), Errc::ok);
  EXPECT_FALSE(o.waits_for(plc, false)) << "its scanner goes on writing the same block";
  EXPECT_EQ(o.judge(panel, true), Errc::ok);
}

TEST_F(Owned, TakeOverNeedsAHigherRank) {
  Ownership o = owned(rules, kStart);
  EXPECT_EQ(o.may_take_over(panel), Errc::not_owner) << "equal ranks";
  panel->rank = 1;
  EXPECT_EQ(o.may_take_over(panel), Errc::ok);
  EXPECT_EQ(o.take(panel, kStart + 10ms), Taken::lower_rank);
  EXPECT_EQ(o.may_take_over(plc), Errc::not_owner);
  EXPECT_EQ(o.may_take_over(panel), Errc::ok) << "the owner itself";
}

TEST_F(Owned, ReleaseFreesADisabledAxisAndLeavesAnEnabledOneOpen) {
  Ownership o = owned(rules, kStart);
  EXPECT_EQ(o.release(panel, false, kStart), Errc::not_owner);
  EXPECT_EQ(o.release(plc, false, kStart + 1s), Errc::ok);
  EXPECT_EQ(o.until(), kNever);
  EXPECT_EQ(o.take(panel, kStart + 1s), Taken::free);
  EXPECT_EQ(o.release(panel, true, kStart + 2s), Errc::ok);
  EXPECT_FALSE(lease.owner);
  EXPECT_EQ(o.until(), kStart + 4s);
  EXPECT_EQ(o.judge(plc, true), Errc::ok) << "open to every operator";
  const auto expired = o.take_expired(kStart + 4s);
  ASSERT_TRUE(expired);
  EXPECT_TRUE(expired->was_open);
}

TEST_F(Owned, AStrongerDdsWriterTakesTheAxisFromAWeakerOneByAClaimAlone) {
  const auto weak = client(11, "participant a");
  const auto strong = client(12, "participant b");
  weak->strength = 5;
  strong->strength = 6;
  weak->last_request = strong->last_request = kStart;
  Ownership o = of(rules);
  EXPECT_EQ(o.take(weak, kStart), Taken::free);
  EXPECT_EQ(o.judge(strong, false), Errc::not_owner) << "not by what claims nothing";
  EXPECT_EQ(o.judge(strong, true), Errc::ok);
  EXPECT_EQ(o.take(strong, kStart + 1s), Taken::weaker);
  EXPECT_EQ(o.until(), kStart + 3s) << "the lease runs anew";
  EXPECT_EQ(o.judge(weak, true), Errc::not_owner);
  weak->strength = 6;
  EXPECT_EQ(o.judge(weak, true), Errc::not_owner) << "who is as strong is not stronger";
  EXPECT_NE(text(Taken::weaker, *strong).find("weaker DDS writer"), std::string::npos);
}

TEST_F(Owned, StrengthIsNothingToAModbusClient) {
  const auto strong = client(12, "participant b");
  strong->strength = INT32_MAX;
  Ownership o = owned(rules, kStart);
  EXPECT_EQ(o.judge(strong, true), Errc::not_owner);
  ASSERT_EQ(o.release(plc, false, kStart), Errc::ok);
  strong->strength = INT32_MIN;
  EXPECT_EQ(o.take(strong, kStart), Taken::free);
  EXPECT_EQ(o.judge(plc, true), Errc::not_owner) << "nor does it make one strong";
}

TEST_F(Owned, GraceMakesALeaseLongerByItselfAndNotEachTime) {
  Ownership o = owned(rules, kStart);
  plc->grace = {3s, kStart + 1s};
  EXPECT_EQ(o.until(), kStart + 5s);
  EXPECT_FALSE(o.take_expired(kStart + 4999ms));
  EXPECT_TRUE(o.live(kStart + 4999ms));
  plc->grace = {3s, kStart + 4s};
  EXPECT_EQ(o.until(), kStart + 5s);
  const auto expired = o.take_expired(kStart + 5s);
  ASSERT_TRUE(expired);
  EXPECT_EQ(expired->owner, plc);
  EXPECT_EQ(o.take(panel, kStart + 6s), Taken::free);
  EXPECT_EQ(o.until(), kStart + 8s) << "another client's lease has none of it";
}

TEST_F(Owned, GraceOfAnyRenewalIsAddedToWhatRenewedItBeforeAndToNothingLater) {
  for (const LeaseRenewal renew : {LeaseRenewal::any, LeaseRenewal::write, LeaseRenewal::heartbeat}) {
    lease = {};
    plc->heartbeat = kLongAgo;
    rules.renew = renew;
    Ownership o = owned(rules, kStart);
    plc->grace = {3s, kStart};
    EXPECT_EQ(o.until(), kStart + 5s);
    plc->last_request = plc->heartbeat = kStart + 4s;
    o.wrote(plc, true, true, kStart + 4s);
    EXPECT_EQ(o.until(), kStart + 6s);
    plc->grace.since = kStart + 4s;
    EXPECT_EQ(o.until(), kStart + 9s);
  }
}

TEST_F(Owned, AnAxisFoundEnabledIsOpenUntilItsLeaseRunsOut) {
  Ownership o = of(rules);
  o.open(kStart);
  EXPECT_EQ(o.judge(panel, true), Errc::ok);
  EXPECT_EQ(o.take(panel, kStart + 1s), Taken::open);
  o.open(kStart + 2s);
  EXPECT_TRUE(lease.owned_by(2)) << "an owned axis is not opened";
}

// --- Jog
// ---------------------------------------------------------------------------------------------------------------

TEST(Jog, EndsUnlessItsCoilIsWrittenAgainInTime) {
  Jog jog;
  jog.start(Command::jog_forward, 1, kStart, 500ms, 1);
  EXPECT_FALSE(jog.expired(kStart + 499ms));
  static_cast<void>(jog.again(Command::jog_forward, 1, kStart + 400ms));
  EXPECT_FALSE(jog.expired(kStart + 899ms));
  static_cast<void>(jog.again(Command::jog_reverse, 1, kStart + 800ms));
  static_cast<void>(jog.again(Command::jog_forward, 2, kStart + 800ms));
  EXPECT_TRUE(jog.expired(kStart + 900ms)) << "neither another coil nor another client holds it";
}

TEST(Jog, IsNotBegunAnewByAButtonThatIsStillHeld) {
  Jog jog;
  jog.start(Command::jog_forward, 1, kStart, 500ms, 1);
  jog.end();
  static_cast<void>(jog.again(Command::jog_forward, 1, kStart + 100ms));
  EXPECT_FALSE(jog.active());
  EXPECT_EQ(jog.until(), kNever);
}

TEST(JogTravel, BeginsTheHaltAsFarAheadOfTheLimitAsTheRampTakes) {
  // 600 rpm, 600 rpm/s: one second at 5 turns/s on average is 5 turns, 50,000 units.
  JogTravel travel{.position = 0, .velocity = 600'000, .deceleration = 6'000, .limits = {-200'000, 100'000}};
  travel.position = 49'000;
  EXPECT_EQ(time_left(travel, Command::jog_forward), 10ms) << "1,000 units at 10 turns/s";
  travel.position = 50'500;
  EXPECT_EQ(time_left(travel, Command::jog_forward), 0ms);
  EXPECT_GT(time_left(travel, Command::jog_reverse), 1s) << "away from the limit";
  travel.velocity = -600'000;
  travel.position = -150'500;
  EXPECT_EQ(time_left(travel, Command::jog_reverse), 0ms);
}

TEST(JogTravel, AtTheLimitOnlyTheWayBackIsOpen) {
  const JogTravel travel{.position = 100'000, .limits = {0, 100'000}};
  EXPECT_EQ(time_left(travel, Command::jog_forward), 0s);
  EXPECT_EQ(time_left(travel, Command::jog_reverse), 1h) << "it stands";
}

}  // namespace
}  // namespace axisgate::drive
