// SPDX-License-Identifier: Apache-2.0
// The rules by which a write acts, on the memory alone (design 3.3 Edges).
#include "gateway/upstream/modbus_tcp/client/edges.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

namespace axisgate::modbus_tcp {
namespace {

using namespace std::chrono_literals;
using enum Command;

constexpr Verdict kNothing = Verdict::nothing;
constexpr Verdict kActs = Verdict::acts;
constexpr Verdict kNotNew = Verdict::not_new;
constexpr ClientId kMe = 1;
constexpr ClientId kOther = 2;

Writing at(WriteForm form, Duration since_start) {
  Writing writing;
  writing.form = form;
  writing.now = Instant{} + since_start;
  writing.rearm = 1000ms;
  writing.client = kMe;
  return writing;
}
Writing single(Duration since_start = 0ms) { return at(WriteForm::single, since_start); }
Writing block(Duration since_start = 0ms) { return at(WriteForm::block, since_start); }

std::string word(Verdict verdict) { return verdict == kActs ? "acts" : verdict == kNotNew ? "not_new" : ""; }

/// What one write comes to, in a word; "" for nothing.
using Write = std::function<std::string(const std::string& value, const Writing&)>;

/// Plays the writes of a story, told between commas: "block 0", "single 6 acts", "@999 single 6 not_new": at which
/// millisecond (10 after the one before where none is told), how, which value, and what comes of it, if anything.
void play(const char* sentence, const std::string& story, const Write& write) {
  SCOPED_TRACE(sentence);
  Duration now = -10ms;
  std::istringstream steps(story);
  for (std::string step; std::getline(steps, step, ',');) {
    SCOPED_TRACE(step);
    std::istringstream words(step);
    std::string form;
    std::string value;
    std::string outcome;
    words >> form;
    now += 10ms;
    if (form[0] == '@') {
      now = std::chrono::milliseconds(std::stoi(form.substr(1)));
      words >> form;
    }
    words >> value >> outcome;
    EXPECT_EQ(write(value, form == "single" ? single(now) : block(now)), outcome);
  }
}

struct Story {
  const char* sentence;
  const char* steps;
};

TEST(Edges, of_command) {
  const Story stories[] = {
      {"a block write with an empty memory is only remembered, and says so once", "block 1 not_new, block 1"},
      {"except a stop that is asserted, which acts", "block 2 acts, block 2, block 2"},
      {"a block write acts if the value differs", "block 0, block 6 acts"},
      {"the same block for ever starts nothing twice", "block 0, block 6 acts, block 6, @5000 block 6, @60000 block 6"},
      {"0 does nothing and arms", "block 0, block 6 acts, block 0, block 6 acts"},
      {"from one command to another no 0 is needed", "block 0, block 1 acts, block 6 acts"},
      {"a single write acts if the memory is empty or the value differs", "single 1 acts, single 6 acts"},
      {"two presses within rearm_ms count once", "single 6 acts, @999 single 6"},
      {"a relative move that is not new says so", "single 7 acts, @999 single 7 not_new"},
      {"it acts when it was not written for rearm_ms", "single 6 acts, @1000 single 6 acts"},
      {"a press that does not act is a write all the same",
       "single 6 acts, @999 single 6, @1998 single 6, @2998 single 6 acts"},
      {"a block write counts as written too", "block 0, block 6 acts, single 6, @1020 single 6 acts"},
      {"what was only remembered is not new in a single write", "block 6 not_new, single 6 not_new"},
      {"0 arms a single write at once", "single 6 acts, single 0, single 6 acts"},
      {"a single 0 does nothing, whatever the memory", "single 0, @5000 single 0"},
      {"a stop's press is never swallowed", "single 3 acts, single 3 acts"},
  };
  for (const Story& story : stories) {
    EdgeMemory memory;
    play(story.sentence, story.steps, [&](const std::string& value, const Writing& writing) {
      return word(memory.command(Command{static_cast<std::uint8_t>(std::stoi(value))}, writing));
    });
  }
}

TEST(Edges, of_controlword) {
  const Story stories[] = {
      {"a block with an empty memory is only remembered, also where it would stop by the edge rule",
       "block 15 not_new, block 15"},
      {"a 0 from a new connection stops nothing", "block 0, block 0"},
      {"a block write acts where the value differs, 0 too", "block 15 not_new, block 0 acts, block 0, block 6 acts"},
      {"a single write acts with an empty memory", "single 0 acts"},
      {"or after rearm_ms", "single 31 acts, @500 single 31, @1500 single 31 acts"},
  };
  for (const Story& story : stories) {
    EdgeMemory memory;
    play(story.sentence, story.steps, [&](const std::string& value, const Writing& writing) {
      return word(memory.controlword(static_cast<std::uint16_t>(std::stoi(value)), writing));
    });
  }
}

TEST(Edges, of_coils) {
  struct CoilStory {
    const char* sentence;
    std::size_t coil;
    const char* steps;
  };
  const CoilStory stories[] = {
      {"enable: 0 -> 1 enables and 1 -> 0 disables", 0, "block 0, block 1 enable, block 0 disable"},
      {"a level of 1 found in a first block is only remembered", 0, "block 1 not_new, block 1"},
      {"so is a level of 0", 0, "block 0, block 0"},
      {"a level of 1 is no standing right", 0, "block 0, block 1 enable, @20000 block 1, @40000 block 1"},
      {"nor in single writes, however far apart, and these are told", 0,
       "single 1 enable, @2000 single 1 not_new, @60000 single 1 not_new, single 0 disable, single 1 enable"},
      {"a single 0 always acts", 0, "single 0 disable, @500 single 0 disable, block 0"},
      {"fault_reset acts on 0 -> 1 only", 1, "block 0, block 1 fault_reset, block 0, block 1 fault_reset"},
      {"fault_reset in a first block is only remembered", 1, "block 1 not_new"},
      {"a button that only ever writes 1 works once per rearm_ms", 1,
       "single 1 fault_reset, @999 single 1, @1999 single 1 fault_reset"},
      {"a relative move's button says that it is not new", 5, "single 1 move_relative, @999 single 1 not_new"},
      {"a 0 arms it at once", 5, "single 1 move_relative, single 0, single 1 move_relative"},
      {"quick_stop asserted in a first block acts", 2, "block 1 quick_stop, block 1"},
      {"quick_stop 0 does nothing", 2, "single 0, block 0"},
      {"a quick_stop's press is never swallowed", 2, "single 1 quick_stop, single 1 quick_stop"},
      {"halt asserted in a first block acts, and 0 ends it", 3, "block 1 halt, block 1, block 0 end_halt"},
      {"a halt's press is never swallowed", 3, "single 1 halt, single 1 halt"},
      {"halt 0 in a first block is only remembered", 3, "block 0, block 1 halt"},
      {"start_absolute acts on 0 -> 1", 4, "block 0, block 1 move_absolute"},
      {"home acts on 0 -> 1", 6, "block 0, block 1 home"},
      {"run_velocity: 1 runs and 0 halts", 7, "block 0, block 1 run_velocity, block 0 end_run"},
      {"run_velocity in a first block is only remembered, 1 and 0", 7, "block 1 not_new, block 0 end_run"},
      {"run_velocity needs a 0 first in single writes too", 7,
       "single 1 not_new, single 1 not_new, single 0 end_run, single 1 run_velocity"},
  };
  for (const CoilStory& story : stories) {
    EdgeMemory memory;
    play(story.sentence, story.steps, [&](const std::string& value, const Writing& writing) {
      const CoilAsks asks = memory.coil(coil_rows()[story.coil], value == "1", writing);
      EXPECT_EQ(asks.verdict == kActs, asks.command != none);
      return asks.verdict == kActs ? std::string(text(asks.command)) : word(asks.verdict);
    });
  }
}

TEST(Edges, of_command_ids) {
  // The command's number, and behind the slash the id.
  const Story stories[] = {
      {"the first id is only remembered", "block 1/7 not_new, block 1/7, block 1/8 acts"},
      {"a stop acts with the first id too", "block 3/7 acts, block 3/7"},
      {"a stop acts if the command differs, though the id does not",
       "block 0/1, block 1/2 acts, block 2/2 acts, block 3/2 acts, block 3/2"},
      {"a stop acts if the id differs, though the command does not", "block 3/7 acts, block 3/8 acts, block 3/8"},
      {"the same id acts once, whatever else is commanded with it", "block 0/1, block 1/2 acts, block 10/2"},
      {"a new id needs no other command", "block 0/4, block 7/5 acts, block 7/6 acts"},
      {"an id that went back differs too", "block 0/9, block 1/8 acts"},
      {"command 0 with an id sets the last id", "block 0/1, block 0/2, block 1/2, block 1/3 acts"},
  };
  for (const Story& story : stories) {
    EdgeMemory memory;
    CommandIds ids;
    std::optional<std::uint16_t> own;
    play(story.sentence, story.steps, [&](const std::string& value, Writing writing) {
      const auto id = static_cast<std::uint16_t>(std::stoi(value.substr(value.find('/') + 1)));
      writing.own.id = std::exchange(own, id);
      return word(memory.command_with_id(Command{static_cast<std::uint8_t>(std::stoi(value))}, id, ids, writing));
    });
  }
}

// Of one client that is all connections of an address.
TEST(Edges, what_a_connection_repeats_without_an_id_is_not_new_either) {
  EdgeMemory memory;
  Writing writing = block();
  EXPECT_EQ(memory.command(none, writing), kNothing);
  EXPECT_EQ(memory.controlword(15, single()), kActs);
  EXPECT_EQ(memory.command(halt, block()), kActs) << "of another connection";
  EXPECT_EQ(memory.controlword(7, single()), kActs);
  writing.own = {.controlword = 15, .command = 8};
  EXPECT_EQ(memory.command(run_velocity, writing), kNothing);
  EXPECT_EQ(memory.controlword(15, writing), kNothing);
  writing.form = WriteForm::single;
  EXPECT_EQ(memory.controlword(7, single()), kActs);
  EXPECT_EQ(memory.controlword(15, writing), kActs) << "somebody presses";
}

// What ends a motion between two presses of the same command, and what the second press comes to then.
TEST(Edges, a_single_repetition_is_not_new_after_what_ended_its_action) {
  struct Ending {
    const char* what;
    std::function<void(AxisRecord&)> happens;
    Verdict soon;   ///< pressed again within rearm_ms
    Verdict later;  ///< pressed again after it
  };
  const Ending endings[] = {
      {"nothing", [](AxisRecord&) {}, kNothing, kActs},
      {"its own stop", [](AxisRecord& e) { e.stopped(kMe); }, kNotNew, kActs},
      {"another client's stop", [](AxisRecord& e) { e.stopped(kOther); }, kNotNew, kNotNew},
      {"the gateway's own stop", [](AxisRecord& e) { e.stopped(0); }, kNotNew, kNotNew},
      {"another's and its own", [](AxisRecord& e) { e.stopped(kOther), e.stopped(kMe); }, kNotNew, kNotNew},
      {"a fault", [](AxisRecord& e) { e.faulted(); }, kNotNew, kNotNew},
      {"a link loss", [](AxisRecord& e) { e.lost(); }, kNotNew, kNotNew},
      {"its own command", [](AxisRecord& e) { e.commanded(kMe, e.accepted()); }, kNothing, kActs},
      {"another client's command", [](AxisRecord& e) { e.commanded(kOther, e.accepted()); }, kNotNew, kActs},
  };
  for (const Ending& ending : endings) {
    SCOPED_TRACE(ending.what);
    for (const Duration pause : {10ms, 1000ms}) {
      EdgeMemory memory;
      AxisRecord history;
      const auto press = [&](Duration when, Command command) {
        Writing writing = single(when);
        writing.record = &history;
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

TEST(Edges, a_release_of_what_its_client_owns_acts_within_rearm_ms_too) {
  EdgeMemory memory;
  Writing writing = single();
  writing.owns = true;
  EXPECT_EQ(memory.command(release, writing), kActs);
  EXPECT_EQ(memory.command(release, single(10ms)), kNothing) << "it is given back";
  writing.now += 300ms;
  EXPECT_EQ(memory.command(release, writing), kActs) << "claimed again since";
  EXPECT_EQ(memory.command(release, single(310ms)), kNothing);
}

TEST(Edges, a_changed_target_beside_what_is_not_new_is_told) {
  EdgeMemory memory;
  const auto write = [&](Writing writing, std::uint64_t targets) {
    writing.targets = targets;
    return memory.command(move_absolute, writing);
  };
  EXPECT_EQ(write(single(0ms), 1), kActs);
  EXPECT_EQ(write(single(300ms), 2), kNotNew) << "another target, the same press";
  EXPECT_EQ(write(single(600ms), 2), kNotNew) << "each time";
  EXPECT_EQ(write(block(700ms), 3), kNotNew) << "a block that has the command";
  EXPECT_EQ(write(block(710ms), 3), kNothing) << "once";
  EXPECT_EQ(write(single(1710ms), 3), kActs);
  EXPECT_EQ(write(block(1720ms), 3), kNothing);
  EXPECT_EQ(write(block(1730ms), 4), kNotNew);
}

TEST(Edges, a_level_that_is_so_already_is_answered_normally) {
  EdgeMemory memory;
  Writing writing = single();
  EXPECT_EQ(memory.coil(coil_rows()[0], true, writing).command, enable);
  writing.enabled = true;
  EXPECT_EQ(memory.coil(coil_rows()[0], true, writing).verdict, kNothing);
  EXPECT_EQ(memory.coil(coil_rows()[7], false, writing).command, end_run);
  EXPECT_EQ(memory.coil(coil_rows()[7], true, writing).command, run_velocity);
  writing.runs_velocity = true;
  EXPECT_EQ(memory.coil(coil_rows()[7], true, writing).verdict, kNothing);
}

TEST(Edges, enable_needs_a_0_first_while_latched_or_faulted) {
  EdgeMemory memory;
  Writing writing = single();
  writing.needs_zero = true;
  EXPECT_EQ(memory.coil(coil_rows()[0], true, writing).verdict, kNotNew);
  EXPECT_EQ(memory.coil(coil_rows()[0], true, writing).verdict, kNotNew);
  EXPECT_EQ(memory.coil(coil_rows()[0], false, writing).command, disable);
  EXPECT_EQ(memory.coil(coil_rows()[0], true, writing).command, enable);
}

TEST(Edges, an_id_that_was_only_remembered_is_not_seen) {
  EdgeMemory memory;
  CommandIds ids;
  static_cast<void>(memory.command_with_id(enable, 7, ids, block()));
  EXPECT_EQ(ids.last, 7);
  EXPECT_EQ(ids.seen, std::nullopt);
  static_cast<void>(memory.command_with_id(none, 8, ids, block(1ms)));
  EXPECT_EQ(ids.seen, 8);
  static_cast<void>(memory.command_with_id(enable, 9, ids, block(2ms)));
  EXPECT_EQ(ids.seen, 9);
}

Writing of_request(std::uint64_t request, Writing writing) {
  writing.request = request;
  return writing;
}

TEST(Edges, what_was_refused_and_did_nothing_is_no_press) {
  EdgeMemory memory;
  EXPECT_EQ(memory.command(move_absolute, of_request(1, single())), kActs);
  memory.forget_presses(1, false);
  EXPECT_EQ(memory.command(move_absolute, of_request(2, single(100ms))), kActs);
  EXPECT_EQ(memory.command(move_absolute, of_request(3, single(200ms))), kNothing);
  memory.forget_presses(3, false);
  EXPECT_EQ(memory.command(move_absolute, of_request(4, block(300ms))), kNothing) << "it starts no scanner's block";
}

TEST(Edges, what_one_request_was_refused_leaves_the_press_of_another_in_the_same_instant) {
  EdgeMemory memory;
  EXPECT_EQ(memory.command(move_absolute, of_request(1, single())), kActs);
  EXPECT_EQ(memory.controlword(0x1F, of_request(2, single())), kActs);
  memory.forget_presses(2, false);
  EXPECT_EQ(memory.command(move_absolute, of_request(3, single(100ms))), kNothing);
  EXPECT_EQ(memory.controlword(0x1F, of_request(4, single(100ms))), kActs);
}

TEST(Edges, what_a_failed_request_has_done_before_stays_pressed) {
  EdgeMemory memory;
  static_cast<void>(memory.controlword(0x0F, of_request(1, block())));
  static_cast<void>(memory.command(none, of_request(1, block())));
  EXPECT_EQ(memory.controlword(0x1F, of_request(2, block(10ms))), kActs);
  EXPECT_EQ(memory.command(home, of_request(2, block(10ms))), kActs);
  memory.controlword_done(2);
  memory.forget_presses(2, false);
  EXPECT_EQ(memory.controlword(0x1F, of_request(3, single(20ms))), kNothing);
  EXPECT_EQ(memory.command(home, of_request(4, single(20ms))), kActs);
}

TEST(Edges, what_was_sent_before_it_failed_has_acted_as_far_as_anothers_stop_is_concerned) {
  AxisRecord record;
  const auto writing = [&](std::uint64_t request, Duration at) {
    Writing out = of_request(request, single(at));
    out.record = &record;
    return out;
  };
  EdgeMemory memory;
  EXPECT_EQ(memory.command(enable, writing(1, 0ms)), kActs);
  memory.forget_presses(1, true);
  EXPECT_EQ(memory.command(enable, writing(2, 10ms)), kActs) << "nobody else has stopped it";
  memory.forget_presses(2, true);
  record.stopped(kOther);
  EXPECT_EQ(memory.command(enable, writing(3, 20ms)), kNotNew);
}

TEST(Edges, a_block_of_zeros_stops_where_the_controlword_was_another) {
  EdgeMemory memory;
  EXPECT_FALSE(memory.zeros(block())) << "on an empty memory it is only remembered";
  EXPECT_FALSE(memory.command_empty());
  EXPECT_EQ(memory.controlword(0x0F, block(10ms)), kActs);
  EXPECT_TRUE(memory.zeros(block(20ms)));
  EXPECT_FALSE(memory.zeros(block(30ms)));
}

TEST(Edges, the_last_command_is_read_back_though_it_did_not_act) {
  EdgeMemory memory;
  EXPECT_EQ(memory.last_command(), 0);
  static_cast<void>(memory.command(home, block()));
  EXPECT_EQ(memory.last_command(), 10);
}

TEST(Stops, of_controlword_are_bit_1_or_2_clear_and_the_values_6_and_7) {
  for (const int value : {0x00, 0x02, 0x04, 0x05, 0x06, 0x07, 0x0B, 0x0D, 0x80, 0x106})
    EXPECT_TRUE(is_stop_controlword(static_cast<std::uint16_t>(value))) << value;
  for (const int value : {0x0F, 0x1F, 0x3F, 0x10F, 0x8F, 0x0E})
    EXPECT_FALSE(is_stop_controlword(static_cast<std::uint16_t>(value))) << value;
}

}  // namespace
}  // namespace axisgate::modbus_tcp
