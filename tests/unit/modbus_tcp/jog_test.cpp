// The jog coils 8 and 9 and the jog velocity, as a client meets them (design 3.4, "Jog").
#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

using enum Command;

class Jog : public ::testing::Test {
 protected:
  /// FC 15 of coils 8 and 9 of axis 1.
  std::string write_both(bool forward, bool reverse) {
    return plc.ask("0F 00 6C 00 02 01" + word((forward ? 1 : 0) | (reverse ? 2 : 0)).substr(3));
  }
  /// What the groups since the last call asked for, in words: "jog_forward", "again jog_forward", "" for nothing.
  std::string asked() {
    std::string out;
    for (const auto& [axis, group] : desk.port.taken()) {
      if (!out.empty()) out += ", ";
      if (group.command != none) out += text(group.command);
      if (group.jog_again) out += "again " + std::string(text(*group.jog_again));
    }
    return out;
  }
  std::string asked_by(const std::string& reply) { return (is_done(reply) ? "" : "refused, ") + asked(); }
  std::string forward(bool on) { return asked_by(plc.write_coil(108, on)); }
  std::string reverse(bool on) { return asked_by(plc.write_coil(109, on)); }
  std::string both(bool f, bool r) { return asked_by(write_both(f, r)); }

  Desk desk;
  Line plc{desk};
};

TEST_F(Jog, AButtonStartsHoldsAndEnds) {
  EXPECT_EQ(forward(true), "refused, ") << "a 1 before any 0: perhaps a panel that reconnects and rewrites its buttons";
  EXPECT_EQ(plc.read(125), "00 0A");
  EXPECT_EQ(forward(false), "jog_end");
  EXPECT_EQ(forward(true), "jog_forward");
  EXPECT_EQ(forward(true), "again jog_forward");
  EXPECT_EQ(forward(true), "again jog_forward");
  EXPECT_EQ(forward(false), "jog_end");
  EXPECT_EQ(forward(false), "jog_end") << "a single 0 always acts";
  EXPECT_EQ(forward(true), "jog_forward") << "0 -> 1";
  EXPECT_EQ(reverse(false), "jog_end") << "of a memory that is empty: a button let go after a reconnect";
}

TEST_F(Jog, HoldingNeverStartsAnewHoweverLongAgo) {
  EXPECT_EQ(reverse(false), "jog_end");
  EXPECT_EQ(reverse(true), "jog_reverse");
  for (const Duration pause : {Duration(100ms), Duration(999ms), Duration(1s), Duration(60s)}) {
    desk.runtime.advance_by(pause);
    EXPECT_EQ(reverse(true), "again jog_reverse");
  }
}

TEST_F(Jog, ABlockWithAnEmptyMemoryOnlyRemembersA1) {
  EXPECT_EQ(both(true, false), "");
  EXPECT_EQ(both(true, false), "again jog_forward") << "which starts nothing";
  EXPECT_EQ(both(false, false), "jog_end");
  EXPECT_EQ(both(false, true), "jog_reverse");
}

TEST_F(Jog, BothAt1InOneRequestHaltAndStartNothing) {
  EXPECT_EQ(both(false, false), "");
  EXPECT_EQ(both(true, true), "jog_end") << "both rising: one end";
  EXPECT_EQ(both(true, false), "jog_end") << "reverse is let go";
  EXPECT_EQ(both(true, false), "again jog_forward") << "which starts nothing: its own 0 -> 1 does";
  EXPECT_EQ(both(false, false), "jog_end");
  EXPECT_EQ(both(true, false), "jog_forward");
}

TEST_F(Jog, TheOtherCoilBesideAHeldOneEnds) {
  EXPECT_EQ(forward(false), "jog_end");
  EXPECT_EQ(reverse(false), "jog_end");
  EXPECT_EQ(forward(true), "jog_forward");
  EXPECT_EQ(reverse(true), "jog_end");
  EXPECT_EQ(reverse(true), "jog_end") << "still both";
  EXPECT_EQ(forward(true), "jog_end");
  EXPECT_EQ(reverse(false), "jog_end");
  EXPECT_EQ(forward(true), "again jog_forward") << "of a jog that has ended";
  EXPECT_EQ(reverse(true), "jog_end") << "forward's memory is 1 all the same";
  EXPECT_EQ(reverse(false), "jog_end");
  EXPECT_EQ(forward(false), "jog_end");
  EXPECT_EQ(reverse(true), "jog_reverse");
}

TEST_F(Jog, BothInAFirstBlockAreOnlyRemembered) {
  EXPECT_EQ(both(true, true), "jog_end") << "which ends what this client jogs: nothing";
  EXPECT_EQ(both(true, true), "jog_end");
}

TEST_F(Jog, FromOneDirectionToTheOtherInOneRequestIsAnEndAndNoStart) {
  EXPECT_EQ(both(false, false), "");
  EXPECT_EQ(both(true, false), "jog_forward");
  EXPECT_EQ(write_both(false, true), "8F 06");
  EXPECT_EQ(asked(), "jog_end");
  EXPECT_EQ(plc.read(125), "00 06") << "never started";
  EXPECT_EQ(both(false, true), "again jog_reverse") << "which starts nothing";
  EXPECT_EQ(both(false, false), "jog_end");
  EXPECT_EQ(both(false, true), "jog_reverse");
}

TEST_F(Jog, IsDroppedByAStopInItsOwnRequest) {
  const auto row = [&](const char* low, const char* high) {
    return plc.ask("0F 00 64 00 0A 02" + std::string(low) + high);
  };
  EXPECT_TRUE(is_done(row("00", "00")));
  EXPECT_EQ(asked(), "");
  EXPECT_EQ(row("08", "01"), "8F 06") << "halt and jog_forward";
  EXPECT_EQ(asked(), "halt");
  EXPECT_TRUE(is_done(row("08", "01")));
  EXPECT_EQ(asked(), "again jog_forward") << "the halt does not act anew, and this starts nothing";
  EXPECT_TRUE(is_done(row("04", "01")));
  EXPECT_EQ(asked(), "quick_stop, end_halt") << "a held jog beside a stop is nothing";
}

TEST_F(Jog, AnEndDropsOtherStartsAndGoesFirst) {
  EXPECT_EQ(forward(false), "jog_end");
  EXPECT_EQ(forward(true), "jog_forward");
  EXPECT_TRUE(is_done(plc.ask("0F 00 64 00 0A 02 00 01")));
  static_cast<void>(asked());
  EXPECT_EQ(plc.ask("0F 00 64 00 0A 02 12 00"), "8F 06") << "fault_reset, start_absolute, and the jog let go";
  EXPECT_EQ(asked(), "jog_end, fault_reset");
}

TEST_F(Jog, HoldingTravelsWithTheFirstOfOtherCommands) {
  EXPECT_EQ(forward(false), "jog_end");
  EXPECT_EQ(forward(true), "jog_forward");
  EXPECT_TRUE(is_done(plc.ask("0F 00 64 00 0A 02 00 01")));
  EXPECT_EQ(asked(), "again jog_forward");
  EXPECT_TRUE(is_done(plc.ask("0F 00 64 00 0A 02 03 01")));
  EXPECT_EQ(asked(), "fault_resetagain jog_forward, enable");
}

TEST_F(Jog, BesideAnotherStartIsNoPossibleValue) {
  EXPECT_TRUE(is_done(plc.ask("0F 00 64 00 0A 02 00 00")));
  static_cast<void>(asked());
  EXPECT_EQ(plc.ask("0F 00 64 00 0A 02 10 01"), "8F 03");
  EXPECT_EQ(asked(), "");
}

TEST_F(Jog, HoldingWhatHasEndedIsRefusedEachTime) {
  EXPECT_EQ(forward(false), "jog_end");
  EXPECT_EQ(forward(true), "jog_forward");
  for (int i = 0; i < 2; ++i) {
    desk.port.at_once = {{{Errc::not_new, 0}, 0, 0}};  // as the axis says it: its time was over
    EXPECT_EQ(plc.write_coil(108, true), "85 06");
    EXPECT_EQ(plc.read(125), "00 0A");
  }
  desk.port.at_once = {{{Errc::not_new, 0}, 0, 0}};
  EXPECT_TRUE(is_done(write_both(true, false))) << "a scanner's row is answered";
}

TEST_F(Jog, HoldingLeavesTheResultRegistersAsTheyAre) {
  EXPECT_EQ(forward(false), "jog_end");
  desk.port.at_once = {{{Errc::state_unsuitable, kDetailDeviceState}, 0, 0}};
  EXPECT_EQ(plc.write_coil(108, true), "85 04");
  EXPECT_TRUE(is_done(plc.write_coil(108, true)));
  EXPECT_EQ(plc.read(125), "00 09");
}

TEST_F(Jog, NeedsRunVelocityAmongTheCommandsOfTheDrive) {
  desk.axis(1).supported_commands &= ~(1U << 8);
  EXPECT_EQ(plc.write_coil(108, true), "85 02");
  EXPECT_EQ(plc.write_coil(109, true), "85 02");
  EXPECT_EQ(write_both(true, false), "8F 02");
  EXPECT_TRUE(is_done(write_both(false, false))) << "in a longer write a 0 asks for nothing";
  EXPECT_EQ(plc.write_block(158, "00 00 00 01"), "90 02") << "jog_velocity";
}

TEST_F(Jog, AReleaseOvertakesWhatHasToWait) {
  desk.port.slow = true;
  plc.send("06 00 92 00 01");
  plc.send("16 00 8C FF FF 00 00");  // waits for the write before it
  plc.send("05 00 6C 00 00");
  ASSERT_EQ(desk.port.submitted.size(), 2U);
  EXPECT_EQ(desk.port.submitted.back().group.command, jog_end);
}

TEST_F(Jog, VelocityIsTheAxissOwn) {
  EXPECT_TRUE(is_done(plc.write_block(158, words(250'000))));
  EXPECT_EQ(desk.port.submitted.back().group.jog_velocity, 250'000U);
  desk.axis(1).jog_velocity = 250'000;
  Line panel(desk, Role::viewer, kPanel);
  EXPECT_EQ(panel.read(158, 2), words(250'000)) << "the same for every client";
  EXPECT_EQ(plc.write_block(158, "FF FF FF FF"), "90 03") << "the number that means none";
}

TEST_F(Jog, ABlockSkipsTheVelocityThatTheAxisHas) {
  desk.axis(1).jog_velocity = 250'000;
  EXPECT_TRUE(is_done(plc.write_block(156, "00 01 00 00" + words(250'000))));
  EXPECT_TRUE(is_done(plc.write_block(156, "00 02 00 00" + words(250'000))));
  EXPECT_FALSE(desk.port.submitted.back().group.jog_velocity.has_value());
  EXPECT_TRUE(is_done(plc.write_block(156, "00 01 00 00" + words(260'000))));
  EXPECT_EQ(desk.port.submitted.back().group.jog_velocity, 260'000U);
}

TEST_F(Jog, CoilsReadWhetherTheAxisJogsTheSameForEveryClient) {
  desk.axis(1).level_coils = 1U << 8;
  EXPECT_EQ(plc.ask("01 00 6C 00 02"), "01 01 01");
  desk.axis(1).level_coils = 1U << 9;
  Line panel(desk, Role::viewer, kPanel);
  EXPECT_EQ(panel.ask("01 00 6C 00 02"), "01 01 02");
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
