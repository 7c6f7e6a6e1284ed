# SPDX-License-Identifier: Apache-2.0
"""The settings of a drive in a file: saved by reads alone, compared, and written to the drive that takes its place."""
import json
import os
import re
import subprocess
import sys

from can_stage import CanStory
from processes import NEVER, Program, until
from stage import AXISGATE, SOURCE, Story, bus, drive, main

sys.path.insert(0, f"{SOURCE}/tests/docs")
from page_commands import of_page  # noqa: E402

# What the profile of a JD does not have: u16, index 60F9.
EDS = """[DeviceInfo]
VendorName=Made for tests
ProductName=JD
"""
OF_EDS = {"60F9sub1": "Velocity loop gain", "60F9subE": "Load observer", "2FF0subC": "Auto tuning start", "2010sub2": "Input simulation"}


def eds():
    return EDS + "".join(f"[{at}]\nParameterName={name}\nObjectType=0x7\nDataType=0x0006\nAccessType=rw\nPDOMapping=0\n" for at, name in OF_EDS.items())


class ParametersStory:
    def parameters(self, verb, *options, answer="", axis="1", file="axis.json"):
        return self.command_line("parameters", verb, self.config, axis, self.path(file), *options, answer=answer)

    def done(self, code, call):
        self.assertEqual(call.returncode, code, call.stdout + call.stderr)
        return call.stdout

    def saved(self, file="axis.json"):
        with open(self.path(file), encoding="utf-8") as saved:
            return json.load(saved)

    def edit(self, change, file="edited.json"):
        content = self.saved()
        change(content)
        with open(self.path(file), "w", encoding="utf-8") as edited:
            json.dump(content, edited)

    def objects(self, content):
        return {entry["at"]: entry for entry in content["objects"]}


class OnASerialLine(ParametersStory, Story):
    lines = {"lift": "jd@1"}

    def buses(self):
        return [bus(self.path("lift"), drive("jd", 1, 1, name="lift"))]

    def setUp(self):
        super().setUp()
        self.simulate()
        self.configure()
        with open(self.path("jd.eds"), "w", encoding="utf-8") as file:
            file.write(eds())
        self.eds = ("--eds", self.path("jd.eds"))

    def get(self, address):
        return self.sim.object("lift/1", address)

    def exchange(self):
        """Another drive takes the place of the first: its settings are others."""
        for address, value in (("60F9.01", 500), ("60F9.0E", 100), ("6073.00", 1000)):
            self.sim.ask(f"set lift/1 {address} {value}")

    def writes(self):
        return self.sim.writes("lift/1", "60F9.01", "60F9.0E", "6073.00", "6040.00", "6060.00", "2FF0.0C", "2010.02", "2010.03", "2FF0.01", "1017.00")

    def test_saved_compared_restored(self):
        self.done(0, self.parameters("save", *self.eds, axis="lift"))
        saved = self.saved()
        self.assertEqual((saved["axis"], saved["axis_name"], saved["profile"], saved["protocol"]), (1, "lift", "kinco-jd", "kinco-serial"))
        held = self.objects(saved)
        self.assertEqual((held["60F9.01"]["value"], held["60F9.01"]["name"], held["60F9.01"]["type"]), (100, "Velocity loop gain", "u16"))
        self.assertIn("6073.00", held)
        self.done(0, self.parameters("compare", *self.eds))
        self.assertIn("not written over", self.parameters("save").stderr)
        self.assertEqual(self.writes(), 0, "both only read")

        self.exchange()
        shown = self.done(1, self.parameters("compare", *self.eds))
        self.assertIn("Velocity loop gain (60F9.01): 100 in the file, 500 in the drive", shown)
        self.assertIn("max_current (6073.00): 2047 in the file, 1000 in the drive", shown)
        for answer in ("no\n", "", "y\n"):
            self.assertIn("nothing was written", self.done(1, self.parameters("restore", *self.eds, answer=answer)))
        self.assertEqual(self.writes(), 0)

        stores = int(self.sim.ask("stores lift/1"))
        shown = self.done(0, self.parameters("restore", *self.eds, answer="yes\n"))
        for line in ("60F9.01): 100 in the file, 500 in the drive: written", "3 written\n", "stored in the drive\n", "the drive is as the file has it"):
            self.assertIn(line, shown)
        self.assertEqual([self.get(at) for at in ("60F9.01", "60F9.0E", "6073.00")], [100, 20, 2047])
        self.assertEqual(self.writes(), 4, "three, and one that stores")
        until("stored, once", lambda: int(self.sim.ask("stores lift/1")) == stores + 1)
        self.assertNotIn("operation", self.sim.state("lift/1"))
        self.assertIn("nothing to write", self.done(0, self.parameters("restore", *self.eds)))

    def test_the_commands_of_the_page_back_up_and_restore(self):
        """With a folder in the place of the computer's root."""
        old, new = self.path("old"), self.path("new")
        for folder in ("etc/axisgate", "etc/udev/rules.d", "etc/systemd/network"):
            os.makedirs(f"{old}/{folder}")
        os.makedirs(new)
        os.rename(self.config, f"{old}/etc/axisgate/gateway.json")

        def typed(command, root, answer=""):
            for name in re.findall(r" (/\S*)", command):
                command = command.replace(f" {name}", f" {root}{name}".rstrip("/"))
            command = command.replace("AXIS", "1").replace("axisgate parameters", f"{AXISGATE} parameters")
            done = subprocess.run(["bash", "-c", command], cwd=self.folder, input=answer, capture_output=True, text=True, timeout=NEVER, check=False)
            self.assertEqual(done.returncode, 0, f"{command}: {done.stdout}{done.stderr}")
            return done.stdout

        typed(of_page("docs/installation.md", "axisgate parameters save"), old)
        typed(of_page("docs/installation.md", "tar -C / -czf"), old)
        typed(of_page("docs/installation.md", "tar -C / -xzf"), new)
        self.assertIn("nothing differs", typed(of_page("docs/installation.md", "axisgate parameters compare"), new))
        self.sim.ask("set lift/1 6073.00 1000")
        typed(of_page("docs/installation.md", "axisgate parameters restore"), new, "yes\n")
        self.assertEqual(self.get("6073.00"), 2047)

    def test_an_edited_file_and_a_drive_that_does_not_take_it(self):
        self.done(0, self.parameters("save", *self.eds))

        def change(content):
            held = self.objects(content)
            held["60F9.0E"]["value"] = 5  # the drive takes 20 to 15000
            held["60F9.01"]["value"] = 200
            held["2010.03"]["value"] = 1  # the input enables the drive
            held["2010.02"]["value"] = 1  # as if an input were on
            held["2FF0.0C"]["value"] = 11  # turns the motor
            held["6040.00"]["value"] = 15
            content["objects"].append({"at": "4444.00", "name": "nobody's", "type": "u16", "value": 1})

        self.edit(change)
        shown = self.done(1, self.parameters("restore", *self.eds, file="edited.json", answer="yes\n"))
        self.assertIn("Load observer (60F9.0E): 5 in the file, 20 in the drive: the drive holds 20, although 5 was written", shown)
        self.assertIn("1 written, 1 not", shown)
        self.assertIn("nobody's (4444.00): neither the profile nor an EDS", shown)
        self.assertIn("axisgate commission decides", shown)
        self.assertIn("still: Load observer", shown)
        self.assertEqual(self.get("60F9.01"), 200, "the others go on")
        self.assertEqual(self.sim.writes("lift/1", "2010.03", "2010.02", "2FF0.0C", "6040.00"), 0)

        self.edit(lambda content: content.update(profile="kinco-md"))
        other = self.parameters("restore", file="edited.json", answer="yes\n")
        self.assertIn("the file is of a drive with profile kinco-md, and this one has kinco-jd", other.stderr)
        self.edit(lambda content: content["objects"][0].update(value=2**40))
        wrong = self.parameters("restore", file="edited.json", answer="yes\n")
        self.assertRegex(wrong.stderr, r"edited.json: /objects/0/value: must be a whole number of ")
        self.assertEqual((other.returncode, wrong.returncode), (1, 1))
        self.assertIn('there are 1 "lift"', self.parameters("compare", axis="hoist").stderr)
        self.assertIn("cannot be read", self.parameters("compare", file="none.json").stderr)

    def test_a_drive_with_torque_or_a_running_gateway_is_left_alone(self):
        self.done(0, self.parameters("save", *self.eds))
        self.exchange()
        self.run_gateway()
        self.assertIn("stop it first", self.parameters("compare").stderr)
        self.client = self.connect()
        self.until_online()
        self.axis(1).command("enable")
        self.gateway.terminate()
        enabled = self.parameters("restore", *self.eds, answer="yes\n")
        self.assertEqual(enabled.returncode, 1)
        self.assertIn("disable it first", enabled.stderr)
        self.assertEqual(self.sim.writes("lift/1", "60F9.01", "60F9.0E", "6073.00"), 0)

    def test_a_drive_that_gets_torque_or_dies_behind_the_question(self):
        self.done(0, self.parameters("save", *self.eds))
        self.sim.ask("set lift/1 2010.03 1")
        for change, said in ((("input lift/1 1 on", "operation"), "is enabled"), (("unplug lift", None), "does not answer any more")):
            self.exchange()
            desk = self.keep(Program("axisgate parameters", [AXISGATE, "parameters", "restore", self.config, "1", self.path("axis.json"), *self.eds],
                                     stdin=subprocess.PIPE))
            desk.wait_for("then the drive stores them")  # the question is the next line
            self.sim.ask(change[0])
            if change[1]:
                until("it has torque", lambda word=change[1]: word in self.sim.state("lift/1"))
            desk.process.stdin.write("yes\n")
            desk.process.stdin.close()
            self.assertEqual(desk.ended(), 1)
            self.assertIn(said, desk.text())
            self.assertRegex(desk.text(), r"max_current \(6073.00\).*: not written")
            self.assertIn("0 written", desk.text())
            self.sim.ask("input lift/1 1 off")
            until("it has none", lambda: "operation" not in self.sim.state("lift/1"))
        self.assertEqual(self.sim.writes("lift/1", "60F9.01", "60F9.0E", "6073.00"), 0)

    def test_a_drive_that_dies_while_it_is_read_leaves_no_file(self):
        self.sim.ask("unplug lift")
        silent = self.parameters("save")
        self.assertIn("does not come online", silent.stderr)
        self.assertFalse(os.path.exists(self.path("axis.json")))


class OnCan(ParametersStory, CanStory):
    """A drive that says who it is."""

    drives_on = {"cell": "ld2@1"}

    def test_nothing_but_reads_leaves_until_the_yes(self):
        self.simulate()
        self.configure()
        where = self.node(1)
        self.done(0, self.parameters("save"))
        saved = self.saved()
        self.assertIn("vendor", saved["identity"])
        self.assertEqual(self.sim.writes(where, "1016.01", "1017.00", "1800.01", "6085.00", "6040.00"), 0)
        before = self.sim.object(where, "6085.00")
        self.sim.ask(f"set {where} 6085.00 {before + 5}")
        self.edit(lambda content: content["identity"].update(serial=4711), file="axis.json")  # it is another drive
        shown = self.done(0, self.parameters("restore", answer="yes\n"))
        self.assertIn("another serial number: 0x1267 in the file", shown)
        self.assertEqual(self.sim.object(where, "6085.00"), before)
        self.assertEqual(self.sim.writes(where, "1016.01", "1017.00", "1800.01", "6040.00"), 0, "it is not set up")

        with open(self.path("ld2.eds"), "w", encoding="utf-8") as file:
            file.write(EDS + "[5400sub1]\nParameterName=Sync period minimum\nObjectType=0x7\nDataType=0x0007\nAccessType=rw\n")
        with_eds = ("--eds", self.path("ld2.eds"))
        self.done(0, self.parameters("save", *with_eds, file="whole.json"))
        content = self.saved("whole.json")
        held = self.objects(content)
        held["5400.01"]["value"] = 5  # the drive takes 125 to 1000
        held["6085.00"]["value"] = before + 7
        with open(self.path("whole.json"), "w", encoding="utf-8") as file:
            json.dump(content, file)
        shown = self.done(1, self.parameters("restore", *with_eds, file="whole.json", answer="yes\n"))
        self.assertRegex(shown, r"Sync period minimum \(5400.01\).*: not written: refused by the drive: 0x0609\w+ .*; it is tried again at the end\n")
        self.assertIn("1 written, 1 not", shown)
        self.assertIn("still: Sync period minimum", shown)
        self.assertEqual(self.sim.object(where, "6085.00"), before + 7, "the others go on")
        self.edit(lambda content: content["identity"].update(product=4711))
        self.assertIn("the file is of a drive with product 0x1267", self.parameters("restore", file="edited.json", answer="yes\n").stderr)


if __name__ == "__main__":
    main()
