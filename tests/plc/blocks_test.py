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
LEAST = (SOURCE / "deploy/plc/example_least.st").read_text(encoding="utf-8")
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
        for word in set(re.findall(r"[A-Za-z_]\w*", re.sub(r"\(\*.*?\*\)", "", TEXT + EXAMPLE + PLAIN + LEAST, flags=re.S))):
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


class Least(unittest.TestCase):
    """The program of a dozen lines, before a gateway that only reads ids back: each command that it asks for, with its id."""

    def setUp(self):
        self.machine = Machine(("example_least.st", LEAST))
        self.power_on()

    def power_on(self):
        self.program, self.seen, self.asked = self.machine.new("Least"), 0, []

    def cycles(self, wish, count=3, heard=True):
        self.program.Wish = wish
        for _ in range(count):
            self.program.In1[30] = self.seen
            self.program.run()
            command, number = self.program.Out1[14], self.program.Out1[15]
            if self.asked[-1:] != [(command, number)]:
                self.asked.append((command, number))
            self.seen = number if heard else self.seen

    def test_each_wish_is_one_command_with_an_id_of_its_own_behind_a_0(self):
        for wish in (0, 1, 6, 6, 0, 6):
            self.cycles(wish)
        self.assertEqual(self.asked, [(0, 1), (1, 2), (6, 3), (0, 4), (6, 5)])
        self.assertEqual((self.program.Out1[2], self.program.Out1[3]), (0, 10000))
        self.assertEqual((self.program.Out1[8], self.program.Out1[9]), (0, 60000))

    def test_what_is_wished_at_the_start_is_not_carried_out(self):
        for seen in (0, 1, 57):
            self.power_on()
            self.seen = seen
            self.cycles(6, count=20)
            self.assertEqual(self.asked, [(0, 1)])

    def test_a_stop_waits_for_no_answer_and_the_others_do(self):
        self.cycles(0)
        self.cycles(1, heard=False)
        self.cycles(6, heard=False)
        self.assertEqual(self.asked[-1], (1, 2))
        self.cycles(3, heard=False)
        self.assertEqual(self.asked[-1], (3, 3))

    def test_its_heartbeat_changes_in_each_cycle_and_its_id_skips_0(self):
        beats = []
        for _ in range(4):
            self.cycles(0, count=1)
            beats.append(self.program.Out1[16])
        self.assertEqual([a != b for a, b in zip(beats, beats[1:])], [True, True, True])
        self.program.Id = 65535
        self.cycles(2)
        self.assertEqual(self.asked[-1], (2, 1))


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
        for text in (EXAMPLE, LEAST):
            licence, program = text.split("\n", 1)
            self.assertIn("SPDX", licence)
            self.assertIn(program, MANUAL)

    def test_it_says_how_long_the_programs_are(self):
        for program in (EXAMPLE, PLAIN):
            code = re.sub(r"\(\*.*?\*\)", "", program, flags=re.S)
            self.assertIn(f" {sum(bool(line.strip()) for line in code.splitlines())} lines", MANUAL)
        body = LEAST.rpartition("END_VAR\n")[2].partition("END_PROGRAM")[0]
        self.assertEqual(len(body.splitlines()), 12)
        self.assertIn("## 3. Twelve lines without blocks", MANUAL)

    def test_its_addresses_are_those_of_the_images(self):
        """CODESYS counts from 0, Siemens from 40001, or from 0 with a mode of its own."""
        images = {"In": (100, 39), "Out": (140, 17), "Info": (178, 18), "Preset": (178, 2)}
        codesys = re.findall(r"^\| (\w+)1 \| .* \| (\d+) \| (\d+) \|[^|]*\| `", MANUAL, re.M)
        self.assertEqual({name: (int(offset), int(length)) for name, offset, length in codesys}, images)
        ranges = re.findall(r"^\| `(\w+)` \| 100 \* n(?: \+ (\d+))? to 100 \* n \+ (\d+) \| (\d+) to (\d+) \|", MANUAL, re.M)
        self.assertEqual({name: (100 + int(first or 0), int(last) - int(first or 0) + 1) for name, first, last, _, _ in ranges}, images)
        for name, _, _, first, last in ranges:
            self.assertEqual((int(first) - 40001, int(last) - int(first) + 1), images[name])
        siemens = re.findall(r"^\| (\w+), axis 1 \| ([01]) \| (\d+) \| 1(\d\d), (\d+) \| (\d+) \|", MANUAL, re.M)
        self.assertEqual({name: (int(zero), int(length)) for name, _, _, _, zero, length in siemens}, images)
        for _, mode, one, function, zero, _ in siemens:
            self.assertEqual((int(one) - 40001, function), (int(zero), {"0": "03", "1": "16"}[mode]))

    def test_its_rows_are_those_of_the_register_map(self):
        axis = REGISTERS.partition("## Axis n: registers")[2]
        rows = dict(re.findall(r"^\| (\d+) \| (\w+) \|", axis.partition("## Axis n: coils")[0], re.M))
        told = re.findall(r"^\| (1\d\d)(?:, 1\d\d)? \| (4\d{4}) \| `(\w+)\[(\d+)\]`(?:, `\w+\[\d+\]`)? \| (\w+)", MANUAL, re.M)
        self.assertGreater(len(told), 15)
        for register, reference, image, index, name in told:
            self.assertEqual(rows[str(int(register) - 100)], name)
            self.assertEqual(int(reference), 40001 + int(register))
            self.assertEqual(int(register), {"In": 100, "Out": 140}[image] + int(index))

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
        self.assertEqual([row for row in re.findall(r"^\| 16#0.*$", MANUAL, re.M) if re.search(r"\|  \|$", row)], [], "what to do about it")
        errors = set(re.findall(r"(?:ErrorID|AnswerError|Wrong|Failed) := 16#(02\w\w)", TEXT))
        self.assertEqual(errors, set(re.findall(r"^\| 16#(02\w\w) \|", MANUAL, re.M)))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
