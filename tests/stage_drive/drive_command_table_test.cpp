// SPDX-License-Identifier: Apache-2.0
// Design 3.3 and 3.4 as a table for every drive and protocol: each command in each situation, what it comes to, and
// what the motor does of it. What a drive cannot do is refused, whatever its state.
#include <gmock/gmock.h>

#include <map>

#include "tests/stage_drive/drive_rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using enum Situation;
using testing::IsEmpty;

/// What a command comes to.
enum class End : std::uint8_t {
  yes,
  state,    ///< 0x04 with result 9
  busy,     ///< 0x06
  refused,  ///< one of these two: both hold
  none,     ///< 0x02: the drive has no such command
  away,     ///< 0x0A
  setup,    ///< 0x06 with result 6
};
constexpr End yes = End::yes, state = End::state, busy = End::busy, refused = End::refused, none = End::none,
              away = End::away, setup = End::setup;

constexpr std::array kCommands{Command::enable,        Command::disable,      Command::quick_stop,
                               Command::halt,          Command::fault_reset,  Command::move_absolute,
                               Command::move_relative, Command::run_velocity, Command::run_torque,
                               Command::home,          Command::set_position, Command::save_parameters};
using Row = std::array<End, kCommands.size()>;
using Table = std::map<Situation, Row>;

// clang-format off
const Table kServo{
    //        enable disable quick halt reset  abs    rel    vel    torque home   setpos save
    {disabled, {yes,   yes,   yes,  yes,  yes,  state, state, state, state, state, state, yes}},
    {enabled,  {yes,   yes,   yes,  yes,  yes,  yes,   yes,   yes,   yes,   yes,   yes,   busy}},
    {moving,   {yes,   yes,   yes,  yes,  yes,  yes,   busy,  yes,   yes,   yes,   busy,  busy}},
    {running,  {yes,   yes,   yes,  yes,  yes,  yes,   busy,  yes,   yes,   yes,   busy,  busy}},
    {homing,   {yes,   yes,   yes,  yes,  yes,  yes,   busy,  yes,   yes,   yes,   busy,  busy}},
    {halted,   {yes,   yes,   yes,  yes,  yes,  yes,   yes,   yes,   yes,   yes,   yes,   busy}},
    {latched,  {yes,   yes,   yes,  yes,  yes,  state, state, state, state, state, state, yes}},
    {faulted,  {state, yes,   yes,  yes,  yes,  state, state, state, state, state, state, yes}},
    {offline,  {away,  away,  away, away, away, away,  away,  away,  away,  away,  away,  away}},
};
// While it is in doubt, asked on Kinco's own protocol.
const Table kInDoubt{
    {in_setup,  {setup, yes,   yes,  yes,  setup, setup, setup, setup, setup, setup, setup, setup}},
    {suspect,   {yes,   yes,   yes,  yes,  yes,   yes,   yes,   yes,   yes,   yes,   yes,   busy}},
    {link_down, {away,  away,  away, away, away,  away,  away,  away,  away,  away,  away,  away}},
};
// A homing from a motion is not described (iD286pro 5); nor is a torque mode or a save.
const Table kStepper{
    {disabled, {yes,   yes,   yes,  yes,  yes,  state, state, state, none,  state, state, none}},
    {enabled,  {yes,   yes,   yes,  yes,  yes,  yes,   yes,   yes,   none,  yes,   yes,   none}},
    {moving,   {yes,   yes,   yes,  yes,  yes,  yes,   busy,  yes,   none,  busy,  busy,  none}},
    {running,  {yes,   yes,   yes,  yes,  yes,  yes,   busy,  yes,   none,  busy,  busy,  none}},
    {halted,   {yes,   yes,   yes,  yes,  yes,  yes,   yes,   yes,   none,  yes,   yes,   none}},
    {latched,  {yes,   yes,   yes,  yes,  yes,  state, state, state, none,  state, state, none}},
    {faulted,  {state, yes,   yes,  yes,  yes,  state, state, state, none,  state, state, none}},
    {offline,  {away,  away,  away, away, away, away,  away,  away,  none,  away,  away,  none}},
};
// Keya 8.2, 8.3: one mode, which the maker's tool has set; no homing, no forcing of a position, no speed limit in
// torque mode, no saving.
const Table kKeyaSpeed{
    {disabled, {yes,   yes,   yes,  yes,  yes,  none,  none,  state, none,  none,  none,  none}},
    {enabled,  {yes,   yes,   yes,  yes,  yes,  none,  none,  yes,   none,  none,  none,  none}},
    {running,  {yes,   yes,   yes,  yes,  yes,  none,  none,  yes,   none,  none,  none,  none}},
    {halted,   {yes,   yes,   yes,  yes,  yes,  none,  none,  yes,   none,  none,  none,  none}},
    {latched,  {yes,   yes,   yes,  yes,  yes,  none,  none,  state, none,  none,  none,  none}},
    {faulted,  {state, yes,   yes,  yes,  yes,  none,  none,  state, none,  none,  none,  none}},
    {offline,  {away,  away,  away, away, away, none,  none,  away,  none,  none,  none,  none}},
};
const Table kKeyaPosition{
    {disabled, {yes,   yes,   yes,  yes,  yes,  state, state, none,  none,  none,  none,  none}},
    {enabled,  {yes,   yes,   yes,  yes,  yes,  yes,   yes,   none,  none,  none,  none,  none}},
    {moving,   {yes,   yes,   yes,  yes,  yes,  yes,   busy,  none,  none,  none,  none,  none}},
    {halted,   {yes,   yes,   yes,  yes,  yes,  yes,   yes,   none,  none,  none,  none,  none}},
    {latched,  {yes,   yes,   yes,  yes,  yes,  state, state, none,  none,  none,  none,  none}},
    {faulted,  {state, yes,   yes,  yes,  yes,  state, state, none,  none,  none,  none,  none}},
    {offline,  {away,  away,  away, away, away, away,  away,  none,  none,  none,  none,  none}},
};
// Keya 6.2, 8.4: the enabling chooses the mode, so the other one has to wait until the axis is disabled; the position
// can be forced to zero, but not under a target that would then be a move.
const Table kKeyaCanopenSpeed{
    {disabled, {yes,   yes,   yes,  yes,  yes,  state, state,   state, none, none, state, none}},
    {enabled,  {yes,   yes,   yes,  yes,  yes,  state, state,   yes,   none, none, yes,   none}},
    {running,  {yes,   yes,   yes,  yes,  yes,  state, refused, yes,   none, none, busy,  none}},
    {halted,   {yes,   yes,   yes,  yes,  yes,  state, state,   yes,   none, none, yes,   none}},
    {latched,  {yes,   yes,   yes,  yes,  yes,  state, state,   state, none, none, state, none}},
    {faulted,  {state, yes,   yes,  yes,  yes,  state, state,   state, none, none, state, none}},
    {offline,  {away,  away,  away, away, away, away,  away,    away,  none, none, away,  none}},
};
const Table kKeyaCanopenPosition{
    {disabled, {yes,   yes,   yes,  yes,  yes,  state, state, state, none, none, state,   none}},
    {enabled,  {yes,   yes,   yes,  yes,  yes,  yes,   yes,   state, none, none, state,   none}},
    {moving,   {yes,   yes,   yes,  yes,  yes,  yes,   busy,  state, none, none, refused, none}},
    {halted,   {yes,   yes,   yes,  yes,  yes,  yes,   yes,   state, none, none, state,   none}},
    {latched,  {yes,   yes,   yes,  yes,  yes,  state, state, state, none, none, state,   none}},
    {faulted,  {state, yes,   yes,  yes,  yes,  state, state, state, none, none, state,   none}},
    {offline,  {away,  away,  away, away, away, away,  away,  away,  none, none, away,    none}},
};
// clang-format on

bool is_in_doubt(Situation situation) { return kInDoubt.contains(situation); }

const Table& table_of(Subject subject) {
  if (subject == Subject::id286pro) return kStepper;
  if (!is_keya(subject)) return kServo;
  if (is_keya_canopen(subject)) return !has_speeds(subject) ? kKeyaCanopenPosition : kKeyaCanopenSpeed;
  return !has_speeds(subject) ? kKeyaPosition : kKeyaSpeed;
}

End expected(Subject subject, Situation situation, Command command) {
  // Its quick stop ends in quick stop active, under torque (LD2 5.4, 605Ah = 6): that is not disabled.
  if (subject == Subject::leadshine && situation == latched && command == Command::save_parameters) return busy;
  const auto place = std::ranges::find(kCommands, command) - kCommands.begin();
  const Table& table = is_in_doubt(situation) ? kInDoubt : table_of(subject);
  return table.at(situation).at(static_cast<std::size_t>(place));
}

struct Case {
  Subject subject;
  Situation situation;
};

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const Subject subject : kSubjects)
    for (const auto& [situation, row] : table_of(subject)) out.push_back({subject, situation});
  for (const Subject subject : {Subject::jd_serial, Subject::md_serial})
    for (const auto& [situation, row] : kInDoubt) out.push_back({subject, situation});
  return out;
}

/// With the numbers it works on. What a drive does not have is asked for alone.
WriteBatch request(Subject subject, Command command, End end) {
  WriteBatch batch = with_command(command);
  if (end == none) return batch;
  const bool moves = command == Command::move_absolute || command == Command::move_relative;
  if (moves) batch.setpoints.push_back({Quantity::target_position, 5'000});
  if (command == Command::run_velocity) batch.setpoints.push_back({Quantity::target_velocity, 100'000});
  if (command == Command::run_torque)
    batch.setpoints = {{Quantity::max_velocity, 1'000'000}, {Quantity::target_torque, 0}};
  if (command == Command::home) batch.setpoints.push_back({Quantity::homing_method, 19});
  if (moves && !is_keya(subject)) batch.setpoints.push_back({Quantity::profile_velocity, 600'000});
  return batch;
}

/// One command to one drive in a world of its own.
class Trial {
 public:
  Trial(const Case& where, Command what)
      : rig(where.subject), subject(where.subject), situation(where.situation), command(what) {
    // Long enough for each poll and keep-alive to have been seen once; a doubt would be over by then.
    rig.bring_to(situation, is_in_doubt(situation) ? 0ms : 700ms);
    was_powered = rig.powered();
    was_turning = !is_in_doubt(situation) && rig.turns();
    began_at = rig.axis()[Quantity::position_actual].value;
    stores = is_keya(subject) || subject == Subject::id286pro ? 0 : rig.stores();
  }
  void run();

 private:
  std::int64_t value(Quantity quantity) { return rig.axis()[quantity].value; }
  bool latched_now() { return rig.axis().has(AxisInput::stop_latched); }
  bool comes_to_rest() {
    return rig.stage.run_until([&] { return !rig.turns(); }, 10s);
  }
  bool completes() {
    return rig.stage.run_until([&] { return rig.axis().motion_state == MotionState::completed; }, 30s);
  }
  void code_is(const BatchResult& result, End end);
  void nothing_changed();
  void enabled_or_stopped();
  void was_reset();
  void went_there();
  void did_what_it_says();

  DriveRig rig;
  Subject subject;
  Situation situation;
  Command command;
  bool was_powered = false;
  bool was_turning = false;
  std::int64_t began_at = 0;
  std::uint64_t stores = 0;
};

void Trial::code_is(const BatchResult& result, End end) {
  const Errc code = result.outcome.code;
  switch (end) {
    case End::yes:
      EXPECT_EQ(code, Errc::ok) << text(code);
      break;
    case End::state:
      EXPECT_EQ(code, Errc::state_unsuitable) << text(code);
      EXPECT_EQ(result.outcome.detail, kDetailDeviceState);
      break;
    case End::busy:
      EXPECT_EQ(code, Errc::busy) << text(code);
      break;
    case End::refused:
      EXPECT_TRUE(code == Errc::busy || code == Errc::state_unsuitable) << text(code);
      break;
    case End::none:
      EXPECT_EQ(code, Errc::not_supported) << text(code);
      break;
    case End::away:
      EXPECT_EQ(code, Errc::offline) << text(code);
      break;
    case End::setup:
      EXPECT_EQ(code, Errc::still_in_setup) << text(code);
      break;
  }
  const bool has = (rig.axis().supported_commands >> static_cast<unsigned>(command) & 1U) != 0;
  EXPECT_EQ(has, end != End::none) << "supported_commands";
}

void Trial::nothing_changed() {
  rig.stage.run(300ms);
  EXPECT_THAT(rig.commanding(), IsEmpty());
  if (command == Command::quick_stop) {
    EXPECT_TRUE(latched_now()) << "accepted in every state";
  }
  if (situation == offline || situation == link_down) {
    EXPECT_TRUE(was_powered || !rig.powered());
    return;
  }
  EXPECT_EQ(rig.powered(), was_powered);
  EXPECT_EQ(rig.turns(), was_turning);
}

void Trial::enabled_or_stopped() {
  const bool stepper = subject == Subject::id286pro;
  switch (command) {
    case Command::enable:
      EXPECT_TRUE(rig.powered());
      EXPECT_FALSE(latched_now());
      EXPECT_EQ(rig.turns(), was_turning) << "an enable never moves the axis";
      if (was_powered && situation != latched) {
        EXPECT_THAT(rig.commanding(), IsEmpty()) << "already enabled: nothing is sent";
      }
      break;
    case Command::disable:
      EXPECT_FALSE(rig.powered());
      EXPECT_TRUE(comes_to_rest());
      EXPECT_EQ(rig.axis().axis_state == AxisState::error_stop, situation == faulted && !is_keya(subject));
      EXPECT_EQ(rig.axis().axis_state == AxisState::stopping, situation == latched);
      break;
    case Command::quick_stop:
      EXPECT_TRUE(comes_to_rest());
      EXPECT_TRUE(latched_now());
      EXPECT_TRUE(situation == faulted || rig.axis().axis_state == AxisState::stopping);
      EXPECT_TRUE(stepper || !rig.powered());
      break;
    default:
      EXPECT_TRUE(comes_to_rest());
      EXPECT_EQ(rig.powered(), was_powered && (stepper || !latched_now())) << "a halt stays enabled, and never enables";
      // Where a drive has no halt a quick stop stands for it, and says so (JD 6.4: in the velocity modes alone); and
      // where a drive that is in doubt may have restarted, which a halt could enable.
      if (was_powered && latched_now() && situation != latched) {
        const bool has_halt = is_md(subject) || situation == running || situation == halted;
        EXPECT_TRUE(is_kinco(subject) && (!has_halt || situation == suspect));
      }
      break;
  }
  rig.stage.run(2s);
  if (command != Command::enable) {
    EXPECT_FALSE(rig.turns()) << "nothing resumes";
  }
}

void Trial::was_reset() {
  EXPECT_FALSE(rig.axis().has(AxisInput::fault));
  EXPECT_EQ(rig.powered(), was_powered) << "clears, never enables";
  EXPECT_EQ(rig.turns(), was_turning);
  if (situation != faulted) {
    EXPECT_THAT(rig.commanding(), IsEmpty()) << "not faulted: nothing is sent";
  } else {
    EXPECT_EQ(rig.axis().axis_state, AxisState::disabled);
  }
}

void Trial::went_there() {
  constexpr double kWindow = 50;
  const bool relative = command == Command::move_relative;
  EXPECT_TRUE(completes()) << "motion_state " << static_cast<int>(rig.axis().motion_state) << " at " << rig.position();
  rig.stage.run(300ms);
  EXPECT_FALSE(rig.turns());
  EXPECT_NEAR(static_cast<double>(value(Quantity::position_actual)),
              static_cast<double>(relative ? began_at + 5'000 : 5'000), kWindow);
}

void Trial::did_what_it_says() {
  switch (command) {
    case Command::fault_reset:
      was_reset();
      break;
    case Command::move_absolute:
    case Command::move_relative:
      went_there();
      break;
    case Command::run_velocity:
      EXPECT_TRUE(rig.stage.run_until([&] { return std::abs(value(Quantity::velocity_actual) - 100'000) < 2'000; }));
      EXPECT_TRUE(rig.turns());
      EXPECT_EQ(rig.axis().axis_state, AxisState::continuous_motion);
      break;
    case Command::run_torque:
      EXPECT_EQ(rig.axis().axis_state, AxisState::continuous_motion);
      EXPECT_EQ(value(Quantity::mode_display), 4);
      break;
    case Command::home:
      EXPECT_EQ(rig.axis().axis_state, AxisState::homing);
      EXPECT_TRUE(rig.turns());
      break;
    case Command::set_position:
      rig.stage.run(200ms);
      EXPECT_NEAR(static_cast<double>(value(Quantity::position_actual)), 0, 20);
      EXPECT_FALSE(rig.turns()) << "the position changes, not the place";
      break;
    case Command::save_parameters:
      EXPECT_EQ(rig.stores(), stores + 1);
      break;
    default:
      enabled_or_stopped();
      break;
  }
}

void Trial::run() {
  const End end = expected(subject, situation, command);
  EXPECT_EQ(was_turning, situation == moving || situation == running || situation == homing);
  const BatchResult result = rig.ask(request(subject, command, end));
  code_is(result, end);
  if (result.outcome.code == Errc::ok) {
    did_what_it_says();
  } else if (end != yes) {
    nothing_changed();
  }
  EXPECT_TRUE(was_powered || command == Command::enable || !rig.powered()) << "nothing but enable enables";
  EXPECT_FALSE(rig.neighbour_powered());
}

class EveryCommand : public testing::TestWithParam<Case> {};

TEST_P(EveryCommand, EndsAsTheContractSays) {
  for (const Command command : kCommands) {
    SCOPED_TRACE(text(command));
    Trial(GetParam(), command).run();
  }
}

INSTANTIATE_TEST_SUITE_P(Table, EveryCommand, testing::ValuesIn(cases()), [](const auto& case_of) {
  return name(case_of.param.subject) + "_" + name(case_of.param.situation);
});

}  // namespace
}  // namespace axisgate::test
