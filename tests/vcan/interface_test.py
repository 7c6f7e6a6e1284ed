# SPDX-License-Identifier: Apache-2.0
"""A CAN interface is taken down, removed and made anew, stops and starts again, or its queue is full, while the gateway runs.

Run as: interface_test.py AXISGATE AXISGATE_SIM SOURCE_FOLDER --vcan [unittest's arguments]
"""
import os
import random
import socket
import struct
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "integration"))
from can_stage import FAR, RPM, TURN, CanStory, ip, main  # noqa: E402
from modbus import (CONTINUOUS, DISABLED, ERROR_STOP, FAILED, LINK_DOWN, NO_PATH, ONLINE, STANDSTILL, SUSPECT)  # noqa: E402
from processes import until  # noqa: E402

BUS_OFF, RESTARTED = 0x040, 0x100
DUPLICATE_NODE = 1 << 8
MAX_BUS_OFFS = 5  # in a minute; then somebody must look at the bus


class Interface(CanStory):
    """Two buses, each on its own interface; the first has the trouble."""

    drives_on = {"cell": "ld2@1,jd@2,md@3", "other": "md@1"}

    def setUp(self):
        super().setUp()
        self.begin()
        for axis in self.axes:
            self.prepare(axis)
        self.lost, self.kept = self.axes[:3], self.axes[3]
        self.interface = self.wire("cell")

    def raw_socket(self):
        peer = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.addCleanup(peer.close)
        peer.bind((self.interface,))
        return peer

    def assert_gone(self):
        for axis in self.lost:
            axis.until(link_state=LINK_DOWN)
            block = axis.block()
            self.assertEqual((block["valid"], block["statusword"]), (0, 0))
            for name in ("enable", "move_absolute"):
                with self.refused(NO_PATH):
                    axis.command(name)
        self.assertEqual((self.client.bus(0)["link"], self.client.bus(1)["link"]), (0, 1))
        self.assert_goes_on(self.kept)
        self.assertEqual(self.client.bus(1)["timeouts"], 0)

    def assert_back(self):
        for axis in self.lost:
            axis.until(link_state=ONLINE)
            self.assertNotIn("enabled", axis.inputs())
            if "fault" in axis.inputs():  # it has missed the gateway
                self.reset(axis)
            self.targets[axis.number] = axis.get("position_actual")
            self.move(axis)
            axis.command("disable")
            axis.until(axis_state=DISABLED)
        self.assert_no_request_beside_another()

    def assert_no_request_beside_another(self):
        self.assert_one_request_at_a_time("cell", "other")


class DownAndUp(Interface):
    def test_at_rest(self):
        for count in range(1, 4):
            ip("link", "set", self.interface, "down")
            if count == 1:  # the log tells it once a minute
                self.gateway.wait_for(f"bus cell: .*{self.interface} is down: ip link set {self.interface} up")
            self.assert_gone()
            ip("link", "set", self.interface, "up")
            for axis in self.lost:
                axis.until(link_state=ONLINE)
            self.assertEqual(self.client.bus(0)["reconnects"], count)
        self.assert_back()

    def test_while_motors_run(self):
        for axis in self.lost:
            axis.command("enable")
        self.lost[0].set(target_position=FAR)
        self.lost[0].command("move_absolute")
        for axis in self.lost[1:]:
            axis.set(target_velocity=300 * RPM)
            axis.command("run_velocity")
            axis.until(axis_state=CONTINUOUS)
        self.lost[0].until_input("moving")
        self.let_heartbeats_pass()  # a gateway that was never heard is not missed
        ip("link", "set", self.interface, "down")
        self.assert_gone()
        for axis in self.lost:
            until("it notices", lambda: self.ask("state DRIVE", axis.number) == "fault")
        ip("link", "set", self.interface, "up")
        for axis in self.lost:
            axis.until(link_state=ONLINE, axis_state=ERROR_STOP, motion_state=FAILED)
        self.assert_back()

    def test_removed_and_made_anew(self):
        ip("link", "del", self.interface)
        self.gateway.wait_for(f"{self.interface} does not exist|{self.interface} is down")
        self.assert_gone()
        self.ask("unplug LINE")
        ip("link", "add", "dev", self.interface, "type", "vcan")
        ip("link", "set", self.interface, "up")
        self.ask("plug LINE")
        self.assert_back()
        self.assertEqual(self.client.bus(0)["reconnects"], 1)


class Controller(Interface):
    """Error frames, as the driver of a real controller hands them over."""

    def tell(self, classes):
        if not hasattr(self, "controller"):
            self.controller = self.raw_socket()
        self.controller.send(struct.pack("=IB3x8s", socket.CAN_ERR_FLAG | classes, 8, bytes(8)))

    def assert_back(self):
        """The drives know nothing of our controller's trouble: what they were asked before it they may still answer while the gateway
        asks anew. Hence no such request from the moment that all are online, and none at all on the other bus."""
        for axis in self.lost:
            axis.until(link_state=ONLINE)
        self.overlaps = self.ask("overlaps LINE")
        super().assert_back()

    def assert_no_request_beside_another(self):
        self.assertEqual(self.ask("overlaps LINE"), self.overlaps, "requests were on the bus at the same time")
        self.assert_one_request_at_a_time("other")

    def test_bus_off_and_restarted(self):
        self.tell(BUS_OFF)
        self.gateway.wait_for("bus cell: .*bus-off")
        self.assert_gone()
        self.tell(RESTARTED)
        self.assert_back()

    def test_off_again_and_again_it_is_given_up_until_somebody_takes_the_interface_up(self):
        for _ in range(MAX_BUS_OFFS):
            self.tell(BUS_OFF)
            self.lost[0].until(link_state=LINK_DOWN)
            self.tell(RESTARTED)
            for axis in self.lost:
                axis.until(link_state=ONLINE)
        self.tell(BUS_OFF)
        self.lost[0].until(link_state=LINK_DOWN)
        self.tell(RESTARTED)
        self.assert_gone()
        ip("link", "set", self.interface, "down")
        self.gateway.wait_for(f"{self.interface} is down")
        ip("link", "set", self.interface, "up")
        self.assert_back()


class Queue(Interface):
    """vcan never fills; a token bucket that lets nothing through is a bus on which nobody acknowledges."""

    def test_a_full_queue_is_told_and_outlived(self):
        subprocess.run(["tc", "qdisc", "add", "dev", self.interface, "root", "tbf", "rate", "8bit", "burst", "16", "limit", "32"],
                       check=True)
        self.gateway.wait_for("bus cell: .*(nobody acknowledges|overloaded|frames wait)")
        self.assert_gone()
        subprocess.run(["tc", "qdisc", "del", "dev", self.interface, "root"], check=True)
        self.assert_back()


class Flood(Interface):
    def test_a_flood_of_foreign_frames_slows_nobody_down(self):
        peer = self.raw_socket()
        frame = struct.pack("=IB3x8s", 0x081, 8, bytes.fromhex("0010010000000000"))  # an EMCY of node 1
        stranger = struct.pack("=IB3x8s", 0x3FF, 8, bytes(8))
        sent = 0
        while not self.gateway.found("axis 1: floods the bus with frames 0x081") or sent < 5000:
            for each in (frame, stranger):
                try:
                    peer.send(each)
                except OSError:
                    pass  # the queue is full: all the better
            sent += 1
            if sent % 500 == 0:
                self.assertIn(self.client.overview(4)["link_state"], (ONLINE, SUSPECT))
        # Not that no request of it timed out: a flood takes the one processor of a guest away from the simulated drives, too.
        self.assert_goes_on(self.kept)
        for axis in self.lost:
            axis.until(link_state=ONLINE)
        self.assert_goes_on(*self.lost)


class AnotherMaster(Interface):
    """Somebody else speaks on the bus: a maker's tool, a second master, a device gone mad."""

    def send(self, cob_id, data, flags=0):
        if not hasattr(self, "peer"):
            self.peer = self.raw_socket()
        self.peer.send(struct.pack("=IB3x8s", cob_id | flags, len(data), data))

    def test_a_node_that_is_stopped_is_taken_back(self):
        for axis in self.lost:
            self.send(0x000, bytes([0x02, axis.number]))
            self.gateway.wait_for(f"axis {axis.number}: the node is stopped by no command of ours")
            until("it runs its process data", lambda: self.ask("nmt DRIVE", axis.number) == "operational")
        self.assert_back()

    def test_a_node_that_is_reset_while_it_moves(self):
        for axis in self.lost:
            axis.command("enable")
            axis.set(target_position=FAR)
            axis.command("move_absolute")
            axis.until_input("moving")
            self.send(0x000, bytes([0x81, axis.number]))
            self.gateway.wait_for(f"axis {axis.number}: the drive has restarted")
            axis.until(link_state=ONLINE, axis_state=DISABLED, motion_state=FAILED)
            self.prepare(axis)
        self.assert_back()

    def test_another_reader_of_objects_takes_nothing_from_us(self):
        for axis in self.lost:
            self.targets[axis.number] = axis.number * 3 * TURN
            self.move(axis)
        before = {axis.number: axis.block()["position_actual"] for axis in self.lost}
        for turn in range(200):
            number = 1 + turn % 3
            self.send(0x600 + number, bytes.fromhex("4018100100000000"))  # 1018:01, which the gateway does not read now
            block = self.lost[number - 1].block()
            if block["valid"] & 4:
                self.assertAlmostEqual(block["position_actual"], before[number], delta=20)
        for axis in self.lost:
            axis.until(link_state=ONLINE)
            self.assertEqual(axis.get("axis_alarms") & DUPLICATE_NODE, 0, "a second master is no duplicate node-ID")
        self.assert_goes_on(*self.lost)

    def test_random_frames_stop_nobody(self):
        chance = random.Random(7)
        services = [0x080, 0x180, 0x280, 0x380, 0x480, 0x580, 0x700]  # what a drive may send
        for turn in range(2000):
            flags = chance.choice([0, 0, 0, socket.CAN_EFF_FLAG, socket.CAN_RTR_FLAG])
            cob_id = chance.getrandbits(29) if flags == socket.CAN_EFF_FLAG else chance.choice(services) + chance.randrange(1, 5)
            try:
                self.send(cob_id, chance.randbytes(chance.randrange(9)), flags)
            except OSError:
                pass  # the queue is full
            if turn % 100 == 0:
                self.assertEqual(self.client.overview(4)["link_state"], ONLINE)
        for axis in self.lost:
            self.assertNotIn("operation", self.ask("state DRIVE", axis.number))
        self.assert_goes_on(self.kept)
        for axis in self.lost:
            until("it can be used", lambda: "ready" in axis.inputs() or "fault" in axis.inputs())
        self.let_heartbeats_pass()  # and true positions: a forged one is believed until the drive's own comes, a second later
        self.assert_back()


class NotThereYet(CanStory):
    def test_an_interface_that_comes_after_the_gateway(self):
        ip("link", "del", self.wire("cell"))
        self.configure()
        self.run_gateway()
        self.gateway.wait_for(f"bus cell: .*{self.wire('cell')} does not exist")
        self.client = self.connect()
        with self.refused(NO_PATH):
            self.axis(1).command("enable")
        ip("link", "add", "dev", self.wire("cell"), "type", "vcan")
        self.gateway.wait_for(f"bus cell: .*{self.wire('cell')} is down: ip link set {self.wire('cell')} up")
        ip("link", "set", self.wire("cell"), "up")
        self.simulate()
        self.until_online()
        self.axis(1).command("enable")
        self.axis(1).until(axis_state=STANDSTILL)


if __name__ == "__main__":
    main()
