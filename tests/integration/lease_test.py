# SPDX-License-Identifier: Apache-2.0
"""Masters that are gone, as their connections and their programs show it: on every drive and protocol their motors stop, and those of
the living run on. What else a lease does is told of each drive by tests/obey and tests/unit/drive."""
import time

from lease_stage import ANOTHER, ME, PANEL_1, PLC, RPM, Machine, main
from modbus import ABORTED, ACTIVE, BUSY, CONTINUOUS, Axis, mbpoll
from processes import until

RUN_VELOCITY = 8


class OwnersGone(Machine):
    """Three masters with a third of the motors each, and one who lives and has the second motor of each Keya."""

    lease = {"timeout_ms": 2500}  # all axes are asked between two signs of life, beside a busy machine too

    def test_one_closes_one_resets_and_one_falls_silent_and_who_lives_keeps_its_motors(self):
        self.begin()
        gone, lives = [self.peer() for _ in range(3)], self.peer("127.0.0.2")
        kept = [number for number, (_, motor) in self.motors.items() if motor == "B"]
        lost = [number for number in self.numbers if number not in kept]
        owners = {**{number: gone[at % 3] for at, number in enumerate(lost)}, **{number: lives for number in kept}}
        for number, owner in owners.items():
            self.set_running(Axis(owner, number))
            for client in (*gone, lives):
                client.gateway()
        for _ in range(20):
            for number, owner in owners.items():
                self.assertEqual(Axis(owner, number).get("owner"), ME)
                self.assertNotEqual(self.speed(number), 0, f"axis {number}")
            time.sleep(1.5 * self.lease["timeout_ms"] / 1000 / 20)
        before = time.monotonic()
        for client in gone:
            client.gateway()
        for leave in (gone[0].close, gone[1].reset, gone[2].fall_silent):
            leave()
        standing = {}

        def stand_meanwhile():
            lives.gateway()
            for number in owners:
                if self.speed(number) == 0:
                    standing.setdefault(number, time.monotonic())
            return len(standing) == len(lost)

        until("their motors stand", stand_meanwhile)
        self.assertEqual(set(standing), set(lost))
        self.assertGreaterEqual(min(standing.values()) - before, self.lease["timeout_ms"] / 1000, "none before its time")
        self.keep_running(lives, kept, 1.5 * self.lease["timeout_ms"] / 1000)
        for number in kept:
            axis = Axis(lives, number)
            self.assertEqual((axis.get("motion_state"), axis.get("owner")), (ACTIVE, ME))
            self.assertNotIn("stop_latched", axis.inputs())
            axis.command("quick_stop")
        for line in {self.motors[number][0] for number in kept}:
            self.assertEqual(self.sim.ask(f"trips {line}/1"), "0", "its watchdog was fed")
        for number in lost:
            self.assert_stopped_for_good(number)
            self.assertTrue(self.leases_told(number, "has run out"))
            self.assert_it_can_be_had_again(number)


class ComesBack(Machine):
    lease = {"timeout_ms": 2500}

    def test_from_its_own_address_it_goes_on_as_if_it_had_never_been_away(self):
        self.begin()
        plc, other = self.peer(), self.peer(PANEL_1)
        motions = {number: self.set_running(Axis(plc, number)) for number in self.numbers}
        plc.reset()
        for number in self.each():
            with self.refused(BUSY):  # of another address
                Axis(other, number).set(target_velocity=0)
        again = self.peer()
        for number in self.numbers:
            Axis(again, number).set(target_velocity=400 * RPM)
        for number in self.each():
            axis = Axis(again, number)
            self.until_it_turns_at(number, 400)
            self.assertEqual((axis.get("motion_state"), axis.get("motion_id")), (ACTIVE, motions[number]))
            self.assertEqual((axis.get("owner"), Axis(other, number).get("owner")), (ME, ANOTHER))
            self.assertFalse(self.leases_told(number, "has run out"))
            self.until_told(number, "its connection had ended")
        self.keep_running(again, self.numbers, 1.2 * self.lease["timeout_ms"] / 1000)
        third = Axis(self.peer(), 1)  # the connection before it lives
        with self.refused(BUSY):
            third.set(target_velocity=0)
        third.command("take_over")
        self.until_it_stands(1)
        self.until_told(1, "has taken the axis over from another connection of its address")


class OneShot(Machine):
    """"client": "address": a tool that connects for each call owns what it has begun."""

    listener_options = {"client": "address"}
    lease = {"timeout_ms": 5000}

    def test_mbpoll_owns_what_it_has_enabled(self):
        self.begin()
        for number in self.each():
            first = 100 * number
            mbpoll(self.ports[0], "0", first, 1)
            self.assertEqual(mbpoll(self.ports[0], "4", first + 28), [ME])
            mbpoll(self.ports[0], "4:int", first + 44, 300 * RPM)
            mbpoll(self.ports[0], "0", first + 7, 0)
            mbpoll(self.ports[0], "0", first + 7, 1)
            self.until_it_turns_at(number, 300)
            with self.refused(BUSY):
                Axis(self.peer(PANEL_1), number).set(target_velocity=0)
            self.assertEqual(Axis(self.peer(PLC), number).get("owner"), ME)
            mbpoll(self.ports[0], "0", first + 2, 1)
            self.until_it_stands(number)


class NothingElseStopsIt(Machine):
    """A stepper watches no line: without a lease its gateway stops it when the client is gone that commanded it."""

    lines_of = ("stepper",)
    lease = None

    def test_its_motion_ends_with_the_connection_that_commanded_it(self):
        self.begin()
        first, second = self.peer(), self.peer()
        self.set_running(Axis(first, 1))
        second.close()
        axis = self.watched(1)
        self.assertEqual(axis.get("axis_state"), CONTINUOUS, "another client's end is no reason")
        first.close()
        axis.until(motion_state=ABORTED)
        axis.until_input("stop_latched")
        self.until_it_stands(1)
        self.gateway.wait_for("axis 1: the client that commanded the motion is gone: quick stop")


class InStop(Machine):
    """A PLC's scanner writes command, command_id and heartbeat of each axis as one block, and the target velocity, and reads all the
    rest. In STOP it goes on with what the program has left. The lease that wants a heartbeat knows."""

    lease = {"timeout_ms": 1200, "renew": "heartbeat"}

    def test_a_scanner_without_its_program_does_not_keep_a_motor_running(self):
        self.begin()
        self.plc, self.beat, self.ids = self.peer(), 0, {}
        for number in self.numbers:
            self.prepare(Axis(self.plc, number))
        self.set_all_running()
        end = time.monotonic() + 1.5 * self.lease["timeout_ms"] / 1000
        while time.monotonic() < end:
            self.scan_all(beating=True)
            for number in self.numbers:
                self.assertNotEqual(self.speed(number), 0, f"axis {number}: its program lives")
        self.until_all_stand()
        end = time.monotonic() + 1.2 * self.lease["timeout_ms"] / 1000
        while time.monotonic() < end:
            self.scan_all(beating=False)
            for number in self.numbers:
                self.assertEqual(self.speed(number), 0)
        for number in self.each():
            self.assertIn("stop_latched", self.watched(number).inputs())
            self.assertTrue(self.leases_told(number, "has run out"))
        self.ids.clear()
        self.set_all_running()  # its program is in RUN again, and enables anew

    def set_all_running(self):
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
            self.beat = self.beat % 0xFFFF + 1
        for number in self.numbers:
            if number not in self.ids:
                Axis(self.plc, number).set(heartbeat=self.beat)
                continue
            first = 100 * number
            self.plc.write(first + 44, 300 * RPM >> 16, 300 * RPM & 0xFFFF)
            self.plc.write(first + 54, RUN_VELOCITY, self.ids[number], self.beat)
            self.plc.registers(first, 39)

    def until_all_stand(self):
        """Stopped by the gateway, although the scanner goes on."""
        stopped = set()

        def look():
            self.scan_all(beating=False)
            stopped.update(number for number in self.numbers if "stop_latched" in self.watched(number).inputs())
            return len(stopped) == len(self.numbers)

        until("all of them are stopped", look)
        for number in self.each():
            self.until_it_stands(number)


if __name__ == "__main__":
    main()
