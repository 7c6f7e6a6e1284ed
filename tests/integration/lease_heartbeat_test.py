# SPDX-License-Identifier: Apache-2.0
"""A PLC in STOP: its program is dead, and its scanner goes on writing the same block. The lease that wants a heartbeat knows."""
import time

from lease_stage import ME, NOBODY, RPM, Machine, main
from modbus import GATEWAY, Axis
from processes import until

RUN_VELOCITY = 8


class Scanner(Machine):
    """It writes command, command_id and heartbeat of each axis as one block, and the target velocity, and reads all the rest."""

    lease = {"timeout_ms": 1200, "renew": "heartbeat"}

    def setUp(self):
        super().setUp()
        self.begin()
        self.plc = self.peer()
        self.beat = 0
        self.ids = {}
        for number in self.numbers:
            axis = Axis(self.plc, number)
            self.prepare(axis)
            axis.set(heartbeat=self.next_beat())

    def next_beat(self):
        self.beat = self.beat % 0xFFFF + 1
        return self.beat

    def runs(self):
        """Every axis is enabled and turns; the program beats all the while."""
        for number in self.numbers:
            axis = Axis(self.plc, number)
            self.scan_all(beating=True)
            axis.command("enable")
            self.scan_all(beating=True)
            axis.set(target_velocity=300 * RPM)
            self.ids[number] = axis.command("run_velocity")
        until("all of them turn", lambda: self.scan_all(beating=True) or all(self.speed(number) for number in self.numbers))

    def scan_all(self, beating):
        if beating:
            self.next_beat()
        for number in self.numbers:
            if number in self.ids:
                self.scan(number)
            else:
                Axis(self.plc, number).set(heartbeat=self.beat)

    def scan(self, number):
        first = 100 * number
        self.plc.write(first + 44, 300 * RPM >> 16, 300 * RPM & 0xFFFF)
        self.plc.write(first + 54, RUN_VELOCITY, self.ids[number], self.beat)
        self.plc.registers(first, 39)

    def until_stopped(self, scan):
        """By the gateway, although the scanner goes on."""
        stopped = set()

        def look():
            scan()
            for number in self.numbers:
                if self.watched(number).get("axis_state") == 5 or "stop_latched" in self.watched(number).inputs():
                    stopped.add(number)
            return len(stopped) == len(self.numbers)

        until("all of them are stopped", look)

    def assert_stays_stopped(self, scan):
        """Whatever the scanner writes: for longer than a lease."""
        for number in self.each():
            self.until_it_stands(number)
        end = time.monotonic() + 1.2 * self.lease["timeout_ms"] / 1000
        while time.monotonic() < end:
            scan()
            for number in self.numbers:
                self.assertEqual(self.speed(number), 0)
        for number in self.each():
            self.assertIn("stop_latched", self.watched(number).inputs())

    def in_stop(self):
        self.scan_all(beating=False)


class InStop(Scanner):
    def test_a_scanner_without_its_program_does_not_keep_a_motor_running(self):
        self.runs()
        end = time.monotonic() + 1.5 * self.lease["timeout_ms"] / 1000
        while time.monotonic() < end:
            self.scan_all(beating=True)
            for number in self.numbers:
                self.assertNotEqual(self.speed(number), 0, f"axis {number}: its program lives")
        self.until_stopped(self.in_stop)
        self.assert_stays_stopped(self.in_stop)
        for number in self.each():
            self.assertTrue(self.leases_told(number, "has run out"))

    def test_a_program_that_is_in_run_again_enables_anew_and_goes_on(self):
        self.runs()
        self.until_stopped(self.in_stop)
        self.ids.clear()
        self.runs()
        for number in self.each():
            self.assertEqual(Axis(self.plc, number).get("owner"), ME)


class GatewaysHeartbeat(Scanner):
    def test_register_8_beats_for_all_axes_at_once(self):
        self.runs()
        end = time.monotonic() + 1.5 * self.lease["timeout_ms"] / 1000
        while time.monotonic() < end:
            self.plc.write(GATEWAY["heartbeat"][0], self.next_beat())
            for number in self.numbers:
                self.assertNotEqual(self.speed(number), 0, f"axis {number}")

        def the_same():
            self.plc.write(GATEWAY["heartbeat"][0], self.beat)

        self.until_stopped(the_same)
        for number in self.each():
            self.assert_stopped_for_good(number)
            self.assertEqual(Axis(self.plc, number).get("owner"), NOBODY)


class WritesAlone(Scanner):
    lease = {"timeout_ms": 1200, "renew": "write"}

    def test_reads_do_not_renew_and_writes_do(self):
        self.runs()
        end = time.monotonic() + 1.5 * self.lease["timeout_ms"] / 1000
        while time.monotonic() < end:
            self.scan_all(beating=False)
            for number in self.numbers:
                self.assertNotEqual(self.speed(number), 0, f"axis {number}")

        def reads():
            for number in self.numbers:
                self.plc.registers(100 * number, 39)

        self.until_stopped(reads)
        for number in self.each():
            self.assert_stopped_for_good(number)


if __name__ == "__main__":
    main()
