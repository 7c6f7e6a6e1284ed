# SPDX-License-Identifier: Apache-2.0
"""The set of deploy/compose.yaml: moved from outside, killed, restarted and unplugged while an axis moves. Run by tests/containers/run."""
import json
import os
import re
import shlex
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from engine import Cell
from container_stage import ENGINE, SOURCE, USER, patient, plain_json
from page_commands import of_page
from modbus import ACTIVE, ALARM_ADOPTED, COMPLETED, DISABLED, LINK_DOWN, ONLINE, STANDSTILL, Client, Closed, Refused, mbpoll
from processes import NEVER, until

PORT = 1502
TURN = 10000
FAR = 20000 * TURN
RPM = 1000
LIFT, FEEDER = 1, 2


class CellTest(unittest.TestCase):
    """The whole set, once for all tests of a class: each leaves it as it found it."""

    def run(self, result=None):
        before = len(result.failures) + len(result.errors)
        super().run(result)
        if len(result.failures) + len(result.errors) > before:
            for container in getattr(self, "cell", None) and self.cell.containers.values() or ():
                lines = [line[:200] for line in container.text().splitlines()]
                print(f"--- {container.name} ({self.id()})", *lines[-30:], sep="\n", file=sys.stderr)

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-cell-")
        cls.addClassCleanup(folder.cleanup)
        os.chmod(folder.name, 0o755)
        cls.config = f"{folder.name}/gateway.json"
        with open(cls.config, "w", encoding="utf-8") as file:
            json.dump(patient(plain_json(f"{SOURCE}/deploy/container/compose.json")), file)
        cls.cell = Cell(ENGINE, SOURCE, cls.config)
        cls.addClassCleanup(cls.cell.down)
        cls.cell.up()
        lines = ENGINE("volume", "inspect", "--format", "{{.Mountpoint}}", "cell_lines")
        cls.control = f"{lines}/control"
        # A set that does not come up fails once, not in each test.
        until("both axes are online", lambda: "axes online 2 of 2" in ENGINE.done(
            "exec", cls.cell.gateway.name, "/usr/bin/axisgate", "top", f"127.0.0.1:{PORT}", "--once").stdout)

    def setUp(self):
        self.client = self.connect()
        self.until_online()
        self.feeder = self.client.axis(FEEDER)

    def connect(self):
        """Through the port that the set publishes, once somebody answers there."""
        def connected():
            client = None
            try:
                client = Client(PORT)
                client.gateway()
                return client
            except Closed:
                if client:
                    client.close()
                return None

        client = until("the gateway answers", connected)
        self.addCleanup(client.close)
        return client

    def until_online(self):
        until("all axes online", lambda: (g := self.client.gateway())["axes_online"] == g["axis_count"] == 2)

    @classmethod
    def ask_simulator(cls, command):
        with socket.socket(socket.AF_UNIX) as asked:
            asked.settimeout(NEVER)
            asked.connect(cls.control)
            asked.sendall(command.encode() + b"\n")
            answer = asked.makefile().readline().rstrip("\n")
        assert answer.startswith("ok"), f"{command}: {answer}"
        return answer[3:]

    def follow(self, container):
        follower = container.follow()
        self.addCleanup(follower.clean_up)
        return follower

    def sees_position(self, follower, axis, since=0):
        """The next sample of this axis that says so."""
        return follower.sees(f"a sample of axis {axis}", lambda told: told.get("axis", told.get("data", {}).get("axis")) == axis, since)

    def start_feeder(self):
        """Far away: it is still moving when a test has done what it does."""
        self.feeder.set(profile_velocity=600 * RPM, profile_acceleration=30000, profile_deceleration=30000)
        target = self.feeder.get("position_actual") + FAR
        if self.feeder.get("position_actual") > FAR:
            target -= 2 * FAR
        self.feeder.command("enable")
        self.feeder.until(axis_state=STANDSTILL)
        self.feeder.set(target_position=target)
        self.feeder.command("move_absolute")
        self.feeder.until(motion_state=ACTIVE)
        self.assert_feeder_moves()

    def assert_feeder_moves(self):
        """As its drive has it."""
        begun = self.feeder_position()
        until("the feeder's motor turns", lambda: abs(self.feeder_position() - begun) > 100)

    def feeder_position(self):
        return int(self.ask_simulator("position feeder/1").split()[0])

    def stop_feeder(self):
        self.feeder.command("disable")
        self.feeder.until(axis_state=DISABLED)

    # What the script says.

    def test_the_script_tells_what_runs_and_starts_no_second_set(self):
        code, text = self.cell.typed("up")
        self.assertEqual(code, 1)
        self.assertRegex(text, "cell_gateway.*there already: deploy/container/cell down")
        code, text = self.cell.typed("status")
        self.assertEqual([name for name in self.cell.containers if not re.search(rf"^cell_{name} +Up ", text, re.MULTILINE)], [], text)
        code, text = self.cell.typed("logs", "simulator")
        self.assertRegex(text, "ready /lines/lift -> /terminals/[0-9]")
        self.assertNotIn("listening on", text)
        code, text = self.cell.typed("logs", "simulators")
        self.assertEqual(code, 1)
        self.assertIn("gateway", text)

    def test_the_pages_looks_show_both_axes(self):
        engine, *look = shlex.split(of_page("docs/containers.md", "podman exec cell_gateway"))
        self.assertEqual(engine, "podman")
        self.assertIn("axes online 2 of 2", ENGINE(*look))
        lift = shlex.split(of_page("docs/containers.md", "mbpoll -0"))
        until("the lift moves", lambda: len({subprocess.run(lift, capture_output=True, text=True, check=True).stdout for _ in range(2)}) == 2)

    # Seen from outside, and in other containers.

    def test_an_axis_moved_from_outside_is_a_topic_in_the_other_containers(self):
        followers = [self.follow(self.cell.subscriber), self.follow(self.cell.neighbour)]
        self.feeder.set(profile_velocity=600 * RPM, profile_acceleration=30000, profile_deceleration=30000)
        target = self.feeder.get("position_actual") + 3 * TURN
        self.feeder.command("enable")
        self.feeder.until(axis_state=STANDSTILL)
        self.feeder.set(target_position=target)
        number = self.feeder.command("move_absolute")
        self.feeder.until(motion_state=COMPLETED, motion_id=number)
        until("it is there", lambda: abs(mbpoll(PORT, "4:int", 100 * FEEDER + 2)[0] - target) <= 20)
        for follower in followers:
            # In rad, 2 pi a turn.
            follower.sees("the feeder at its target", lambda told: told.get("axis") == FEEDER
                          and abs(told["position"] / 6.283185307179586 * TURN - target) <= 20)
        mbpoll(PORT, "0", 100 * FEEDER, 0)
        self.feeder.until(axis_state=DISABLED)

    def test_the_neighbour_hears_through_memory(self):
        # What came to it as datagrams would be counted by its network.
        self.start_feeder()
        self.cell.subscriber.kill()  # whose acknowledgements are datagrams, too
        follower = self.follow(self.cell.neighbour)
        self.sees_position(follower, FEEDER)
        counted, since, samples = self.datagrams(), follower.now(), 200
        until("samples", lambda: follower.now() >= since + samples)
        self.assertLess(self.datagrams() - counted, samples / 2)
        self.cell.subscriber.start()
        self.stop_feeder()

    def datagrams(self):
        """Received in the gateway's network."""
        with open(f"/proc/{self.cell.gateway.pid()}/net/snmp", encoding="utf-8") as file:
            names, values = (line.split() for line in file if line.startswith("Udp:"))
        return int(values[names.index("InDatagrams")])

    def test_the_plc_in_its_container_moves_its_axis(self):
        lift = self.client.axis(LIFT)
        first = lift.until(motion_state=ACTIVE)["motion_id"]
        until("one move after the other", lambda: lift.get("motion_id") != first)
        with self.assertRaises(Refused):
            lift.set(target_position=0)

    # What they may do.

    def test_no_container_has_a_right_that_it_was_not_given(self):
        for container in self.cell.containers.values():
            with self.subTest(container.name):
                pid = container.pid()
                with open(f"/proc/{pid}/status", encoding="utf-8") as file:
                    status = dict(line.rstrip("\n").split(":\t", 1) for line in file if ":\t" in line)
                for which in ("CapInh", "CapPrm", "CapEff", "CapBnd", "CapAmb"):
                    self.assertEqual(int(status[which], 16), 0, which)
                self.assertEqual(status["NoNewPrivs"], "1")
                self.assertEqual(status["Uid"].split(), [str(USER)] * 4)
                with open(f"/proc/{pid}/mountinfo", encoding="utf-8") as file:
                    mounts = [line.split() for line in file]
                self.assertTrue(next(mount for mount in mounts if mount[4] == "/")[5].startswith("ro"), "the root can be written")
                devices = {name for name in os.listdir(f"/proc/{pid}/root/dev")}
                self.assertLessEqual(devices, {"console", "core", "fd", "full", "mqueue", "null", "ptmx", "pts", "random", "shm", "stderr", "stdin",
                                               "stdout", "tty", "urandom", "zero"})

    def test_healthy_is_a_gateway_that_answers(self):
        gateway = self.cell.gateway
        until("healthy", gateway.healthy)
        self.cell.simulator.kill()
        self.feeder.until(link_state=LINK_DOWN)
        self.assertTrue(gateway.healthy(), "a dead drive is no reason to start the gateway anew")
        os.kill(gateway.pid(), signal.SIGSTOP)
        self.assertFalse(gateway.healthy(), "one that does not answer is not healthy")
        os.kill(gateway.pid(), signal.SIGCONT)
        until("healthy again", gateway.healthy)
        self.cell.simulator.start()
        self.until_online()
        self.plc_again()

    # Killed while an axis moves.

    def plc_again(self):
        """The program enables its axis at its start alone."""
        self.cell.plc.kill()
        lift = self.client.axis(LIFT)
        until("its lease has run out", lambda: lift.get("owner") == 0)
        self.cell.plc.start()
        lift.until(motion_state=ACTIVE)

    def test_a_killed_subscriber_costs_nothing_and_sees_again(self):
        self.start_feeder()
        for container in (self.cell.subscriber, self.cell.neighbour):
            container.kill()
            self.assert_feeder_moves()
            container.start()
            self.sees_position(self.follow(container), FEEDER, since=1)
        self.assertEqual(self.feeder.get("motion_state"), ACTIVE)
        self.stop_feeder()

    def test_a_killed_plc_has_its_axis_stopped_and_no_other(self):
        self.start_feeder()
        lift = self.client.axis(LIFT)
        lift.until(motion_state=ACTIVE)
        self.cell.plc.kill()
        until("its axis is stopped", lambda: (block := lift.block())["owner"] == 0 and block["motion_state"] != ACTIVE
              and block["velocity_actual"] == 0)
        self.assert_feeder_moves()
        self.cell.plc.start()
        lift.until(motion_state=ACTIVE)
        self.assertEqual(self.feeder.get("motion_state"), ACTIVE)
        self.stop_feeder()

    def test_a_killed_gateway_finds_the_moving_axis_and_can_stop_it(self):
        self.start_feeder()
        self.cell.gateway.kill()
        self.assert_feeder_moves()
        self.cell.gateway.start()
        self.cell.neighbour.kill()  # its network and memory were those of the gateway that is gone
        self.cell.neighbour.start()
        self.setUp()
        self.assertTrue(self.feeder.until(link_state=ONLINE)["axis_alarms"] & ALARM_ADOPTED)
        self.assert_feeder_moves()
        self.stop_feeder()
        for container in (self.cell.subscriber, self.cell.neighbour):
            follower = self.follow(container)
            self.sees_position(follower, FEEDER, follower.now())
        self.plc_again()

    def test_a_stopped_gateway_ends_on_purpose(self):
        self.assertEqual(self.cell.gateway.stop(), 0)
        self.assertRegex(self.cell.gateway.text(), "signal 15: ending")
        begun = time.monotonic()
        self.cell.gateway.start()
        self.setUp()
        print(f"from podman start to both axes online: {1000 * (time.monotonic() - begun):.0f} ms", file=sys.stderr)
        self.cell.neighbour.kill()
        self.cell.neighbour.start()
        self.plc_again()

    def test_killed_drives_are_told_and_come_back_disabled(self):
        self.start_feeder()
        self.cell.simulator.kill()
        self.feeder.until(link_state=LINK_DOWN)
        self.assertTrue(self.cell.gateway.running())
        self.cell.simulator.start()
        self.feeder.until(link_state=ONLINE, axis_state=DISABLED)
        self.until_online()
        self.start_feeder()
        self.stop_feeder()
        self.plc_again()

    def test_a_pulled_device_comes_back_with_its_axis_as_it_was(self):
        self.start_feeder()
        self.ask_simulator("unplug feeder")
        self.feeder.until(link_state=LINK_DOWN)
        self.assert_feeder_moves()
        self.ask_simulator("plug feeder")
        self.feeder.until(link_state=ONLINE)
        self.assert_feeder_moves()
        self.stop_feeder()

    def child_of_gateway(self, name):
        gateway = self.cell.gateway.pid()
        with open(f"/proc/{gateway}/task/{gateway}/children", encoding="utf-8") as file:
            children = [int(pid) for pid in file.read().split()]
        return next(pid for pid in children if os.path.basename(os.readlink(f"/proc/{pid}/exe")) == name)

    def test_a_crash_of_the_topics_process_costs_topics_alone(self):
        self.start_feeder()
        follower = self.follow(self.cell.subscriber)
        os.kill(self.child_of_gateway("axisgate-dds"), signal.SIGKILL)
        self.cell.gateway.says("axisgate-dds .*(ended|killed|signal)")
        self.sees_position(follower, FEEDER, follower.now())
        self.assert_feeder_moves()
        self.assertEqual(self.feeder.get("motion_state"), ACTIVE)
        self.stop_feeder()
