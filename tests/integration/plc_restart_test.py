# SPDX-License-Identifier: Apache-2.0
"""What a program meets that is stopped, started, loses its power, its cable or its gateway: nothing starts by that, and what it asks for
afterwards is done."""
import signal

from plc_stage import TURN, PlcStory, main

FAR = 5000.0 * TURN
SPEED = 5.0 * TURN
RUNS, MOVES = 1, 2  # axes: one runs at a velocity, one is on its way to a far position
SOME_CYCLES = 20
LEASE_REMAINING = 29  # register


class Interrupted(PlcStory):
    lines_of = ("serial", "stepper")

    def setUp(self):
        super().setUp()
        self.begin()
        self.first = self.plc()

    def set_out(self):
        """Both are on their way."""
        plc = self.first
        plc.enable()
        plc.begin(RUNS, "MoveVelocity", Velocity=SPEED)
        plc.begin(MOVES, "MoveAbsolute", Position=FAR, Velocity=SPEED)
        self.until("both are active", lambda: plc[RUNS].MoveVelocity.Active and plc[MOVES].MoveAbsolute.Active)
        self.until_motor_turns(RUNS, MOVES)

    def until_told_and_ready(self):
        plc = self.first
        self.until("both are told", lambda: not plc[RUNS].MoveVelocity.Busy and not plc[MOVES].MoveAbsolute.Busy)
        self.until("the gateway answers for both", lambda: all(plc[number].Axis.Ready for number in (RUNS, MOVES)))

    def assert_nothing_starts(self):
        """In cycles of a program that is ready and asks for nothing."""
        self.until("each PLC is ready", lambda: all(s.Axis.Ready for plc in self.plcs for s in plc.stations.values()))
        self.assert_stays(RUNS, MOVES, cycles=SOME_CYCLES)

    def assert_it_goes_on(self, plc):
        """A reset, and each does what it is asked for."""
        for number in (RUNS, MOVES):
            station = plc[number]
            for block in (station.MoveVelocity, station.MoveAbsolute, station.Stop):
                block.Execute = False
            self.go_on()
            plc.do(number, "Reset")
            if not station.Power.Enable:
                plc.enable(number)
            self.until("it is enabled", lambda station=station: station.Power.Status and not station.Power.Error)
        self.assert_nothing_starts()
        for number in (RUNS, MOVES):
            place = plc[number].Axis.Position + TURN
            plc.do(number, "MoveAbsolute", Position=place, Velocity=SPEED)
            self.until("it is there", lambda number=number, place=place: abs(plc[number].Axis.Position - place) <= 20)
            self.until_motor_stands(number)


class ProgramStopped(Interrupted):
    """The heartbeat ends with the program, and the scanner goes on with its last block."""

    lease = {"timeout_ms": 6000, "renew": "heartbeat"}

    def test_its_motors_stop_and_its_start_starts_nothing(self):
        self.set_out()
        self.until_renewed(RUNS)
        self.first.stop()
        self.until_motor_stands(RUNS, MOVES)
        self.first.running = True
        self.until("both have been told", lambda: self.first[RUNS].MoveVelocity.CommandAborted
                   and self.first[MOVES].MoveAbsolute.CommandAborted)
        for number in (RUNS, MOVES):
            power = self.first[number].Power
            self.until("the power is gone", lambda power=power: power.Error)
            self.assertEqual(power.ErrorID, 0x208)
        self.assert_nothing_starts()
        self.assert_it_goes_on(self.first)

    def until_renewed(self, number):
        """The time that is left of the lease grows again once the program goes on."""
        plc = self.first
        plc.stop()
        self.cycles(5)
        left = plc[number].Axis.In[LEASE_REMAINING]
        plc.running = True
        self.until("the program's signs of life renew the lease", lambda: plc[number].Axis.In[LEASE_REMAINING] > left)

    def test_a_start_with_new_variables_starts_nothing(self):
        self.set_out()
        self.first.stop()
        self.until_motor_stands(RUNS, MOVES)
        self.first.without_power()
        second = self.plc()
        self.assert_nothing_starts()
        self.assert_it_goes_on(second)


class PowerLost(Interrupted):
    lease = {"timeout_ms": 6000}

    def start_again(self, retained):
        """Its scanner is there before its program is."""
        plc = self.plc(retained=retained)
        plc.running = False
        self.cycles(2)
        plc.running = True
        return plc

    def test_its_motors_stop_and_retained_variables_start_nothing(self):
        self.set_out()
        retained = self.first.without_power()
        self.until_motor_stands(RUNS, MOVES)
        second = self.start_again(retained)
        self.until("both have been told", lambda: not second[RUNS].MoveVelocity.Busy and not second[MOVES].MoveAbsolute.Busy)
        self.assert_nothing_starts()
        self.assert_it_goes_on(second)

    def test_a_command_that_was_retained_unsent_is_not_sent_later(self):
        plc = self.first
        plc.enable()
        plc.silence()
        for number in (RUNS, MOVES):
            plc[number].MoveAbsolute.Position, plc[number].MoveAbsolute.Execute = FAR, True
        self.go_on()
        self.go_on()
        second = self.start_again(plc.without_power())
        self.until("both have failed", lambda: all(second[number].MoveAbsolute.Error for number in (RUNS, MOVES)))
        self.assert_nothing_starts()
        self.assert_it_goes_on(second)

    def test_a_command_written_in_the_last_cycle_is_not_sent_later(self):
        """It is in the image, and the scanner did not come to send it."""
        plc = self.first
        plc.enable()
        plc.begin(RUNS, "MoveAbsolute", Position=FAR)
        self.assertNotEqual(plc[RUNS].Axis.PendingId, 0)
        second = self.start_again(plc.without_power())
        self.until("it has failed", lambda: second[RUNS].MoveAbsolute.Error)
        self.assertEqual(second[RUNS].MoveAbsolute.ErrorID, 0x201)
        self.assert_nothing_starts()
        self.assert_it_goes_on(second)


class CounterAtItsEnd(Interrupted):
    def test_ids_go_on_from_1(self):
        plc = self.first
        plc.enable()
        ids = []
        for number in (RUNS, MOVES):
            plc[number].Axis.LastId = 65532
        self.go_on()
        self.until("both are ready", lambda: all(plc[number].Axis.Ready for number in (RUNS, MOVES)))
        for turns in (1.0, 2.0, 1.0, 3.0, 0.0):
            for number in (RUNS, MOVES):
                plc.do(number, "MoveAbsolute", Position=turns * TURN, Velocity=SPEED)
                self.until("it is there", lambda number=number, turns=turns: abs(plc[number].Axis.Position - turns * TURN) <= 20)
            ids.append(plc[RUNS].Axis.LastId)
        self.assertEqual(ids, [65534, 65535, 1, 2, 3])


class NetworkCable(Interrupted):
    """Between PLC and gateway. The lease is long: motors go on."""

    def test_a_short_absence_ends_nothing(self):
        plc = self.first
        self.set_out()
        for station in plc.stations.values():
            station.Axis.LossTimeout = 60000
        plc.silence()
        self.cycles(SOME_CYCLES)
        self.assertTrue(plc[RUNS].MoveVelocity.Active and plc[MOVES].MoveAbsolute.Active)
        plc.plug()
        self.until("both are ready", lambda: all(plc[number].Axis.Ready for number in (RUNS, MOVES)))
        self.cycles(SOME_CYCLES)
        self.assertTrue(plc[RUNS].MoveVelocity.InVelocity and plc[MOVES].MoveAbsolute.Active)
        for number in (RUNS, MOVES):
            self.assert_turns_on(number)
            plc.do(number, "Stop")
            self.until_motor_stands(number)

    def test_a_long_absence_is_an_error_and_a_stop_waits_for_the_cable(self):
        plc = self.first
        self.set_out()
        plc.silence()
        self.until("both have failed", lambda: plc[RUNS].MoveVelocity.Error and plc[MOVES].MoveAbsolute.Error)
        self.assertEqual({plc[RUNS].MoveVelocity.ErrorID, plc[MOVES].MoveAbsolute.ErrorID}, {0x200})
        for number in (RUNS, MOVES):
            self.assertFalse(plc[number].ReadStatus.Valid)
            self.assertTrue(plc[number].Power.Error)
            plc.begin(number, "Stop")
        self.cycles(SOME_CYCLES)
        for number in (RUNS, MOVES):
            self.assertTrue(plc[number].Stop.Busy, "a stop is never given up")
            self.assert_turns_on(number)
        plc.plug()
        self.until("both have stopped", lambda: plc[RUNS].Stop.Done and plc[MOVES].Stop.Done)
        self.until_motor_stands(RUNS, MOVES)
        self.assert_it_goes_on(plc)

    def test_a_stop_that_was_on_its_way_is_asked_for_again(self):
        plc = self.first
        self.set_out()
        for number in (RUNS, MOVES):
            plc[number].Stop.Execute = True
        self.go_on()
        plc.silence()
        self.cycles(SOME_CYCLES)
        self.assertTrue(plc[RUNS].Stop.Busy and plc[MOVES].Stop.Busy)
        plc.plug()
        self.until("both have stopped", lambda: plc[RUNS].Stop.Done and plc[MOVES].Stop.Done)
        self.until_motor_stands(RUNS, MOVES)

    def test_what_was_asked_for_meanwhile_is_refused_and_never_done(self):
        plc = self.first
        plc.enable()
        plc.silence()
        self.until("it is noticed", lambda: not plc[RUNS].Axis.Online and not plc[MOVES].Axis.Online)
        for number in (RUNS, MOVES):
            move = plc.begin(number, "MoveAbsolute", Position=FAR)
            self.assertEqual((move.Error, move.ErrorID), (True, 0x200))
        plc.plug()
        self.assert_nothing_starts()
        for number in (RUNS, MOVES):
            self.assertTrue(plc[number].Power.Status, "it is still enabled")
        self.assert_it_goes_on(plc)


class OneConnectionIsOneClient(Interrupted):
    """As the listener has it by default: who connects again must wait until the lease of the silent connection is over."""

    lease = {"timeout_ms": 6000}
    listener_options = {"writes": "posted"}

    def test_motors_stop_and_then_the_plc_may_go_on(self):
        plc = self.first
        self.set_out()
        plc.silence()
        plc.plug()
        self.until("both have been told", lambda: plc[RUNS].MoveVelocity.CommandAborted and plc[MOVES].MoveAbsolute.CommandAborted)
        self.until_motor_stands(RUNS, MOVES)
        self.until("nobody owns them", lambda: plc[RUNS].Axis.Owner == 0 and plc[MOVES].Axis.Owner == 0)
        self.assert_nothing_starts()
        self.assert_it_goes_on(plc)


class GatewayStarted(Interrupted):
    def restart(self, signal_number):
        self.gateway.send(signal_number)
        self.gateway.ended()
        self.run_gateway()

    def test_anew_while_motors_turn(self):
        for number in (signal.SIGTERM, signal.SIGKILL):
            self.set_out()
            self.restart(number)
            self.until_told_and_ready()
            for axis in (RUNS, MOVES):
                self.first.do(axis, "Stop")
            self.until_motor_stands(RUNS, MOVES)
            self.assert_it_goes_on(self.first)

    def test_anew_while_all_stands(self):
        plc = self.first
        plc.enable()
        plc.disable()
        self.restart(signal.SIGTERM)
        self.go_on()
        self.assertFalse(plc[RUNS].Axis.Ready, "it has noticed")
        self.assert_nothing_starts()
        self.assert_it_goes_on(plc)


class GatewayMissed(Interrupted):
    """By drives that watch for it."""

    lines_of = ("kincocan", "leadshine")

    def test_and_started_anew(self):
        self.set_out()
        self.gateway.send(signal.SIGKILL)
        self.gateway.ended()
        self.until_motor_stands(RUNS, MOVES)
        self.run_gateway()
        self.until_told_and_ready()
        # A reset before that is refused: result 6.
        self.until("the gateway sees both drives", lambda: all(self.first[number].ReadStatus.Valid for number in (RUNS, MOVES)))
        self.assert_nothing_starts()
        self.assert_it_goes_on(self.first)


if __name__ == "__main__":
    main()
