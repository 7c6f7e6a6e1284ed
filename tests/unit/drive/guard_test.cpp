// SPDX-License-Identifier: Apache-2.0
// The guard of an axis alone: every short sequence of what may happen to it, and what must always hold; then the words
// in which it says why.
#include "gateway/drive/guard/guard.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "tests/unit/drive/alone.hpp"
#include "tests/unit/drive/clients.hpp"

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;

/// An axis that turns, as its guard sees it: it obeys no stop until it is said so.
class World {
 public:
  explicit World(LeaseAction on_expiry = LeaseAction::quick_stop) {
    rules_.on_expiry = on_expiry;
    guard_.emplace(lease_, rules_, jog_);
    guard_->ownership().set_armed(true);
  }

  Guard& guard() { return *guard_; }
  [[nodiscard]] bool owned() const { return lease_.owner != nullptr; }
  [[nodiscard]] Instant now() const { return now_; }
  [[nodiscard]] bool away() const { return away_; }
  void pass(Duration time) { now_ += time; }

  void owner_writes() {
    static_cast<void>(guard_->ownership().take(me_, now_));
    guard_->ownership().wrote(me_, true, true, now_);
  }
  void press() {
    owner_writes();
    guard_->jog().start(Command::jog_forward, me_->id, now_, 500ms, ++point_);
  }
  void hold() {
    owner_writes();
    static_cast<void>(guard_->jog().again(Command::jog_forward, me_->id, now_));
  }
  void read(model::State402 state) {
    ++exchange_;
    guard_->shows(state, exchange_, false, seen());
  }
  void lose() {
    away_ = true;
    guard_->lost(now_, exchange_);
  }
  void come_back() {
    away_ = false;
    read(model::State402::operation_enabled);
  }
  /// The drive shows the stop that was sent last.
  void obey() {
    if (!last_ || away_) return;
    ++exchange_;
    guard_->discharged(guard_->owed().attempted(*last_, true, exchange_, now_));
  }

  /// All that is due now; what is sent is accepted and sent, as its axis does.
  std::vector<OwnStop> settle() {
    std::vector<OwnStop> sent;
    for (std::size_t looks = 0; auto stop = guard_->due(seen()); ++looks) {
      EXPECT_LT(looks, 2 * Guard::kMostDue) << "it does not come to an end";
      if (looks >= 2 * Guard::kMostDue) break;
      said_ += stop->why + "\n";
      if (stop->command == Command::none) continue;
      const StopKind kind = kind_of(stop->command);
      guard_->jog().end();
      if (!stop->again) guard_->owed().accepted(kind, exchange_);
      if (!away_) {
        guard_->owed().sending();
        if (stop->again) guard_->discharged(guard_->owed().attempted(kind, false, exchange_, now_));
      }
      last_ = kind;
      sent.push_back(*stop);
    }
    return sent;
  }
  [[nodiscard]] const std::string& said() const { return said_; }

  [[nodiscard]] Guard::Seen seen() const {
    return {.now = now_, .exchange = exchange_, .state = AxisState::continuous_motion, .torque = true, .runs = true};
  }

 private:
  static StopKind kind_of(Command command) {
    if (command == Command::halt) return StopKind::halt;
    return command == Command::quick_stop ? StopKind::quick_stop : StopKind::disable;
  }
  Lease lease_;
  LeaseRules rules_;
  Jog jog_;
  std::optional<Guard> guard_;
  std::shared_ptr<ClientLife> me_ = test::client(7, "192.168.1.7:4711");
  Instant now_ = kStart;
  std::uint64_t exchange_ = 1;
  AxisRecord::Point point_ = 0;
  bool away_ = false;
  std::optional<StopKind> last_{};
  std::string said_;
};

// O the owner writes, J presses a jog's button, B holds it; t 0.6 s pass, L 2.1 s; H a homing runs out of time, W the
// watch asks for a quick stop, D for a disable; E it is read enabled, X disabled; S the drive shows the stop; G it is
// gone, R back.
constexpr std::string_view kHappenings = "OJBtLHWDEXSGR";

void happens(World& world, char event) {
  switch (event) {
    case 'O':
      return world.owner_writes();
    case 'J':
      return world.press();
    case 'B':
      return world.hold();
    case 't':
      return world.pass(600ms);
    case 'L':
      return world.pass(2100ms);
    case 'H':
      return world.guard().homing_timed_out();
    case 'W':
      return world.guard().asks(Command::quick_stop);
    case 'D':
      return world.guard().asks(Command::disable);
    case 'E':
      return world.away() ? void() : world.read(model::State402::operation_enabled);
    case 'X':
      return world.away() ? void() : world.read(model::State402::switched_on);
    case 'S':
      return world.obey();
    case 'G':
      return world.lose();
    default:
      return world.come_back();
  }
}

/// Empty: what must hold after this event does.
std::string broken(World& world, char event) {
  const bool owned = world.owned();
  const Instant lease_until = world.guard().ownership().until();
  const bool jogged = world.guard().jog().active();
  const Instant jog_until = world.guard().jog().until();
  happens(world, event);
  const bool jog_late = jogged && event != 'B' && event != 'J' && world.now() >= jog_until;
  const bool lease_late = owned && world.now() >= lease_until && world.guard().ownership().until() == lease_until;
  const bool was_owed = world.guard().owed().owed();
  const auto sent = world.settle();
  std::size_t brakes = 0, again = 0, disables = 0;
  bool quick = false;
  for (const OwnStop& stop : sent) {
    brakes += stop.command != Command::disable && !stop.again ? 1 : 0;
    disables += stop.command == Command::disable && !stop.again ? 1 : 0;
    again += stop.again ? 1 : 0;
    quick = quick || stop.command == Command::quick_stop;
  }
  if (brakes > 1) return "two stops where the stronger one is both";
  if (again > 0 && world.away()) return "a stop is sent to a drive that is gone";
  if (again > 1) return "what is owed is sent twice at once";
  if (again > 0 && !was_owed) return "nothing is owed, and it is sent again";
  if (lease_late && !quick) return "its lease has run out, and no quick stop is sent";
  if (jog_late && brakes == 0) return "its button was not held, and no stop is sent";
  if (event == 'H' && brakes == 0) return "a homing out of time is not halted";
  if (event == 'W' && !quick) return "what the watch asks for is not sent";
  const bool asked = jog_late || lease_late || event == 'H' || event == 'W';
  if (brakes > 0 && !asked) return "a stop that nothing asks for";
  if (world.guard().jog().active() && world.now() >= world.guard().jog().until()) return "a jog without its button";
  if (sent.empty() && (event == 'G' || event == 'R') && was_owed && !world.guard().owed().owed())
    return "a loss ends what is owed";
  return {};
}

void play(const std::string& sequence, std::size_t length) {
  World world;
  for (const char event : sequence) {
    const std::string what = broken(world, event);
    ASSERT_EQ(what, "") << sequence << "\n" << world.said();
  }
  if (sequence.size() == length) return;
  for (const char event : kHappenings) {
    play(sequence + event, length);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(Guard, EveryShortSequence) { play("", 4); }

TEST(Guard, ADisableFollowsTheStopThatIsDueWithIt) {
  World world;
  world.guard().asks(Command::disable);
  world.guard().homing_timed_out();
  auto sent = world.settle();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].command, Command::halt);
  world.obey();
  sent = world.settle();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].command, Command::disable);
}

TEST(Guard, ADisableDoesNotWaitForAStopThatIsNotObeyed) {
  World world;
  world.guard().asks(Command::disable);
  world.guard().homing_timed_out();
  static_cast<void>(world.settle());
  EXPECT_EQ(world.guard().next_deadline(world.now()), world.now() + Guard::kStopFirst);
  world.pass(Guard::kStopFirst);
  const auto sent = world.settle();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].command, Command::disable);
}

TEST(Guard, OfTwoStopsTheStrongerIsSentAndBothAreSaid) {
  World world;
  world.press();
  world.pass(2100ms);
  const auto sent = world.settle();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].command, Command::quick_stop);
  EXPECT_TRUE(sent[0].latches);
  EXPECT_NE(world.said().find("the lease of 192.168.1.7:4711 has run out: quick stop"), std::string::npos);
  EXPECT_NE(world.said().find("jog: its coil was not written 1 again in time"), std::string::npos);
}

TEST(Guard, NobodyIsNeededWhereOnExpiryIsNone) {
  World world(LeaseAction::none);
  world.owner_writes();
  world.pass(2100ms);
  EXPECT_TRUE(world.settle().empty());
  EXPECT_NE(world.said().find("nothing is done (on_expiry none)"), std::string::npos);
}

}  // namespace
}  // namespace axisgate::drive
