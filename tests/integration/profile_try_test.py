# SPDX-License-Identifier: Apache-2.0
"""A profile is tried beside its motor: one that is right, one that is wrong, and a person who changes his mind."""
import json
import re
import signal

from hand_stage import CTRL_C, OnTerminal
from processes import until
from stage import AXISGATE, DRIVES, Story, drive, main

DRIVES["ld2"] = ("leadshine-ld2-can", {})
TURN = 10000
# What asks: the word it wants, a yes or no, or a turn of the shaft.
PROMPT = re.compile(r'type "([^"]*)" to go on|(\? yes or no;)|(press Enter; "skip")')
STEPS = ["read", "setup", "turn", "torque", "moves", "stops", "loss", "home"]
SETUP_WRITES = ["1016.01", "1017.00", "1800.01", "1A00.00"]


class Trying(Story):
    lines = {"cell": "lawicel:ld2@1"}
    drive_name = "cell/1"

    def buses(self):
        return [{"name": "cell", "adapter": "canopen", "device": f"slcan:{self.path('cell')}", "bitrate": 500000, "timeout_ms": 1000,
                 "drives": [self.drive()]}]

    def drive(self):
        return drive("ld2", 1, 1)

    def setUp(self):
        super().setUp()
        self.simulate()
        self.configure()
        self.report_file = self.path("report.json")
        self.answered = 0

    def run_try(self, *options):
        self.program = OnTerminal([AXISGATE, "profile", "try", self.config, "1", "--report", self.report_file, *options])
        self.program.name = "axisgate profile try"
        return self.keep(self.program)

    def shown(self, since=0):
        return " ".join(self.program.text()[since:].split())

    def asked(self):
        """The next prompt that nobody has answered; None where it has ended."""
        def look():
            return PROMPT.search(self.shown(self.answered)) or self.program.process.poll() is not None
        found = until("it asks, or ends", look)
        return None if found is True else found

    def say(self, line):
        self.answered = len(self.program.text())
        self.program.press(line.encode() + b"\n")

    def go_on(self, last="nothing"):
        """Consents to everything before the consent `last`, and says of all that it is right."""
        while (prompt := self.asked()) is not None:
            if prompt[1] == f"1 {last}":
                return
            self.say(prompt[1] or ("yes" if prompt[2] else "skip"))

    def report(self):
        with open(self.report_file, encoding="utf-8") as file:
            return json.load(file)

    def verdicts(self):
        return {step["step"]: step["verdict"] for step in self.report()["steps"]}

    def saw(self, step):
        return "\n".join(self.report()["steps"][STEPS.index(step)]["saw"])

    def position(self):
        return int(self.sim.ask(f"position {self.drive_name}"))

    def torque(self):
        return any(word in self.sim.state(self.drive_name) for word in ("operation", "quick"))

    def assert_stands_disabled(self):
        self.assertFalse(self.torque(), self.sim.state(self.drive_name))
        until("the motor stands", lambda: self.sim.object(self.drive_name, "606C.00") == 0)


class RightProfile(Trying):
    def test_it_passes_every_step_and_leaves_the_motor_as_it_was(self):
        self.run_try()
        self.go_on()
        self.assertEqual(self.program.ended(), 0, self.program.text())
        self.assertEqual(self.verdicts(), {"read": "right", "setup": "right", "turn": "not tried", "torque": "right", "moves": "right",
                                           "stops": "right", "loss": "right", "home": "not tried"})
        self.assertIn("rpm by position", self.saw("moves"))
        self.assertRegex(self.saw("stops"), "quick_stop: it stood after")
        self.assertRegex(self.saw("loss"), "without heartbeats: it stood after")
        report = self.report()
        self.assertEqual((report["ended"], report["profile"], report["axis"]), ("", "leadshine-ld2-can", 1))
        self.assertIn("statusword", [row["name"] for row in report["objects"]])
        self.assert_stands_disabled()
        self.assertTrue(all(len(line) < 80 for line in self.program.text().splitlines()), "80 columns are enough")

    def test_dry_writes_nothing(self):
        done = self.command_line("profile", "try", self.config, "1", "--dry", "--report", self.report_file)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(self.verdicts()["read"], "right")
        self.assertIn("the setup writes", self.saw("setup"))
        self.assertEqual(self.sim.writes(self.drive_name), 0)
        self.assertEqual(self.sim.writes(self.drive_name, *SETUP_WRITES), 0)
        self.assertEqual(self.sim.ask(f"nmt {self.drive_name}"), "pre_operational")

    def test_what_moves_needs_a_terminal(self):
        done = self.command_line("profile", "try", self.config, "1", answer="1 torque\n1 moves\n")
        self.assertEqual(done.returncode, 2)
        self.assertIn("needs a terminal", done.stderr)
        self.assertEqual(self.sim.writes(self.drive_name), 0)

    def test_another_word_ends_it_before_torque(self):
        self.run_try()
        self.go_on("torque")
        self.say("torque")
        self.assertEqual(self.program.ended(), 1)
        self.assertEqual(self.sim.writes(self.drive_name, "6040.00"), 0)
        self.assertEqual(self.verdicts()["torque"], "not tried")

    def end_in_the_middle_of_a_motion(self, end):
        self.run_try()
        self.go_on("moves")
        before = self.position()
        self.say("1 moves")

        def has_turned():
            if PROMPT.search(self.shown(self.answered)):
                self.say("yes")
            return abs(self.position() - before) >= TURN // 4

        until("a quarter of a turn", has_turned)
        end()
        code = self.program.ended()
        self.assert_stands_disabled()
        self.assertLess(abs(self.position() - before), TURN)
        self.assertEqual(self.verdicts()["moves"], "not tried")
        return code

    def test_ctrl_c_in_the_middle_of_a_motion(self):
        self.assertEqual(self.end_in_the_middle_of_a_motion(lambda: self.program.press(CTRL_C)), 1)
        self.assertEqual(self.report()["ended"], "Ctrl-C")
        self.assertIn("the motor stands and has no torque", self.shown())

    def test_a_closed_terminal_in_the_middle_of_a_motion(self):
        self.end_in_the_middle_of_a_motion(self.program_hangs_up)
        self.assertIn("terminal", self.report()["ended"])

    def program_hangs_up(self):
        self.program.hang_up()

    def test_a_signal_in_the_middle_of_a_motion(self):
        self.assertEqual(self.end_in_the_middle_of_a_motion(lambda: self.program.process.send_signal(signal.SIGTERM)), 1)

    def test_a_drive_that_falls_silent_in_a_motion_is_not_said_to_stand(self):
        self.run_try()
        self.go_on("moves")
        before = self.position()
        self.say("1 moves")
        until("it turns", lambda: self.position() != before)
        self.sim.ask(f"unresponsive {self.drive_name} on")
        self.assertEqual(self.program.ended(), 1)
        self.assertIn("THE DRIVE DOES NOT ANSWER", self.shown())
        self.assertEqual(self.verdicts()["moves"], "wrong")
        self.assertLess(abs(self.position() - before), 2 * TURN)


class WrongProfile(Trying):
    """As it is written by whoever takes the unit of speed for turns a minute."""
    changes = {"units": {"speed": {"mul": ["units_per_motor_rev", 60]}}}

    def drive(self):
        with open(self.path("mine.json"), "w", encoding="utf-8") as file:
            json.dump({"profile": 1, "name": "mine", "extends": "leadshine-ld2-can", "title": "Mine", **self.changes}, file)
        return {**drive("ld2", 1, 1), "profile": self.path("mine.json")}

    def test_a_speed_unit_sixty_times_too_large_is_stopped(self):
        self.run_try()
        before = self.position()
        self.go_on("stops")
        self.assertEqual(self.program.ended(), 1, self.program.text())
        self.assertEqual(self.verdicts()["moves"], "wrong")
        self.assertRegex(self.saw("moves"), "unit")
        self.assertEqual(self.verdicts()["stops"], "not tried")
        self.assertLess(abs(self.position() - before), 3 * TURN)
        self.assert_stands_disabled()

    def test_a_drive_that_ignores_its_stop_is_disabled(self):
        self.sim.ask(f"ignore-quick-stop {self.drive_name} on")
        self.run_try()
        self.go_on("stops")
        self.assertEqual(self.program.ended(), 1, self.program.text())
        self.assert_stands_disabled()


if __name__ == "__main__":
    main()
