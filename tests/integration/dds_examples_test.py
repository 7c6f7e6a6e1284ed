# SPDX-License-Identifier: Apache-2.0
"""The example writers of deploy/examples/dds, as a user calls them: the axis is enabled, moves, is kept and is let go."""
import math
import os
import signal

from dds_stage import PEERS, DdsStory, main
from processes import Program, until

CYCLONE_HERE = "<General><Interfaces><NetworkInterface address='127.0.0.1'/></Interfaces><AllowMulticast>false</AllowMulticast></General>" \
    "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>20</MaxAutoParticipantIndex>" \
    "<Peers><Peer address='127.0.0.1'/></Peers></Discovery>"

EXAMPLES = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "deploy", "examples", "dds")
DONE = "result (2,|21, detail 0x2$)"  # 21: the first reply was lost, and it was so


class Writers(DdsStory):
    lines_of = ("serial",)
    gateway_name = "cell_7"

    def setUp(self):
        super().setUp()
        self.begin()

    def position(self):
        return self.registers(1)["position_actual"] / 10000 * 2 * math.pi

    def test_each_is_short(self):
        for name in ("command_fastdds.cpp", "command_cyclonedds.c"):
            with open(os.path.join(EXAMPLES, name), encoding="utf-8") as source:
                self.assertLess(len(source.readlines()), 100, name)

    def test_each_moves_its_axis_and_lets_it_go(self):
        for turn, vendor in enumerate(("fastdds", "cyclonedds"), 1):
            self.at = vendor
            target = 3.0 * turn
            program = self.keep(Program(f"command_{vendor}", [
                "env", f"CYCLONEDDS_URI={CYCLONE_HERE}", os.path.join(PEERS, f"command_{vendor}"), str(self.domain), "cell_7", "1", str(target)]))
            program.wait_for(f"command 1: {DONE}")
            program.wait_for(f"command 6: {DONE}")
            until("it is there", lambda target=target: abs(self.position() - target) < 0.005)
            self.assertIn("enabled", self.watched(1).inputs())
            program.send(signal.SIGINT)
            self.assertEqual(program.ended(), 0, program.text())
            program.wait_for(f"command 2: {DONE}")
            until("it is disabled", lambda: "enabled" not in self.watched(1).inputs())
        self.at = None


class Death(DdsStory):
    lines_of = ("serial",)
    gateway_name = "cell_7"
    lease = {"timeout_ms": 10000}

    def test_its_axis_is_stopped(self):
        self.begin()
        program = self.keep(Program("command_fastdds", [os.path.join(PEERS, "command_fastdds"), str(self.domain), "cell_7", "1", "9000"]))
        program.wait_for("command 6: result")
        self.until_it_turns(1)
        program.process.kill()
        until("it is stopped", lambda: "stop_latched" in self.watched(1).inputs())
        self.until_it_stands(1)


if __name__ == "__main__":
    main()
