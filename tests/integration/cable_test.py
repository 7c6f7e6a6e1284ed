# SPDX-License-Identifier: Apache-2.0
"""Somebody pulls the cable of a line, or its adapter, and puts it back, with drives of each type and protocol; the other lines go on.
What a drive and the gateway do afterwards is told in every situation by tests/obey/outage_test.cpp and tests/unit/drive."""
import os
import signal

from lease_stage import MACHINES, RPM, Machine, main
from modbus import (ALARM_ADOPTED, CONTINUOUS, DISABLED, ERROR_STOP, FAILED, LINK_DOWN, NO_ANSWER, NO_PATH, ONLINE, SETUP, STANDSTILL,
                    SUSPECT, Axis)
from processes import Program, until
from stage import Story, bus, drive

NEVER_SENT, OUTCOME_UNKNOWN = 6, 4
STOP_BY_THEMSELVES = ("kincocan", "leadshine", "keya232", "keyacan")  # when nobody is heard


class Cable(Machine):
    lease = None

    def axes_of(self, line):
        return [Axis(self.operator, number) for number, (of, _) in self.motors.items() if of == line]

    def pull(self, line):
        self.sim.ask(f"unplug {line}")
        for axis in self.axes_of(line):
            axis.until(link_state=LINK_DOWN)

    def put_back(self, line):
        self.sim.ask(f"plug {line}")
        for axis in self.axes_of(line):
            axis.until(link_state=ONLINE)

    def assert_gone(self, axis):
        """Reads go on and say what is known; writes are refused as never sent."""
        block = axis.block()
        self.assertEqual((block["link_state"], block["valid"], block["statusword"]), (LINK_DOWN, 0, 0))
        self.assertNotEqual(block["error_code"], 0)
        self.assertEqual(axis.inputs() - {"warning", "stop_latched"}, set())
        self.assertEqual(axis.client.overview(axis.number)["link_state"], LINK_DOWN)
        for name in ("enable", "fault_reset", "run_velocity"):
            with self.refused(NO_PATH):
                axis.command(name)
            self.assertEqual(axis.get("command_result"), NEVER_SENT)
        with self.refused(NO_PATH):
            axis.set(target_velocity=1)


class PulledWhile(Cable):
    def written(self, line):
        """What would start or stop its motors; none where the drive is set up anew by the same."""
        if line.startswith("keya"):
            return self.sim.ask(f"commands {line}/1")
        if line == "stepper":
            return self.sim.ask(f"writes {line}/1 323")
        return self.sim.writes(f"{line}/1") if line in ("serial", "modbus") else None

    def test_moving(self):
        self.begin()
        self.operator = self.peer()
        motions = {number: self.set_running(Axis(self.operator, number)) for number in self.numbers}
        for at, line in enumerate(self.lines_of):
            self.at = line
            self.pull(line)
            for axis in self.axes_of(line):
                self.assert_gone(axis)
            gateway = self.client.gateway()
            lost = len(self.axes_of(line))
            self.assertEqual((gateway["gateway_state"], gateway["axes_online"]), (2, len(self.numbers) - lost))
            self.assertEqual(gateway["alarms"] & 0b11, 0b11)
            self.assertEqual([self.client.bus(number)["link"] for number in range(len(self.lines_of))],
                             [0 if number == at else 1 for number in range(len(self.lines_of))])
            for other in self.lines_of[at + 1:]:
                for axis in self.axes_of(other):
                    self.assertNotEqual(self.speed(axis.number), 0, f"{other} goes on")
                    self.assert_online(axis)
            if line in STOP_BY_THEMSELVES:
                for axis in self.axes_of(line):
                    self.until_it_stands(axis.number)
            written = self.written(line)
            self.put_back(line)
            self.assertEqual(self.client.bus(at)["reconnects"], 1)
            for axis in self.axes_of(line):
                axis.until(motion_state=FAILED, motion_id=motions[axis.number])  # a lost link ends every motion for good
            self.assertEqual(self.written(line), written, "nothing was written")
            for axis in self.axes_of(line):
                self.assert_is_as_it_was_left(axis, line)
                self.set_running(axis, -200)
                axis.command("quick_stop")
                self.until_it_stands(axis.number)

    def assert_is_as_it_was_left(self, axis, line):
        if line in STOP_BY_THEMSELVES:
            self.assertEqual(self.speed(axis.number), 0)
            axis.until_input("enabled", False)
            if axis.get("axis_state") == ERROR_STOP:
                axis.command("fault_reset")
            axis.until(axis_state=DISABLED)
            return
        self.assertNotEqual(self.speed(axis.number), 0, "nobody could tell it")
        axis.until_input("enabled")
        self.assertTrue(axis.get("axis_alarms") & ALARM_ADOPTED)
        axis.command("quick_stop")
        self.until_it_stands(axis.number)
        axis.command("disable")
        until("no longer adopted", lambda: not axis.get("axis_alarms") & ALARM_ADOPTED)


class PulledOnAQuietLine(Cable):
    """Polls are rare and deadlines long, so that the wire holds what the story put there."""

    lines_of = ("serial",)
    reply_timeout_ms = 10000
    bus_options = {"poll": {"fast": 60000, "normal": 60000, "slow": 600000}}

    def setUp(self):
        super().setUp()
        self.begin()
        self.operator = self.peer()
        self.first, self.second = Axis(self.operator, 1), Axis(self.peer(), 1)

    def test_while_a_command_waits_behind_a_write(self):
        self.sim.ask("late serial/1 5000 next 1")
        write = self.later(lambda: self.first.set(profile_acceleration=12345))
        until("the write at the drive", lambda: self.sim.writes("serial/1", "6083.00") == 1)
        command = self.later(lambda: self.second.command("enable"))
        until("the command waits", lambda: self.client.bus(0)["queue_depth"] >= 1)
        self.sim.ask("unplug serial")
        self.assertEqual((self.code_of(write), self.code_of(command)), (NO_ANSWER, NO_PATH))
        self.assertEqual((self.first.get("command_result"), self.second.get("command_result")), (OUTCOME_UNKNOWN, NEVER_SENT))
        self.put_back("serial")
        self.assertEqual(self.sim.writes("serial/1", "6083.00"), 1, "it is not written twice")
        self.assertEqual(self.sim.writes("serial/1", "6040.00"), 0, "what waited was never sent")
        self.assertAlmostEqual(self.first.get("profile_acceleration"), 12345, delta=5)

    def test_in_the_middle_of_an_enable(self):
        self.sim.ask("late serial/1 5000 next 1")
        enable = self.later(lambda: self.first.command("enable"))
        until("it is on the wire", lambda: self.client.bus(0)["requests"] > self.client.bus(0)["replies"])
        self.sim.ask("unplug serial")
        self.assertEqual(self.code_of(enable), NO_ANSWER)
        self.put_back("serial")
        self.assertNotIn("enabled", self.first.inputs())
        self.assertNotIn("operation", self.sim.state("serial/1"))


class PulledAtStart(Cable):
    def test_devices_that_are_not_there_are_picked_up_when_they_appear_and_are_pulled_in_their_setup(self):
        self.simulate({line: MACHINES[line][0] for line in self.lines_of})
        for line in self.lines_of:
            self.sim.ask(f"unplug {line}")
            self.sim.ask(f"reply-delay {line} 50")
        self.configure()
        self.run_gateway()
        self.client = self.operator = self.peer()
        for line in self.lines_of:
            self.gateway.wait_for(rf"warning bus {line}: .*{line}.*trying again")
            for axis in self.axes_of(line):
                self.assert_gone(axis)
        for line in self.lines_of:
            self.sim.ask(f"plug {line}")
            self.axes_of(line)[0].until(link_state=SETUP)
            self.pull(line)
            self.sim.ask(f"reply-delay {line} 0")
            self.put_back(line)
            for axis in self.axes_of(line):
                axis.command("enable")
                axis.until(axis_state=STANDSTILL)
            self.assertEqual(len(self.gateway.found(rf"bus {line}: .*trying again")), 1, "said once, not each second")


class SocatCable(Story):
    """The line is a cable between two ptys that socat made; ending socat is pulling it."""

    lines = {"far-end": "jd@1"}

    def setUp(self):
        super().setUp()
        self.simulate()
        self.cable = self.lay_cable()
        self.configure(buses=[bus(self.path("lift"), drive("jd", 1, 1))])
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        self.lift = self.axis(1)

    def lay_cable(self):
        near, far = self.path("lift"), self.path("far-end")
        cable = self.keep(Program("socat", ["socat", f"PTY,link={near},rawer", f"{far},rawer"]))
        until("socat's pty", lambda: os.path.islink(near) and os.path.exists(near))
        return cable

    def until_the_cable_is_laid_again_after(self, end_of_socat):
        end_of_socat()
        self.lift.until(link_state=LINK_DOWN)
        self.lay_cable()
        self.lift.until(link_state=ONLINE)
        self.lift.set(target_velocity=100 * RPM)
        self.lift.command("enable")
        self.lift.command("run_velocity")
        self.lift.until(axis_state=CONTINUOUS)

    def test_a_cable_that_takes_its_name_along(self):
        self.until_the_cable_is_laid_again_after(self.cable.terminate)

    def test_a_cable_whose_name_points_nowhere(self):
        def kill():
            self.cable.process.kill()
            self.cable.ended()

        self.until_the_cable_is_laid_again_after(kill)

    def test_bytes_are_lost_but_the_line_stays(self):
        # Stopped, socat passes nothing on: the drive is unresponsive, the port is still there.
        self.cable.send(signal.SIGSTOP)
        until("no answer is noticed", lambda: self.lift.get("link_state") not in (ONLINE, SUSPECT))
        self.assertNotEqual(self.lift.get("link_state"), LINK_DOWN)
        self.cable.send(signal.SIGCONT)
        self.lift.until(link_state=ONLINE)
        self.assertNotIn("enabled", self.lift.inputs())


if __name__ == "__main__":
    main()
