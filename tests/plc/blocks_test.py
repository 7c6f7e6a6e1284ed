# SPDX-License-Identifier: Apache-2.0
"""The function blocks as they are shipped: of the subset, with PLCopen's inputs and outputs, and the same in text, XML and manual."""
import re
import subprocess
import sys
import unittest
from pathlib import Path
from xml.etree import ElementTree

from st_machine import Machine

SOURCE = Path(sys.argv[1])
TEXT = (SOURCE / "deploy/plc/axisgate.st").read_text(encoding="utf-8")
EXAMPLE = (SOURCE / "deploy/plc/example.st").read_text(encoding="utf-8")
PLAIN = (SOURCE / "deploy/plc/example_plain.st").read_text(encoding="utf-8")
MANUAL = (SOURCE / "docs/plc.md").read_text(encoding="utf-8")
REGISTERS = (SOURCE / "schemas/register-map.md").read_text(encoding="utf-8")
WORDS = (SOURCE / "gateway/core/word_table.cpp").read_text(encoding="utf-8")
NAMESPACE = "{http://www.plcopen.org/xml/tc6_0201}"

MOTION = {"Execute", "Done", "Busy", "Active", "CommandAborted", "Error", "ErrorID", "Axis"}
SERVICE = {"Execute", "Done", "Busy", "Error", "ErrorID", "Axis"}
RAMPS = {"Velocity", "Acceleration", "Deceleration"}
READING = {"Enable", "Valid", "Busy", "Error", "ErrorID", "Axis"}
BLOCKS = {
    "AXG_Cycle": {"Connected", "Axis"},
    "AXG_Power": {"Enable", "Status", "Busy", "Error", "ErrorID", "Axis"},
    "AXG_Reset": SERVICE,
    "AXG_Stop": MOTION | {"Deceleration"},
    "AXG_Halt": MOTION | {"Deceleration"},
    "AXG_Home": MOTION,
    "AXG_MoveAbsolute": MOTION | RAMPS | {"Position"},
    "AXG_MoveRelative": MOTION | RAMPS | {"Distance"},
    "AXG_MoveVelocity": MOTION - {"Done"} | RAMPS | {"InVelocity"},
    "AXG_Jog": MOTION - {"Execute"} | RAMPS | {"JogForward", "JogBackward"},
    "AXG_SetPosition": SERVICE | {"Position"},
    "AXG_TakeOver": SERVICE,
    "AXG_ReadStatus": READING | {"ErrorStop", "Disabled", "Stopping", "Homing", "Standstill", "DiscreteMotion", "ContinuousMotion"},
    "AXG_ReadError": READING | {"AxisErrorID", "VendorError", "Alarms"},
}


class Blocks(unittest.TestCase):
    def setUp(self):
        self.machine = Machine(("axisgate.st", TEXT), ("example.st", EXAMPLE), ("example_plain.st", PLAIN))

    def test_each_has_the_inputs_and_outputs_of_plcopens(self):
        for name, wanted in BLOCKS.items():
            members = {member for member, (_, section) in self.machine.members_of(name).items() if section != "VAR"}
            self.assertEqual(members, wanted, name)

    def test_names_are_short_enough_for_every_controller(self):
        """24 characters: the shortest limit of those that are in use."""
        for word in set(re.findall(r"[A-Za-z_]\w*", re.sub(r"\(\*.*?\*\)", "", TEXT + EXAMPLE + PLAIN, flags=re.S))):
            self.assertLessEqual(len(word), 24, word)

    def test_the_images_are_as_long_as_the_map_says(self):
        axis = self.machine.new("AXG_AXIS")
        self.assertEqual([len(image) for image in (axis.In, axis.Out, axis.Info, axis.Preset)], [39, 17, 18, 2])


class InVelocity(unittest.TestCase):
    """Of a run that has begun, by what the drive shows as its speed."""

    def shown(self, wanted, velocity):
        machine = Machine(("axisgate.st", TEXT))
        axis, run = machine.new("AXG_AXIS"), machine.new("AXG_MoveVelocity")
        run.Axis = axis
        axis.Connected = axis.Online = axis.Ready = axis.UnitsKnown = True
        axis.Handshake, axis.UnitsPerTurn, axis.UnitScale = 2, 5000.0, 1000.0  # 5 mm a turn
        run.Execute, run.Velocity = True, wanted
        run.run()
        axis.AnsweredId = axis.MotionId = axis.PendingId
        axis.PendingId, axis.MotionState, axis.Velocity = 0, 1, velocity
        run.run()
        self.assertTrue(run.Active)
        return run.InVelocity

    def test_at_a_velocity_of_0_a_drive_that_shows_a_ripple_is_in_velocity(self):
        self.assertEqual([self.shown(0.0, velocity) for velocity in (0.0, 0.4, -0.4, 0.5)], [True, True, True, False])  # 5 rpm are 0.417 mm/s

    def test_at_any_other_it_is_within_a_twentieth(self):
        self.assertEqual([self.shown(25.0, velocity) for velocity in (23.8, 26.2, 23.7, 26.3)], [True, True, False, False])
        self.assertEqual([self.shown(-25.0, velocity) for velocity in (-25.0, 25.0)], [True, False])


class ReadError(unittest.TestCase):
    """A fault is told before its cause: register 10 reads 65535 then, and bit 7 of `valid` is 0."""

    KNOWN, NOT_KNOWN = 0x0080, 0

    def setUp(self):
        self.machine = Machine(("axisgate.st", TEXT))
        self.axis, self.cycle, self.block = (self.machine.new(name) for name in ("AXG_AXIS", "AXG_Cycle", "AXG_ReadError"))
        self.cycle.Axis = self.block.Axis = self.axis
        self.cycle.Connected = self.block.Enable = True
        self.axis.In[36] = 1

    def read(self, code, valid, supported=0x0080, low_first=False, after=20):
        self.machine.now += after
        self.axis.LowWordFirst = low_first
        self.axis.In[10], self.axis.In[20 if low_first else 21], self.axis.In[22 if low_first else 23] = code, supported, valid
        self.cycle.run()
        self.block.run()
        return (self.block.Valid, self.block.Busy, self.block.Error, self.block.AxisErrorID)

    def test_it_waits_for_the_cause(self):
        for low_first in (False, True):
            self.setUp()
            self.read(0, self.KNOWN, low_first=low_first)
            self.assertEqual(self.read(0, self.KNOWN, low_first=low_first), (True, True, False, 0))
            self.assertEqual(self.read(65535, self.NOT_KNOWN, low_first=low_first), (False, True, False, 0))
            self.assertEqual(self.read(65535, self.NOT_KNOWN, low_first=low_first, after=500), (False, True, False, 0))
            self.assertEqual(self.read(0x3210, self.KNOWN, low_first=low_first), (True, True, False, 0x3210))

    def test_it_waits_for_600_ms_at_most_and_each_time_anew(self):
        self.read(0, self.KNOWN)
        for _ in range(2):
            self.read(0x8130, self.NOT_KNOWN)
            self.assertEqual(self.read(0x8130, self.NOT_KNOWN, after=599), (False, True, False, 0))
            self.assertEqual(self.read(0x8130, self.NOT_KNOWN, after=1), (True, True, False, 0x8130), "out of sight: the gateway's own code")
            self.read(0, self.KNOWN)

    def test_it_does_not_wait_where_the_drive_has_no_code(self):
        self.read(0, self.NOT_KNOWN, supported=0)
        self.assertEqual(self.read(65535, self.NOT_KNOWN, supported=0), (True, True, False, 65535))


class Xml(unittest.TestCase):
    def setUp(self):
        self.shipped = (SOURCE / "deploy/plc/axisgate.xml").read_text(encoding="utf-8")

    def test_it_is_made_from_the_text(self):
        made = subprocess.run([SOURCE / "deploy/plc/make_xml", "-"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(made, self.shipped, "call deploy/plc/make_xml")

    def test_it_holds_every_block_with_every_variable(self):
        root = ElementTree.fromstring(self.shipped.encode())
        machine = Machine(("axisgate.st", TEXT))
        found = {pou.get("name"): [v.get("name") for v in pou.iter(f"{NAMESPACE}variable")] for pou in root.iter(f"{NAMESPACE}pou")}
        found |= {kind.get("name"): [v.get("name") for v in kind.iter(f"{NAMESPACE}variable")] for kind in root.iter(f"{NAMESPACE}dataType")}
        self.assertEqual({name: set(members) for name, members in found.items()},
                         {name: set(machine.members_of(name)) for name in machine.units})

    def test_its_bodies_say_what_the_text_says(self):
        root = ElementTree.fromstring(self.shipped.encode())
        squeezed = re.sub(r"\s+", " ", TEXT)
        for body in root.iter("{http://www.w3.org/1999/xhtml}xhtml"):
            self.assertIn(re.sub(r"\s+", " ", body.text), squeezed)


class Manual(unittest.TestCase):
    def test_its_program_is_the_one_that_runs(self):
        # The page has its licence where all pages have it.
        licence, program = EXAMPLE.split("\n", 1)
        self.assertIn("SPDX", licence)
        self.assertIn(program, MANUAL)

    def test_it_says_how_long_the_programs_are(self):
        for program in (EXAMPLE, PLAIN):
            code = re.sub(r"\(\*.*?\*\)", "", program, flags=re.S)
            self.assertIn(f" {sum(bool(line.strip()) for line in code.splitlines())} lines", MANUAL)

    def test_its_addresses_are_those_of_the_images(self):
        """CODESYS counts from 0, Siemens from 40001, or from 0 with a mode of its own."""
        images = {"In": (100, 39), "Out": (140, 17), "Info": (178, 18), "Preset": (178, 2)}
        codesys = re.findall(r"^\| (\w+)1 \| .* \| (\d+) \| (\d+) \|[^|]*\| `", MANUAL, re.M)
        self.assertEqual({name: (int(offset), int(length)) for name, offset, length in codesys}, images)
        siemens = re.findall(r"^\| (\w+), axis 1 \| ([01]) \| (\d+) \| 1(\d\d), (\d+) \| (\d+) \|", MANUAL, re.M)
        self.assertEqual({name: (int(zero), int(length)) for name, _, _, _, zero, length in siemens}, images)
        for _, mode, one, function, zero, _ in siemens:
            self.assertEqual((int(one) - 40001, function), (int(zero), {"0": "03", "1": "16"}[mode]))

    def test_its_command_numbers_are_those_of_the_register_map(self):
        row = re.search(r"^\| 54 \| command \|.*$", REGISTERS, re.M)[0]
        numbers = {name: number for number, name in re.findall(r"\b(\d+) ([a-z_]{4,})", row)}
        printed = re.search(r"Numbers: (.*?) \|$", MANUAL, re.M)[1]
        told = {name: number for number, name in re.findall(r"(\d+) (\w+)", printed)}
        self.assertGreater(len(told), 8)
        self.assertLessEqual(told.items(), numbers.items())
        sent = re.findall(r"Command := (\d+);  ?\(\* (\w+)", PLAIN)
        self.assertGreater(len(sent), 5)
        self.assertLessEqual({name: number for number, name in sent}.items(), numbers.items())

    def test_its_errors_of_rows_and_results_mean_what_the_sources_say(self):
        rows = dict(re.findall(r"^\| (\d+) \| (\w+) \|", REGISTERS.partition("| 40 |")[2], re.M))
        named = re.findall(r"16#01(\w\w) (?:the )?(\w+_\w+|command)\b", MANUAL)
        self.assertGreater(len(named), 2)
        for offset, name in named:
            self.assertEqual(rows[str(int(offset, 16))], name)
        words = dict(re.findall(r'\{result, (\d+), "([^"]+)"', WORDS))
        results = re.search(r"^\| 16#0003 to 16#(\w{4}) \|", MANUAL, re.M)[1]
        self.assertEqual(words[str(int(results, 16))], "not_reached", "the last result that is no DDS's")
        self.assertIn("another client owns the axis", re.search(r'\{result, 7, .*', WORDS)[0])
        self.assertIn("the axis is in no state for it", re.search(r'\{result, 9, .*', WORDS)[0])
        self.assertIn("7: another client owns the axis; 9: not enabled, faulted or stop-latched", MANUAL)

    def test_it_names_every_block_and_every_error(self):
        for name in BLOCKS:
            self.assertIn(name, MANUAL)
        errors = set(re.findall(r"(?:ErrorID|AnswerError|Wrong|Failed) := 16#(02\w\w)", TEXT))
        self.assertEqual(errors, set(re.findall(r"^\| 16#(02\w\w) \|", MANUAL, re.M)))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
