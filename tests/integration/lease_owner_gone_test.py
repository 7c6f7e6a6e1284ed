# SPDX-License-Identifier: Apache-2.0
"""A master that is gone: its connection is closed, reset, or open and silent. Its motors stop, on every drive and protocol."""
import time

from lease_stage import ANOTHER, ME, Machine, main
from modbus import ACTIVE, Axis
from processes import until


class OwnerGone(Machine):
    """One owner has all motors running and goes away."""

    lease = {"timeout_ms": 1200}

    def goes_away(self, leave):
        self.begin()
        owner = self.peer()
        axes = [Axis(owner, number) for number in self.numbers]
        for axis in axes:
            self.set_running(axis)
        for axis in axes:
            self.assertEqual((axis.get("owner"), self.watched(axis.number).get("owner")), (ME, ANOTHER))
        self.keep_running(owner, self.numbers, 1.5 * self.lease["timeout_ms"] / 1000)
        before = time.monotonic()
        owner.gateway()
        leave(owner)
        # No drive is stopped before its time.
        for number in self.numbers:
            turning = self.speed(number) != 0
            if time.monotonic() - before < self.lease["timeout_ms"] / 1000:
                self.assertTrue(turning, f"axis {number} was stopped while its lease lived")
        for number in self.each():
            self.assert_stopped_for_good(number)
            self.assertGreaterEqual(time.monotonic() - before, self.lease["timeout_ms"] / 1000)
            self.assertTrue(self.leases_told(number, "has run out"))
        for number in self.each():
            self.assert_it_can_be_had_again(number)


class Closes(OwnerGone):
    def test_it_closes_its_connection(self):
        self.goes_away(lambda owner: owner.close())


class Resets(OwnerGone):
    def test_its_connection_is_reset(self):
        self.goes_away(lambda owner: owner.reset())


class FallsSilent(OwnerGone):
    def test_its_connection_stays_open_and_silent(self):
        self.goes_away(lambda owner: owner.fall_silent())


class OneOfTwoMotors(Machine):
    """Two masters, each with one motor of the same drive."""

    lines_of = ("keya232", "keyacan")
    lease = {"timeout_ms": 1200}

    def test_the_other_motor_of_the_drive_goes_on(self):
        self.begin()
        for line in self.lines_of:
            with self.subTest(line=line):
                self.one_of_two(line)

    def one_of_two(self, line):
        gone, stays = self.peer(), self.peer("127.0.0.2")
        a, b = Axis(gone, self.number_of(line, "A")), Axis(stays, self.number_of(line, "B"))
        self.set_running(a)
        self.set_running(b)
        trips = self.sim.ask(f"trips {line}/1")
        gone.reset()

        def stopped_meanwhile():
            stays.gateway()
            self.assertNotEqual(self.speed(b.number), 0)
            return self.speed(a.number) == 0

        until("motor A is stopped", stopped_meanwhile)
        self.keep_running(stays, [b.number], 1.5 * self.lease["timeout_ms"] / 1000)
        self.assertEqual((b.get("motion_state"), b.get("owner")), (ACTIVE, ME))
        self.assertEqual(self.sim.ask(f"trips {line}/1"), trips, "its watchdog was fed")
        self.assertIn("stop_latched", self.watched(a.number).inputs())
        self.assertNotIn("stop_latched", b.inputs())
        b.command("quick_stop")
        self.until_it_stands(b.number)


class KeepAlive(Machine):
    """A drive that wants a command each second gets it from the gateway, as long as somebody owns its motor."""

    lines_of = ("keya232", "keyacan")
    lease = {"timeout_ms": 2000}

    def test_it_is_sent_while_the_owner_lives_and_not_afterwards(self):
        self.begin()
        owner = self.peer()
        for number in self.numbers:
            self.set_running(Axis(owner, number))
        self.keep_running(owner, self.numbers, 2.5)  # it reads, and writes nothing
        for line in self.lines_of:
            self.assertEqual(self.sim.ask(f"trips {line}/1"), "0")
        owner.reset()
        for number in self.each():
            self.assert_stopped_for_good(number)
        sent = [self.sim.ask(f"commands {line}/1") for line in self.lines_of]
        self.let_pass(1)  # some more of them would have been due
        self.assertEqual([self.sim.ask(f"commands {line}/1") for line in self.lines_of], sent)
        for line in self.lines_of:
            self.assertEqual(self.sim.ask(f"trips {line}/1"), "0", "it was stopped by the gateway, not by its watchdog")


if __name__ == "__main__":
    main()
