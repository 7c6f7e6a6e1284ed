# SPDX-License-Identifier: Apache-2.0
"""The tag lists of deploy/examples/panels, played as a panel plays them: with coils and jog, in turns and rpm, and one register at a time."""
import csv
import struct
import time

from examples_stage import EXAMPLES, FAR, FLOATS, FUNCTION_6, PROGRAMS, TOOLS, TURN, Examples, main
from modbus import AXIS, COILS, COMMANDS, INPUTS, STANDSTILL, Refused, width
from processes import until

TURNS = 2.5


class Panel:
    """Does what a panel does with its tags: one connection, one element after the other."""

    def __init__(self, story, name, listener):
        with open(f"{EXAMPLES}/panels/{name}.csv", encoding="utf-8") as file:
            self.tags = {row["tag"]: row for row in csv.DictReader(file)}
        self.client = story.connect(listener)

    def write(self, row, value):
        address, tcp = int(row["address"]), self.client.tcp
        if row["function"] == "5":
            self.client.ask(tcp.write_coil, address, bool(value))
        elif row["function"] == "6":
            words = [value] if row["type"] == "u16" else struct.unpack(">HH", struct.pack(">i", value))
            for place, word in enumerate(words):
                self.client.ask(tcp.write_register, address + place, word)
        else:
            packed = struct.pack({"i32": ">i", "u32": ">I", "float": ">f"}[row["type"]], value)
            self.client.ask(tcp.write_registers, address, list(struct.unpack(">HH", packed)))

    def set(self, tag, value):
        assert self.tags[tag]["element"] in ("number", "switch"), tag
        self.write(self.tags[tag], value)

    def press(self, tag):
        """Down and up again."""
        row = self.tags[tag]
        assert row["element"] == "button", tag
        self.write(row, int(row["pressed"]))
        self.write(row, 0)

    def hold(self, tag, look):
        """Held until it is so: the 1 is written again five times a second, or oftener."""
        row = self.tags[tag]
        assert row["element"] == "hold", tag

        def held():
            self.write(row, 1)
            return look()

        until(f"{tag} is held", held)

    def let_go(self, tag):
        self.write(self.tags[tag], 0)

    def shows(self, tag):
        row = self.tags[tag]
        address = int(row["address"])
        if row["function"] == "2":
            return self.client.ask(self.client.tcp.read_discrete_inputs, address, 1).bits[0]
        count = 1 if row["type"] == "u16" else 2
        words = self.client.registers(address, count)
        packed = struct.pack(f">{count}H", *words)
        return struct.unpack({"u16": ">H", "i32": ">i", "u32": ">I", "float": ">f"}[row["type"]], packed)[0]

    def until(self, tag, value=True):
        until(f"{tag} shows {value}", lambda: self.shows(tag) == value)


class Panels(Examples):
    lease_ms = 30000

    def test_every_tag_is_a_row_of_the_map_of_that_type(self):
        kinds = {100 + offset: kind for offset, kind in AXIS.values()} | {158: "u32"}  # jog_velocity
        coils = [*COILS, "jog_forward", "jog_reverse"]
        others = {"stop": "quick_stop", "go": "move_absolute", "step": "move_relative", "reset": "fault_reset"}
        for name in ("coils", "float", "function6"):
            for row in Panel(self, name, PROGRAMS).tags.values():
                with self.subTest(panel=name, tag=row["tag"]):
                    address = int(row["address"])
                    if row["function"] in ("2", "5"):
                        self.assertLess(address - 100, len(INPUTS if row["function"] == "2" else coils))
                        continue
                    kind = kinds[address]
                    self.assertEqual(row["type"] if row["type"] != "float" else kind, kind)
                    if row["type"] == "float":
                        self.assertEqual(width(kind), 2)
                    if address == 154:
                        tag = row["tag"].lower()
                        self.assertEqual(int(row["pressed"]), COMMANDS[others.get(tag, tag)])

    def test_coils_and_jog(self):
        panel = Panel(self, "coils", PROGRAMS)
        for tag in ("Jog +", "Jog -"):
            panel.let_go(tag)  # as the page says: once, when the panel starts
        panel.set("Enable", 1)
        panel.until("Enabled")
        panel.set("Speed", 600000)
        panel.set("Target", 25000)
        panel.press("Go")
        panel.until("Position", 25000)
        panel.until("Reached")
        panel.set("Target", -5000)
        panel.press("Step")
        panel.until("Position", 20000)
        panel.until("Reached")
        panel.set("Jog speed", 200000)
        for tag, sign in (("Jog +", 1), ("Jog -", -1)):
            panel.hold(tag, lambda sign=sign: self.speed() * sign > 0)
            panel.until("Moving")
            panel.let_go(tag)
            until("it stands", lambda: self.speed() == 0 and self.speed() == 0)
            panel.until("Enabled")
        panel.press("Home")
        panel.until("Homed")
        panel.set("Target", FAR * TURN)
        panel.press("Go")
        self.until_it_turns()
        panel.press("Stop")
        panel.until("Stopped")
        until("it stands", lambda: self.speed() == 0 and self.speed() == 0)
        with self.assertRaises(Refused):
            panel.press("Go")
        panel.set("Enable", 0)
        panel.set("Enable", 1)
        panel.until("Stopped", False)
        panel.until("Enabled")
        self.sim.ask("fault lift/1 2601 0x0020")
        panel.until("Fault")
        self.assertNotEqual(panel.shows("Error"), 0)
        self.sim.ask("clear lift/1 2601 0x0020")
        panel.press("Reset")
        panel.until("Fault", False)
        panel.until("Enabled", False)
        panel.set("Enable", 0)
        panel.set("Enable", 1)
        panel.until("Enabled")
        panel.set("Enable", 0)
        self.until_it_stands_without_torque()

    def test_turns_and_rpm(self):
        panel = Panel(self, "float", FLOATS)
        panel.set("Speed", 600.0)
        panel.set("Ramp up", 3000.0)
        panel.set("Ramp down", 3000.0)
        panel.set("Enable", 1)
        panel.until("Enabled")
        panel.set("Target", TURNS)
        panel.press("Go")
        until("it is there", lambda: abs(panel.shows("Position") - TURNS) < 0.001)
        until("it stands", lambda: panel.shows("Velocity") == 0)
        self.assertAlmostEqual(self.position(), TURNS, delta=0.01)
        panel.press("Stop")
        panel.until("Stopped")
        panel.set("Enable", 0)
        self.until_it_stands_without_torque()

    def test_one_register_at_a_time(self):
        panel = Panel(self, "function6", FUNCTION_6)
        panel.press("Enable")
        panel.until("State", STANDSTILL)
        panel.until("Result", 2)
        panel.set("Speed", 600000)
        panel.set("Target", 25000)
        panel.press("Go")
        panel.until("Position", 25000)
        panel.until("State", STANDSTILL)
        panel.set("Target", -5000)
        panel.press("Step")
        panel.until("Position", 20000)
        panel.until("State", STANDSTILL)
        panel.press("Home")
        panel.until("Position", 0)
        panel.until("State", STANDSTILL)
        panel.set("Target", FAR * TURN)
        panel.press("Go")
        self.until_it_turns()
        panel.press("Halt")
        panel.until("State", 5)  # a JD in a move halts by its quick stop, as the page says
        panel.press("Enable")
        panel.until("State", STANDSTILL)
        panel.press("Go")
        self.until_it_turns()
        panel.press("Stop")
        panel.until("State", 5)
        panel.press("Enable")
        panel.until("State", STANDSTILL)
        panel.press("Disable")
        panel.until("State", 0)
        self.until_it_stands_without_torque()


class Habits(Examples):
    """What the panel guide says about elements that are set otherwise."""

    lease_ms = 30000

    def setUp(self):
        super().setUp()
        self.panel = Panel(self, "coils", PROGRAMS)

    def begin(self):
        self.panel.set("Enable", 1)
        self.panel.until("Enabled")

    def test_a_jog_button_that_is_down_when_the_panel_connects_moves_nothing(self):
        self.begin()
        self.panel.set("Jog speed", 200000)
        for _ in range(10):
            with self.assertRaises(Refused):
                self.panel.write(self.panel.tags["Jog +"], 1)
            self.assertEqual(self.speed(), 0)
        self.panel.let_go("Jog +")
        self.panel.hold("Jog +", lambda: self.speed() > 0)

    def test_a_button_that_never_writes_0_is_refused_after_somebodys_stop(self):
        self.begin()
        self.panel.set("Target", FAR * TURN)
        go = self.panel.tags["Go"]
        self.panel.write(go, 1)
        self.until_it_turns()
        self.axis(1).coil("quick_stop")
        self.panel.until("Stopped")
        until("it stands", lambda: self.speed() == 0 and self.speed() == 0)
        self.panel.set("Enable", 0)
        self.begin()
        with self.assertRaises(Refused) as refused:
            self.panel.write(go, 1)
        self.assertEqual(refused.exception.code, 6)
        self.assertEqual(self.speed(), 0)
        self.panel.write(go, 0)
        self.panel.write(go, 1)
        self.until_it_turns()

    def test_a_number_takes_the_axis_and_a_look_does_not(self):
        self.panel.shows("Target")
        self.axis(1).until(owner=0)
        self.panel.set("Target", 100)
        self.axis(1).until(owner=2)


class OneRequestAConnection(Examples):
    """On the listener for panels that connect anew each time, with the lease as the examples have it."""

    def setUp(self):
        super().setUp()
        self.panel = Panel(self, "coils", TOOLS)
        self.panel.set("Target", FAR * TURN)
        self.panel.set("Enable", 1)
        self.panel.press("Go")
        self.until_it_turns()

    def test_reads_do_not_keep_its_axis(self):
        self.panel.until("Stopped")

    def test_a_number_that_changes_in_register_8_does(self):
        end = time.monotonic() + 3 * 2
        count = 0
        while time.monotonic() < end:
            count += 1
            self.panel.client.write(8, count % 65536)
            self.assertFalse(self.panel.shows("Stopped"))
        self.assertNotEqual(self.speed(), 0)


class PanelIsSwitchedOff(Examples):
    def test_its_motor_is_stopped(self):
        """With the lease as the examples have it."""
        panel = Panel(self, "coils", PROGRAMS)
        panel.set("Enable", 1)
        panel.until("Enabled")
        panel.set("Target", FAR * TURN)
        panel.press("Go")
        self.until_it_turns()
        panel.client.close()
        self.axis(1).until_input("stop_latched")
        until("it stands", lambda: self.speed() == 0 and self.speed() == 0)


if __name__ == "__main__":
    main()
