# SPDX-License-Identifier: Apache-2.0
"""The examples of deploy/examples/dds, called as their page has it: writers enable the axis, move it, keep it and let it go; readers show it."""
import math
import os
import shlex
import signal
import subprocess
import sys

from dds_stage import PEERS, DdsStory, main
from processes import Program, until
from stage import AXISGATE, SOURCE

sys.path.insert(0, f"{SOURCE}/tests/docs")
from page_commands import of_page  # noqa: E402

EXAMPLES = f"{SOURCE}/deploy/examples/dds"
CYCLONE_HERE = shlex.split(of_page("deploy/examples/dds/README.md", "export CYCLONEDDS_URI="))[1]
DONE = "result (2,|21, detail 0x2$)"  # 21: the first reply was lost, and it was so


class OfExamples(DdsStory):
    lines_of = ("serial",)
    gateway_name = "cell_7"

    def example(self, words):
        return self.keep(Program(words[0], ["env", CYCLONE_HERE, f"{PEERS}/{os.path.basename(words[0])}", *words[1:]]))

    def command(self, vendor, target):
        name, domain, gateway, axis, position = shlex.split(of_page("deploy/examples/dds/README.md", "build/command_fastdds"))
        self.assertEqual((domain, gateway, axis, position), ("0", "", "1", "6.28"))
        return self.example([name.replace("fastdds", vendor), str(self.domain), self.gateway_name, axis, str(target)])


class Readers(OfExamples):
    def test_each_shows_the_axis(self):
        self.begin()
        for command in (of_page("deploy/examples/dds/README.md", "build/axes_fastdds"), of_page("deploy/examples/dds/README.md", "build/axes_cyclonedds")):
            name, domain = command.split()
            self.assertEqual(domain, "0")
            self.example([name, str(self.domain)]).wait_for("^cell_7 axis 1 serial  link 2 ")

    def test_lines_of_json_are_for_any_language(self):
        self.begin()
        here = f"topics --json --once --domain {self.domain}"
        command = of_page("deploy/examples/dds/README.md", "axisgate-dds topics --json |").replace("topics --json", here, 1)
        path = {**os.environ, "PATH": f"{os.path.dirname(AXISGATE)}:{os.environ['PATH']}"}
        until("the axis is shown", lambda: "1 serial" in subprocess.run(["bash", "-c", command], env=path, capture_output=True, text=True, check=True).stdout)


class Writers(OfExamples):
    def setUp(self):
        super().setUp()
        self.begin()

    def position(self):
        return self.registers(1)["position_actual"] / 10000 * 2 * math.pi

    def test_each_is_short(self):
        for name in ("command_fastdds.cpp", "command_cyclonedds.c"):
            with open(os.path.join(EXAMPLES, name), encoding="utf-8") as source:
                self.assertLess(len(source.readlines()), 105, name)

    def test_each_moves_its_axis_and_lets_it_go(self):
        for turn, vendor in enumerate(("fastdds", "cyclonedds"), 1):
            self.at = vendor
            target = 3.0 * turn
            program = self.command(vendor, target)
            program.wait_for(f"command 1: {DONE}")
            program.wait_for(f"command 6: {DONE}")
            until("it is there", lambda target=target: abs(self.position() - target) < 0.005)
            self.assertIn("enabled", self.watched(1).inputs())
            program.send(signal.SIGINT)
            self.assertEqual(program.ended(), 0, program.text())
            program.wait_for(f"command 2: {DONE}")
            until("it is disabled", lambda: "enabled" not in self.watched(1).inputs())
        self.at = None


    def test_one_that_is_refused_leaves_the_owners_motor_alone(self):
        """A disable is heard from everybody: one behind a refused enable would stop the motor of whoever owns it."""
        for owner, other in (("fastdds", "cyclonedds"), ("cyclonedds", "fastdds")):
            first = self.command(owner, 3.0)
            first.wait_for(f"command 6: {DONE}")
            second = self.command(other, -3.0)
            self.assertEqual(second.ended(), 1, second.text())
            second.wait_for("command 1: result (7,|21, detail 0x7$)")
            self.assertNotIn("command 2", second.text())
            self.assertIn("enabled", self.watched(1).inputs())
            first.send(signal.SIGINT)
            self.assertEqual(first.ended(), 0, first.text())


class Death(OfExamples):
    lease = {"timeout_ms": 10000}

    def test_its_axis_is_stopped(self):
        self.begin()
        program = self.command("fastdds", 9000)
        program.wait_for("command 6: result")
        self.until_it_turns(1)
        program.process.kill()
        until("it is stopped", lambda: "stop_latched" in self.watched(1).inputs())
        self.until_it_stands(1)


if __name__ == "__main__":
    main()
