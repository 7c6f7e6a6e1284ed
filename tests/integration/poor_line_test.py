# SPDX-License-Identifier: Apache-2.0
"""A cable that loses or spoils each tenth answer, for days: the log stays readable."""
import re

from processes import until
from stage import Story, bus, drive, main

TIME_AND_NUMBERS = re.compile(r"^\S+ \S+ |\d+")
TIMEOUTS = 60
HANDFUL = 12  # kinds of lines; each comes once a minute, of one axis and one bus


class Lossy(Story):
    lines = {"lift": "jd@1"}

    def buses(self):
        return [bus(self.path("lift"), drive("jd", 1, 1), timeout_ms=50)]

    def trouble(self):
        counted = self.client.bus(0)
        return counted["timeouts"] + counted["bad_frames"]

    def suffer(self, fault):
        """So many answers are missed; what the log says of it."""
        self.start()
        before, lines = self.trouble(), len(self.gateway.lines)
        self.sim.ask(f"{fault} lift/1 0.1")
        until(f"{TIMEOUTS} answers are missed", lambda: self.trouble() >= before + TIMEOUTS)
        return self.gateway.lines[lines:]

    def assert_told_once_each(self, told):
        self.assertTrue([line for line in told if "link online -> suspect" in line], "the first one is told as it is")
        self.assertLessEqual(len(told), HANDFUL, "\n".join(told))
        kinds = [TIME_AND_NUMBERS.sub("", line) for line in told]
        self.assertEqual(len(kinds), len(set(kinds)), "\n".join(told))

    def test_each_tenth_answer_lost_is_a_handful_of_lines(self):
        self.assert_told_once_each(self.suffer("lose"))

    def test_each_tenth_answer_spoilt_is_a_handful_of_lines(self):
        self.assert_told_once_each(self.suffer("corrupt"))


if __name__ == "__main__":
    main()
