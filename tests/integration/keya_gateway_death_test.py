# SPDX-License-Identifier: Apache-2.0
"""The gateway is killed or hangs while both motors of a Keya run. By RS232, CAN and CANopen the drive stops by itself; by RS485 it goes
on, as far as its manual says, and the axes had an alarm that told so. A Keya on each of its interfaces at once."""
import signal
import time

from lease_stage import KEYAS, NOBODY, Axis, Machine, main
from modbus import CONTINUOUS, DISABLED, FAILED, ONLINE
from processes import until

COMMUNICATION = 0x8130
ALARM_NO_COMM_WATCHDOG = 1
SPEED = 100  # rpm: 0.2 s of the drive's ramp as delivered
LONGER_THAN_A_WATCHDOG_MS = 1500
MANY_KEEP_ALIVES = 1.0  # seconds; they are 300 ms apart
UNWATCHED = "keya485"
WATCHED = tuple(line for line in KEYAS if line != UNWATCHED)
ROUNDS = 6


class GatewayDies(Machine):
    lines_of = KEYAS
    lease = {"timeout_ms": 60000}

    def set_out(self):
        self.begin()
        self.owner = self.peer()
        self.run_all()
        for number, (line, _) in self.motors.items():
            alarms = self.watched(number).get("axis_alarms")
            self.assertEqual(alarms & ALARM_NO_COMM_WATCHDOG, ALARM_NO_COMM_WATCHDOG if line == UNWATCHED else 0)
        self.assertEqual(self.trips(), dict.fromkeys(KEYAS, 0))

    def run_all(self):
        """One motor after the other, while the owner asks."""
        for number in self.numbers:
            self.set_running(Axis(self.owner, number), SPEED)
        until("all are at their speed", lambda: self.owner.gateway() and all(self.speed(number) == SPEED for number in self.numbers))

    # What the drives know.

    def ask(self, word, lines=WATCHED):
        return {line: self.sim.ask(f"{word} {line}/1") for line in lines}

    def trips(self):
        return {line: int(trips) for line, trips in self.ask("trips", KEYAS).items() if line in self.lines_of}

    def stopped(self):
        """Of every drive that watches its master: both motors stand and are disabled."""
        return all(state == "disabled disabled" for state in self.ask("state").values()) and \
            all(speed == "0 0" for speed in self.ask("speed").values())

    def until_stopped_by_their_watchdogs(self):
        until("each drive notices", lambda: all(self.trips()[line] for line in WATCHED))
        until("they stand", self.stopped)

    def assert_the_unwatched_runs_on(self):
        """No command for longer than any watchdog of this drive, and yet both motors turn."""
        until("silence", lambda: int(self.sim.ask(f"last-command {UNWATCHED}/1").split()[0]) > LONGER_THAN_A_WATCHDOG_MS)
        self.assertEqual(self.sim.ask(f"speed {UNWATCHED}/1"), f"{SPEED} {SPEED}")

    def assert_never_enabled(self):
        """While many a keep-alive would be due. Looks without a pause: an enable for a moment is one too."""
        where = self.ask("position")
        over = time.monotonic() + MANY_KEEP_ALIVES
        while self.watcher.gateway() and time.monotonic() <= over:
            self.assertTrue(self.stopped())
            self.assertEqual(self.ask("position"), where)

    def assert_nothing_starts(self):
        """What has stopped stays so until somebody enables it, and then is kept alive again."""
        stopped = [number for number, (line, _) in self.motors.items() if line in WATCHED]
        for number in stopped:
            self.watched(number).until(link_state=ONLINE)
            self.assertNotIn("enabled", self.watched(number).inputs())
        self.assert_never_enabled()
        trips = self.trips()
        for number in stopped:
            self.set_running(Axis(self.owner, number), SPEED)
        self.keep_running(self.owner, stopped, LONGER_THAN_A_WATCHDOG_MS / 1000)
        self.assertEqual(self.trips(), trips)

    def stand_still(self):
        self.gateway.send(signal.SIGSTOP)
        self.addCleanup(self.gateway.send, signal.SIGCONT)


class Killed(GatewayDies):
    def test_the_drive_stops_by_itself_and_nothing_starts_it_again(self):
        self.set_out()
        self.gateway.send(signal.SIGKILL)
        self.gateway.ended()
        self.until_stopped_by_their_watchdogs()
        self.assert_the_unwatched_runs_on()
        commands = self.ask("commands", KEYAS)
        self.run_gateway()
        self.client = self.watcher = self.peer("127.0.0.9")
        self.until_online()
        self.owner = self.peer()
        for number, (line, _) in self.motors.items():
            if line in WATCHED:
                self.watched(number).until(axis_state=DISABLED, error_code=COMMUNICATION)
        self.assert_never_enabled()
        self.assertEqual(self.ask("commands", KEYAS), commands)
        self.assert_nothing_starts()


class Hangs(GatewayDies):
    """Stopped until the drive has noticed, and then let go on: it must not carry on where it was."""

    def test_nothing_is_carried_on(self):
        self.set_out()
        self.stand_still()
        self.until_stopped_by_their_watchdogs()
        self.assert_the_unwatched_runs_on()
        self.gateway.send(signal.SIGCONT)
        self.assert_never_enabled()
        for number, (line, _) in self.motors.items():
            if line in WATCHED:
                self.watched(number).until(axis_state=DISABLED, motion_state=FAILED, error_code=COMMUNICATION)
            else:
                self.watched(number).until(axis_state=CONTINUOUS)
        self.assertEqual({trips for line, trips in self.trips().items() if line in WATCHED}, {1}, "not enabled for a moment either")
        self.assert_nothing_starts()


class HangsAgainAndAgain(GatewayDies):
    """Whatever is due first when it goes on, a question or the keep-alive: on RS232 that one carries the enable of both motors. The
    drive answers slowly here, so that what the gateway finds first is an answer from before the drive has tripped."""

    lines_of = ("keya232",)

    def ask(self, word, lines=WATCHED):
        return super().ask(word, self.lines_of)

    def test_on_rs232(self):
        self.begin()
        self.owner = self.peer()
        self.sim.ask("reply-delay keya232 40")
        for count in range(1, ROUNDS + 1):
            self.run_all()
            self.stand_still()
            until("the drive notices", lambda count=count: self.trips() == {"keya232": count})
            until("it stands", self.stopped)
            self.gateway.send(signal.SIGCONT)
            self.assert_never_enabled()


class HangsLongerThanALease(GatewayDies):
    """By RS485 nothing but the leases stops the motors, and at once."""

    lease = {"timeout_ms": 3000}

    def test_both_are_stopped_for_good(self):
        self.set_out()
        self.stand_still()
        until("silence", lambda: int(self.sim.ask(f"last-command {UNWATCHED}/1").split()[0]) > self.lease["timeout_ms"] + 300)
        self.until_stopped_by_their_watchdogs()
        self.gateway.send(signal.SIGCONT)
        self.assert_never_enabled()
        for number, (line, _) in self.motors.items():
            self.watched(number).until(owner=NOBODY)
            if line == UNWATCHED:
                self.assert_stopped_for_good(number)
        self.owner = self.peer()
        self.assert_nothing_starts()


if __name__ == "__main__":
    main()
