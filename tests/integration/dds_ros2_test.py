# SPDX-License-Identifier: Apache-2.0
"""ROS 2 nodes and the gateway on one computer with several interfaces: nodes as they come, of both vendors, see joint_states and
diagnostics and command axes, and hardware of ros2_control that knows nothing of the axes at its start moves none of them."""
from own_network import make_interfaces  # first: it begins anew in a network of its own

import math

from dds_stage import FAST, TURN, DdsStory, Peer, main
from modbus import COMPLETED
from processes import until

ERROR_LEVEL = 2
NEAR = 0.005  # rad: the drives stand within a window of their own
CYCLONE_ON_LOOPBACK = "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name='lo'/></Interfaces><AllowMulticast>false" \
    "</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>30" \
    "</MaxAutoParticipantIndex><Peers><Peer address='127.0.0.1'/></Peers></Discovery></Domain></CycloneDDS>"


def setUpModule():
    make_interfaces()


class Hardware:
    """What topic_based_ros2_control/TopicBasedSystem does in each cycle of its controller manager: the newest joint_states are read,
    then the commands are written, unless they differ from the states by no more than a threshold, all joints together."""

    def __init__(self, node, joints, threshold=1e-5, initial_states=False):
        self.node, self.joints, self.threshold = node, joints, threshold
        self.states = dict.fromkeys(joints, 0.0)
        self.commands = dict.fromkeys(joints, 0.0)
        self.take_states = initial_states
        self.seen = 0
        node.say("reader", "joint_states", "best_effort")
        node.say("writer", "joint_commands")

    def read(self):
        """Waits for joint_states: the control loop of this story runs as they come."""
        sample = self.node.wait("sample", "joint_states", since=self.seen)["data"]
        newest = self.node.samples("joint_states", since=self.seen)[-1]
        self.seen = self.node.now()
        for name, position in zip(newest["name"], newest["position"]):
            if name in self.states:
                self.states[name] = position
        if self.take_states:
            self.commands = dict(self.states)
            self.take_states = False
        return sample

    def write(self):
        difference = sum(abs(self.states[name] - self.commands[name]) for name in self.joints)
        if difference <= self.threshold:
            return False
        self.node.say("write", "joint_commands", f"name={','.join(self.joints)}",
                      f"position={','.join(repr(self.commands[name]) for name in self.joints)}")
        return True

    def cycle(self, count=1):
        for _ in range(count):
            self.read()
            self.write()

    def cycle_until(self, what, look):
        def cycled():
            self.cycle()
            return look()
        until(what, cycled)


class Ros2(DdsStory):
    # joint_states again and again: they are what the nodes of these stories go by.
    dds = {"ros2": True, "max_period_ms": 20}

    def setUp(self):
        super().setUp()
        self.begin()

    def node(self, vendor):
        """A participant as a ROS 2 node makes it. Cyclone DDS must be told of the loopback (docs/dds/ros2.md)."""
        environment = {"CYCLONEDDS_URI": CYCLONE_ON_LOOPBACK}
        node = self.keep(Peer(vendor, self.domain, ("env", *(f"{name}={value}" for name, value in environment.items())),
                              "as_it_comes"))
        node.name = f"{vendor} node {len(self.programs)}"
        return node

    def topic(self, node, kind, name):
        """A publisher of an axis's own topic, matched with the gateway."""
        word = f"{kind}:rt/{name}"
        node.say("writer", word)
        node.wait("matched", word, lambda told: told["count"] > 0)
        return word

    def position(self, number):
        return self.registers(number)["position_actual"] / 10000 * TURN

    def move_away(self, number, turns=3):
        """By a master that then leaves: the axis stands disabled, away from 0."""
        master = self.commander(FAST)
        self.prepare_by_dds(master, number)
        master.do(number, "enable")
        target = self.position(number) + turns * TURN
        master.do(number, "move_absolute", target_position=target, profile_velocity=TURN)
        until("it is there", lambda: abs(self.position(number) - target) < NEAR)
        self.let_go(master, number)
        master.leave()

    def hardware(self, vendor, **options):
        node = self.node(vendor)
        hardware = Hardware(node, [self.motors[number][0] for number in self.numbers], **options)
        node.wait("matched", "joint_commands", lambda told: told["count"] > 0)
        return hardware

    def enable_by(self, hardware, topic):
        hardware.node.say("write", topic, "data=1")
        hardware.cycle_until("it is enabled", lambda: "enabled" in self.watched(1).inputs())

    def come_into_step(self, hardware):
        """The first target of a stream that acts is where the axis stands: a move that is over at once."""
        hardware.cycle_until("the stream has been where the axis is", lambda: self.watched(1).block()["motion_state"] == COMPLETED)

    def disable_by(self, hardware, topic):
        hardware.node.say("write", topic, "data=0")
        hardware.cycle_until("it is disabled", lambda: "enabled" not in self.watched(1).inputs())


class Control(Ros2):
    def test_hardware_that_starts_with_zero_moves_nothing_until_it_is_where_the_axis_is(self):
        self.move_away(1)
        for vendor in self.each_vendor():
            hardware = self.hardware(vendor)
            enable = self.topic(hardware.node, "flag", "serial/enable")
            before = self.position(1)
            self.assertGreater(abs(before), 1)
            hardware.cycle(20)
            self.assertNotIn("enabled", self.watched(1).inputs(), "a stream enables nothing")
            self.enable_by(hardware, enable)
            hardware.cycle(100)
            self.assertAlmostEqual(self.position(1), before, delta=NEAR)
            self.assertIn("enabled", self.watched(1).inputs(), "it lives, and keeps the lease")
            # A controller is started: it holds what it reads, and goes on from there.
            hardware.commands = dict(hardware.states)
            hardware.cycle(10)
            begun = hardware.states["serial"]
            for step in range(1, 101):
                hardware.commands["serial"] = begun + 5 * (1 - math.cos(math.pi * step / 100)) / 2
                hardware.cycle()
            hardware.cycle_until("it has followed", lambda: abs(self.position(1) - begun - 5) < NEAR)
            self.disable_by(hardware, enable)
            hardware.node.leave()

    def test_after_a_stop_a_stream_that_goes_on_moves_nothing(self):
        for vendor in self.each_vendor():
            hardware = self.hardware(vendor, threshold=-1, initial_states=True)
            enable = self.topic(hardware.node, "flag", "serial/enable")
            stop = self.topic(hardware.node, "signal", "serial/quick_stop")
            self.enable_by(hardware, enable)
            self.come_into_step(hardware)
            hardware.cycle_until("its position is good now", lambda: not math.isnan(hardware.states["serial"]))
            hardware.commands["serial"] = hardware.states["serial"] + 500 * TURN
            hardware.cycle_until("it moves", lambda: self.speed(1) != 0)
            hardware.node.say("write", stop)
            hardware.cycle_until("it is stopped", lambda: "stop_latched" in self.watched(1).inputs())
            hardware.cycle_until("it stands", lambda: self.speed(1) == 0)
            hardware.cycle(10)
            before = self.position(1)
            self.enable_by(hardware, enable)
            hardware.cycle(50)
            self.assertAlmostEqual(self.position(1), before, delta=NEAR)
            self.disable_by(hardware, enable)
            hardware.node.leave()


class Seen(Ros2):
    dds = {"ros2": True, "min_period_ms": 50, "max_period_ms": 100}

    def test_diagnostics_tell_of_each_axis_in_words(self):
        for vendor in self.each_vendor():
            node = self.node(vendor).read("diagnostics")
            first = node.wait("sample", "diagnostics")["data"]
            self.assertEqual([status["name"] for status in first["status"]],
                             ["axisgate: gateway", "axisgate: serial", "axisgate: leadshine"])

            def serial(data):
                return next(status for status in data["status"] if status["name"] == "axisgate: serial")

            good = node.wait("sample", "diagnostics", lambda told: serial(told["data"])["level"] != ERROR_LEVEL)["data"]
            self.assertIn("disabled", serial(good)["message"])
            self.sim.ask("unplug serial")
            since = node.now()
            lost = node.wait("sample", "diagnostics", lambda told: serial(told["data"])["level"] == ERROR_LEVEL, since)["data"]
            values = {pair["key"]: pair["value"] for pair in serial(lost)["values"]}
            self.assertEqual(values["axis"], "1")
            self.assertNotIn(values["link"], ("online", "suspect"))
            self.sim.ask("plug serial")
            node.wait("sample", "diagnostics", lambda told: serial(told["data"])["level"] != ERROR_LEVEL, node.now())
            node.leave()


if __name__ == "__main__":
    main()
