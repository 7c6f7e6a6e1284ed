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

Writing at(WriteForm form, Duration since_start) { return {form, Instant{} + since_start, kRearm}; }

/// One write of a story: when, how, what, and whether it acts.
struct Step {
  Duration at;
  WriteForm form;
  int value;
  bool acts;
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
      EXPECT_EQ(memory.command(Command{static_cast<std::uint8_t>(step.value)}, at(step.form, step.at)), step.acts)
          << "value " << step.value << " at " << step.at.count() / 1'000'000 << " ms";
    }
  }
}

TEST(Edges, OfCommand) {
  play_commands({
      {"a block write with an empty memory is only remembered", {{0ms, kBlock, 1, false}, {10ms, kBlock, 1, false}}},
      {"except a stop that is asserted, which acts",
       {{0ms, kBlock, 2, true}, {10ms, kBlock, 2, false}, {20ms, kBlock, 2, false}}},
      {"a block write acts if the value differs", {{0ms, kBlock, 0, false}, {10ms, kBlock, 6, true}}},
      {"the same block written for ever starts nothing twice",
       {{0ms, kBlock, 0, false},
        {10ms, kBlock, 6, true},
        {20ms, kBlock, 6, false},
        {5000ms, kBlock, 6, false},
        {60000ms, kBlock, 6, false}}},
      {"0 does nothing and arms",
       {{0ms, kBlock, 0, false}, {10ms, kBlock, 6, true}, {20ms, kBlock, 0, false}, {30ms, kBlock, 6, true}}},
      {"from one command to another no 0 is needed",
       {{0ms, kBlock, 0, false}, {10ms, kBlock, 1, true}, {20ms, kBlock, 6, true}}},
      {"a single write acts if the memory is empty", {{0ms, kSingle, 1, true}}},
      {"or the value differs", {{0ms, kSingle, 1, true}, {10ms, kSingle, 6, true}}},
      {"two presses within rearm_ms count once", {{0ms, kSingle, 6, true}, {999ms, kSingle, 6, false}}},
      {"it acts when it was not written for rearm_ms", {{0ms, kSingle, 6, true}, {1000ms, kSingle, 6, true}}},
      {"a press that does not act is a write all the same",
       {{0ms, kSingle, 6, true}, {999ms, kSingle, 6, false}, {1998ms, kSingle, 6, false}, {2998ms, kSingle, 6, true}}},
      {"a block write counts as written too",
       {{0ms, kBlock, 0, false}, {10ms, kBlock, 6, true}, {20ms, kSingle, 6, false}, {1020ms, kSingle, 6, true}}},
      {"0 arms a single write at once", {{0ms, kSingle, 6, true}, {10ms, kSingle, 0, false}, {20ms, kSingle, 6, true}}},
      {"a single 0 does nothing, whatever the memory", {{0ms, kSingle, 0, false}, {5000ms, kSingle, 0, false}}},
      {"a stop's press is never swallowed", {{0ms, kSingle, 3, true}, {10ms, kSingle, 3, true}}},
  });
}

TEST(Edges, OfControlword) {
  const std::vector<Story> stories{
      {"a block write with an empty memory is only remembered, also where it would stop by the edge rule",
       {{0ms, kBlock, 0x0F, false}, {10ms, kBlock, 0x0F, false}}},
      {"a block of zeros from a new connection stops nothing", {{0ms, kBlock, 0, false}, {10ms, kBlock, 0, false}}},
      {"a block write acts where the value differs, 0 too",
       {{0ms, kBlock, 0x0F, false}, {10ms, kBlock, 0, true}, {20ms, kBlock, 0, false}, {30ms, kBlock, 6, true}}},
      {"a single write acts with an empty memory", {{0ms, kSingle, 0, true}}},
      {"or after rearm_ms", {{0ms, kSingle, 0x1F, true}, {500ms, kSingle, 0x1F, false}, {1500ms, kSingle, 0x1F, true}}},
  };
  for (const Story& story : stories) {
    SCOPED_TRACE(story.sentence);
    EdgeMemory memory;
    for (const Step& step : story.steps)
      EXPECT_EQ(memory.controlword(static_cast<std::uint16_t>(step.value), at(step.form, step.at)), step.acts)
          << step.value;
  }
}

struct CoilStep {
  Duration at;
  WriteForm form;
  bool value;
  Command asks;  ///< none: does not act
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
       {{0ms, kBlock, true, none}, {9ms, kBlock, true, none}}},
      {"so is a level of 0", 0, {{0ms, kBlock, false, none}, {10ms, kBlock, false, none}}},
      {"a level of 1 is no standing right, in a block",
       0,
       {{0ms, kBlock, false, none},
        {10ms, kBlock, true, enable},
        {20s, kBlock, true, none},
        {40s, kBlock, true, none}}},
      {"nor in single writes, however far apart",
       0,
       {{0ms, kSingle, true, enable},
        {2s, kSingle, true, none},
        {60s, kSingle, true, none},
        {61s, kSingle, false, disable},
        {62s, kSingle, true, enable}}},
      {"a single 0 with an empty memory disables", 0, {{0ms, kSingle, false, disable}}},
      {"and disables again after rearm_ms, but not as a second press",
       0,
       {{0ms, kSingle, false, disable}, {500ms, kSingle, false, none}, {1500ms, kSingle, false, disable}}},
      {"fault_reset acts on 0 -> 1 only",
       1,
       {{0ms, kBlock, false, none},
        {10ms, kBlock, true, fault_reset},
        {20ms, kBlock, false, none},
        {30ms, kBlock, true, fault_reset}}},
      {"fault_reset in a first block is only remembered", 1, {{0ms, kBlock, true, none}}},
      {"a button that only ever writes 1 works once per rearm_ms",
       1,
       {{0ms, kSingle, true, fault_reset}, {999ms, kSingle, true, none}, {1999ms, kSingle, true, fault_reset}}},
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
      {"halt 0 in a first block is only remembered", 3, {{0ms, kBlock, false, none}, {10ms, kBlock, true, halt}}},
      {"start_absolute acts on 0 -> 1", 4, {{0ms, kBlock, false, none}, {10ms, kBlock, true, move_absolute}}},
      {"home acts on 0 -> 1", 6, {{0ms, kBlock, false, none}, {10ms, kBlock, true, home}}},
      {"run_velocity: 1 runs and 0 halts",
       7,
       {{0ms, kBlock, false, none}, {10ms, kBlock, true, run_velocity}, {20ms, kBlock, false, halt}}},
      {"run_velocity in a first block is only remembered, 1 and 0",
       7,
       {{0ms, kBlock, true, none}, {10ms, kBlock, false, halt}}},
  };
  for (const CoilStory& story : stories) {
    SCOPED_TRACE(story.sentence);
    EdgeMemory memory;
    const CoilRow& coil = coil_rows()[static_cast<std::size_t>(story.coil)];
    for (const CoilStep& step : story.steps) {
      EXPECT_EQ(text(memory.coil(coil, step.value, at(step.form, step.at)).value_or(none)), text(step.asks))
          << step.value << " at " << step.at.count() / 1'000'000 << " ms";
    }
  }
}

struct IdStep {
  Command command;
  int id;
  bool acts;
};

TEST(Edges, OfCommandIds) {
  const std::vector<std::pair<const char*, std::vector<IdStep>>> stories{
      {"the first id is only remembered", {{enable, 7, false}, {enable, 7, false}, {enable, 8, true}}},
      {"a stop acts with the first id too", {{quick_stop, 7, true}, {quick_stop, 7, false}}},
      {"the same id acts once, whatever the command", {{none, 1, false}, {enable, 2, true}, {disable, 2, false}}},
      {"an id that went back differs too", {{none, 9, false}, {enable, 8, true}}},
      {"an id with command 0 counts", {{none, 1, false}, {none, 2, false}, {enable, 2, false}, {enable, 3, true}}},
  };
  for (const auto& [sentence, steps] : stories) {
    SCOPED_TRACE(sentence);
    EdgeMemory memory;
    CommandIds ids;
    for (const IdStep& step : steps) {
      EXPECT_EQ(memory.command_with_id(step.command, static_cast<std::uint16_t>(step.id), ids, Instant{}), step.acts)
          << step.id;
    }
  }
}

TEST(Edges, TheFirstIdActsWhereId0WasWrittenBefore) {
  EdgeMemory memory;
  CommandIds ids;
  ids.zero_written = true;
  EXPECT_TRUE(memory.command_with_id(enable, 1, ids, Instant{}));
  EXPECT_FALSE(memory.command_with_id(enable, 1, ids, Instant{}));
}

TEST(Edges, AnIdNeedsNeitherADifferentCommandNorAnEmptyMemory) {
  EdgeMemory memory;
  CommandIds ids{4, false};
  EXPECT_TRUE(memory.command_with_id(move_relative, 5, ids, Instant{}));
  EXPECT_TRUE(memory.command_with_id(move_relative, 6, ids, Instant{} + 1ms));
}

TEST(Edges, WhatWasRefusedAndDidNothingIsNoPress) {
  EdgeMemory memory;
  EXPECT_TRUE(memory.command(move_absolute, at(kSingle, 0ms)));
  memory.forget_presses(Instant{});
  EXPECT_TRUE(memory.command(move_absolute, at(kSingle, 100ms)));
  EXPECT_FALSE(memory.command(move_absolute, at(kSingle, 200ms)));
  memory.forget_presses(Instant{} + 200ms);
  EXPECT_FALSE(memory.command(move_absolute, at(kBlock, 300ms))) << "a scanner's block is not started by it";
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
