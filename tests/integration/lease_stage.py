# SPDX-License-Identifier: Apache-2.0
"""What the stories of owners and their leases need: a machine with a drive on every protocol, clients that come from an address of
their own and go away in every way, and the motors' speeds as the drives themselves know them."""
import socket
import struct
import sys
import time

from pymodbus.client import ModbusTcpClient

from modbus import AXIS, COILS, COMMANDS, CONTINUOUS, ONLINE, STANDSTILL, Axis, Client, Closed
from processes import NEVER, until
from stage import DRIVES, Story, bus, drive, main  # noqa: F401 main: for the stories

DRIVES["ld2"] = ("leadshine-ld2-can", {})
DRIVES["keya"] = ("keya-kydas4860-2e", {})
COMMANDS.update(release=13, take_over=14)
COILS.extend(["jog_forward", "jog_reverse"])
AXIS["jog_velocity"] = (58, "u32")
RPM = 1000
NOBODY, ME, ANOTHER = range(3)
NOT_OWNER, STOPPED_BY_ANOTHER = 7, 8
PLC, PANEL_1 = "127.0.0.1", "127.0.0.2"
EVERYBODY = [{"from": "127.0.0.0/8", "role": "engineer"}]

# Line: what the simulator hangs on it, the gateway's adapter, the profile, and where the drive keeps its motor's speed.
MACHINES = {
    "serial": ("jd@1", "kinco-serial", "jd", "606C.00"),
    "modbus": ("rtu:md@1", "modbus-rtu", "md", "606C.00"),
    "stepper": ("rtu:id286pro@1", "modbus-rtu", "id286pro", "119"),
    "kincocan": ("lawicel:jd@1", "canopen", "jd", "606C.00"),
    "leadshine": ("lawicel:ld2@1", "canopen", "ld2", "606C.00"),
    "keya232": ("keya-rs232", "keya-rs232", "keya", None),
    "keyacan": ("lawicel:keya-can@1", "keya-can", "keya", None),
    "keya485": ("keya-rs485@1", "keya-rs485", "keya", None),
    "keyacanopen": ("lawicel:keya-kydas4860-2e@1", "canopen", "keya", None),
}
KEYAS = tuple(line for line in MACHINES if line.startswith("keya"))


class Peer(Client):
    """A client with an address of its own. It goes away in good order, by a reset, or by saying nothing any more."""

    def __init__(self, port, address=PLC):
        self.unit = 1
        self.tcp = ModbusTcpClient("127.0.0.1", port=port, timeout=NEVER, retries=0, source_address=(address, 0))
        if not self.tcp.connect():
            raise Closed(f"no connection to port {port} from {address}")

    def reset(self):
        self.tcp.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.tcp.socket.close()
        self.tcp.socket = None

    def fall_silent(self):
        """The connection stays open, and nothing comes any more."""


class Machine(Story):
    """Axis n is motor n of these lines; a Keya has two. Nobody but those whom a story connects says anything."""

    lines_of = tuple(line for line in MACHINES if line not in ("keya485", "keyacanopen"))  # two of its interfaces are enough
    lease = {"timeout_ms": 2000}
    axis_options = {}
    listener_options = {}
    allow = EVERYBODY
    reply_timeout_ms = 1000
    bus_options = {}

    def listener(self, **more):
        # Long enough for a machine that is busy with something else.
        return super().listener(**{"start_deadline_ms": 60000, "reply_deadline_ms": 60000, "allow": self.allow,
                                   **self.listener_options, **more})

    def buses(self):
        buses, self.motors = [], {}
        for line in self.lines_of:
            _, adapter, kind, _ = MACHINES[line]
            can = adapter in ("canopen", "keya-can")
            rate = {"bitrate": 500000 if adapter == "canopen" else 250000} if can else {"rs485": "off"}
            entry = drive(kind, 1, 0)
            entry["axes"] = []
            for motor in ("A", "B") if kind.startswith("keya") else (None,):
                number = len(self.motors) + 1
                self.motors[number] = (line, motor)
                entry["axes"].append({"axis": number, "name": f"{line}{motor or ''}", "lease": self.lease, **self.axis_options})
            device = f"slcan:{self.path(line)}" if can else self.path(line)
            made = bus(device, entry, adapter=adapter, timeout_ms=self.reply_timeout_ms, **rate, **self.bus_options)
            if can:
                made.pop("rs485")
            buses.append({**made, "name": line})
        return buses

    def begin(self):
        """Drives, gateway, and a watcher who never writes and so owns nothing: it has nobody's address."""
        self.simulate({line: MACHINES[line][0] for line in self.lines_of})
        self.configure()
        self.run_gateway()
        self.client = self.watcher = self.peer("127.0.0.9")
        self.until_online()
        self.numbers = list(self.motors)

    def peer(self, address=PLC):
        client = Peer(self.ports[0], address)
        self.addCleanup(client.close)
        return client

    def watched(self, number):
        return Axis(self.watcher, number)

    def each(self):
        """The number of each axis; where a story fails, the axis it was at is told."""
        for number in self.numbers:
            self.at = "{} {}".format(*self.motors[number])
            yield number
        self.at = None

    def run_once(self, result):
        self.at = None
        super().run_once(result)
        if not result.wasSuccessful() and self.at:
            print(f"--- it was at {self.at}", file=sys.stderr)

    def number_of(self, line, motor=None):
        return next(number for number, where in self.motors.items() if where == (line, motor))

    # What the drives know.

    def speed(self, number):
        line, motor = self.motors[number]
        if motor:
            return int(self.sim.ask(f"speed {line}/1").split()["AB".index(motor)])
        return self.sim.object(f"{line}/1", MACHINES[line][3])

    def until_it_turns(self, number):
        until(f"the motor of axis {number} turns", lambda: self.speed(number) != 0)

    def until_it_stands(self, number):
        """Twice in a row: a motor that turns round is at speed 0 once."""
        until(f"the motor of axis {number} stands", lambda: self.speed(number) == 0 and self.speed(number) == 0)

    def until_it_turns_at(self, number, rpm):
        def near():
            return abs(self.watched(number).get("velocity_actual") - rpm * RPM) < abs(rpm) * RPM / 5
        until(f"axis {number} turns at {rpm} rpm", near)

    # What a master does.

    def prepare(self, axis):
        """Ramps, where the drive has them: half a second to the speeds of these stories."""
        for name in ("profile_acceleration", "profile_deceleration"):
            if axis.get("supported") >> {"profile_acceleration": 21, "profile_deceleration": 22}[name] & 1:
                axis.set(**{name: 10000})

    def enable(self, axis):
        axis.command("enable")
        axis.until_input("enabled")

    def set_running(self, axis, rpm=300):
        self.prepare(axis)
        self.enable(axis)
        axis.set(target_velocity=rpm * RPM)
        number = axis.command("run_velocity")
        self.until_it_turns(axis.number)
        return number

    def keep_running(self, client, numbers, seconds):
        """The owner goes on asking for so long, and its motors turn all the while."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            client.gateway()
            for number in numbers:
                self.assertNotEqual(self.speed(number), 0, f"axis {number}")

    def let_pass(self, seconds):
        """In which the gateway answers the watcher alone."""
        over = time.monotonic() + seconds
        until("time", lambda: self.watcher.gateway() and time.monotonic() > over)

    # What is true afterwards.

    def until_without_torque(self, number):
        """A Keya's stop ends with that."""
        line, motor = self.motors[number]
        if motor:
            until(f"axis {number} has no torque", lambda: self.sim.ask(f"enabled {line}/1").split()["AB".index(motor)] == "0")

    def assert_stopped_for_good(self, number):
        self.until_it_stands(number)
        self.until_without_torque(number)
        axis = self.watched(number)
        axis.until_input("stop_latched")
        until("nobody owns it", lambda: axis.get("owner") == NOBODY)
        self.assertEqual(axis.get("lease_remaining_ms"), 0)
        self.assertEqual(axis.get("link_state"), ONLINE)

    def assert_it_can_be_had_again(self, number):
        """An enable is enough; it moves nothing, and from then on the axis runs as ever."""
        client = self.peer()
        axis = Axis(client, number)
        self.enable(axis)
        axis.until(axis_state=STANDSTILL, owner=ME)
        self.assertNotIn("stop_latched", axis.inputs())
        self.assertEqual(self.speed(number), 0)
        axis.set(target_velocity=-200 * RPM)
        axis.command("run_velocity")
        axis.until(axis_state=CONTINUOUS)
        until("it turns the other way", lambda: self.speed(number) < 0)
        axis.command("quick_stop")
        self.until_it_stands(number)
        axis.command("release")
        client.close()

    def leases_told(self, number, words):
        """Lines of the log that tell this of the axis."""
        return [line for line in list(self.gateway.lines) if f"axis {number}" in line and words in line]

    def until_told(self, number, words):
        until(f"the log tells of axis {number}: {words}", lambda: self.leases_told(number, words))
