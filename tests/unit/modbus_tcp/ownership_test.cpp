// SPDX-License-Identifier: Apache-2.0
// What a client sees of an axis's owner, and what its life tells of it.
#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

class OwnerRegisters : public AtTheDesk {
 protected:
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

TEST_F(OwnerRegisters, TellTheOwnersAddress) {
  EXPECT_EQ(plc.read(196, 2), "00 00 00 00") << "nobody";
  desk.axis(1).lease = {.owner = plc.life(), .running = true, .renewed = desk.runtime.now()};
  EXPECT_EQ(panel.read(196, 2), "C0 A8 01 07");
  EXPECT_EQ(plc.read(196, 2), "C0 A8 01 07");
  EXPECT_EQ(panel.read(296, 2), "00 00 00 00") << "another axis";
  const Address v6{0x20, 0x01, 0x0D, 0xB8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  Line far{desk, Role::engineer, v6};
  desk.axis(1).lease.owner = far.life();
  EXPECT_EQ(panel.read(128, 1), "00 02");
  EXPECT_EQ(panel.read(196, 2), "00 00 00 00") << "not IPv4";
  ClientLife writer;  // of DDS, with a GUID that looks like an address
  writer.origin = kPlc;
  writer.strength = 0;
  desk.axis(1).lease.owner = std::make_shared<const ClientLife>(writer);
  EXPECT_EQ(panel.read(196, 2), "00 00 00 00");
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
    return last().beats;
  };
  EXPECT_TRUE(beats(156, 0));
  EXPECT_FALSE(beats(156, 0));
  EXPECT_TRUE(beats(156, 1));
  EXPECT_TRUE(beats(256, 1)) << "each axis has its own";
  EXPECT_FALSE(beats(156, 1));
  EXPECT_TRUE(is_done(plc.write_block(154, "00 00 00 00 00 02")));
  EXPECT_TRUE(last().beats) << "in a block";
  EXPECT_FALSE(beats(146, 1)) << "no heartbeat in it";
  EXPECT_TRUE(is_done(panel.write(156, 2)));
  EXPECT_TRUE(last().beats) << "the panel's first";
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
  port.life = port.submitted.back().batch.life;
  EXPECT_TRUE(port.life->connected);
  session.on_closed(desk.runtime.now());
  EXPECT_EQ(port.connected_when_told, false);
  EXPECT_EQ(port.gone.size(), 1U);
}

TEST_F(Life, OfAnAddressIsToldByWritesThatAreAcceptedFromWhoMayCommand) {
  desk.settings.client_is_address = true;
  Line pump(desk, Role::engineer, kPanel);
  Line viewer(desk, Role::viewer, kPanel);
  EXPECT_TRUE(is_done(pump.write(156, 1)));
  const auto life = last().life;
  const auto lives = [&](Line& line, const char* pdu) {
    desk.runtime.advance_by(1s);
    static_cast<void>(line.ask(pdu));
    return life->last_request == desk.runtime.now();
  };
  EXPECT_FALSE(lives(pump, "06 00 B5 60 64")) << "the object of a read to come";
  EXPECT_FALSE(last().renews || last().reclaims);
  EXPECT_FALSE(lives(pump, "10 00 B4 00 04 08 00 01 60 64 00 00 00 04")) << "a read by the mailbox";
  EXPECT_FALSE(lives(pump, "2B 0D 00 00 01 60 64 00 00 00 00 00")) << "and by 43/13";
  EXPECT_FALSE(lives(pump, "06 00 9A 00 63")) << "no command";
  EXPECT_FALSE(lives(pump, "06 FF FF 00 01")) << "no register";
  EXPECT_FALSE(lives(pump, "2B 0D 01 00 63 60 64 00 00 00 00 02 01 02")) << "no such axis";
  desk.port.at_once = {{{Errc::not_owner}}};
  EXPECT_FALSE(lives(pump, "06 00 92 00 01"));
  EXPECT_FALSE(lives(viewer, "06 00 08 00 01"));
  EXPECT_FALSE(lives(viewer, "06 00 92 00 01"));
  EXPECT_TRUE(lives(pump, "06 00 92 00 01"));
  EXPECT_TRUE(lives(pump, "0F 00 64 00 08 01 00"));
  EXPECT_TRUE(lives(pump, "06 00 08 00 01"));
  EXPECT_TRUE(lives(pump, "2B 0D 01 00 01 60 64 00 00 00 00 02 01 02"));
}

TEST_F(Life, AViewersGatewayHeartbeatIsNobodys) {
  desk.settings.client_is_address = true;
  Line pump(desk, Role::operator_, kPanel);
  Line viewer(desk, Role::viewer, kPanel);
  EXPECT_TRUE(is_done(viewer.write(8, 7)));
  const auto life = pump.life();
  EXPECT_EQ(life->heartbeat, kLongAgo);
  EXPECT_EQ(viewer.read(8), word(7));
  EXPECT_TRUE(is_done(pump.write(8, 7)));
  EXPECT_EQ(life->heartbeat, desk.runtime.now()) << "whatever a viewer wrote before";
}

TEST_F(Life, AHeartbeatOfTheAxisThatStandsStillIsNoWrite) {
  EXPECT_TRUE(is_done(plc.write(156, 1)));
  EXPECT_TRUE(last().reclaims);
  EXPECT_TRUE(is_done(plc.write(156, 1)));
  EXPECT_FALSE(last().reclaims) << "nobody has come back";
  EXPECT_TRUE(is_done(plc.write_block(154, "00 00 00 00 00 01")));
  EXPECT_TRUE(last().reclaims) << "a block is";
}

TEST_F(Life, AConnectionIsAsOldAsTheOldestOfItsAddress) {
  EXPECT_EQ(plc.life()->opened, desk.runtime.now());
  desk.runtime.advance_by(1s);
  Line again(desk);
  EXPECT_EQ(again.life()->opened, desk.runtime.now());
  desk.settings.client_is_address = true;
  const Instant first = desk.runtime.now();
  Line one(desk, Role::engineer, kPanel);
  desk.runtime.advance_by(1s);
  Line two(desk, Role::engineer, kPanel);
  EXPECT_EQ(two.life()->opened, first);
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
