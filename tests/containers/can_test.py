# SPDX-License-Identifier: Apache-2.0
"""A gateway with the file system of its image, the user of its image and a network of its own, into which a CAN interface is moved.

Containers share the kernel, so this runs in a kernel that has CAN (tests/vcan/in_guest), where podman does not run: namespaces, the
user and the read-only root are made here as the engine makes them.
can_test.py ROOT_OF_THE_IMAGE AXISGATE_SIM SOURCE_FOLDER [unittest's arguments]
"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

ROOT, SIMULATOR, SOURCE = (os.path.abspath(path) for path in sys.argv[1:4])
sys.path[:0] = [f"{SOURCE}/tests/integration", f"{SOURCE}/tests/docs"]

from pymodbus.client import ModbusTcpClient  # noqa: E402

from modbus import COMPLETED, LINK_DOWN, ONLINE, STANDSTILL, Client  # noqa: E402
from page_commands import of_page  # noqa: E402
from processes import NEVER, Program, until  # noqa: E402

USER = 10001
INSIDE, OUTSIDE = "10.99.0.2", "10.99.0.1"
TURN = 10000
NETWORK = "axisgate-cell"


def run(*words):
    subprocess.run(words, check=True)


class FromOutside(Client):
    """Not on loopback, which each network has for itself."""

    def __init__(self):  # pylint: disable=super-init-not-called
        self.unit = 1
        self.tcp = ModbusTcpClient(INSIDE, port=1502, timeout=NEVER, retries=0)
        assert self.tcp.connect()


class CanInAContainer(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        run("mount", "-t", "tmpfs", "tmpfs", f"{ROOT}/etc/axisgate")
        self.addCleanup(run, "umount", f"{ROOT}/etc/axisgate")
        with open(f"{ROOT}/etc/axisgate/gateway.json", "w", encoding="utf-8") as file:
            json.dump({"modbus_tcp": [{"listen": "0.0.0.0:1502", "start_deadline_ms": 60000, "reply_deadline_ms": 60000,
                                       "allow": [{"from": "127.0.0.1", "role": "viewer"}, {"from": OUTSIDE, "role": "operator"}]}],
                       "buses": [{"name": "press", "adapter": "canopen", "device": "can0", "bitrate": 500000, "timeout_ms": 1000, "drives": [
                           {"profile": "leadshine-ld2-can", "node": 1, "axes": [{"axis": 1, "name": "press", "lease": None}]}]}]}, file)
        run("ip", "netns", "add", NETWORK)
        self.addCleanup(run, "ip", "netns", "del", NETWORK)
        run("ip", "link", "add", "cell-out", "type", "veth", "peer", "name", "eth0", "netns", NETWORK)
        run("ip", "address", "add", f"{OUTSIDE}/24", "dev", "cell-out")
        run("ip", "link", "set", "cell-out", "up")
        for words in (["address", "add", f"{INSIDE}/24", "dev", "eth0"], ["link", "set", "eth0", "up"], ["link", "set", "lo", "up"]):
            run("ip", "-n", NETWORK, *words)
        # A cable with the drives at one end.
        run("ip", "link", "add", "can-drives", "type", "vxcan", "peer", "name", "can-gateway")
        run("ip", "link", "set", "can-drives", "up")
        self.simulator = self.keep(Program("axisgate-sim", [SIMULATOR, "--line", "can-drives:can:ld2@1", "--control", f"{self.folder}/control"]))
        self.simulator.wait_for("^control ")
        self.gateway = self.start_gateway()

    def keep(self, program):
        self.addCleanup(program.clean_up)
        return program

    def start_gateway(self):
        return self.keep(Program("axisgate", ["ip", "netns", "exec", NETWORK, "setpriv", "--no-new-privs", "chroot", f"--userspec={USER}:{USER}", ROOT,
                                              "/usr/bin/axisgate", "run", "/etc/axisgate/gateway.json"]))

    def test_an_interface_that_is_moved_in_is_used_without_any_right(self):
        gateway = self.gateway
        gateway.wait_for("listening on")
        client = FromOutside()
        self.addCleanup(client.close)
        axis = client.axis(1)
        axis.until(link_state=LINK_DOWN)
        with open(f"/proc/{gateway.pid}/status", encoding="utf-8") as file:
            status = dict(line.rstrip("\n").split(":\t", 1) for line in file if ":\t" in line)
        self.assertEqual((int(status["CapEff"], 16), status["Uid"].split()[0]), (0, str(USER)))
        # Granted: it is this network's alone from now on.
        moved = of_page("docs/containers.md", "ip link set can0 netns").replace("can0", "can-gateway").replace("NAME", NETWORK)
        run(*moved.split(), "name", "can0")
        run("ip", "-n", NETWORK, "link", "set", "can0", "up")
        axis.until(link_state=ONLINE)
        axis.set(profile_velocity=600 * 1000, profile_acceleration=30000, profile_deceleration=30000)
        target = axis.get("position_actual") + TURN
        axis.command("enable")
        axis.until(axis_state=STANDSTILL)
        axis.set(target_position=target)
        number = axis.command("move_absolute")
        axis.until(motion_state=COMPLETED, motion_id=number)
        until("it is there", lambda: abs(axis.get("position_actual") - target) <= 20)
        # Taken away, and given back.
        run("ip", "-n", NETWORK, "link", "set", "can0", "down")
        axis.until(link_state=LINK_DOWN)
        run("ip", "-n", NETWORK, "link", "set", "can0", "up")
        axis.until(link_state=ONLINE)
        axis.command("disable")
        self.assertEqual(gateway.terminate(), 0)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
