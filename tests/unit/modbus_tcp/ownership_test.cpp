// What a client sees of an axis's owner, what its life tells of it, and what a refusal by ownership leaves behind.
#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

using enum Command;

class OwnerRegisters : public ::testing::Test {
 protected:
  Desk desk;
  Line plc{desk};
  Line panel{desk, Role::operator_, kPanel};
};

TEST_F(OwnerRegisters, TellEachClientWhetherItIsTheOwner) {
  EXPECT_EQ(plc.read(128, 2), "00 00 00 00") << "nobody, and no lease runs";
  EXPECT_EQ(plc.ask("02 00 6F 00 01"), "02 01 00");
  desk.axis(1).lease = {.owner = plc.life(), .running = true, .renewed = desk.runtime.now()};
  EXPECT_EQ(plc.read(128), "00 01");
  EXPECT_EQ(plc.ask("02 00 6F 00 01"), "02 01 01");
  EXPECT_EQ(panel.read(128), "00 02");
  EXPECT_EQ(panel.ask("02 00 6F 00 01"), "02 01 00");
  EXPECT_EQ(plc.read(228), "00 00") << "another axis";
}

TEST_F(OwnerRegisters, TellAlsoOfAnAxisThatIsOffline) {
  desk.axis(1).lease = {.owner = plc.life(), .running = true, .renewed = desk.runtime.now()};
  desk.axis(1).link_state = LinkState::offline;
  EXPECT_EQ(plc.read(128), "00 01");
  EXPECT_EQ(plc.ask("02 00 6F 00 01"), "02 01 01");
}

TEST_F(OwnerRegisters, TellHowLongTheLeaseStillRuns) {
  Lease& lease = desk.axis(1).lease;
  lease = {.owner = plc.life(), .running = true, .renewed = desk.runtime.now()};
  lease.rules.renew = LeaseRenewal::write;
  EXPECT_EQ(panel.read(129), word(2000));
  desk.runtime.advance_by(1500ms);
  EXPECT_EQ(panel.read(129), word(500));
  desk.runtime.advance_by(600ms);
  EXPECT_EQ(panel.read(129), "00 00") << "over";
  lease.rules.timeout = 100s;
  EXPECT_EQ(panel.read(129), "FF FF") << "saturating";
  lease.running = false;
  EXPECT_EQ(panel.read(129), "00 00") << "nothing runs";
  lease = {.running = true, .renewed = desk.runtime.now()};
  EXPECT_EQ(panel.read(128, 2), "00 00" + (" " + word(2000))) << "nobody's, and it runs";
}

class Life : public OwnerRegisters {};

TEST_F(Life, RemembersTheLastRequestWhateverItsKind) {
  const auto life = plc.life();
  for (const char* pdu : {"03 00 64 00 01", "01 00 64 00 01", "06 00 92 00 01", "08 00 00 12 34", "2B 0E 01 00",
                          "2B 0D 00 00 01 60 64 00 00 00 00 00", "41", "03 FF FF 00 02"}) {
    desk.runtime.advance_by(1s);
    EXPECT_NE(life->last_request, desk.runtime.now());
    static_cast<void>(plc.ask(pdu));
    EXPECT_EQ(life->last_request, desk.runtime.now()) << pdu;
  }
  const auto others = panel.life();
  desk.runtime.advance_by(1s);
  static_cast<void>(plc.read(0));
  EXPECT_NE(others->last_request, desk.runtime.now()) << "its own";
}

TEST_F(Life, BeatsWithAChangedGatewayHeartbeatTheFirstIncluded) {
  const auto life = plc.life();
  EXPECT_EQ(life->heartbeat, kLongAgo);
  const auto beats = [&](int value) {
    desk.runtime.advance_by(1s);
    EXPECT_TRUE(is_done(plc.write(8, value)));
    return life->heartbeat == desk.runtime.now();
  };
  EXPECT_TRUE(beats(0)) << "the first, though it is what the register reads";
  EXPECT_FALSE(beats(0));
  EXPECT_TRUE(beats(1));
  EXPECT_FALSE(beats(1)) << "a PLC in STOP scans on";
  EXPECT_TRUE(beats(0));
}

TEST_F(Life, BeatsWithAChangedHeartbeatOfTheAxisTheFirstIncluded) {
  const auto beats = [&](std::uint16_t address, int value) {
    EXPECT_TRUE(is_done(plc.write(address, value)));
    return desk.port.submitted.back().group.beats;
  };
  EXPECT_TRUE(beats(156, 0));
  EXPECT_FALSE(beats(156, 0));
  EXPECT_TRUE(beats(156, 1));
  EXPECT_TRUE(beats(256, 1)) << "each axis has its own";
  EXPECT_FALSE(beats(156, 1));
  EXPECT_TRUE(is_done(plc.write_block(154, "00 00 00 00 00 02")));
  EXPECT_TRUE(desk.port.submitted.back().group.beats) << "in a block";
  EXPECT_FALSE(beats(146, 1)) << "no heartbeat in it";
  EXPECT_TRUE(is_done(panel.write(156, 2)));
  EXPECT_TRUE(desk.port.submitted.back().group.beats) << "the panel's first";
}

TEST_F(Life, EndsWithTheConnectionBeforeThePortIsTold) {
  struct Port final : FakeCommandPort {
    void client_gone(ClientId client) override {
      connected_when_told = life->connected;
      FakeCommandPort::client_gone(client);
    }
    std::shared_ptr<const ClientLife> life;
    std::optional<bool> connected_when_told;
  } port;
  const SessionContext context{desk.settings, desk.image, port, desk.registry, desk.log, &desk.runtime};
  Session session(context, Peer{kPanel, 1, Role::operator_, 0}, desk.runtime.now(), [] {});
  session.on_bytes(frame(1, 1, bytes("06 00 92 00 01")), desk.runtime.now());
  port.life = port.submitted.back().group.life;
  EXPECT_TRUE(port.life->connected);
  session.on_closed(desk.runtime.now());
  EXPECT_EQ(port.connected_when_told, false);
  EXPECT_EQ(port.gone.size(), 1U);
}

TEST_F(Life, OfAHostIsOneForAllItsConnectionsAndNeverGone) {
  desk.settings.client_is_address = true;
  auto first = std::make_unique<Line>(desk, Role::operator_, kPanel);
  auto second = std::make_unique<Line>(desk, Role::operator_, kPanel);
  const auto life = first->life();
  EXPECT_EQ(second->life(), life);
  EXPECT_EQ(life->name, "192.168.1.8");
  first.reset();
  EXPECT_TRUE(life->connected) << "one connection is left";
  second.reset();
  EXPECT_FALSE(life->connected);
  EXPECT_TRUE(desk.port.gone.empty());
  Line again(desk, Role::operator_, kPanel);
  EXPECT_TRUE(life->connected);
  EXPECT_EQ(again.life(), life);
}

/// A port at which another client owns the axis: stops pass, all else is refused.
class Refused : public OwnerRegisters {
 protected:
  std::string refuse(const std::string& pdu) {
    desk.port.at_once = {{{Errc::not_owner, 0}, 0, 0}};
    const std::string reply = plc.ask(pdu);
    EXPECT_TRUE(is_exception(reply, 6)) << reply;
    EXPECT_EQ(plc.read(125), "00 07");
    desk.runtime.advance_by(100ms);
    static_cast<void>(desk.port.taken());
    return reply;
  }
  std::vector<Command> accept(const std::string& pdu) {
    EXPECT_TRUE(is_done(plc.ask(pdu)));
    desk.runtime.advance_by(100ms);
    const auto out = commands(desk);
    static_cast<void>(desk.port.taken());
    return out;
  }
  static std::string row(const char* coils) { return "0F 00 64 00 08 01" + std::string(coils); }
};
using Commands = std::vector<Command>;

TEST_F(Refused, AWriteThatDoesNotActIsToldSo) {
  EXPECT_EQ(refuse("06 00 9A 00 00"), "86 06");
  EXPECT_EQ(refuse(row("00")), "8F 06");
}

TEST_F(Refused, AScannersLevelStartsNothingOnTheDayOnWhichTheAxisIsFree) {
  EXPECT_EQ(accept(row("00")), Commands{});
  refuse(row("01"));
  refuse(row("01"));
  EXPECT_EQ(accept(row("01")), Commands{}) << "the axis is free now";
  EXPECT_EQ(accept(row("00")), Commands{disable}) << "it is its own level now, and its fall is a stop";
  EXPECT_EQ(accept(row("01")), Commands{enable});
}

TEST_F(Refused, TheNext0To1Acts) {
  EXPECT_EQ(accept(row("00")), Commands{});
  refuse(row("81"));
  refuse(row("00"));
  EXPECT_EQ(accept(row("81")), (Commands{enable, run_velocity}));
  refuse("06 00 9A 00 06");
  EXPECT_EQ(accept("06 00 9A 00 06"), Commands{move_absolute}) << "a press in vain is not the press that counts";
}

TEST_F(Refused, ACommandInABlockActsAfter0) {
  const std::string rest = "10 00 9A 00 02 04 00 00 00 00";
  const std::string move = "10 00 9A 00 02 04 00 06 00 00";
  EXPECT_EQ(accept(rest), Commands{});
  refuse(move);
  EXPECT_EQ(accept(move), Commands{}) << "the axis is free now";
  EXPECT_EQ(accept(rest), Commands{});
  EXPECT_EQ(accept(move), Commands{move_absolute});
}

TEST_F(Refused, AButtonInARowOfCoilsThatWasPressedInVainStopsNobodyWhenItIsLetGo) {
  EXPECT_EQ(accept(row("00")), Commands{});
  refuse(row("81"));
  EXPECT_EQ(accept(row("00")), Commands{});
}

TEST_F(Refused, ASingle0AlwaysStops) {
  for (const char* press : {"05 00 64 FF 00", "05 00 6B FF 00"}) {
    refuse(press);
    EXPECT_EQ(accept(std::string(press).substr(0, 8) + " 00 00").size(), 1U) << press;
  }
}

TEST_F(Refused, ALevelThatWasItsOwnBeforeStillStopsByItsFall) {
  EXPECT_EQ(accept(row("00")), Commands{});
  EXPECT_EQ(accept(row("01")), Commands{enable});
  refuse(row("01"));  // another client has taken the axis over
  EXPECT_EQ(accept(row("00")), Commands{disable}) << "a stop is open to everybody";
}

TEST_F(Refused, AJogInVainNeitherHoldsNorEndsAnything) {
  EXPECT_EQ(accept("05 00 6C 00 00"), Commands{jog_end});
  refuse("05 00 6C FF 00");
  EXPECT_EQ(accept("05 00 6C FF 00"), Commands{}) << "held: the axis knows that nothing jogs";
  EXPECT_EQ(accept("05 00 6C 00 00"), Commands{jog_end});
  EXPECT_EQ(accept("05 00 6C FF 00"), Commands{jog_forward}) << "its next 0 -> 1";
}

TEST_F(Refused, AStopPassesAndTheRestOfItsRowIsRefused) {
  EXPECT_EQ(accept(row("00")), Commands{});
  desk.port.at_once = {{{}, 0, 0}, {{Errc::not_owner, 0}, 0, 0}};
  EXPECT_EQ(plc.ask(row("09")), "8F 06");
  EXPECT_EQ(commands(desk), (Commands{halt, enable}));
  EXPECT_EQ(plc.read(125), "00 07");
  static_cast<void>(desk.port.taken());
  desk.runtime.advance_by(100ms);
  EXPECT_EQ(accept(row("00")), Commands{end_halt}) << "of its own halt, but nothing of the enable in vain";
}

TEST_F(Refused, IsAnsweredAtOnceWhereWritesArePosted) {
  desk.settings.posted_writes = true;
  EXPECT_EQ(refuse("06 00 92 00 01"), "86 06");
  EXPECT_EQ(refuse("06 00 9A 00 00"), "86 06") << "also where nothing acts";
  EXPECT_EQ(refuse("05 00 64 FF 00"), "85 06");
}

TEST_F(Refused, IsToldLaterAsWell) {
  desk.port.slow = true;
  EXPECT_EQ(plc.write_coil(100, true), "");
  desk.port.finish({Errc::not_owner, 0});
  EXPECT_EQ(plc.reply(), "85 06");
  desk.port.slow = false;
  static_cast<void>(desk.port.taken());
  EXPECT_EQ(accept("0F 00 64 00 08 01 00"), Commands{}) << "a press in vain";
}

TEST_F(Refused, ByFunctions22And23And4313AsByAnyWrite) {
  EXPECT_EQ(refuse("16 00 8C 00 00 00 0F"), "96 06");
  EXPECT_EQ(refuse("17 00 64 00 01 00 92 00 01 02 00 07"), "97 06");
  desk.port.at_once = {{{Errc::not_owner, 0}, 0, 0}};
  EXPECT_EQ(plc.ask("2B 0D 01 00 01 60 64 00 00 00 00 02 01 02"), "AB 06");
}

TEST_F(Refused, AMailboxWriteEndsWithIt) {
  desk.port.at_once = {{{Errc::not_owner, 0}, 0, 0}};
  EXPECT_EQ(plc.write_block(180, "00 02 60 64 00 00 00 04"), "90 06");
  EXPECT_EQ(plc.read(186), "00 03") << "failed";
}

TEST_F(Refused, AnAcceptedWriteThatDoesNotActLeavesTheResultRegisters) {
  refuse("06 00 92 00 01");
  EXPECT_EQ(accept("06 00 9A 00 00"), Commands{});
  EXPECT_EQ(plc.read(125), "00 07");
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
