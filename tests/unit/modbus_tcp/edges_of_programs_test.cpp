// SPDX-License-Identifier: Apache-2.0
// The rules of edges for several programs at one address (design 3.3 Edges): what command_ids come to.
#include <gtest/gtest.h>

#include "gateway/upstream/modbus_tcp/client/edges.hpp"

namespace axisgate::modbus_tcp {
namespace {

using namespace std::chrono_literals;

constexpr ClientId kProgram = 1;

Writing in_a_block(Duration since_start = 0ms) {
  Writing writing;
  writing.form = WriteForm::block;
  writing.now = Instant{} + since_start;
  writing.rearm = 1000ms;
  writing.client = kProgram;
  return writing;
}

// `own`: what the connection wrote last itself; by the address the id of another one was written since.
TEST(EdgesOfPrograms, what_a_connection_repeats_is_not_new_whatever_others_of_its_address_wrote) {
  const auto write = [](Command command, std::uint16_t id, const LastWords& own) {
    EdgeMemory memory;
    CommandIds ids{.last = 3, .seen = 3};
    Writing first = in_a_block();
    static_cast<void>(memory.command_with_id(Command::halt, 900, ids, first));
    Writing writing = in_a_block(10ms);
    writing.own = own;
    return memory.command_with_id(command, id, ids, writing);
  };
  EXPECT_EQ(write(Command::run_velocity, 4, {.command = 8, .id = 4}), Verdict::nothing);
  EXPECT_EQ(write(Command::run_velocity, 4, {.command = 0, .id = 4}), Verdict::nothing) << "zeros never erase it";
  EXPECT_EQ(write(Command::run_velocity, 5, {.command = 8, .id = 4}), Verdict::acts);
  EXPECT_EQ(write(Command::run_velocity, 4, {}), Verdict::acts) << "on a new connection the id of the address decides";
  EXPECT_EQ(write(Command::run_velocity, 900, {.command = 8, .id = 4}), Verdict::nothing);
  EXPECT_EQ(write(Command::quick_stop, 4, {.command = 3, .id = 4}), Verdict::acts)
      << "a stop too many is the smaller harm";
  EXPECT_EQ(write(Command::halt, 900, {.command = 4, .id = 4}), Verdict::acts) << "an id that differs from its own";
  EXPECT_EQ(write(Command::halt, 900, {.command = 4}), Verdict::acts) << "and where it has written none";
}

TEST(EdgesOfPrograms, what_another_program_has_overtaken_is_not_new_once_its_action_was_ended) {
  EdgeMemory memory;
  CommandIds ids;
  AxisRecord record;
  const auto write = [&](std::uint16_t id, std::optional<std::uint16_t> own, Duration connected, Duration now) {
    Writing writing = in_a_block(now);
    writing.own.id = own;
    writing.connected_at = Instant{} + connected;
    writing.record = &record;
    return memory.command_with_id(Command::run_velocity, id, ids, writing);
  };
  EXPECT_EQ(write(3, {}, 0ms, 10ms), Verdict::not_new);
  EXPECT_EQ(write(4, 3, 0ms, 20ms), Verdict::acts);
  EXPECT_EQ(write(900, {}, 15ms, 30ms), Verdict::acts) << "of another program: its connection was there before";
  EXPECT_EQ(write(4, {}, 40ms, 50ms), Verdict::acts) << "nothing was ended";
  EXPECT_EQ(write(901, 900, 15ms, 60ms), Verdict::acts);
  record.stopped(kProgram);
  EXPECT_EQ(write(4, {}, 70ms, 80ms), Verdict::not_new) << "the first id of a connection";
  EXPECT_EQ(write(4, {}, 90ms, 100ms), Verdict::nothing) << "and the last of the address by then";
  EXPECT_EQ(write(902, 901, 15ms, 110ms), Verdict::acts);
  EXPECT_EQ(write(5, 4, 90ms, 120ms), Verdict::acts) << "its program goes on";
  EXPECT_EQ(write(4, {}, 130ms, 140ms), Verdict::acts) << "and has left the id";
  EXPECT_EQ(write(6, {}, 150ms, 160ms), Verdict::acts) << "of a successor, which has overtaken nothing";
  record.stopped(kProgram);
  EXPECT_EQ(write(4, {}, 170ms, 180ms), Verdict::acts) << "so the id of the address decides";
}

}  // namespace
}  // namespace axisgate::modbus_tcp
