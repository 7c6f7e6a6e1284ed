# SPDX-License-Identifier: Apache-2.0
"""`axisgate jog`: the motor turns while a key repeats on the terminal, and for nothing else."""
import os
import signal
import termios

from hand_stage import CTRL_C, LEFT, RIGHT, Hand
from lease_stage import NOBODY, PANEL_1
from modbus import Axis
from processes import until
from stage import main


class Jogs(Hand):
    def setUp(self):
        super().setUp()
        for number in self.each():
            self.prepare(Axis(panel := self.peer(PANEL_1), number))
            Axis(panel, number).command("release")
            panel.close()

    def ready(self, number, address=None):
        program = self.on_terminal("jog", number, "--velocity", 200, "--enable", address=address)
        program.wait_for("hold an arrow key")
        return program

    def hold(self, program, number, key=RIGHT):
        """As a terminal repeats a key, until the motor turns its way. A machine that was busy for a while is a key that was let go."""
        def turns():
            program.press(key)
            return self.speed(number) * (1 if key == RIGHT else -1) > 0

        until(f"the motor of axis {number} turns", turns)

    def assert_given_back(self, program, number, code=0):
        self.assertEqual(program.ended(), code, program.text())
        self.assert_disabled(number)
        self.assertEqual(self.watched(number).get("owner"), NOBODY)


class KeysAndSilence(Jogs):
    def test_repeats_turn_it_silence_stops_it_and_q_gives_it_back(self):
        for number in self.each():
            program = self.ready(number)
            for key in (RIGHT, LEFT, b"+", b"-"):
                self.hold(program, number, RIGHT if key == b"+" else LEFT if key == b"-" else key)
                self.until_it_stands(number)
                self.assertIn("enabled", self.watched(number).inputs(), "a button that is let go is a halt")
            program.press(b"q")
            self.assert_given_back(program, number)
            self.assertIn(f"axis {number} is let go", program.text())

    def test_no_timer_presses_the_button(self):
        network = self.network()
        program = self.ready(1, network.address)
        self.assertEqual(network.presses(), 0)
        pressed = 0
        for _ in range(5):
            program.press(RIGHT)
            pressed += 1
            until("the key was a press", lambda: network.presses() == pressed)
            self.let_pass(0.7)  # longer than a button is held without a key, and than many of the program's turns
            self.assertEqual(network.presses(), pressed, "nobody pressed")
            self.until_it_stands(1)
        program.press(b"q")
        self.assert_given_back(program, 1)

    def test_the_terminal_is_left_as_it_was_found(self):
        for key, code in ((b"q", 0), (CTRL_C, 1)):
            program = self.ready(1)
            self.assertNotEqual(termios.tcgetattr(program.slave), program.modes)
            program.press(key)
            self.assertEqual(program.ended(), code)
            self.assertEqual(termios.tcgetattr(program.slave), program.modes)


class ItEnds(Jogs):
    def test_by_ctrl_c_and_by_a_signal_while_the_key_is_held(self):
        for number in self.each():
            for end in (None, signal.SIGTERM):
                program = self.ready(number)
                self.hold(program, number)
                if end is None:
                    program.press(CTRL_C)
                else:
                    program.process.send_signal(end)
                self.assert_given_back(program, number, 1)

    def test_by_a_terminal_that_is_closed(self):
        for number in self.each():
            program = self.ready(number)
            self.hold(program, number)
            program.hang_up()
            self.assert_given_back(program, number, 1)


class ItDies(Jogs):
    lease = {"timeout_ms": 1500}

    def test_killed_its_button_is_up(self):
        for number in self.each():
            program = self.ready(number)
            self.hold(program, number)
            program.process.kill()
            self.assert_stopped_for_good(number)
            self.assert_it_can_be_had_again(number)

    def test_one_that_was_stopped_presses_nothing_of_what_was_typed_meanwhile(self):
        network = self.network()
        program = self.ready(1, network.address)
        self.hold(program, 1)
        self.let_pass(0.1)  # what was typed until now is no press of later
        program.process.send_signal(signal.SIGSTOP)
        self.assert_stopped_for_good(1)
        before = network.presses()
        for _ in range(20):
            os.write(program.master, RIGHT)
        program.process.send_signal(signal.SIGCONT)
        self.assertEqual(program.ended(), 1)
        self.assertEqual(network.presses(), before)
        self.assertEqual(self.speed(1), 0)


if __name__ == "__main__":
    main()
