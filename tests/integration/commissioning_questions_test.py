# SPDX-License-Identifier: Apache-2.0
"""Somebody commissions a drive: one question for each finding, the bus goes on meanwhile, and only what was agreed to is written."""
import os
import subprocess

from can_stage import CanStory
from processes import Program, until
from stage import AXISGATE, Story, bus, drive, main

# What decides over the bus on a JD, and the store command.
SETTINGS = ["2010.03", "2010.04", "2010.05", "2010.06", "2010.07", "2010.08", "2010.09", "2010.1D", "2FF0.01"]


class Typist:
    """Commissioning with somebody at its terminal, who reads each question before the answer. A drive in the factory's state is
    asked about DIN1, DIN3 and its limit inputs, in this order."""

    FACTORY = {"2010.03": 1, "2010.05": 4, "2010.07": 0x10, "2010.08": 0x20}

    def sit_down(self, axis=1, **options):
        options.setdefault("stdin", subprocess.PIPE)
        self.desk = self.keep(Program("axisgate commission", [AXISGATE, "commission", self.config, str(axis)], **options))
        return self.desk

    def is_asked(self, number, about):
        """The question is the last thing printed before the answer is waited for."""
        self.desk.wait_for(f"question {number} of [0-9]+: {about}")

    def answers(self, *lines):
        for line in lines:
            self.desk.process.stdin.write(line + "\n")
        self.desk.process.stdin.flush()

    def ends(self, code):
        self.assertEqual(self.desk.ended(), code, self.desk.text())
        if self.desk.process.stdin:
            self.desk.process.stdin.close()

    def settings(self):
        return {address: self.sim.object("lift/1", address) for address in self.FACTORY}

    def until_the_bus_went_on(self, line="lift", requests=100):
        def heard():
            return int(self.sim.ask(f"exchanges {line}"))

        before = heard()
        until("the bus goes on", lambda: heard() >= before + requests)


class OneQuestionForEachFinding(Typist, Story):
    lines = {"lift": "jd@1+fresh"}

    def buses(self):
        return [bus(self.path("lift"), drive("jd", 1, 1))]

    def setUp(self):
        super().setUp()
        self.simulate()
        self.configure()
        self.assertEqual(self.settings(), self.FACTORY)

    def test_the_bus_goes_on_while_the_person_thinks(self):
        self.sit_down()
        for number, about in ((1, "din1_local_control"), (2, "din3_local_control"), (3, "limit_inputs_open")):
            self.is_asked(number, about)
            self.until_the_bus_went_on()
            self.answers("yes")
        self.ends(0)

    def test_a_drive_that_was_enabled_behind_the_prompt_is_not_written(self):
        self.sit_down()
        self.is_asked(1, "din1_local_control")
        before = self.sim.writes("lift/1", *SETTINGS)
        self.sim.ask("input lift/1 1 on")  # DIN1 has the function drive enable
        until("it has torque", lambda: "operation" in self.sim.state("lift/1"))
        self.answers("yes", "no", "no")
        self.ends(1)
        self.assertTrue(self.desk.found("not written: axis 1 is enabled"), self.desk.text())
        self.assertEqual(self.settings(), self.FACTORY)
        self.assertEqual(self.sim.writes("lift/1", *SETTINGS), before)

    def test_the_end_of_the_input_is_a_no_to_all_that_is_left(self):
        self.sit_down()
        self.is_asked(1, "din1_local_control")
        self.answers("yes")
        self.is_asked(2, "din3_local_control")
        self.desk.process.stdin.close()
        self.assertEqual(self.desk.ended(), 1)
        self.assertFalse(self.desk.found("question 3"))
        self.assertEqual(self.settings(), self.FACTORY | {"2010.03": 0})

    def test_nobody_at_the_terminal_is_a_no(self):
        self.sit_down(stdin=subprocess.DEVNULL)
        self.ends(1)
        self.assertTrue(self.desk.found("nothing was written"))
        self.sit_down(stdin=None, preexec_fn=lambda: os.close(0))
        self.ends(1)
        self.assertEqual(self.settings(), self.FACTORY)

    def test_on_a_terminal_a_yes_typed_before_the_question_is_none(self):
        keyboard, terminal = os.openpty()
        self.addCleanup(os.close, keyboard)
        self.sit_down(stdin=terminal)
        self.is_asked(1, "din1_local_control")
        self.until_the_bus_went_on()
        os.write(keyboard, b"yes\nyes\nyes\n")
        self.is_asked(2, "din3_local_control")
        self.until_the_bus_went_on()
        self.assertFalse(self.desk.found("question 3"))
        self.assertTrue(os.get_blocking(terminal), "the shell's terminal is left as it was")
        os.write(keyboard, b"no\n")
        self.is_asked(3, "limit_inputs_open")
        self.until_the_bus_went_on()
        os.write(keyboard, b"\x04")  # end of input
        self.ends(1)
        os.close(terminal)
        self.assertEqual(self.settings(), self.FACTORY | {"2010.03": 0})


class AHeartbeatAtThePrompt(Typist, CanStory):
    """The drives of the bus expect the gateway's heartbeat or guarding, and fault without it."""

    drives_on = {"cell": "ld2@1,jd@2+fresh,md@3"}

    def assert_no_fault(self):
        for node in (1, 2, 3):
            self.assertNotIn("fault", self.ask("transitions DRIVE", node))

    def test_it_goes_on_and_no_drive_faults(self):
        self.simulate()
        self.configure()
        self.ask("set DRIVE 605A.00 0", 1)
        self.ask("set DRIVE 605E.00 2", 1)
        for axis, about, address, value in ((1, "quick_stop_option", "605A.00", 2), (2, "din1_local_control", "2010.03", 0)):
            self.sit_down(axis)
            self.is_asked(1, about)
            self.until_the_bus_went_on(self.wire("cell"))
            self.assert_no_fault()
            self.answers("yes")
            until("it is written", lambda node=axis, at=address, to=value: self.sim.object(self.node(node), at) == to)
            self.desk.process.stdin.close()
            self.desk.ended()
            self.assertTrue(self.desk.found(f"{about}: reads as it should"), self.desk.text())


if __name__ == "__main__":
    main()
