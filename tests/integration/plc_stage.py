# SPDX-License-Identifier: Apache-2.0
"""Stories of PLCs: the shipped function blocks, run by the machine of tests/plc before the real gateway and simulated drives. A PLC has
a cycle time and a scanner that writes and reads the image of each axis once a cycle. After each cycle the outputs of every block are
held against PLCopen's rules; what the motors do is asked from the drives.

A story waits for events by letting its PLCs go on; nothing here is asked to happen within a time.
"""
import re
import socket
import struct
import sys
import time

from lease_stage import DRIVES, EVERYBODY, MACHINES, PLC, Machine, main  # noqa: F401 EVERYBODY, MACHINES, PLC, main: for the stories
from processes import NEVER
from stage import SOURCE

sys.path.insert(0, f"{SOURCE}/tests/plc")
from plcopen_rules import AxisRules, outputs  # noqa: E402
from st_machine import Machine as StMachine  # noqa: E402

MACHINES["mdserial"] = ("md@1", "kinco-serial", "md", "606C.00")
MACHINES["mdcan"] = ("lawicel:md@1", "canopen", "md", "606C.00")
MACHINES["keyaplaces"] = ("lawicel:keya-can@1+0020=3+0050=3", "keya-can", "keyaplaces", None)
DRIVES["keyaplaces"] = ("keya-kydas4860-2e", {"control_mode_a": 3, "control_mode_b": 3})
EVERY_KIND = ("serial", "modbus", "stepper", "kincocan", "leadshine", "keya232", "mdserial", "mdcan", "keyacan", "keya485", "keyacanopen",
              "keyaplaces")
# A Keya works as its maker's tool has set it: at speed as delivered, or to positions, at the drive's own speed.
AT_SPEED_ALONE = ("keya232", "keyacan", "keya485", "keyacanopen")
TO_POSITIONS_ALONE = ("keyaplaces",)
# What the makers' manuals make of a turn of the motor, and of 1 rpm: by the kind of drive, whatever the gateway takes it for.
COUNTS_PER_TURN = {"jd": 10000, "md": 65536, "ld2": 10000, "id286pro": 10000, "keya": 10000, "keyaplaces": 10000}
COUNTS_PER_RPM = {"jd": 1, "md": 512 * 65536 / 1875, "ld2": 10000 / 60, "id286pro": 1 / 0.6, "keya": 1, "keyaplaces": 1}
TURN = 10000  # units of the gateway, and of a program that sets no UnitScale
READ, WRITE = 3, 16
INFO_EVERY = 25  # cycles between two reads of registers 78 to 95


def text_of(path):
    with open(f"{SOURCE}/{path}", encoding="utf-8") as file:
        return path, file.read()


class Unplugged(Exception):
    pass


def printed_rule():
    """How the manual takes what Siemens's MB_CLIENT tells of a call for a connection, or for none."""
    name, text = text_of("docs/plc.md")
    return name, re.search(r"^```\n(FUNCTION_BLOCK ScannerRule\n.*?)^```$", text, re.MULTILINE | re.DOTALL)[1]


class Scanner:
    """A Modbus-TCP I/O scanner as PLCs have it: one connection, one request at a time. Whether it is connected, the rule of the manual says."""

    DONE, EXCEPTION, LOST = (True, False, 0), (False, True, 0x8380), (False, True, 0x80C8)  # DONE, ERROR, STATUS

    def __init__(self, port, address):
        self.port, self.address = port, address
        self.socket, self.number = None, 0
        self.plugged = True
        self.refused = []  # exception codes, newest last
        self.rule = StMachine(printed_rule()).new("ScannerRule")
        self.never_lost = False  # in this round of calls

    def call_ended(self, how, code=0):
        self.rule.Ended, self.rule.Failed, status = how
        self.rule.Status = status + code
        self.rule.run()
        self.never_lost = self.never_lost and self.rule.Connected

    def connected(self):
        """After each call of the last round: a program may look after any of them."""
        return self.never_lost

    def connect(self):
        """Begins a round of calls. False if there is no connection to ask on."""
        self.never_lost = True
        if not self.open():
            self.call_ended(self.LOST)
            return False
        return True

    def open(self):
        if not self.plugged:
            return False
        if self.socket is None:
            made = socket.socket()
            made.settimeout(NEVER)
            made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            try:
                made.bind((self.address, 0))
                made.connect(("127.0.0.1", self.port))
            except OSError:
                made.close()
                return False
            self.socket = made
        return True

    def close(self):
        if self.socket is not None:
            self.socket.close()
        self.socket = None

    def receive(self, count):
        data = b""
        while len(data) < count:
            part = self.socket.recv(count - len(data))
            if not part:
                raise Unplugged
            data += part
        return data

    def ask(self, pdu):
        """The answer's PDU; None for an exception."""
        self.number = self.number % 0xFFFF + 1
        try:
            self.socket.sendall(struct.pack(">HHHB", self.number, 0, len(pdu) + 1, 1) + pdu)
            length = struct.unpack(">HHHB", self.receive(7))[2]
            answer = self.receive(length - 1)
        except (OSError, Unplugged):
            self.call_ended(self.LOST)
            raise Unplugged from None
        if answer[0] & 0x80:
            self.refused.append(answer[1])
            self.call_ended(self.EXCEPTION, answer[1])
            return None
        self.call_ended(self.DONE)
        return answer

    def read(self, address, count):
        answer = self.ask(struct.pack(">BHH", READ, address, count))
        return list(struct.unpack(f">{count}H", answer[2:])) if answer else None

    def write(self, address, words):
        return self.ask(struct.pack(f">BHHB{len(words)}H", WRITE, address, len(words), 2 * len(words), *words))


class Plc:
    """One controller. `stations` are its axes, by number. Its scanner exchanges all images `scans` times in each `every` cycles."""

    def __init__(self, story, axes, cycle_ms=20, address=PLC, port=None, retained=None, scans=1, every=1):
        self.scans, self.every = scans, every
        self.story, self.cycle, self.address = story, cycle_ms / 1000, address
        self.scanner = Scanner(port or story.ports[0], address)
        self.machine = StMachine(text_of("deploy/plc/axisgate.st"), text_of("tests/plc/station.st"))
        self.stations = retained or {number: self.machine.new("Station") for number in axes}
        for station in self.stations.values():
            station.Axis.AckTimeout = 1000 * NEVER  # a busy machine is no deaf gateway
        # Outputs are not retained: what the scanner sends before the program's first cycle.
        self.outputs = {number: [0] * 17 for number in self.stations}
        self.rules = {number: AxisRules(station) for number, station in self.stations.items()}
        self.preset_before = dict.fromkeys(self.stations, False)
        self.running, self.started, self.cycles, self.due = True, False, 0, time.monotonic()
        story.plcs.append(self)
        story.addCleanup(self.scanner.close)

    def scan(self):
        if self.scanner.connect():
            try:
                for number, station in self.stations.items():
                    self.exchange(number, station.Axis)
            except Unplugged:
                self.scanner.close()

    def exchange(self, number, axis):
        first = 100 * number
        if axis.PresetWrite and not self.preset_before[number]:
            self.scanner.write(first + 78, axis.Preset)
        self.preset_before[number] = axis.PresetWrite
        self.scanner.write(first + 40, self.outputs[number])
        image = self.scanner.read(first, 39)
        if image:
            axis.In[:] = image
        if self.cycles % INFO_EVERY == 0 or axis.PresetWrite or not axis.UnitsKnown:
            info = self.scanner.read(first + 78, 18)
            if info:
                axis.Info[:] = info

    def step(self):
        """One cycle, when it is due."""
        time.sleep(max(0.0, self.due - time.monotonic()))
        self.due = max(self.due + self.cycle, time.monotonic())
        if self.cycles % self.every == 0:
            for _ in range(self.scans):
                self.scan()
        connected = self.scanner.connected()
        self.cycles += 1
        if not self.running:
            return
        self.machine.now = int(time.monotonic() * 1000)
        for number, station in self.stations.items():
            # A variable that is not retained is FALSE in the first cycle, as the manual has it.
            station.Connected = connected and self.started
            station.run()
            self.outputs[number] = list(station.Axis.Out)
            broken = list(self.rules[number].broken())
            if broken:
                raise AssertionError(f"axis {number}, cycle {self.cycles}: {'; '.join(broken)}; {self.told(number)}")
        self.started = True

    def told(self, number):
        """What a failing story shows."""
        station = self.stations[number]
        blocks = {rules.name: [name for name, value in outputs(rules.block).items() if value] + [hex(rules.block.ErrorID)]
                  for rules in self.rules[number].blocks if any(outputs(rules.block).values())}
        axis = station.Axis
        return (f"{blocks}, Power {station.Power.Status} {station.Power.Busy} {station.Power.ErrorID:#x}, handshake {axis.Handshake}, "
                f"ids {axis.LastId} {axis.PendingId} {axis.AnsweredId}, error {axis.AnswerError:#x}, in {axis.In}, out {axis.Out}, "
                f"refused {self.scanner.refused[-5:]}")

    # What a program does.

    def __getitem__(self, number):
        return self.stations[number]

    def begin(self, number, block, **inputs):
        """A rising edge of Execute."""
        made = getattr(self.stations[number], block)
        if made.Execute:
            made.Execute = False
            self.step()
        for name, value in inputs.items():
            setattr(made, name, value)
        made.Execute = True
        self.step()
        return made

    def end(self, number, block):
        """Waits for the block's end: the output that told it. Execute falls."""
        made = getattr(self.stations[number], block)
        self.story.until(f"the end of {block} of axis {number}", lambda: not made.Busy)
        ended = [name for name, value in outputs(made).items() if value]
        made.Execute = False
        self.step()
        return ended[0]

    def do(self, number, block, **inputs):
        """Begins it, waits for its end, which must be Done."""
        made = self.begin(number, block, **inputs)
        self.story.until(f"the end of {block} of axis {number}", lambda: not made.Busy)
        error = made.ErrorID
        self.story.assertEqual((self.end(number, block), hex(error)), ("Done", "0x0"), f"{block} of axis {number}: {self.told(number)}")

    def enable(self, *numbers):
        """A switch that is on before there is a connection enables nothing."""
        for number in numbers or tuple(self.stations):
            self.story.until(f"axis {number} is connected", lambda number=number: self.stations[number].Axis.Connected)
            self.stations[number].Power.Enable = True
        for number in numbers or tuple(self.stations):
            power = self.stations[number].Power
            self.until_or_over(f"axis {number} is enabled", lambda power=power: power.Status, lambda power=power: power.Error)

    def until_or_over(self, what, wanted, is_over):
        """What a drive or a block has ended in another way will not come."""
        self.story.until(what, lambda: wanted() or is_over())
        self.story.assertTrue(wanted(), f"{what}: {[self.told(number) for number in self.stations]}")

    def until_at_speed(self, number):
        run = self.stations[number].MoveVelocity
        self.until_or_over(f"axis {number} is at speed", lambda: run.InVelocity, lambda: not run.Busy)

    def disable(self, *numbers):
        numbers = numbers or tuple(self.stations)
        for number in numbers:
            self.stations[number].Power.Enable = False
        self.story.until(f"axes {numbers} are disabled", lambda: all(self.stations[number].ReadStatus.Disabled for number in numbers))

    def stop(self):
        """The program is stopped; the scanner goes on with what it has."""
        self.running = False

    def silence(self):
        """The network cable is out: nothing is said on the connection, not even its end."""
        self.scanner.plugged = False
        left, self.scanner.socket = self.scanner.socket, None
        if left:
            self.story.addCleanup(left.close)

    def plug(self):
        self.scanner.plugged = True

    def without_power(self):
        """It is gone without a word: its variables, as they were."""
        self.story.plcs.remove(self)
        self.silence()
        return self.stations


class PlcStory(Machine):
    """A machine with the drives that a story names. PLCs go on while a story waits."""

    lease = {"timeout_ms": 60000}
    # As the manual recommends it: a scanner that connects again is the client that it was.
    listener_options = {"writes": "posted", "client": "address"}

    def setUp(self):
        super().setUp()
        self.plcs = []

    def plc(self, axes=None, **more):
        return Plc(self, axes or self.numbers, **more)

    def go_on(self):
        for plc in list(self.plcs):
            plc.step()

    def until(self, what, look):
        deadline = time.monotonic() + NEVER
        while not (value := look()):
            if time.monotonic() > deadline:
                raise AssertionError(f"{what}: not within {NEVER} s; {[plc.told(n) for plc in self.plcs for n in plc.stations]}")
            self.go_on()
        return value

    def cycles(self, count):
        for _ in range(count):
            self.go_on()

    # What the drives know.

    def position(self, number):
        """In the drive's own counts."""
        line, motor = self.motors[number]
        if motor:
            return int(self.sim.ask(f"position {line}/1").split()["AB".index(motor)])
        return int(self.sim.ask(f"position {line}/1"))

    def turns(self, number):
        """Of the motor, by the drive's own counts."""
        return self.position(number) / COUNTS_PER_TURN[MACHINES[self.motors[number][0]][2]]

    def rpm(self, number):
        """Of the motor, as the drive has it."""
        return self.speed(number) / COUNTS_PER_RPM[MACHINES[self.motors[number][0]][2]]

    def assert_turns_on(self, number):
        """By its position: what a drive calls its speed may be from its last look."""
        before = self.position(number)
        self.until(f"the motor of axis {number} turns on", lambda: self.position(number) != before)

    def assert_stays(self, *numbers, cycles=5):
        where = [self.position(number) for number in numbers]
        for _ in range(cycles):
            self.go_on()
            self.assertEqual([self.position(number) for number in numbers], where, f"axes {numbers}")

    def until_motor_turns(self, *numbers):
        for number in numbers:
            self.until(f"the motor of axis {number} turns", lambda number=number: self.speed(number) != 0)

    def until_motor_stands(self, *numbers):
        """By its position as well: what a JD calls its speed may be from before it has begun to turn."""
        looks = 3
        for number in numbers:
            seen = []

            def stands(number=number, seen=seen):
                seen.append(self.position(number))
                return self.speed(number) == 0 and len(seen) >= looks and len(set(seen[-looks:])) == 1

            self.until(f"the motor of axis {number} stands", stands)
