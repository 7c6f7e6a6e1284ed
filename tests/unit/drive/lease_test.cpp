// Design 3.5 on an axis that really moves: what its motor does when whoever commands it falls silent, goes, or comes
// back.
#include <gmock/gmock.h>

#include <functional>

#include "tests/unit/drive/clients.hpp"
#include "tests/unit/drive/rig.hpp"

namespace axisgate::test {
namespace {

using namespace std::chrono_literals;
using simulated::KincoType;

RigOptions leased(LeaseAction on_expiry = LeaseAction::quick_stop, LeaseRenewal renew = LeaseRenewal::any) {
  RigOptions options;
  options.lease = LeaseRules{.on_expiry = on_expiry, .renew = renew};
  return options;
}

struct LeasedAxis {
  explicit LeasedAxis(
      const RigOptions& options = leased(), const std::function<void(Rig&)>& before = [](Rig&) {})
      : rig(KincoType::jd, options) {
    before(rig);
    rig.online();
  }

  Rig rig;
  std::shared_ptr<ClientLife> plc = client(1, "10.0.0.1");
  std::shared_ptr<ClientLife> panel = client(2, "10.0.0.2");

  Group from(const std::shared_ptr<ClientLife>& who, Group group, bool claims = true) {
    who->last_request = rig.stage.runtime().now();
    group.client = who->id;
    group.role = who->role;
    group.life = who;
    group.claims = claims;
    return group;
  }
  Errc ask(const std::shared_ptr<ClientLife>& who, Group group, bool claims = true) {
    return rig.ask(from(who, std::move(group), claims)).outcome.code;
  }
  Errc command(const std::shared_ptr<ClientLife>& who, Command command) {
    return ask(who, with_command(command), !is_stop(command) && command < Command::release);
  }
  /// Enabled and running, by this client.
  void run(const std::shared_ptr<ClientLife>& who) {
    EXPECT_EQ(command(who, Command::enable), Errc::ok);
    EXPECT_EQ(ask(who, with_command(Command::run_velocity, {{Quantity::target_velocity, 100'000}})), Errc::ok);
    EXPECT_TRUE(rig.stage.run_until([&] {
      who->last_request = rig.stage.runtime().now();
      return rig.axis().has(AxisInput::moving);
    }));
  }
  /// The client goes on asking for so long.
  void keep(const std::shared_ptr<ClientLife>& who, Duration time) {
    for (Duration done{}; done < time; done += 100ms) {
      who->last_request = rig.stage.runtime().now();
      rig.stage.run(100ms);
    }
  }
  bool latched() { return rig.axis().has(AxisInput::stop_latched); }
  bool enabled() { return rig.axis().has(AxisInput::enabled); }
  bool event(const std::string& part) { return rig.has_event(EventKind::lease, part); }
};

TEST(Lease, AMotorWhoseMasterFallsSilentIsStoppedAndLatched) {
  LeasedAxis axis;
  axis.run(axis.plc);
  axis.keep(axis.plc, 5s);
  EXPECT_TRUE(axis.rig.turns()) << "as long as its owner asks for anything";
  axis.rig.stage.run(4s);
  EXPECT_FALSE(axis.rig.turns());
  EXPECT_TRUE(axis.latched());
  EXPECT_FALSE(axis.rig.axis().lease.owner);
  EXPECT_TRUE(axis.event("the lease of 10.0.0.1 has run out: quick stop"));
}

TEST(Lease, TheStopGoesOutAtTheEndOfTheLeaseAndNotBefore) {
  LeasedAxis axis;
  axis.run(axis.plc);
  axis.plc->last_request = axis.rig.stage.runtime().now();
  axis.rig.mark();
  axis.rig.stage.run(1999ms);
  EXPECT_TRUE(axis.rig.writes().empty());
  axis.rig.stage.run(50ms);
  EXPECT_FALSE(axis.rig.writes_of(kControlword).empty());
}

TEST(Lease, HaltOnExpiryLatchesAsWellAndStaysEnabled) {
  LeasedAxis axis(leased(LeaseAction::halt));
  axis.run(axis.plc);
  axis.rig.stage.run(8s);
  EXPECT_FALSE(axis.rig.turns());
  EXPECT_TRUE(axis.enabled());
  EXPECT_TRUE(axis.latched());
  EXPECT_EQ(axis.ask(axis.plc, with_command(Command::run_velocity, {{Quantity::target_velocity, 100'000}})),
            Errc::state_unsuitable);
}

TEST(Lease, DisableOnExpiryTakesTheTorque) {
  LeasedAxis axis(leased(LeaseAction::disable));
  axis.run(axis.plc);
  axis.rig.stage.run(8s);
  EXPECT_FALSE(axis.rig.motor_enabled());
  EXPECT_TRUE(axis.latched());
}

TEST(Lease, NothingOnExpiryLeavesTheMotorRunningAndSaysSo) {
  LeasedAxis axis(leased(LeaseAction::none));
  axis.run(axis.plc);
  axis.rig.stage.run(8s);
  EXPECT_TRUE(axis.rig.turns());
  EXPECT_TRUE(axis.event("nothing is done"));
  EXPECT_FALSE(axis.rig.axis().lease.owner);
}

TEST(Lease, ADisabledAxisOnlyLosesItsOwner) {
  LeasedAxis axis;
  EXPECT_EQ(axis.ask(axis.plc, setpoints({{Quantity::profile_velocity, 500'000}})), Errc::ok);
  EXPECT_TRUE(axis.rig.axis().lease.owned_by(1));
  axis.rig.mark();
  axis.rig.stage.run(3s);
  EXPECT_FALSE(axis.rig.axis().lease.owner);
  EXPECT_FALSE(axis.latched());
  EXPECT_TRUE(axis.rig.writes().empty());
}

TEST(Lease, AnEnableThatIsUnderWayWhenItRunsOutIsStopped) {
  RigOptions options = leased();
  options.lease->timeout = 20ms;
  options.reply_delay = 15ms;
  LeasedAxis axis(options);
  const auto enable = axis.rig.stage.begin(1, axis.from(axis.plc, with_command(Command::enable)));
  axis.rig.stage.run(2s);
  EXPECT_TRUE(enable->has_value());
  EXPECT_FALSE(axis.rig.motor_enabled()) << "nobody owns it";
  EXPECT_TRUE(axis.latched());
}

TEST(Lease, AnotherClientIsRefusedButMayAlwaysStop) {
  LeasedAxis axis;
  axis.run(axis.plc);
  axis.rig.mark();
  EXPECT_EQ(axis.ask(axis.panel, setpoints({{Quantity::target_velocity, 5'000}})), Errc::not_owner);
  EXPECT_EQ(axis.command(axis.panel, Command::enable), Errc::not_owner);
  EXPECT_EQ(axis.command(axis.panel, Command::fault_reset), Errc::not_owner);
  EXPECT_TRUE(axis.rig.writes().empty());
  EXPECT_EQ(axis.command(axis.panel, Command::quick_stop), Errc::ok);
  EXPECT_TRUE(axis.rig.axis().lease.owned_by(1)) << "a stop does not move the lease";
  EXPECT_FALSE(axis.rig.turns());
}

TEST(Lease, WhatAStopHasDroppedUnsentItsOwnerAsksForAnew) {
  LeasedAxis axis;
  const auto enable = axis.rig.stage.begin(1, axis.from(axis.plc, with_command(Command::enable)));
  ASSERT_TRUE(axis.rig.stage.run_until([&] { return !axis.rig.writes().empty(); }));
  const auto target = axis.rig.stage.begin(1, axis.from(axis.plc, setpoints({{Quantity::target_position, 77}})));
  EXPECT_FALSE(axis.rig.stage.gateway().owner_asks(1, 1, Quantity::target_position, 77)) << "it waits";
  EXPECT_EQ(axis.command(axis.panel, Command::disable), Errc::ok);
  EXPECT_EQ((*target)->outcome.code, Errc::dropped_by_stop);
  EXPECT_TRUE(axis.rig.stage.gateway().owner_asks(1, 1, Quantity::target_position, 77));
}

TEST(Lease, AStopOfAnotherClientIsCarriedOutAndWhatStandsBesideItRefused) {
  LeasedAxis axis;
  axis.run(axis.plc);
  EXPECT_EQ(axis.ask(axis.panel, with_command(Command::quick_stop, {{Quantity::target_velocity, 5'000}})),
            Errc::not_owner);
  EXPECT_TRUE(axis.latched());
  EXPECT_TRUE(axis.rig.axis().lease.owned_by(1));
}

TEST(Lease, APlcThatComesBackAfterItsConnectionEndedGoesOnWithoutAStop) {
  LeasedAxis axis;
  axis.run(axis.plc);
  axis.plc->connected = false;
  axis.rig.stage.gateway().client_gone(1);
  axis.rig.stage.run(1500ms);
  const auto back = client(9, "10.0.0.1");
  EXPECT_EQ(axis.ask(axis.panel, setpoints({{Quantity::target_velocity, 5'000}})), Errc::not_owner);
  EXPECT_EQ(axis.ask(back, setpoints({{Quantity::target_velocity, 120'000}})), Errc::ok);
  axis.keep(back, 3s);
  EXPECT_TRUE(axis.rig.turns());
  EXPECT_FALSE(axis.latched());
  EXPECT_TRUE(axis.event("its connection had ended"));
}

TEST(Lease, APlcThatComesBackTooLateFindsTheMotorStoppedAndMustEnableAnew) {
  LeasedAxis axis;
  axis.run(axis.plc);
  axis.plc->connected = false;
  axis.rig.stage.run(5s);
  const auto back = client(9, "10.0.0.1");
  EXPECT_EQ(axis.ask(back, setpoints({{Quantity::target_velocity, 120'000}})), Errc::ok) << "kept, not sent";
  axis.keep(back, 1s);
  EXPECT_FALSE(axis.rig.turns());
  EXPECT_EQ(axis.command(back, Command::run_velocity), Errc::state_unsuitable);
}

TEST(Lease, APlcInStopWhoseScannerGoesOnIsDeadWhereHeartbeatsRenew) {
  LeasedAxis axis(leased(LeaseAction::quick_stop, LeaseRenewal::heartbeat));
  Group beat;
  beat.beats = true;
  EXPECT_EQ(axis.command(axis.plc, Command::enable), Errc::ok);
  EXPECT_EQ(axis.ask(axis.plc, with_command(Command::run_velocity, {{Quantity::target_velocity, 100'000}})), Errc::ok);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(axis.ask(axis.plc, beat), Errc::ok);
    axis.rig.stage.run(200ms);
  }
  EXPECT_TRUE(axis.rig.turns());
  for (int i = 0; i < 40; ++i) {
    static_cast<void>(axis.ask(axis.plc, Group{}));
    axis.rig.stage.run(200ms);
  }
  EXPECT_FALSE(axis.rig.turns());
}

TEST(Lease, AReleasedRunningAxisIsStoppedUnlessSomebodyTakesIt) {
  LeasedAxis axis;
  axis.run(axis.plc);
  EXPECT_EQ(axis.command(axis.plc, Command::release), Errc::ok);
  EXPECT_FALSE(axis.rig.axis().lease.owner);
  axis.rig.stage.run(1s);
  EXPECT_TRUE(axis.rig.turns());
  axis.rig.stage.run(4s);
  EXPECT_FALSE(axis.rig.turns());
}

TEST(Lease, ReleaseHandsARunningAxisOverWithoutAStop) {
  LeasedAxis axis;
  axis.run(axis.plc);
  EXPECT_EQ(axis.command(axis.panel, Command::release), Errc::not_owner);
  EXPECT_EQ(axis.command(axis.plc, Command::release), Errc::ok);
  EXPECT_EQ(axis.ask(axis.panel, setpoints({{Quantity::target_velocity, 50'000}})), Errc::ok);
  axis.keep(axis.panel, 4s);
  EXPECT_TRUE(axis.rig.turns());
  EXPECT_EQ(axis.command(axis.plc, Command::enable), Errc::not_owner);
}

TEST(Lease, TakeOverFromALowerRankHaltsFirst) {
  LeasedAxis axis;
  axis.run(axis.plc);
  EXPECT_EQ(axis.command(axis.panel, Command::take_over), Errc::not_owner) << "equal ranks";
  EXPECT_TRUE(axis.rig.turns());
  axis.panel->rank = 3;
  EXPECT_EQ(axis.command(axis.panel, Command::take_over), Errc::ok);
  EXPECT_TRUE(axis.rig.axis().lease.owned_by(2));
  axis.keep(axis.panel, 2s);
  EXPECT_FALSE(axis.rig.turns());
  EXPECT_FALSE(axis.latched()) << "a halt, no quick stop";
  EXPECT_EQ(axis.ask(axis.plc, setpoints({{Quantity::target_velocity, 5'000}})), Errc::not_owner);
  EXPECT_TRUE(axis.event("taken the axis over"));
}

TEST(Lease, AnAxisFoundEnabledIsStoppedUnlessAClientWritesToIt) {
  for (const bool taken : {false, true}) {
    LeasedAxis axis(leased(), [](Rig& rig) { rig.motor().poke({0x6040, 0}, 0x0F); });
    ASSERT_TRUE(axis.enabled());
    EXPECT_TRUE(axis.event("found enabled, and nobody owns it"));
    axis.rig.mark();
    if (taken) {
      EXPECT_EQ(axis.ask(axis.panel, Group{}), Errc::ok);
      axis.keep(axis.panel, 4s);
      EXPECT_TRUE(axis.rig.writes().empty());
      EXPECT_TRUE(axis.enabled());
    } else {
      axis.rig.stage.run(4s);
      EXPECT_TRUE(axis.latched());
      EXPECT_TRUE(axis.event("nobody has taken over the enabled axis: quick stop"));
    }
  }
}

TEST(Lease, AnOwnersSixInABlockIsAStop) {
  LeasedAxis axis;
  axis.run(axis.plc);
  Group block = setpoints({{Quantity::target_velocity, 100'000}});
  block.controlword = 0x0006;
  EXPECT_EQ(axis.ask(axis.panel, block), Errc::not_owner);
  EXPECT_TRUE(axis.rig.turns());
  EXPECT_EQ(axis.ask(axis.plc, block), Errc::ok);
  axis.keep(axis.plc, 2s);
  EXPECT_FALSE(axis.rig.turns());
}

// --- Jog
// ---------------------------------------------------------------------------------------------------------------

struct JoggedAxis : LeasedAxis {
  explicit JoggedAxis(const RigOptions& options = leased()) : LeasedAxis(options) {
    EXPECT_EQ(command(plc, Command::enable), Errc::ok);
    Group speed;
    speed.jog_velocity = 60'000;
    EXPECT_EQ(ask(plc, speed), Errc::ok);
  }
  void hold(Command direction, Duration time) {
    for (Duration done{}; done < time; done += 100ms) {
      Group again;
      again.jog_again = direction;
      // not_new: the jog has ended meanwhile, and the button is held in vain.
      EXPECT_THAT(ask(plc, again), testing::AnyOf(Errc::ok, Errc::not_new));
      rig.stage.run(100ms);
    }
  }
  std::int64_t speed() { return rig.axis()[Quantity::velocity_actual].value; }
};

TEST(JogOnAnAxis, RunsWhileTheButtonIsHeldAndEndsWhenItIsLetGo) {
  JoggedAxis axis;
  EXPECT_EQ(axis.command(axis.plc, Command::jog_reverse), Errc::ok);
  axis.hold(Command::jog_reverse, 2s);
  EXPECT_NEAR(static_cast<double>(axis.speed()), -60'000, 2'000);
  EXPECT_EQ(axis.rig.axis().level_coils >> 8 & 3U, 2U);
  EXPECT_EQ(axis.ask(axis.plc, with_command(Command::jog_end), false), Errc::ok);
  axis.keep(axis.plc, 2s);
  EXPECT_FALSE(axis.rig.turns());
  EXPECT_TRUE(axis.enabled());
  EXPECT_FALSE(axis.latched());
  EXPECT_EQ(axis.rig.axis().level_coils >> 8 & 3U, 0U);
}

TEST(JogOnAnAxis, EndsWhenTheReleaseIsLostThoughItsOwnerLives) {
  JoggedAxis axis;
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
  axis.hold(Command::jog_forward, 1s);
  EXPECT_TRUE(axis.rig.turns());
  axis.keep(axis.plc, 3s);  // reads go on; nobody writes the coil
  EXPECT_FALSE(axis.rig.turns());
  axis.hold(Command::jog_forward, 1s);
  EXPECT_FALSE(axis.rig.turns()) << "a button that is still held starts nothing";
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
  axis.hold(Command::jog_forward, 500ms);
  EXPECT_TRUE(axis.rig.turns());
}

TEST(JogOnAnAxis, NeedsAVelocity) {
  LeasedAxis axis;
  EXPECT_EQ(axis.command(axis.plc, Command::enable), Errc::ok);
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::bad_value);
}

TEST(JogOnAnAxis, AStopIsCarriedOutWhateverJogVelocityStandsBesideIt) {
  JoggedAxis axis;
  Group stop = with_command(Command::quick_stop);
  stop.jog_velocity = 4'000'000'000;
  EXPECT_EQ(axis.ask(axis.plc, stop), Errc::bad_value);
  EXPECT_TRUE(axis.latched());
  stop.jog_velocity = 5'000;
  EXPECT_EQ(axis.ask(axis.panel, stop), Errc::not_owner);
  EXPECT_EQ(axis.rig.axis().jog_velocity, 60'000U) << "what is refused is not kept";
}

TEST(JogOnAnAxis, AnotherClientsStopEndsItForGood) {
  JoggedAxis axis;
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
  axis.hold(Command::jog_forward, 1s);
  EXPECT_EQ(axis.command(axis.panel, Command::halt), Errc::ok);
  axis.hold(Command::jog_forward, 2s);
  EXPECT_FALSE(axis.rig.turns());
}

TEST(JogOnAnAxis, EndsAtThePositionLimitOfAHomedAxis) {
  for (const bool of_the_drive : {false, true}) {
    RigOptions options = leased();
    if (!of_the_drive) options.axis.position_limits = Range{-30'000, 30'000};
    options.axis.homing_method = 35;
    JoggedAxis axis(options);
    const Group limits = setpoints({{Quantity::position_limit_min, -30'000}, {Quantity::position_limit_max, 30'000}});
    EXPECT_EQ(axis.ask(axis.plc, of_the_drive ? limits : Group{}), Errc::ok);
    EXPECT_EQ(axis.command(axis.plc, Command::home), Errc::ok);
    ASSERT_TRUE(axis.rig.stage.run_until([&] {
      axis.plc->last_request = axis.rig.stage.runtime().now();
      return axis.rig.axis().has(AxisInput::homed);
    }));
    EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
    axis.hold(Command::jog_forward, 10s);
    EXPECT_FALSE(axis.rig.turns());
    const std::int64_t end = axis.rig.axis()[Quantity::position_actual].value;
    EXPECT_LE(end, 30'000);
    EXPECT_GT(end, 20'000);
    EXPECT_TRUE(axis.rig.has_event(EventKind::warning, "halted at the position limit"));
    EXPECT_EQ(axis.ask(axis.plc, with_command(Command::move_absolute, {{Quantity::target_position, 30'000}})),
              Errc::ok);
    axis.keep(axis.plc, 4s);
    EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::state_unsuitable) << "it stands at the limit";
    EXPECT_EQ(axis.command(axis.plc, Command::jog_reverse), Errc::ok);
    axis.hold(Command::jog_reverse, 1s);
    EXPECT_LT(axis.speed(), 0) << "back is open";
  }
}

TEST(JogOnAnAxis, TheButtonOfAnotherClientDoesNotEndIt) {
  JoggedAxis axis;
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
  axis.hold(Command::jog_forward, 1s);
  EXPECT_EQ(axis.ask(axis.panel, with_command(Command::jog_end), false), Errc::ok);
  axis.hold(Command::jog_forward, 1s);
  EXPECT_TRUE(axis.rig.turns());
}

TEST(JogOnAnAxis, OfARunThatAFaultHasEndedIsOverAndTheHeldButtonIsToldSo) {
  JoggedAxis axis;
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
  axis.hold(Command::jog_forward, 1s);
  axis.rig.motor().inject_fault(1, 0x0020);
  axis.hold(Command::jog_forward, 400ms);
  axis.rig.motor().clear_fault_cause(1, 0x0020);
  EXPECT_EQ(axis.command(axis.plc, Command::fault_reset), Errc::ok);
  EXPECT_EQ(axis.command(axis.plc, Command::enable), Errc::ok);
  EXPECT_EQ(axis.rig.axis().level_coils >> 8 & 3U, 0U);
  Group again;
  again.jog_again = Command::jog_forward;
  EXPECT_EQ(axis.ask(axis.plc, again), Errc::not_new);
}

TEST(JogOnAnAxis, IsHaltedWhenItsOwnerReleasesTheAxis) {
  RigOptions options = leased();
  options.axis.jog_timeout = 60s;
  JoggedAxis axis(options);
  EXPECT_EQ(axis.command(axis.plc, Command::jog_forward), Errc::ok);
  axis.hold(Command::jog_forward, 1s);
  EXPECT_EQ(axis.command(axis.plc, Command::release), Errc::ok);
  axis.rig.stage.run(1500ms);
  EXPECT_FALSE(axis.rig.turns()) << "before anybody's lease has run out";
  EXPECT_FALSE(axis.latched());
}

}  // namespace
}  // namespace axisgate::test
