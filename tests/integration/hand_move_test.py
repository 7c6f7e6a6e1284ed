# SPDX-License-Identifier: Apache-2.0
"""`axisgate enable`, `move` and `stop`: what they show, how they end, and that the motor stands whatever became of them. What they say
and refuse is told by ByHand, Speed and ManualView of tests/unit/commands."""
import re
import signal
import subprocess

from hand_stage import CTRL_C, Hand
from lease_stage import ME, NOBODY, PANEL_1
from modbus import Axis
from processes import NEVER, until
from stage import AXISGATE, main

FAR = 1000  # turns: minutes away


class Moves(Hand):
    def test_it_goes_there_and_gives_back_an_axis_without_torque(self):
        for number in self.each():
            ended = self.hand("move", number, 2.5, "--velocity", 300, "--enable")
            self.assertEqual(ended.returncode, 0, ended.stderr)
            self.assertRegex(ended.stdout, rf"\nreached: axis {number}  2\.5000 turns  0\.0 rpm")
            self.assertEqual(self.watched(number).get("position_actual"), 25000)
            self.assert_disabled(number)
            name = self.motors[number][0]
            ended = self.by_name("move", name, "-1.5", "--relative", "--enable")
            self.assertEqual(ended.returncode, 0, ended.stderr)
            self.assertTrue(ended.stdout.startswith(f'axis {number} "{name}" at {self.address}\n'), ended.stdout)
            self.assertEqual(self.watched(number).get("position_actual"), 10000)
            block = self.watched(number).block()
            self.assertEqual(block["owner"], NOBODY)
            self.assertNotIn("stop_latched", self.watched(number).inputs(), "nothing had to be stopped")
        for number in self.each():
            self.assertEqual(self.by_name("stop", self.motors[number][0][:-1]).returncode, 1, "a part of a name is none")
            self.assertNotIn("stop_latched", self.watched(number).inputs())
            self.assertEqual(self.by_name("stop", self.motors[number][0]).returncode, 0)
            self.assertIn("stop_latched", self.watched(number).inputs())

    def by_name(self, command, name, *rest):
        """The gateway is found by its configuration."""
        return self.command_line(command, name, *rest, "--config", self.config)

    def test_a_terminal_shows_the_position_live(self):
        program = self.on_terminal("move", 1, 20, "--velocity", 600, "--enable")
        self.assertEqual(program.ended(), 0, program.text())
        positions = [float(found) for found in re.findall(r"\raxis 1  (-?\d+\.\d{4}) turns", program.text())]
        self.assertGreater(len(set(positions)), 5, program.text())
        self.assertEqual(positions, sorted(positions))
        self.assertRegex(program.text(), r"discrete motion  to 20 turns; Ctrl-C stops")
        self.assertRegex(program.text(), r"reached: axis 1  20\.0000 turns")


class SomebodyElse(Hand):
    def test_an_axis_that_somebody_owns_is_left_alone_and_he_is_named(self):
        panel = self.peer(PANEL_1)
        self.enable(Axis(panel, 1))
        for arguments in (("move", 1, 1, "--enable"), ("enable", 1)):
            ended = self.hand(*arguments)
            self.assertEqual(ended.returncode, 1)
            self.assertIn(f"axis 1 is owned by {PANEL_1}", ended.stderr)
        self.assertEqual(Axis(panel, 1).get("owner"), ME)
        self.assertIn("enabled", Axis(panel, 1).inputs())

    def test_another_clients_stop_ends_the_move_and_is_told(self):
        program = self.on_terminal("move", 1, FAR, "--velocity", 300, "--enable")
        self.until_it_turns(1)
        Axis(self.peer(PANEL_1), 1).coil("quick_stop")
        self.assertEqual(program.ended(), 1)
        self.assertRegex(program.text(), "axis 1 was stopped|the move of axis 1 was aborted")
        self.assert_disabled(1)


class Held(Hand):
    lease = {"timeout_ms": 3000, "renew": "heartbeat"}

    def test_enable_holds_the_axis_until_ctrl_c(self):
        program = self.on_terminal("enable", 1)
        program.wait_for("held; Ctrl-C disables it")
        self.let_pass(1.5 * self.lease["timeout_ms"] / 1000)
        self.assertIn("enabled", self.watched(1).inputs())
        program.press(CTRL_C)
        self.assertEqual(program.ended(), 0, program.text())
        self.assertIn("Ctrl-C: axis 1 is disabled", program.text())
        self.assert_disabled(1)
        self.assertNotIn("stop_latched", self.watched(1).inputs(), "it stood: nothing had to be stopped")
        self.assertEqual(self.watched(1).get("owner"), NOBODY)


class ItEnds(Hand):
    """In every way: the motor stands, without torque, before the command has ended."""

    def moving(self, number, **options):
        program = self.on_terminal("move", number, FAR, "--velocity", 300, "--enable", **options)
        self.until_it_turns(number)
        program.wait_for("Ctrl-C stops")
        return program

    def test_by_ctrl_c_and_by_signals(self):
        for number in self.each():
            for end in (None, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT):
                program = self.moving(number)
                if end is None:
                    program.press(CTRL_C)
                else:
                    program.process.send_signal(end)
                self.assertEqual(program.ended(), 1, program.text())
                self.assertEqual(self.speed(number), 0)
                self.assertIn(f"axis {number} is stopped", program.text())
                self.assert_disabled(number)

    def test_by_a_terminal_that_is_closed(self):
        for number in self.each():
            program = self.moving(number)
            program.hang_up()
            self.assertEqual(program.ended(), 1)
            self.assertEqual(self.speed(number), 0)
            self.assert_disabled(number)

    def test_by_a_reader_that_is_gone(self):
        for number in self.each():
            command = [AXISGATE, "move", self.address, str(number), str(FAR), "--velocity", "300", "--enable"]
            process = subprocess.Popen(command, stdout=subprocess.PIPE, stdin=subprocess.DEVNULL)
            self.until_it_turns(number)
            process.stdout.close()
            self.assertEqual(process.wait(timeout=NEVER), 1)
            self.assertEqual(self.speed(number), 0)
            self.assert_disabled(number)

    def test_a_motor_that_takes_its_time_is_waited_for_and_twice_ctrl_c_is_not(self):
        program = self.moving(1)
        self.sim.ask("reply-delay serial 900")  # each answer of the drive
        program.press(CTRL_C)
        program.wait_for("quick stop")
        program.press(CTRL_C)
        self.assertEqual(program.ended(), 1)
        self.assertIn("ended at once, without waiting", program.text())
        self.sim.ask("reply-delay serial 0")
        self.until_it_stands(1)


class ItDies(Hand):
    lease = {"timeout_ms": 1500}

    def assert_its_lease_stopped_it(self, number):
        self.assert_stopped_for_good(number)
        self.assert_it_can_be_had_again(number)

    def test_killed_it_leaves_a_lease_that_stops_the_motor(self):
        for number in self.each():
            program = self.on_terminal("move", number, FAR, "--velocity", 300, "--enable")
            self.until_it_turns(number)
            program.process.kill()
            self.assert_its_lease_stopped_it(number)

    def test_a_relay_that_is_killed_and_a_network_that_says_nothing(self):
        for end in ("kill", "cut"):
            for number in self.each():
                network = self.network()
                program = self.on_terminal("move", number, FAR, "--velocity", 300, "--enable", address=network.address)
                self.until_it_turns(number)
                getattr(network, end)()
                self.assert_its_lease_stopped_it(number)
                self.assertEqual(program.ended(), 1)
                said = program.text()
                self.assertRegex(said, r"the gateway is out of reach \(.*\)")
                self.assertRegex(said, rf"if only the network has failed: axis {number} is stopped as its lease says, within 1\d\d\d ms")

    def test_a_gateway_that_is_killed_stops_nothing_and_the_tool_does_not_say_so(self):
        program = self.on_terminal("move", 1, FAR, "--velocity", 300, "--enable")
        program.wait_for("if the gateway dies it GOES ON: keep its wired stop in reach")
        self.until_it_turns(1)
        self.gateway.send(signal.SIGKILL)
        self.assertEqual(self.gateway.ended(), -signal.SIGKILL)
        self.assertEqual(program.ended(), 1)
        self.assertIn("if the gateway has died: axis 1 GOES ON: use its wired stop", program.text())
        self.assertNotEqual(self.speed(1), 0, "and so it does")


class WhatCannotBe(Hand):
    lines_of = ("serial",)

    def test_an_axis_that_is_not_there_and_a_gateway_that_is_not_there(self):
        for arguments in (("stop", 77), ("enable", 77), ("move", 77, 1)):
            ended = self.hand(*arguments)
            self.assertEqual(ended.returncode, 1)
            # A stop does not wait for what else is known: the gateway's own answer may come first.
            self.assertRegex(ended.stderr, "no axis 77" if arguments[0] != "stop" else "no axis 77|illegal data address")
        ended = self.command_line("stop", "127.0.0.1:1", "1")
        self.assertEqual(ended.returncode, 1)
        self.assertIn("Connection refused", ended.stderr)

    def test_a_drive_that_is_out_of_reach(self):
        self.sim.ask("unresponsive serial/1 on")
        until("it is offline", lambda: self.watched(1).get("link_state") > 3)
        ended = self.hand("move", 1, 1, "--enable")
        self.assertEqual(ended.returncode, 1)
        self.assertIn("axis 1 is out of reach (link offline): nothing was sent", ended.stderr)
        ended = self.hand("stop", 1)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("it is owed, and carried out as soon as the drive is back", ended.stderr)

    def test_a_fault_is_named(self):
        self.sim.ask("fault serial/1 2601 0x0008")
        self.watched(1).until_input("fault")
        ended = self.hand("enable", 1)
        self.assertEqual(ended.returncode, 1)
        self.assertRegex(ended.stderr, r"axis 1 has a fault, error_code (0x[0-9A-F]{4}): axisgate explain \1; command 5 resets it")


class Viewers(Hand):
    lines_of = ("serial",)
    allow = [{"from": "127.0.0.1", "role": "viewer"}, {"from": "127.0.0.9", "role": "viewer"}]

    def test_a_viewer_is_told_who_gives_him_the_right(self):
        for arguments in (("stop", 1), ("enable", 1)):
            ended = self.hand(*arguments)
            self.assertEqual(ended.returncode, 1)
            self.assertIn("this computer is a viewer here: the gateway's key \"allow\"", ended.stderr)


if __name__ == "__main__":
    main()
