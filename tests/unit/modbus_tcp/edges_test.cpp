#include "gateway/upstream/modbus_tcp/edges.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace axisgate::modbus_tcp {
namespace {

using namespace std::chrono_literals;
using enum Command;

constexpr Duration kRearm = 1000ms;
constexpr WriteForm kSingle = WriteForm::single;
constexpr WriteForm kBlock = WriteForm::block;

constexpr Verdict kNothing = Verdict::nothing;
constexpr Verdict kActs = Verdict::acts;
constexpr Verdict kNotNew = Verdict::not_new;
constexpr ClientId kMe = 1;
constexpr ClientId kOther = 2;

Writing at(WriteForm form, Duration since_start) {
  Writing writing;
  writing.form = form;
  writing.now = Instant{} + since_start;
  writing.rearm = kRearm;
  writing.client = kMe;
  return writing;
}

/// One write of a story: when, how, what, and what comes of it.
struct Step {
  Duration at;
  WriteForm form;
  int value;
  Verdict verdict;
};
struct Story {
  const char* sentence;
  std::vector<Step> steps;
};

void play_commands(const std::vector<Story>& stories) {
  for (const Story& story : stories) {
    SCOPED_TRACE(story.sentence);
    EdgeMemory memory;
    for (const Step& step : story.steps) {
      EXPECT_EQ(memory.command(Command{static_cast<std::uint8_t>(step.value)}, at(step.form, step.at)), step.verdict)
          << "value " << step.value << " at " << step.at.count() / 1'000'000 << " ms";
    }
  }
}

TEST(Edges, OfCommand) {
  play_commands({
      {"a block write with an empty memory is only remembered, and says so once",
       {{0ms, kBlock, 1, kNotNew}, {10ms, kBlock, 1, kNothing}}},
      {"except a stop that is asserted, which acts",
       {{0ms, kBlock, 2, kActs}, {10ms, kBlock, 2, kNothing}, {20ms, kBlock, 2, kNothing}}},
      {"a block write acts if the value differs", {{0ms, kBlock, 0, kNothing}, {10ms, kBlock, 6, kActs}}},
      {"the same block written for ever starts nothing twice",
       {{0ms, kBlock, 0, kNothing},
        {10ms, kBlock, 6, kActs},
        {20ms, kBlock, 6, kNothing},
        {5000ms, kBlock, 6, kNothing},
        {60000ms, kBlock, 6, kNothing}}},
      {"0 does nothing and arms",
       {{0ms, kBlock, 0, kNothing}, {10ms, kBlock, 6, kActs}, {20ms, kBlock, 0, kNothing}, {30ms, kBlock, 6, kActs}}},
      {"from one command to another no 0 is needed",
       {{0ms, kBlock, 0, kNothing}, {10ms, kBlock, 1, kActs}, {20ms, kBlock, 6, kActs}}},
      {"a single write acts if the memory is empty", {{0ms, kSingle, 1, kActs}}},
      {"or the value differs", {{0ms, kSingle, 1, kActs}, {10ms, kSingle, 6, kActs}}},
      {"two presses within rearm_ms count once", {{0ms, kSingle, 6, kActs}, {999ms, kSingle, 6, kNothing}}},
      {"a relative move that is not new says so", {{0ms, kSingle, 7, kActs}, {999ms, kSingle, 7, kNotNew}}},
      {"it acts when it was not written for rearm_ms", {{0ms, kSingle, 6, kActs}, {1000ms, kSingle, 6, kActs}}},
      {"a press that does not act is a write all the same",
       {{0ms, kSingle, 6, kActs},
        {999ms, kSingle, 6, kNothing},
        {1998ms, kSingle, 6, kNothing},
        {2998ms, kSingle, 6, kActs}}},
      {"a block write counts as written too",
       {{0ms, kBlock, 0, kNothing},
        {10ms, kBlock, 6, kActs},
        {20ms, kSingle, 6, kNothing},
        {1020ms, kSingle, 6, kActs}}},
      {"a single write of what was only remembered says that it is not new",
       {{0ms, kBlock, 6, kNotNew}, {10ms, kSingle, 6, kNotNew}}},
      {"0 arms a single write at once",
       {{0ms, kSingle, 6, kActs}, {10ms, kSingle, 0, kNothing}, {20ms, kSingle, 6, kActs}}},
      {"a single 0 does nothing, whatever the memory", {{0ms, kSingle, 0, kNothing}, {5000ms, kSingle, 0, kNothing}}},
      {"a stop's press is never swallowed", {{0ms, kSingle, 3, kActs}, {10ms, kSingle, 3, kActs}}},
  });
}

TEST(Edges, OfControlword) {
  const std::vector<Story> stories{
      {"a block write with an empty memory is only remembered, also where it would stop by the edge rule",
       {{0ms, kBlock, 0x0F, kNotNew}, {10ms, kBlock, 0x0F, kNothing}}},
      {"a 0 from a new connection stops nothing", {{0ms, kBlock, 0, kNothing}, {10ms, kBlock, 0, kNothing}}},
      {"a block write acts where the value differs, 0 too",
       {{0ms, kBlock, 0x0F, kNotNew}, {10ms, kBlock, 0, kActs}, {20ms, kBlock, 0, kNothing}, {30ms, kBlock, 6, kActs}}},
      {"a single write acts with an empty memory", {{0ms, kSingle, 0, kActs}}},
      {"or after rearm_ms",
       {{0ms, kSingle, 0x1F, kActs}, {500ms, kSingle, 0x1F, kNothing}, {1500ms, kSingle, 0x1F, kActs}}},
  };
  for (const Story& story : stories) {
    SCOPED_TRACE(story.sentence);
    EdgeMemory memory;
    for (const Step& step : story.steps)
      EXPECT_EQ(memory.controlword(static_cast<std::uint16_t>(step.value), at(step.form, step.at)), step.verdict)
          << step.value;
  }
}

// What ends a motion between two presses of the same command, and what the second press comes to then.
TEST(Edges, ASingleRepetitionIsNotNewAfterWhatEndedItsAction) {
  struct Ending {
    const char* what;
    void (*happens)(Endings&);
    Verdict soon;   ///< pressed again within rearm_ms
    Verdict later;  ///< pressed again after it
  };
  const std::vector<Ending> endings{
      {"nothing", [](Endings&) {}, kNothing, kActs},
      {"its own stop", [](Endings& e) { e.stopped(kMe); }, kNotNew, kActs},
      {"another client's stop", [](Endings& e) { e.stopped(kOther); }, kNotNew, kNotNew},
      {"the gateway's own stop", [](Endings& e) { e.stopped(0); }, kNotNew, kNotNew},
      {"another's stop and then its own",
       [](Endings& e) {
         e.stopped(kOther);
         e.stopped(kMe);
       },
       kNotNew, kNotNew},
      {"a fault", [](Endings& e) { e.faulted(); }, kNotNew, kNotNew},
      {"a link loss", [](Endings& e) { e.lost(); }, kNotNew, kNotNew},
      {"its own command", [](Endings& e) { e.commanded(kMe); }, kNothing, kActs},
      {"another client's command", [](Endings& e) { e.commanded(kOther); }, kNotNew, kActs},
  };
  for (const Ending& ending : endings) {
    SCOPED_TRACE(ending.what);
    for (const Duration pause : {10ms, 1000ms}) {
      EdgeMemory memory;
      Endings history;
      const auto press = [&](Duration when, Command command) {
        Writing writing = at(kSingle, when);
        writing.endings = &history;
        return memory.command(command, writing);
      };
      EXPECT_EQ(press(0ms, move_absolute), kActs);
      ending.happens(history);
      EXPECT_EQ(press(pause, move_absolute), pause == 10ms ? ending.soon : ending.later) << pause.count();
      EXPECT_EQ(press(pause + 1ms, none), kNothing);
      EXPECT_EQ(press(pause + 2ms, move_absolute), kActs) << "0 arms it";
    }
  }
}

TEST(Edges, AChangedTargetBesideWhatIsNotNewIsTold) {
  EdgeMemory memory;
  const auto write = [&](WriteForm form, Duration when, std::uint64_t targets) {
    Writing writing = at(form, when);
    writing.targets = targets;
    return memory.command(move_absolute, writing);
  };
  EXPECT_EQ(write(kSingle, 0ms, 1), kActs);
  EXPECT_EQ(write(kSingle, 300ms, 2), kNotNew) << "another target, the same press";
  EXPECT_EQ(write(kSingle, 600ms, 2), kNotNew) << "each time";
  EXPECT_EQ(write(kBlock, 700ms, 3), kNotNew) << "a block that holds the command";
  EXPECT_EQ(write(kBlock, 710ms, 3), kNothing) << "once";
  EXPECT_EQ(write(kSingle, 1710ms, 3), kActs);
  EXPECT_EQ(write(kBlock, 1720ms, 3), kNothing);
  EXPECT_EQ(write(kBlock, 1730ms, 4), kNotNew);
}

struct CoilStep {
  Duration at;
  WriteForm form;
  bool value;
  Command asks;  ///< none: does not act
  Verdict verdict = asks == none ? kNothing : kActs;
};
struct CoilStory {
  const char* sentence;
  int coil;
  std::vector<CoilStep> steps;
};

TEST(Edges, OfCoils) {
  const std::vector<CoilStory> stories{
      {"enable: 0 -> 1 enables and 1 -> 0 disables",
       0,
       {{0ms, kBlock, false, none}, {10ms, kBlock, true, enable}, {20ms, kBlock, false, disable}}},
      {"a level of 1 found in a first block is only remembered",
       0,
       {{0ms, kBlock, true, none, kNotNew}, {9ms, kBlock, true, none}}},
      {"so is a level of 0", 0, {{0ms, kBlock, false, none}, {10ms, kBlock, false, none}}},
      {"a level of 1 is no standing right, in a block",
       0,
       {{0ms, kBlock, false, none},
        {10ms, kBlock, true, enable},
        {20s, kBlock, true, none},
        {40s, kBlock, true, none}}},
      {"nor in single writes, however far apart, and these are told",
       0,
       {{0ms, kSingle, true, enable},
        {2s, kSingle, true, none, kNotNew},
        {60s, kSingle, true, none, kNotNew},
        {61s, kSingle, false, disable},
        {62s, kSingle, true, enable}}},
      {"a single 0 always acts",
       0,
       {{0ms, kSingle, false, disable}, {500ms, kSingle, false, disable}, {600ms, kBlock, false, none}}},
      {"fault_reset acts on 0 -> 1 only",
       1,
       {{0ms, kBlock, false, none},
        {10ms, kBlock, true, fault_reset},
        {20ms, kBlock, false, none},
        {30ms, kBlock, true, fault_reset}}},
      {"fault_reset in a first block is only remembered", 1, {{0ms, kBlock, true, none, kNotNew}}},
      {"a button that only ever writes 1 works once per rearm_ms",
       1,
       {{0ms, kSingle, true, fault_reset}, {999ms, kSingle, true, none}, {1999ms, kSingle, true, fault_reset}}},
      {"a relative move's button says that it is not new",
       5,
       {{0ms, kSingle, true, move_relative}, {999ms, kSingle, true, none, kNotNew}}},
      {"a 0 arms it at once",
       5,
       {{0ms, kSingle, true, move_relative}, {50ms, kSingle, false, none}, {100ms, kSingle, true, move_relative}}},
      {"quick_stop asserted in a first block acts", 2, {{0ms, kBlock, true, quick_stop}, {10ms, kBlock, true, none}}},
      {"quick_stop 0 does nothing", 2, {{0ms, kSingle, false, none}, {10ms, kBlock, false, none}}},
      {"a quick_stop's press is never swallowed",
       2,
       {{0ms, kSingle, true, quick_stop}, {10ms, kSingle, true, quick_stop}}},
      {"halt asserted in a first block acts, and 0 ends the halt",
       3,
       {{0ms, kBlock, true, halt}, {10ms, kBlock, true, none}, {20ms, kBlock, false, end_halt}}},
      {"a halt's press is never swallowed", 3, {{0ms, kSingle, true, halt}, {10ms, kSingle, true, halt}}},
      {"halt 0 in a first block is only remembered", 3, {{0ms, kBlock, false, none}, {10ms, kBlock, true, halt}}},
      {"start_absolute acts on 0 -> 1", 4, {{0ms, kBlock, false, none}, {10ms, kBlock, true, move_absolute}}},
      {"home acts on 0 -> 1", 6, {{0ms, kBlock, false, none}, {10ms, kBlock, true, home}}},
      {"run_velocity: 1 runs and 0 halts",
       7,
       {{0ms, kBlock, false, none}, {10ms, kBlock, true, run_velocity}, {20ms, kBlock, false, end_run}}},
      {"run_velocity in a first block is only remembered, 1 and 0",
       7,
       {{0ms, kBlock, true, none, kNotNew}, {10ms, kBlock, false, end_run}}},
      {"run_velocity needs a 0 first in single writes too",
       7,
       {{0ms, kSingle, true, none, kNotNew},
        {10ms, kSingle, true, none, kNotNew},
        {20ms, kSingle, false, end_run},
        {30ms, kSingle, true, run_velocity}}},
  };
  for (const CoilStory& story : stories) {
    SCOPED_TRACE(story.sentence);
    EdgeMemory memory;
    const CoilRow& coil = coil_rows()[static_cast<std::size_t>(story.coil)];
    for (const CoilStep& step : story.steps) {
      const CoilAsks asks = memory.coil(coil, step.value, at(step.form, step.at));
      EXPECT_EQ(text(asks.command), text(step.asks)) << step.value << " at " << step.at.count() / 1'000'000 << " ms";
      EXPECT_EQ(asks.verdict, step.verdict) << step.value << " at " << step.at.count() / 1'000'000 << " ms";
    }
  }
}

TEST(Edges, ALevelThatIsSoAlreadyIsAnsweredNormally) {
  EdgeMemory memory;
  Writing writing = at(kSingle, 0ms);
  EXPECT_EQ(memory.coil(coil_rows()[0], true, writing).command, enable);
  writing.enabled = true;
  EXPECT_EQ(memory.coil(coil_rows()[0], true, writing).verdict, kNothing);
  EXPECT_EQ(memory.coil(coil_rows()[7], false, writing).command, end_run);
  EXPECT_EQ(memory.coil(coil_rows()[7], true, writing).command, run_velocity);
  writing.runs_velocity = true;
  EXPECT_EQ(memory.coil(coil_rows()[7], true, writing).verdict, kNothing);
}

TEST(Edges, EnableNeedsA0FirstWhileLatchedOrFaulted) {
  EdgeMemory memory;
  Writing writing = at(kSingle, 0ms);
  writing.needs_zero = true;
  EXPECT_EQ(memory.coil(coil_rows()[0], true, writing).verdict, kNotNew);
  EXPECT_EQ(memory.coil(coil_rows()[0], true, writing).verdict, kNotNew);
  EXPECT_EQ(memory.coil(coil_rows()[0], false, writing).command, disable);
  EXPECT_EQ(memory.coil(coil_rows()[0], true, writing).command, enable);
}

struct IdStep {
  Command command;
  int id;
  Verdict verdict;
};

TEST(Edges, OfCommandIds) {
  const std::vector<std::pair<const char*, std::vector<IdStep>>> stories{
      {"the first id is only remembered", {{enable, 7, kNotNew}, {enable, 7, kNothing}, {enable, 8, kActs}}},
      {"a stop acts with the first id too", {{quick_stop, 7, kActs}, {quick_stop, 7, kNothing}}},
      {"a stop acts if the command differs, though the id does not",
       {{none, 1, kNothing},
        {enable, 2, kActs},
        {disable, 2, kActs},
        {quick_stop, 2, kActs},
        {quick_stop, 2, kNothing}}},
      {"a stop acts if the id differs, though the command does not",
       {{quick_stop, 7, kActs}, {quick_stop, 8, kActs}, {quick_stop, 8, kNothing}}},
      {"the same id acts once, whatever else is commanded with it",
       {{none, 1, kNothing}, {enable, 2, kActs}, {home, 2, kNothing}}},
      {"an id that went back differs too", {{none, 9, kNothing}, {enable, 8, kActs}}},
      {"command 0 with an id sets the last id",
       {{none, 1, kNothing}, {none, 2, kNothing}, {enable, 2, kNothing}, {enable, 3, kActs}}},
  };
  for (const auto& [sentence, steps] : stories) {
    SCOPED_TRACE(sentence);
    EdgeMemory memory;
    CommandIds ids;
    for (const IdStep& step : steps) {
      const auto id = static_cast<std::uint16_t>(step.id);
      EXPECT_EQ(memory.command_with_id(step.command, id, ids, at(kBlock, 0ms)), step.verdict) << step.id;
    }
  }
}

TEST(Edges, AnIdThatWasOnlyRememberedIsNotSeen) {
  EdgeMemory memory;
  CommandIds ids;
  static_cast<void>(memory.command_with_id(enable, 7, ids, at(kBlock, 0ms)));
  EXPECT_EQ(ids.last, 7);
  EXPECT_EQ(ids.seen, std::nullopt);
  static_cast<void>(memory.command_with_id(none, 8, ids, at(kBlock, 1ms)));
  EXPECT_EQ(ids.seen, 8);
  static_cast<void>(memory.command_with_id(enable, 9, ids, at(kBlock, 2ms)));
  EXPECT_EQ(ids.seen, 9);
}

TEST(Edges, AnIdNeedsNeitherADifferentCommandNorAnEmptyMemory) {
  EdgeMemory memory;
  CommandIds ids{4, 4};
  EXPECT_EQ(memory.command_with_id(move_relative, 5, ids, at(kBlock, 0ms)), kActs);
  EXPECT_EQ(memory.command_with_id(move_relative, 6, ids, at(kBlock, 1ms)), kActs);
}

TEST(Edges, WhatWasRefusedAndDidNothingIsNoPress) {
  EdgeMemory memory;
  EXPECT_EQ(memory.command(move_absolute, at(kSingle, 0ms)), kActs);
  memory.forget_presses(Instant{});
  EXPECT_EQ(memory.command(move_absolute, at(kSingle, 100ms)), kActs);
  EXPECT_EQ(memory.command(move_absolute, at(kSingle, 200ms)), kNothing);
  memory.forget_presses(Instant{} + 200ms);
  EXPECT_EQ(memory.command(move_absolute, at(kBlock, 300ms)), kNothing) << "a scanner's block is not started by it";
}

TEST(Edges, ABlockOfZerosStopsWhereTheControlwordWasAnother) {
  EdgeMemory memory;
  EXPECT_FALSE(memory.zeros(Instant{})) << "on an empty memory it is only remembered";
  EXPECT_FALSE(memory.command_empty());
  EXPECT_EQ(memory.controlword(0x0F, at(kBlock, 10ms)), kActs);
  EXPECT_TRUE(memory.zeros(Instant{} + 20ms));
  EXPECT_FALSE(memory.zeros(Instant{} + 30ms));
}

TEST(Edges, TheLastCommandIsReadBack) {
  EdgeMemory memory;
  EXPECT_EQ(memory.last_command(), 0);
  static_cast<void>(memory.command(home, at(kBlock, 0ms)));
  EXPECT_EQ(memory.last_command(), 10) << "remembered, though it did not act";
}

TEST(Stops, OfControlwordAreBit1Or2ClearAndTheValues6And7) {
  for (const int value : {0x00, 0x02, 0x04, 0x05, 0x06, 0x07, 0x0B, 0x0D, 0x80, 0x106}) {
    EXPECT_TRUE(is_stop_controlword(static_cast<std::uint16_t>(value))) << value;
  }
  for (const int value : {0x0F, 0x1F, 0x3F, 0x10F, 0x8F, 0x0E}) {
    EXPECT_FALSE(is_stop_controlword(static_cast<std::uint16_t>(value))) << value;
  }
}

}  // namespace
}  // namespace axisgate::modbus_tcp
