# SPDX-License-Identifier: Apache-2.0
"""Whoever commands a Keya keeps it alive by living: the drive wants to hear something each second, and the gateway speaks only while
the owner does."""
import socket
import struct

from keya_stage import CANOPEN, KEYA_CAN, MANY_KEEP_ALIVES, RS232, RS485, SPEED, KeyaStory, main, on
from modbus import BUSY, CONTINUOUS, DISABLED
from processes import until

LEASE = {"timeout_ms": 1500}
NOBODY, ANOTHER = 0, 2


class OwnerLives(KeyaStory):
    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_its_motors_run_on(self, interface):
        self.begin(interface, lease=LEASE)
        self.run_both()
        before, where = self.commands(), self.positions()
        self.let_pass(3, self.owner_asks)  # twice as long as a lease
        self.assertEqual((self.trips(), self.enabled(), self.speeds()), (0, [True, True], [SPEED, SPEED]))
        for axis in self.seen:
            self.assertEqual((axis.get("axis_state"), axis.get("owner")), (CONTINUOUS, ANOTHER))
        self.assertTrue(all(now > then for now, then in zip(self.positions(), where)))
        if interface.loss:
            self.assertGreater(self.commands(), before + 3, "more often than once a second")
        else:
            self.assertEqual(self.commands(), before, "no watchdog, no keep-alive")

    def owner_asks(self):
        """Any request of the owner renews the leases of all that it owns."""
        return self.axes[0].get("axis_state") == CONTINUOUS


class OwnerDies(KeyaStory):
    """Without a word, its connection open, as a PLC does whose cable is pulled."""

    def die(self, interface, how=lambda: None):
        self.begin(interface, lease=LEASE)
        self.run_both()
        how()
        for axis in self.seen:
            axis.until(owner=NOBODY)
        self.until_it_stands()
        commands, where = self.commands(), self.positions()
        for axis in self.seen:
            axis.until_input("stop_latched")
            axis.until_input("enabled", False)
        self.let_pass(MANY_KEEP_ALIVES)
        self.assertEqual((self.commands(), self.positions()), (commands, where), "the keep-alive has ended")
        self.client = self.connect()  # the next one
        self.axes = [self.client.axis(1), self.client.axis(2)]
        self.run_both()
        self.assertEqual(self.enabled(), [True, True])

    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_its_motors_are_stopped_for_good(self, interface):
        self.die(interface)


class OwnerEndsItsConnection(OwnerDies):
    """By closing it, and by a reset, as a process does that is killed."""

    def reset_the_connection(self):
        connection = self.client.tcp.socket
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        connection.close()

    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_its_motors_are_stopped_for_good(self, interface):
        self.die(interface, self.reset_the_connection if interface in (RS485, KEYA_CAN) else lambda: self.client.close())


class ScannerGoesOnWithoutItsProgram(KeyaStory):
    """A PLC in STOP: it asks and writes as ever, and its heartbeat register does not change any more."""

    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_its_motors_are_stopped(self, interface):
        self.begin(interface, lease={**LEASE, "renew": "heartbeat"})
        self.beats = 0
        for axis in self.axes:
            self.beating(lambda axis=axis: self.enable(axis))
            self.beating(lambda axis=axis: self.run_axis(axis))
        self.let_pass(2, self.beat)
        self.assertEqual((self.trips(), self.enabled(), self.speeds()), (0, [True, True], [SPEED, SPEED]))

        def scanned():
            for axis in self.axes:
                axis.block()
                self.scan(axis)
            return self.enabled() == [False, False]

        until("its axes are stopped", scanned)
        self.until_it_stands()
        for axis in self.seen:
            axis.until_input("stop_latched")

    def beat(self):
        self.beats += 1
        for axis in self.axes:
            axis.set(heartbeat=self.beats % 0x10000)
        return True

    def beating(self, work):
        self.beat()
        work()
        self.beat()

    def scan(self, axis):
        axis.set(heartbeat=self.beats % 0x10000)


class LeaseWithoutAStop(KeyaStory):
    """`on_expiry` none: nothing is sent, and that is what the drive's watchdog waits for."""

    def die(self, interface):
        self.begin(interface, lease={**LEASE, "on_expiry": "none"})
        self.run_both()
        for axis in self.seen:
            axis.until(owner=NOBODY)
        if not interface.loss:
            self.assert_runs_on()
            return
        self.assert_stopped_by_its_watchdog()
        for axis in self.seen:
            axis.until(axis_state=DISABLED, error_code=0x8130)
        self.assert_nothing_is_enabled_by_itself()
        self.assert_fresh_enable_works()

    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_it(self, interface):
        self.die(interface)


class TwoOwners(KeyaStory):
    """Two clients with a motor each: the death of one stops its motor alone."""

    @on(RS232, RS485, KEYA_CAN, CANOPEN)
    def test_the_motor_of_the_other_runs_on(self, interface):
        self.begin(interface, lease=LEASE)
        dying = self.axes[0]
        living = self.connect().axis(2)
        self.enable(living)
        self.run_axis(living)
        self.enable(dying)
        self.run_axis(dying)
        with self.refused(BUSY):
            living.client.axis(1).set(target_velocity=0)

        def alive():
            living.get("axis_state")
            return self.enabled() == [False, True] and self.speeds()[0] == 0

        until("its motor stands without torque", alive)
        self.let_pass(2, lambda: living.get("axis_state") == CONTINUOUS)
        self.assertEqual((self.enabled(), self.speeds(), self.trips()), ([False, True], [0, SPEED], 0))


if __name__ == "__main__":
    main()
