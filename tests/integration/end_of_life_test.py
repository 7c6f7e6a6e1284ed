# SPDX-License-Identifier: Apache-2.0
"""How a gateway ends, and how the next one finds an axis that runs."""
import fcntl
import os
import re
import signal
import subprocess
import time

from modbus import ALARM_ADOPTED, CONTINUOUS, NO_MOTION, Closed
from processes import NEVER, Program, until
from stage import AXISGATE, Story, main

TURN = 10000
FAR = 20000 * TURN
RPM = 1000
LOOP_SLOW = 10  # bit of the gateway's alarms
DRIVES = {1: "lift/1", 2: "feeder/1"}


class End(Story):
    def setUp(self):
        super().setUp()
        self.start()

    def run_velocity(self, axis):
        axis.set(profile_acceleration=30000, profile_deceleration=30000, target_velocity=100 * RPM)
        axis.command("enable")
        axis.command("run_velocity")
        axis.until(axis_state=CONTINUOUS)

    def end(self, number):
        self.gateway.send(number)
        return self.gateway.ended()

    def again(self):
        """The same configuration, on the same port."""
        self.run_gateway()
        self.client = self.connect()
        self.until_online()

    def until_it_stands(self, drive):
        places = []

        def look():
            places.append(self.sim.object(drive, "6063.00"))
            return len(places) > 5 and len(set(places[-5:])) == 1

        until(f"{drive} stands", look)

    def runs(self, drive):
        before = self.sim.object(drive, "6063.00")
        until(f"{drive} turns", lambda: self.sim.object(drive, "6063.00") > before)
        return "operation" in self.sim.state(drive)


class Told(End):
    def test_sigterm(self):
        for axis in (self.axis(1), self.axis(2)):
            self.run_velocity(axis)
        writes = {drive: self.sim.writes(drive) for drive in DRIVES.values()}
        waiting = self.connect()
        waiting.gateway()  # accepted, and not only queued by the system
        self.assertEqual(self.end(signal.SIGTERM), 0)
        self.assertRegex(self.gateway.text(), "signal 15: ending; the drives keep what they do")
        with self.assertRaises(Closed, msg="clients are told by their connection"):
            waiting.gateway()
        with self.assertRaises(Closed):
            self.client.gateway()
        with self.assertRaises(Closed):
            self.connect()
        for drive in DRIVES.values():
            self.assertTrue(self.runs(drive))
            self.assertEqual(self.sim.writes(drive), writes[drive])

    def test_a_second_signal_ends_it_at_once(self):
        self.sim.ask("lose lift/1 on")
        write = self.later(lambda: self.axis(1).set(profile_acceleration=12345))
        until("it is at the drive", lambda: self.sim.writes("lift/1", "6083.00") > 0)
        for _ in range(2):
            self.gateway.send(signal.SIGTERM)
            self.gateway.wait_for("signal 15: ending")
        self.assertEqual(self.gateway.ended(), 0)
        self.assertIsNotNone(write.exception(timeout=NEVER))

    def from_elsewhere(self, *wrapper, **options):
        self.gateway = self.keep(Program("axisgate", [*wrapper, AXISGATE, "run", self.config], **options))
        self.gateway.wait_for("listening on ")

    def test_a_service_is_not_ended_by_sighup(self):
        self.assertEqual(self.end(signal.SIGTERM), 0)
        self.from_elsewhere("env", "--default-signal=HUP", start_new_session=True)
        self.client = self.connect()
        self.until_online()
        self.gateway.send(signal.SIGHUP)
        self.gateway.wait_for("was read anew: nothing has changed")
        self.assertEqual(self.axis(1).get("link_state"), 2)
        self.assertEqual(self.end(signal.SIGTERM), 0)

    def test_one_that_was_told_to_outlive_its_terminal_does(self):
        self.assertEqual(self.end(signal.SIGTERM), 0)
        terminal, other = os.openpty()
        self.from_elsewhere("env", "--ignore-signal=HUP", "setsid", "--ctty", stdin=other)  # as nohup does
        os.close(other)
        os.close(terminal)
        self.client = self.connect()
        self.until_online()
        self.assertEqual(self.end(signal.SIGTERM), 0)
        self.assertEqual(self.gateway.found("signal 1:"), [])

    def test_a_terminal_that_is_gone_ends_what_was_started_from_it(self):
        self.assertEqual(self.end(signal.SIGTERM), 0)
        terminal, other = os.openpty()
        self.from_elsewhere("env", "--default-signal=HUP", "setsid", "--ctty", stdin=other)
        os.close(other)
        os.close(terminal)
        self.gateway.wait_for("signal 1: ending; the drives keep what they do")
        self.assertEqual(self.gateway.ended(), 0)


class FileOnDisk(End):
    CHANGED = 1 << 8  # gateway alarm

    def test_the_alarm_stands_while_the_file_differs_from_what_runs(self):
        alarms = lambda: self.client.gateway()["alarms"]
        self.assertFalse(alarms() & self.CHANGED)
        with open(self.config, encoding="utf-8") as file:
            before = file.read()
        for text in (before.replace('"name"', '"name" '), None):
            if text is None:
                os.remove(self.config)
            else:
                with open(self.config, "w", encoding="utf-8") as file:
                    file.write(text)
            until("the alarm", lambda: alarms() & self.CHANGED)
            self.gateway.wait_for(f"{self.config} is not what the gateway runs with")
            with open(self.config, "w", encoding="utf-8") as file:
                file.write(before)
            until("no alarm", lambda: not alarms() & self.CHANGED)


class Killed(End):
    def test_an_axis_that_runs_is_adopted_and_left_alone(self):
        self.run_velocity(self.axis(1))
        writes = self.sim.writes("lift/1")
        self.assertEqual(self.end(signal.SIGKILL), -signal.SIGKILL)
        self.again()
        axis = self.axis(1)
        block = axis.block()
        self.assertTrue(block["axis_alarms"] & ALARM_ADOPTED)
        self.assertTrue(self.client.gateway()["alarms"] & 1 << 6)
        self.assertIn("warning", axis.inputs())
        self.assertIn("enabled", axis.inputs())
        self.assertNotIn("adopted", self.gateway.found("axis 2: .*"))
        until("its speed is shown", lambda: abs(axis.get("velocity_actual") - 100 * RPM) < 2 * RPM)
        self.assertEqual(axis.get("motion_state"), NO_MOTION)
        self.assertTrue(self.runs("lift/1"))
        self.assertEqual(self.sim.writes("lift/1"), writes, "nothing is written until it is disabled")


class LoopThatStands(End):
    """The whole process stands still, as it does where its disk or its machine does."""

    def test_it_is_shown_that_it_stood(self):
        self.run_velocity(self.axis(1))
        self.gateway.send(signal.SIGSTOP)
        self.addCleanup(self.gateway.send, signal.SIGCONT)
        time.sleep(0.3)
        self.gateway.send(signal.SIGCONT)
        until("alarm event loop slow", lambda: self.client.gateway()["alarms"] >> LOOP_SLOW & 1)
        self.assertTrue(self.runs(DRIVES[1]), "shorter than its lease")


class LoopThatStandsLongerThanALease(End):
    """Two owners, one on each axis: one has asked meanwhile, the other has not."""

    lease_s = 6

    def buses(self):
        buses = super().buses()
        for entry in buses:
            entry["drives"][0]["axes"][0]["lease"] = {"timeout_ms": 1000 * self.lease_s}
        return buses

    def test_who_asked_meanwhile_is_not_gone_and_who_did_not_is(self):
        asks, falls_silent = self.connect(), self.connect()
        self.run_velocity(asks.axis(1))
        self.run_velocity(falls_silent.axis(2))
        self.gateway.send(signal.SIGSTOP)
        self.addCleanup(self.gateway.send, signal.SIGCONT)
        time.sleep(self.lease_s + 1)
        asked = self.later(asks.gateway)
        until("it has asked", lambda: self.waiting() == 1)
        self.gateway.send(signal.SIGCONT)
        asked.result(timeout=NEVER)
        until("the silent one's axis is stopped and latched", lambda: asks.gateway() and "stop_latched" in asks.axis(2).inputs())
        self.until_it_stands(DRIVES[2])
        self.assertTrue(self.runs(DRIVES[1]), "its owner lives")
        self.assertEqual(asks.axis(1).get("axis_state"), CONTINUOUS)

    def waiting(self):
        """How many connections have sent what the gateway has not read."""
        with open("/proc/net/tcp", encoding="ascii") as table:
            rows = [line.split() for line in list(table)[1:]]
        return sum(int(row[1].partition(":")[2], 16) in self.ports and int(row[4].partition(":")[2], 16) > 0 for row in rows)

    def test_a_start_that_waited_is_too_late_and_a_stop_is_a_stop(self):
        stops, starts = self.connect().axis(1), self.connect().axis(2)
        self.run_velocity(stops)
        starts.set(target_velocity=100 * RPM)
        starts.command("enable")
        self.gateway.send(signal.SIGSTOP)
        self.addCleanup(self.gateway.send, signal.SIGCONT)
        stop, start = self.later(stops.command, "quick_stop"), self.later(starts.command, "run_velocity")
        until("both have been sent", lambda: self.waiting() == 2)
        time.sleep(3)
        self.gateway.send(signal.SIGCONT)
        self.assertEqual(self.code_of(start), 6)
        self.assertEqual(self.code_of(stop), 0)
        for drive in DRIVES.values():
            self.until_it_stands(drive)


class LogThatNobodyReads(Story):
    """A pipe to a program that hangs, or has gone, or a disk that is full: no reason to leave a motor alone."""

    def start_with_log(self, write_end):
        self.simulate()
        self.configure()
        gateway = subprocess.Popen([AXISGATE, "run", self.config, "--decode", "lift", "--decode", "feeder"], stderr=write_end)
        os.close(write_end)
        self.addCleanup(gateway.wait)
        self.addCleanup(gateway.kill)
        self.client = until("a connection", self.try_to_connect)
        self.until_online()
        return gateway

    def try_to_connect(self):
        try:
            return self.connect()
        except Closed:
            return None

    def assert_it_lives(self, gateway):
        for number, drive in DRIVES.items():
            axis = self.axis(number)
            axis.set(profile_acceleration=30000, profile_deceleration=30000, target_velocity=100 * RPM)
            axis.command("enable")
            axis.command("run_velocity")
            before = self.sim.object(drive, "6063.00")
            until("its motor turns", lambda drive=drive, before=before: self.sim.object(drive, "6063.00") > before)
            axis.command("quick_stop")
            until("its motor stands", lambda drive=drive: self.sim.object(drive, "606C.00") == 0)
            axis.command("disable")
            self.assert_online(axis)
        self.assertIsNone(gateway.poll())
        gateway.terminate()
        self.assertEqual(gateway.wait(timeout=NEVER), 0)

    def test_the_reader_has_gone(self):
        read_end, write_end = os.pipe()
        gateway = self.start_with_log(write_end)
        os.close(read_end)
        self.assert_it_lives(gateway)

    def test_the_disk_is_full(self):
        gateway = self.start_with_log(os.open("/dev/full", os.O_WRONLY))
        self.assert_it_lives(gateway)

    def test_the_reader_hangs(self):
        read_end, write_end = os.pipe()
        self.addCleanup(os.close, read_end)
        fcntl.fcntl(write_end, fcntl.F_SETPIPE_SZ, 4096)
        gateway = self.start_with_log(write_end)
        requests = self.client.bus(0)["requests"]
        until("more frames than the pipe holds lines", lambda: self.client.bus(0)["requests"] > requests + 200)
        # Whoever reads on is told how much is missing.
        os.set_blocking(read_end, False)
        until("the gap is told", lambda: re.search(rb"\(\d+ lines lost here", self.drained(read_end)))
        until("it is full again", lambda: self.client.bus(0)["requests"] > requests + 600)
        self.assert_it_lives(gateway)

    def drained(self, read_end):
        try:
            return os.read(read_end, 1 << 16)
        except BlockingIOError:
            return b""


if __name__ == "__main__":
    main()
