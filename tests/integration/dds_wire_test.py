# SPDX-License-Identifier: Apache-2.0
"""What is on the wire, as tshark dissects it: sound RTPS on loopback alone, and ROS 2's names and layout for joint_states.

The story runs in a network of its own, with a second interface that would take the traffic if it left loopback.
"""
import math
import os
import signal
import struct
import subprocess
import sys

if "AXISGATE_OWN_NETWORK" not in os.environ:
    user = [] if os.geteuid() == 0 else ["--map-root-user"]
    os.execvpe("unshare", ["unshare", "--net", *user, sys.executable, "-B", *sys.argv], {**os.environ, "AXISGATE_OWN_NETWORK": "1"})

from dds_stage import FAST, RPM, VENDORS, DdsStory, main  # noqa: E402
from modbus import Axis  # noqa: E402
from processes import NEVER, Program, until  # noqa: E402

OTHER = "ag0"
PROTOCOLS = {"frame", "eth", "ip", "ipv6", "udp", "icmp", "rtps", "rtpsvt", "rtpsproc", "data", "_ws.malformed"}


def ip(*arguments):
    subprocess.run(["ip", *arguments], check=True)


def setUpModule():
    ip("link", "set", "lo", "up")
    ip("link", "add", OTHER, "type", "veth", "peer", "name", "ag1")
    ip("address", "add", "10.77.0.1/24", "dev", OTHER)
    for name in (OTHER, "ag1"):
        ip("link", "set", name, "up")
    ip("route", "add", "default", "via", "10.77.0.2")


class Wire(DdsStory):
    dds = {"ros2": True, "shared_memory": False}

    def capture(self):
        self.captured = self.path("wire.pcapng")
        self.shark = self.keep(Program("tshark", ["tshark", "-f", "udp", "-i", "lo", "-i", OTHER, "-w", self.captured]))
        self.shark.wait_for("Capture started|Capturing on")
        until("it writes", lambda: os.path.exists(self.captured) and os.path.getsize(self.captured) > 0)

    def dissector(self):
        """A configuration of tshark that knows RTPS alone. The kernel gives away ports that belong to other protocols (57000 is an
        exchange's), and tshark would rather take a sound packet for a malformed one of theirs."""
        folder = self.path("wireshark")
        if not os.path.exists(folder):
            os.mkdir(folder)
            known = subprocess.run(["tshark", "-G", "protocols"], capture_output=True, text=True, timeout=NEVER, check=True).stdout
            names = [line.split("\t")[2] for line in known.splitlines()]
            self.assertLessEqual(PROTOCOLS, set(names))
            with open(os.path.join(folder, "disabled_protos"), "w", encoding="ascii") as file:
                file.writelines(f"{name}\n" for name in names if name not in PROTOCOLS)
        return {**os.environ, "WIRESHARK_CONFIG_DIR": folder}

    def dissect(self, what, *fields):
        """Each packet of this kind: the values of these fields."""
        words = [word for field in fields for word in ("-e", field)]
        done = subprocess.run(["tshark", "-r", self.captured, "-Y", what, "-T", "fields", "-E", "separator=|", *words],
                              capture_output=True, text=True, timeout=NEVER, check=False, env=self.dissector())
        self.assertIn(done.returncode, (0, 2), done.stderr)  # 2: the last packet of the file was cut short
        return [line.split("|") for line in done.stdout.splitlines()]

    def all_there_is(self):
        """Of each topic, by both vendors, with commands and objects."""
        for vendor in VENDORS:
            peer = self.commander(vendor)
            peer.ask_objects()
            for topic in ("axis_state", "axis_event", "gateway_state", "joint_states"):
                peer.read(topic)
                peer.wait("sample", topic)
            for number in self.numbers:
                self.run_by_dds(peer, number)
                peer.object(number, 0x6041, size=2)
                self.let_go(peer, number)
            peer.leave()

    def test_sound_rtps_on_loopback_alone(self):
        self.first_port = 7400 + 250 * self.domain  # DDSI-RTPS 9.6.1.1
        self.capture()
        self.begin()
        self.all_there_is()
        self.gateway.terminate()
        self.shark.send(signal.SIGINT)
        self.shark.ended()
        packets = self.dissect("rtps && !icmp", "frame.interface_name", "ip.src")
        self.assertGreater(len(packets), 500)
        self.assertEqual({tuple(packet) for packet in packets}, {("lo", "127.0.0.1")})
        self.assertEqual(self.dissect(f"frame.interface_name == {OTHER} && udp.port >= {self.first_port}", "udp.dstport"), [])
        self.assertEqual(self.dissect("_ws.malformed", "frame.number", "_ws.col.Info"), [])
        odd = self.dissect(f"udp && !rtps && udp.dstport >= {self.first_port} && udp.dstport < {self.first_port + 250}", "udp.payload")
        # Both libraries wake their own receivers so when they are to end.
        self.assertLessEqual({bytes.fromhex(payload) for payload, in odd}, {b"\0", b"EPRORTPSCLOSE"})
        names = {pair for line in self.dissect("rtps.param.topicName", "rtps.param.topicName", "rtps.param.typeName")
                 for pair in zip(line[0].split(","), line[1].split(","))}
        wanted = {("axisgate/axis_state", "axisgate::AxisState"), ("axisgate/axis_command", "axisgate::AxisCommand"), ("axisgate/heartbeat", "axisgate::Heartbeat"),
                  ("axisgate/command_reply", "axisgate::CommandReply"), ("axisgate/axis_event", "axisgate::AxisEvent"),
                  ("axisgate/object_request", "axisgate::ObjectRequest"), ("axisgate/object_reply", "axisgate::ObjectReply"),
                  ("axisgate/gateway_state", "axisgate::GatewayState"), ("rt/joint_states", "sensor_msgs::msg::dds_::JointState_"),
                  ("rt/joint_commands", "sensor_msgs::msg::dds_::JointState_"),
                  ("rt/diagnostics", "diagnostic_msgs::msg::dds_::DiagnosticArray_")}
        for axis in ("serial", "leadshine"):
            wanted.add((f"rt/{axis}/enable", "std_msgs::msg::dds_::Bool_"))
            wanted |= {(f"rt/{axis}/{topic}", "std_msgs::msg::dds_::Empty_") for topic in ("quick_stop", "fault_reset", "home")}
        self.assertEqual(names, wanted)


class Cdr:
    """Plain CDR, little-endian (DDSI-RTPS 10): every number at a multiple of its size after the encapsulation header."""

    HEADER = bytes((0, 1, 0, 0))

    def __init__(self):
        self.body = b""

    def number(self, form, value):
        size = struct.calcsize(form)
        self.body += b"\0" * (-len(self.body) % size) + struct.pack("<" + form, value)

    def text(self, value):
        self.number("I", len(value.encode()) + 1)
        self.body += value.encode() + b"\0"

    def sequence(self, each, values):
        self.number("I", len(values))
        for value in values:
            each(value)

    def double(self, value):
        self.number("d", value)

    def payload(self):
        return (self.HEADER + self.body).hex()


class FromCdr:
    """The same, read. Behind the last member there is nothing but padding, and that may hold anything (CDR, CORBA 3.3 part 2, 9.3.1):
    a payload that is used again keeps what stood there."""

    def __init__(self, payload):
        whole = bytes.fromhex(payload)
        assert whole[:4] == Cdr.HEADER, payload
        self.body, self.at = whole[4:], 0

    def take(self, count):
        taken, self.at = self.body[self.at:self.at + count], self.at + count
        assert len(taken) == count, f"{count} bytes are more than there are"
        return taken

    def number(self, form):
        size = struct.calcsize(form)
        self.take(-self.at % size)
        return struct.unpack("<" + form, self.take(size))[0]

    def text(self):
        whole = self.take(self.number("I"))
        assert whole.index(0) == len(whole) - 1, whole
        return whole[:-1].decode()

    def sequence(self, each):
        return [each() for _ in range(self.number("I"))]

    def end(self):
        """To whole words, as RTPS has it."""
        assert self.at <= len(self.body) < self.at + 4


def joint_state(data):
    """sensor_msgs/msg/JointState, member by member as its published definition has them:

    std_msgs/Header header (builtin_interfaces/Time stamp (int32 sec, uint32 nanosec), string frame_id), string[] name,
    float64[] position, float64[] velocity, float64[] effort
    """
    cdr = Cdr()
    cdr.number("i", data["header"]["stamp"]["sec"])
    cdr.number("I", data["header"]["stamp"]["nanosec"])
    cdr.text(data["header"]["frame_id"])
    cdr.sequence(cdr.text, data["name"])
    for name in ("position", "velocity", "effort"):
        cdr.sequence(cdr.double, data[name])
    return cdr.payload()


def diagnostic_array(payload):
    """diagnostic_msgs/msg/DiagnosticArray, read from its bytes as its published definition has it:

    DiagnosticArray: std_msgs/Header header (builtin_interfaces/Time stamp (int32 sec, uint32 nanosec), string frame_id),
    DiagnosticStatus[] status. DiagnosticStatus: byte level, string name, string message, string hardware_id, KeyValue[] values.
    KeyValue: string key, string value
    """
    cdr = FromCdr(payload)
    stamp, frame = (cdr.number("i"), cdr.number("I")), cdr.text()

    def status():
        return {"level": cdr.number("B"), **{name: cdr.text() for name in ("name", "message", "hardware_id")},
                "values": dict(cdr.sequence(lambda: (cdr.text(), cdr.text())))}

    statuses = {entry["name"]: entry for entry in cdr.sequence(status)}
    cdr.end()
    return stamp, frame, statuses


def std_bool(data):
    """std_msgs/msg/Bool: bool data."""
    cdr = Cdr()
    cdr.number("?", data)
    return cdr.payload()


def std_empty():
    """std_msgs/msg/Empty has no member; ROS 2 gives such a message one (rosidl: uint8 structure_needs_at_least_one_member)."""
    cdr = Cdr()
    cdr.number("B", 0)
    return cdr.payload()


class Ros2(DdsStory):
    dds = {"ros2": True, "shared_memory": False}

    def test_joint_states_are_what_ros_2_expects(self):
        self.begin()
        raw = self.peer_of(FAST).read("joint_states", "raw")
        readers = [self.peer_of(vendor).read("joint_states") for vendor in VENDORS]
        master = Axis(self.peer(), 1)
        self.set_running(master, rpm=300)
        for reader in readers:
            self.at = reader.name
            place = reader.now()
            sample = reader.sample("joint_states", lambda data: data["velocity"] and data["velocity"][0] > 200 * RPM, place)
            self.assertEqual(sample["name"], list(self.lines_of), "names of axes in the order of their numbers")
            self.assertEqual((len(sample["position"]), len(sample["velocity"])), (2, 2))
            self.assertIn(len(sample["effort"]), (0, 2))
            master.client.gateway()
            raw.wait("sample", "joint_states", lambda told, payload=joint_state(sample): told["data"]["payload"] == payload)
        master.command("disable")
        self.until_it_stands(1)
        there = self.watched(1).get("position_actual")
        for reader in readers:
            reader.sample("joint_states", lambda data: math.isclose(data["position"][0], there * 2 * math.pi / 10000, abs_tol=0.01))


class Ros2ByBytes(DdsStory):
    """The other messages of ROS 2, in bytes that are made and read here alone: no IDL of ours has a part in it."""

    lines_of = ("serial",)
    dds = {"ros2": True, "shared_memory": False}
    gateway_name = "cell_7"

    def test_diagnostics_are_what_ros_2_expects(self):
        self.begin()
        raw = self.peer_of(FAST).read("diagnostics", "raw")
        heard = []

        def axis_is_told():
            for told in raw.all("sample", "diagnostics", since=len(heard)):
                heard.append(told)
                stamp, frame, statuses = diagnostic_array(told["data"]["payload"])
                self.assertGreater(stamp[0], 1_000_000_000)
                self.assertLess(stamp[1], 1_000_000_000)
                self.assertEqual(frame, "")
                for status in statuses.values():
                    self.assertEqual(status["hardware_id"], "cell_7")
                    self.assertIn(status["level"], range(4))
                if "cell_7: serial" in statuses and statuses["cell_7: serial"]["message"].startswith("online"):
                    return statuses
            return None

        statuses = until("the axis is told of", axis_is_told)
        axis, gateway = statuses["cell_7: serial"], statuses["cell_7: gateway"]
        self.assertEqual(axis["values"]["axis"], "1")
        self.assertEqual(axis["values"]["link"], "online")
        self.assertEqual(gateway["values"]["axes"], "1")
        self.assertTrue(gateway["message"])

    def test_bool_and_empty_are_read_as_ros_2_writes_them(self):
        self.begin()
        node, enable, quick_stop = self.peer_of(FAST), "flag:rt/cell_7/serial/enable", "signal:rt/cell_7/serial/quick_stop"
        for topic in (enable, quick_stop):
            node.writer(topic, "raw")

        def publish(topic, payload, done):
            """As often as it takes: what is published before the reader knows the writer is for nobody."""
            def look():
                node.say("write", topic, f"payload={payload}")
                return done()

            until(f"{topic}: {payload}", look)

        def inputs():
            return self.watched(1).inputs()

        publish(enable, std_bool(True), lambda: "enabled" in inputs())
        publish(enable, std_bool(False), lambda: "enabled" not in inputs())
        publish(enable, std_bool(True), lambda: "enabled" in inputs() and "stop_latched" not in inputs())
        publish(quick_stop, std_empty(), lambda: "stop_latched" in inputs())


class NotAsked(DdsStory):
    def test_without_ros2_there_is_no_such_topic(self):
        self.begin()
        for vendor in self.each_vendor():
            peer = self.peer_of(vendor)
            peer.say("reader", "joint_states")
            peer.read("axis_state").sample("axis_state", axis=1)
            self.peer_of(vendor).read("axis_state").sample("axis_state", axis=1)
            self.assertEqual(peer.all("matched", "joint_states"), [])


if __name__ == "__main__":
    main()
