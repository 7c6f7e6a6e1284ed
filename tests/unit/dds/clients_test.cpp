// SPDX-License-Identifier: Apache-2.0
// DDS writers as clients: who they are, when they are heard, and when they are gone.
#include "gateway/upstream/dds/dds_clients.hpp"

#include <gmock/gmock.h>

#include "gateway/upstream/dds/dds_session.hpp"
#include "tests/unit/dds/fake_port.hpp"
#include "tests/unit/dds/samples.hpp"

namespace axisgate::dds {
namespace {

using namespace std::chrono_literals;
using test::beat;
using test::guid;
using test::kStart;
using test::writer_gone;
using test::writer_there;
using testing::ElementsAre;
using testing::IsEmpty;

struct Writers : testing::Test {
  ProcessImage image;
  test::FakePort port;
  SignsOfLife signs{500ms, 500ms};
  DdsSettings settings;
  Identities identities{settings};
  DdsClients clients{identities, signs, image, port};
  Writers() {
    settings.role = Role::operator_;
    image.add_axis(1, "lift", 0);
    clients.on_link_up(kStart);
  }
  /// Told of, and it has asked for something.
  std::shared_ptr<ClientLife> there(const Guid& writer, std::int32_t strength = 0, Instant now = kStart) {
    static_cast<void>(clients.on_writer(writer_there(writer, strength)));
    return clients.on_sample(writer, strength, true, now)->life;
  }
  void give(const std::shared_ptr<ClientLife>& life) {
    Lease& lease = image.find(1)->lease;
    lease.owner = life;
    lease.running = lease.any_sign = true;
    lease.renewed = kStart;
  }
};

TEST_F(Writers, AreClientsOfTheirOwnWithTheSettingsRole) {
  const auto a = there(guid(1), 5);
  const auto b = there(guid(1, 2));
  const auto c = there(guid(2));
  EXPECT_GE(a->id, kFirstDdsClient) << "never a Modbus client's";
  EXPECT_NE(a->id, b->id);
  EXPECT_EQ(a->role, Role::operator_);
  EXPECT_EQ(a->rank, 0);
  EXPECT_EQ(a->strength, 5);
  EXPECT_EQ(a->origin, b->origin) << "of one participant";
  EXPECT_NE(a->origin, c->origin);
  EXPECT_EQ(a->name, "dds 192.168.1.7 010f01000000000000000000:000001");
  EXPECT_NE(a->name, b->name);
  EXPECT_EQ(client_name(guid(1), ""), "dds 010f01000000000000000000:000001");
}

TEST_F(Writers, HaveTheRoleOfTheirCertificateOrThatOfAllOthers) {
  settings.role = Role::viewer;
  settings.roles = {{"a.pem", Role::operator_}, {"b.pem", Role::engineer}};
  identities.on_record({1, guid(7)});
  identities.on_record({2, guid(8)});
  EXPECT_EQ(there(guid(7, 2))->role, Role::engineer);
  EXPECT_EQ(there(guid(8))->role, Role::viewer) << "no such certificate was asked for";
  Guid near = guid(7);
  near[kIdentityBytes - 1] ^= 1U;
  EXPECT_EQ(there(near)->role, Role::viewer);
  Guid other_program = guid(7);
  other_program[kIdentityBytes] ^= 1U;
  EXPECT_EQ(there(other_program)->role, Role::engineer);
}

TEST_F(Writers, AreHeardAsOfThenWhereTheirBeatsLayInTheSocket) {
  const auto life = there(guid(1));
  const auto said = [](Instant then) { return beat(guid(1), then.time_since_epoch().count()); };
  clients.on_beats(said(kStart + 1s), kStart + 5s);
  EXPECT_EQ(life->last_request, kStart + 1s);
  EXPECT_EQ(life->heartbeat, kStart + 1s);
  clients.on_beats(said(kStart + 500ms), kStart + 5s);
  EXPECT_EQ(life->last_request, kStart + 1s);
  clients.on_beats(said(kStart + 9s), kStart + 5s);
  EXPECT_EQ(life->last_request, kStart + 5s) << "never later than now";
}

TEST_F(Writers, OfALivelinessThatCountsForNothingAreToldSoOnce) {
  for (const auto kind : {LivelinessKind::automatic, LivelinessKind::manual_by_participant}) {
    const Guid who = guid(static_cast<std::uint8_t>(kind));
    WriterRecord record = writer_there(who);
    record.liveliness = kind;
    EXPECT_THAT(clients.on_writer(record), testing::HasSubstr("liveliness counts for nothing"));
    EXPECT_EQ(clients.on_writer(record), "");
  }
  for (const auto kind : {LivelinessKind::endless, LivelinessKind::manual_by_topic}) {
    WriterRecord record = writer_there(guid(10 + static_cast<std::uint8_t>(kind)));
    record.liveliness = kind;
    EXPECT_EQ(clients.on_writer(record), "");
  }
}

/// Of the participant's second writer.
HeartbeatRecord heartbeat(const Guid& client, std::uint32_t counter, Instant now, std::uint32_t lease_ms = 0) {
  Guid writer = client;
  writer[14] = 77;
  return {writer, client, counter, lease_ms, now.time_since_epoch().count()};
}

TEST_F(Writers, AHeartbeatCountsWhoseCounterHasChanged) {
  const auto life = there(guid(1));
  clients.on_heartbeat(heartbeat(guid(1), 0, kStart + 1s), kStart + 1s);
  EXPECT_EQ(life->heartbeat, kStart + 1s) << "the first one, whatever its counter";
  EXPECT_EQ(life->last_request, kStart + 1s);
  clients.on_heartbeat(heartbeat(guid(1), 0, kStart + 2s), kStart + 2s);
  EXPECT_EQ(life->heartbeat, kStart + 1s) << "a library that repeats it";
  clients.on_heartbeat(heartbeat(guid(1), UINT32_MAX, kStart + 3s), kStart + 3s);
  EXPECT_EQ(life->heartbeat, kStart + 3s);
}

TEST_F(Writers, AHeartbeatCountsForItsOwnParticipantAlone) {
  const auto life = there(guid(1));
  HeartbeatRecord foreign = heartbeat(guid(1), 1, kStart + 1s);
  foreign.writer = guid(2);
  clients.on_heartbeat(foreign, kStart + 1s);
  clients.on_heartbeat(heartbeat(guid(3), 1, kStart + 1s), kStart + 1s);
  EXPECT_EQ(life->heartbeat, kLongAgo);
  EXPECT_EQ(clients.size(), 1U) << "it makes no client";
}

TEST_F(Writers, AnOldSampleRenewsNothing) {
  const auto life = there(guid(1));
  static_cast<void>(clients.on_sample(guid(1), {}, false, kStart + 5s));
  EXPECT_EQ(life->last_request, kStart);
}

TEST_F(Writers, AnOldHeartbeatRenewsNothing) {
  const auto life = there(guid(1));
  clients.on_heartbeat(heartbeat(guid(1), 1, kStart), kStart + 501ms);
  clients.on_heartbeat(heartbeat(guid(1), 2, kStart + 1002ms), kStart + 501ms);
  EXPECT_EQ(life->heartbeat, kLongAgo);
  clients.on_heartbeat(heartbeat(guid(1), 1, kStart), kStart + 500ms);
  EXPECT_EQ(life->heartbeat, kStart + 500ms);
}

TEST_F(Writers, AHeartbeatMakesItsLeasesShorterAndNeverLonger) {
  const auto life = there(guid(1));
  give(life);
  const Lease& lease = image.find(1)->lease;
  clients.on_heartbeat(heartbeat(guid(1), 1, kStart, 300), kStart);
  EXPECT_EQ(lease.until(), kStart + 300ms);
  clients.on_heartbeat(heartbeat(guid(1), 2, kStart, 9000), kStart);
  EXPECT_EQ(lease.until(), kStart + 2s);
  clients.on_heartbeat(heartbeat(guid(1), 3, kStart), kStart);
  EXPECT_EQ(lease.until(), kStart + 2s);
}

TEST_F(Writers, AHeartbeatBeforeTheFirstCommandCountsForItsLease) {
  const Guid who = guid(1);
  static_cast<void>(clients.on_writer(writer_there(who)));
  clients.on_heartbeat(heartbeat(who, 1, kStart, 300), kStart);
  EXPECT_EQ(clients.size(), 0U) << "it makes no client";
  const auto life = clients.on_sample(who, 0, true, kStart + 1s)->life;
  EXPECT_EQ(life->lease_limit, 300ms);
  clients.on_heartbeat(heartbeat(who, 1, kStart + 2s), kStart + 2s);
  EXPECT_EQ(life->heartbeat, kLongAgo) << "a library that repeats it";
  EXPECT_EQ(life->lease_limit, 300ms);
  clients.on_heartbeat(heartbeat(who, 2, kStart + 2s), kStart + 2s);
  EXPECT_EQ(life->heartbeat, kStart + 2s);
  EXPECT_EQ(life->lease_limit, std::nullopt) << "as it is configured";
}

TEST_F(Writers, AnOldOrForeignHeartbeatBeforeTheFirstCommandCountsForNothing) {
  const Guid who = guid(1);
  static_cast<void>(clients.on_writer(writer_there(who)));
  clients.on_heartbeat(heartbeat(who, 1, kStart, 300), kStart + 501ms);
  HeartbeatRecord foreign = heartbeat(who, 2, kStart + 1s, 300);
  foreign.writer = guid(2);
  clients.on_heartbeat(foreign, kStart + 1s);
  EXPECT_EQ(there(who)->lease_limit, std::nullopt);
}

TEST_F(Writers, AHeartbeatMayComeBeforeAnythingElseOfItsWriter) {
  const Guid who = guid(1);
  clients.on_heartbeat(heartbeat(who, 1, kStart, 300), kStart);
  static_cast<void>(clients.on_writer(writer_there(who)));
  clients.on_time(kStart + 1h);
  EXPECT_EQ(clients.on_sample(who, 0, true, kStart + 1h)->life->lease_limit, 300ms);
  EXPECT_EQ(clients.deadline(), kNever);
}

TEST_F(Writers, AHeartbeatOfOneThatIsGoneOrNeverComesIsForgotten) {
  const Guid who = guid(1);
  static_cast<void>(clients.on_writer(writer_there(who)));
  clients.on_heartbeat(heartbeat(who, 1, kStart, 300), kStart);
  static_cast<void>(clients.on_writer(writer_gone(who)));
  EXPECT_EQ(there(who)->lease_limit, std::nullopt);
  clients.on_heartbeat(heartbeat(guid(2), 1, kStart, 300), kStart);
  clients.on_heartbeat(heartbeat(guid(2), 2, kStart + 1s, 300), kStart + 1s);
  EXPECT_EQ(clients.deadline(), kStart + 1s + kReturnsWithin);
  clients.on_time(kStart + 1s + kReturnsWithin);
  EXPECT_EQ(clients.on_sample(guid(2), 0, true, kStart + 10s)->life->lease_limit, std::nullopt);
}

TEST_F(Writers, ThatOnlyBeatAreBoundedAndTheOneHeardLongestAgoIsForgottenFirst) {
  const auto limit_of = [&](std::uint8_t n) { return clients.on_sample(guid(n), 0, true, kStart)->life->lease_limit; };
  const auto beats = [&](std::uint8_t n, Duration at) {
    clients.on_heartbeat(heartbeat(guid(n), 1, kStart + at, 300), kStart + at);
  };
  const auto owner = there(guid(250));
  give(owner);
  beats(250, 0ms);
  for (std::uint8_t n = 1; n <= kMaxBeatsBefore; ++n) beats(n, n * 1ms);
  clients.on_heartbeat(heartbeat(guid(1), 2, kStart + 100ms, 300), kStart + 100ms);
  beats(200, 101ms);
  EXPECT_EQ(limit_of(200), 300ms) << "a new one is heard";
  EXPECT_EQ(limit_of(2), std::nullopt) << "heard longest ago";
  EXPECT_EQ(limit_of(1), 300ms);
  EXPECT_EQ(owner->lease_limit, 300ms) << "who commands is none of them";
  EXPECT_EQ(clients.find(guid(250))->life, owner);
}

TEST_F(Writers, ABeatOfNobodyMakesNobody) {
  clients.on_beats(beat(guid(9)), kStart);
  EXPECT_EQ(clients.size(), 0U);
}

TEST_F(Writers, OneThatIsGoneIsDeadToItsLeasesAndItsAxesAreTold) {
  const auto life = there(guid(1));
  static_cast<void>(clients.on_writer(writer_gone(guid(1))));
  EXPECT_FALSE(life->connected);
  EXPECT_THAT(port.gone, ElementsAre(life->id));
  static_cast<void>(clients.on_writer(writer_gone(guid(1))));
  EXPECT_EQ(port.gone.size(), 1U);
  EXPECT_NE(there(guid(1))->id, life->id) << "a dead client does not come back: another of its origin does";
}

TEST_F(Writers, ARecordOfAKnownOneIsTheSameClientAgain) {
  const auto life = there(guid(1), 1);
  clients.on_link_down(kStart);
  clients.on_link_up(kStart + 2s);
  EXPECT_EQ(there(guid(1), 9, kStart + 3s), life);
  EXPECT_EQ(life->strength, 9);
  EXPECT_TRUE(life->connected);
  clients.on_time(kStart + 1h);
  EXPECT_THAT(port.gone, IsEmpty());
}

TEST_F(Writers, ASampleBeforeItsRecordTellsTheStrength) {
  DdsClient* const client = clients.on_sample(guid(1), 4, true, kStart);
  ASSERT_NE(client, nullptr);
  const auto life = client->life;
  EXPECT_EQ(life->strength, 4);
  EXPECT_EQ(life->last_request, kStart);
  EXPECT_EQ(there(guid(1), 3), life);
  EXPECT_EQ(life->strength, 3);
  EXPECT_EQ(clients.deadline(), kNever);
}

TEST_F(Writers, ASampleOfOneThatIsNeverToldOfIsForgottenWithIt) {
  const auto life = clients.on_sample(guid(1), 4, true, kStart)->life;
  EXPECT_EQ(clients.deadline(), kStart + kReturnsWithin);
  clients.on_time(kStart + kReturnsWithin);
  EXPECT_FALSE(life->connected);
  EXPECT_EQ(clients.size(), 0U);
}

struct Slots : Writers {
  const Guid late = guid(200);
  /// All slots have their client; the one with the lowest number was heard longest ago.
  void fill() {
    for (std::uint8_t i = 1; i <= kMaxWriters; ++i) static_cast<void>(there(guid(i), 0, kStart + i * 1ms));
    ASSERT_EQ(clients.size(), kMaxWriters);
  }
};

TEST_F(Slots, AreNotForWritersThatAskForNothing) {
  for (std::uint8_t i = 1; i <= kMaxWriters + 6; ++i) static_cast<void>(clients.on_writer(writer_there(guid(i))));
  EXPECT_EQ(clients.size(), 0U);
  static_cast<void>(clients.on_writer(writer_there(late, 7)));
  const auto life = clients.on_sample(late, std::nullopt, true, kStart)->life;
  EXPECT_EQ(life->strength, 7) << "as it was told of";
  EXPECT_EQ(life->name, client_name(late, "192.168.1.7"));
  EXPECT_EQ(clients.deadline(), kNever);
  clients.on_beats(beat(late), kStart + 1s);
  EXPECT_EQ(life->heartbeat, kStart + 1s);
  clients.on_heartbeat(heartbeat(late, 1, kStart + 2s), kStart + 2s);
  EXPECT_EQ(life->heartbeat, kStart + 2s);
}

TEST_F(Slots, OfOneThatOwnsNothingAndWasHeardLongestAgoGoesToALateOne) {
  fill();
  const auto first = clients.find(guid(1))->life;
  give(first);
  ASSERT_NE(clients.on_sample(late, 3, true, kStart + 1s), nullptr);
  EXPECT_EQ(clients.find(guid(2)), nullptr);
  EXPECT_EQ(clients.find(guid(1))->life, first) << "an owner's is never taken";
  EXPECT_TRUE(first->connected);
  EXPECT_EQ(clients.size(), kMaxWriters);
  const auto back = clients.on_sample(guid(2), std::nullopt, true, kStart + 2s);
  ASSERT_NE(back, nullptr) << "it is there still, and asks again";
  EXPECT_EQ(back->life->name, client_name(guid(2), "192.168.1.7"));
  EXPECT_EQ(clients.find(guid(3)), nullptr);
}

TEST_F(Slots, ThatMakeWayKeepWhatTheirHeartbeatHasSaid) {
  fill();
  clients.on_heartbeat(heartbeat(guid(1), 1, kStart, 300), kStart);
  ASSERT_NE(clients.on_sample(late, 3, true, kStart + 1s), nullptr);
  ASSERT_EQ(clients.find(guid(1)), nullptr);
  EXPECT_EQ(clients.on_sample(guid(1), std::nullopt, true, kStart + 2s)->life->lease_limit, 300ms);
}

TEST_F(Slots, OfOneThatHoldsAButtonOrWasTrustedWithoutALeaseAreKept) {
  fill();
  clients.find(guid(1))->held[1] = {Command::jog_forward, 1, false};
  clients.find(guid(2))->unleased = true;
  ASSERT_NE(clients.on_sample(late, 3, true, kStart + 1s), nullptr);
  EXPECT_NE(clients.find(guid(1)), nullptr);
  EXPECT_NE(clients.find(guid(2)), nullptr);
  EXPECT_EQ(clients.find(guid(3)), nullptr);
}

TEST_F(Slots, AreRefusedWhereNoneCanBeTakenUntilOneIsGone) {
  fill();
  for (std::uint8_t i = 1; i <= kMaxWriters; ++i) clients.find(guid(i))->unleased = true;
  EXPECT_EQ(clients.on_sample(late, 0, true, kStart), nullptr);
  EXPECT_EQ(clients.size(), kMaxWriters);
  static_cast<void>(clients.on_writer(writer_gone(guid(3))));
  EXPECT_NE(clients.on_sample(late, 0, true, kStart), nullptr);
}

struct Grace : Writers {
  std::shared_ptr<ClientLife> life = there(guid(1));
  Lease& lease = image.find(1)->lease;
  void own(LeaseRenewal renew) {
    lease.rules.renew = renew;
    give(life);
  }
};

TEST_F(Grace, IsThreeSecondsExactlyOnceUntilTheClientIsHeard) {
  own(LeaseRenewal::any);
  EXPECT_EQ(lease.until(), kStart + 2s);
  clients.on_link_down(kStart);
  EXPECT_EQ(lease.until(), kStart + 5s);
  clients.on_link_up(kStart + 1s);
  clients.on_link_down(kStart + 1500ms);
  EXPECT_EQ(lease.until(), kStart + 5s) << "a second death before it was heard adds nothing";
  clients.on_link_up(kStart + 2s);
  clients.on_beats(beat(guid(1)), kStart + 3s);
  EXPECT_EQ(lease.until(), kStart + 5s) << "heard: its lease is as long as anybody's";
  clients.on_link_down(kStart + 3s);
  EXPECT_EQ(lease.until(), kStart + 8s) << "and its grace is a new one";
}

TEST_F(Grace, OfALeaseThatOnlyWritesRenewLastsUntilItsOwnerCouldWrite) {
  own(LeaseRenewal::write);
  clients.on_link_down(kStart);
  clients.on_link_up(kStart + 2500ms);
  clients.on_beats(beat(guid(1)), kStart + 3s);
  EXPECT_EQ(lease.until(), kStart + 5s) << "a beat is no write, and must not take away what was given";
  lease.renewed = kStart + 4s;
  EXPECT_EQ(lease.until(), kStart + 6s) << "from when it has written none of it is left";
}

TEST_F(Grace, IsNotForOneThatIsKnownToBeDead) {
  own(LeaseRenewal::any);
  static_cast<void>(clients.on_writer(writer_gone(guid(1))));
  clients.on_link_down(kStart);
  EXPECT_EQ(lease.until(), kStart + 2s);
}

TEST_F(Grace, EndsForOneThatDoesNotComeBackWithTheLink) {
  clients.on_link_down(kStart);
  EXPECT_EQ(clients.deadline(), kNever) << "nobody can come back before";
  clients.on_link_up(kStart + 2s);
  clients.on_time(kStart + 2s + kReturnsWithin - 1ns);
  EXPECT_TRUE(life->connected);
  clients.on_time(kStart + 2s + kReturnsWithin);
  EXPECT_FALSE(life->connected);
  EXPECT_THAT(port.gone, ElementsAre(life->id));
}

TEST_F(Grace, OfOneThatIsWaitedForIsNotCutShortByASecondDeathOfTheProcess) {
  clients.on_link_down(kStart);
  clients.on_link_up(kStart + 1s);
  clients.on_link_down(kStart + 1500ms);
  clients.on_time(kStart + 1h);
  EXPECT_TRUE(life->connected) << "nobody could come back";
  clients.on_link_up(kStart + 1h);
  EXPECT_EQ(clients.deadline(), kStart + 1h + kReturnsWithin);
}

}  // namespace
}  // namespace axisgate::dds
