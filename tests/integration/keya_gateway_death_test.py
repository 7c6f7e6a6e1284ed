# SPDX-License-Identifier: Apache-2.0
"""The gateway is killed or hangs while both motors of a Keya run. By RS232, CAN and CANopen the drive stops by itself; by RS485 it goes
on, as far as its manual says, and the axes had an alarm that told so."""
import signal

from keya_stage import (ALARM_NO_COMM_WATCHDOG, CANOPEN, KEYA_CAN, MANY_KEEP_ALIVES, RS232, RS485, SPEED, TURN, KeyaStory,
                        main, on)
from modbus import CONTINUOUS, DISABLED, FAILED, ONLINE
from processes import until

COMMUNICATION = 0x8130
LEASE_MS = 1500
ROUNDS = 6


class GatewayDies(KeyaStory):
    def run_in(self, interface):
        self.begin(interface)
        self.run_both()
        watched = 0 if interface.loss else ALARM_NO_COMM_WATCHDOG
        for axis in self.seen:
            self.assertEqual(axis.get("axis_alarms") & ALARM_NO_COMM_WATCHDOG, watched)
        until("both are at their speed", lambda: self.speeds() == [SPEED, SPEED])
        self.assertEqual(self.trips(), 0)

    def stand_still(self):
        if self.interface.loss:
            # Right behind a keep-alive: none is on its way out that would be sent when the gateway goes on.
            sent = self.commands()
            until("a keep-alive", lambda: self.commands() > sent)
        self.gateway.send(signal.SIGSTOP)
        self.addCleanup(self.gateway.send, signal.SIGCONT)


class Killed(GatewayDies):
    @on(RS232, KEYA_CAN, CANOPEN)
    def test_the_drive_stops_by_itself_and_nothing_starts_it_again(self, interface):
        self.run_in(interface)
        self.kill_the_gateway()
        self.assert_stopped_by_its_watchdog()
        where, commands = self.positions(), self.commands()
        self.start_another_gateway()
        for axis in self.seen:
            axis.until(link_state=ONLINE, axis_state=DISABLED, error_code=COMMUNICATION)
        self.assert_nothing_is_enabled_by_itself(where)
        self.assertEqual(self.commands(), commands)
        self.assert_fresh_enable_works()

    def test_on_rs485_the_motors_run_on(self):
        self.run_in(RS485)
        self.kill_the_gateway()
        self.assert_runs_on()


class EndedInGoodOrder(GatewayDies):
    @on(RS232, KEYA_CAN, CANOPEN)
    def test_the_drive_stops_by_itself(self, interface):
        self.run_in(interface)
        self.assertEqual(self.gateway.terminate(), 0)
        self.assert_stopped_by_its_watchdog()

    def test_on_rs485_the_motors_run_on(self):
        self.run_in(RS485)
        self.assertEqual(self.gateway.terminate(), 0)
        self.assert_runs_on()


class Hangs(GatewayDies):
    """Stopped until the drive has noticed, and then let go on: it must not carry on where it was."""

    @on(RS232, KEYA_CAN, CANOPEN)
    def test_nothing_is_carried_on(self, interface):
        self.run_in(interface)
        self.stand_still()
        self.assert_stopped_by_its_watchdog()
        where = self.positions()
        self.gateway.send(signal.SIGCONT)
        self.assert_never_enabled(where)
        for axis in self.seen:
            axis.until(link_state=ONLINE, axis_state=DISABLED, motion_state=FAILED, error_code=COMMUNICATION)
        self.assert_nothing_is_enabled_by_itself(where)
        self.assertEqual(self.trips(), 1, "it was not enabled for a moment either")
        self.assert_fresh_enable_works()

    def test_on_rs485_the_motors_run_on(self):
        self.run_in(RS485)
        self.stand_still()
        self.assert_runs_on()
        self.gateway.send(signal.SIGCONT)
        for axis in self.axes:
            axis.until(link_state=ONLINE, axis_state=CONTINUOUS)
            axis.command("quick_stop")
        self.until_it_stands()
        self.assert_nothing_is_enabled_by_itself()
        self.assert_fresh_enable_works()


class HangsAgainAndAgain(GatewayDies):
    """Whatever is due first when it goes on, a question or the keep-alive: on RS232 that one carries the enable of both motors. The
    drive answers slowly here, so that what the gateway finds first is an answer from before the drive has tripped."""

    def test_on_rs232(self):
        self.begin(RS232)
        self.sim.ask("reply-delay cart 40")
        for count in range(1, ROUNDS + 1):
            self.run_both()
            self.gateway.send(signal.SIGSTOP)
            self.addCleanup(self.gateway.send, signal.SIGCONT)
            until("the drive notices", lambda: self.trips() == count)
            self.until_it_stands()
            where = self.positions()
            self.gateway.send(signal.SIGCONT)
            self.assert_never_enabled(where)


class HangsForLong(GatewayDies):
    def hang(self, interface, *leases):
        self.begin(interface, lease=[{"timeout_ms": timeout} for timeout in leases])
        self.run_both()
        self.stand_still()
        until("it is silent", lambda: int(self.ask("last-command").split()[0]) > LEASE_MS + 300)
        if interface.loss:
            self.assert_stopped_by_its_watchdog()
        where = self.positions()
        self.gateway.send(signal.SIGCONT)
        if interface.loss:
            self.assert_never_enabled(where)
        self.seen[0].until(owner=0)


class HangsLongerThanALease(HangsForLong):
    """By RS485 nothing but the leases stops the motors, and at once."""

    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_both_are_stopped_for_good(self, interface):
        self.hang(interface, LEASE_MS, LEASE_MS)
        self.until_it_stands()
        self.assert_nothing_is_enabled_by_itself()
        self.assert_fresh_enable_works()


class HangsLongerThanOneOfTwoLeases(HangsForLong):
    """The stop of motor A is no reason to set motor B going."""

    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_one_is_stopped_and_the_other_is_not_set_going(self, interface):
        self.hang(interface, LEASE_MS, 60000)
        if interface.loss:
            self.seen[1].until(axis_state=DISABLED, motion_state=FAILED)
            self.assert_nothing_is_enabled_by_itself()
        else:
            until("motor A stands without torque", lambda: self.enabled() == [False, True] and self.speeds() == [0, SPEED])
            self.assertEqual(self.seen[1].get("axis_state"), CONTINUOUS)


class HangsInAMove(GatewayDies):
    """Motor A is on its way to a far position, motor B runs at speed. Neither goes on, and an enable moves nothing."""

    @on(RS232, KEYA_CAN, CANOPEN)
    def test_an_enable_moves_nothing(self, interface):
        self.begin(interface, drive="+0020=3", constants={"control_mode_a": 3})
        left, right = self.axes
        self.enable(left)
        self.enable(right)
        self.run_axis(right)
        left.set(target_position=20000 * TURN)
        number = left.command("move_absolute")
        until("it moves", lambda: self.positions()[0] > TURN)
        self.stand_still()
        self.assert_stopped_by_its_watchdog()
        where = self.positions()
        self.gateway.send(signal.SIGCONT)
        self.assert_never_enabled(where)
        self.seen[0].until(axis_state=DISABLED, motion_state=FAILED, motion_id=number)
        for axis in self.axes:
            self.enable(axis)
        self.let_pass(MANY_KEEP_ALIVES)
        self.assertEqual((self.enabled(), self.positions()), ([True, True], where), "an enable moves nothing")


if __name__ == "__main__":
    main()
