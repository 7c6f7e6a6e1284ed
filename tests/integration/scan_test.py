# SPDX-License-Identifier: Apache-2.0
"""`axisgate scan` on a serial port and on a serial CAN adapter: who is there is found, nothing is written, and what cannot be used is
named. What is asked of whom, and what a scan makes of it, is told by Scan and SerialScan of tests/unit/commands."""
import os
import pwd
import re
import shutil
import subprocess
import tempfile

from processes import NEVER, Program, until
from stage import AXISGATE, SOURCE, Story, main

NOBODY_KNOWS = 65534  # a user without rights, of every system
# Patience for a busy machine: who does not answer within that is not there.
SERIAL, CAN = ("--timeout-ms", "2500"), ("--timeout-ms", "1000")
# Line: who hangs on it, and what of it a scan is asked to look at.
LINES = {"kinco": ("jd@3,md@4", ("--baud", "38400", "--stations", "3-4", *SERIAL)),
         "rtu": ("rtu:md@2,id286pro@3", ("--baud", "19200", "--stations", "2-3", "--protocol", "modbus-rtu", *SERIAL)),
         "can": ("lawicel:ld2@3,md@4,jd@5", ("--nodes", "1-6", *CAN))}
FOUND = {"kinco": {3: "kinco-jd", 4: "kinco-md"}, "rtu": {2: "kinco-md", 3: "id286pro"},
         "can": {3: "leadshine-ld2-can", 4: "kinco-md", 5: "kinco-jd"}}
BUS_ON_CAN = '{"name": "can", "adapter": "canopen", "device": "slcan:can", "bitrate": 500000, "drives": [%s]}'
PROPOSED = {"rtu": ("a bus of a configuration", "%s"), "can": ('"drives" of a configuration', BUS_ON_CAN)}


class ScanStory(Story):
    lines = {line: drives for line, (drives, _) in LINES.items()}

    def device(self, line):
        return f"slcan:{self.path(line)}" if line == "can" else self.path(line)

    def scan(self, line, *options):
        return self.command_line("scan", self.device(line), *options)

    def check_bus(self, bus):
        config = self.path("proposed.json")
        with open(config, "w", encoding="utf-8") as file:
            file.write('{"modbus_tcp": [{"listen": "127.0.0.1:1502"}], "buses": [' + bus + "]}")
        return self.command_line("check", config)

    def profiles(self, line, text):
        """Of each line of the table: the node and the profile that fits."""
        table = text.partition("\n\n")[0].splitlines()[1:]
        cells = [re.split(r" {2,}", row.strip()) for row in table]
        column, profile = (0, -1) if line == "can" else (2, 3)
        return {int(row[column]): row[profile].split()[0] for row in cells}


class WhoIsThere(ScanStory):
    def setUp(self):
        super().setUp()
        self.simulate()

    def test_each_drive_is_found_with_the_profile_that_fits_it_and_nothing_is_written(self):
        drives = [f"{line}/{node}" for line, nodes in FOUND.items() for node in nodes]
        before = [self.sim.state(name) for name in drives]
        for line, (_, options) in LINES.items():
            ended = self.scan(line, *options)
            self.assertEqual(ended.returncode, 0, ended.stderr)
            self.assertEqual(self.profiles(line, ended.stdout), FOUND[line])
        self.assertEqual([self.sim.state(name) for name in drives], before)
        for name in drives:
            if name != "rtu/3":  # whose registers have other names
                self.assertEqual(self.sim.writes(name), 0)

    def test_what_it_proposes_is_a_configuration(self):
        for line, (words, bus) in PROPOSED.items():
            proposed = self.scan(line, *LINES[line][1]).stdout.partition(words)[2].partition("\n")[2]
            checked = self.check_bus(bus % proposed)
            self.assertEqual((checked.returncode, checked.stdout), (1, ""), "nobody has filled it in")
            self.assertIn('/constants/peak_current_a: still says "FILL IN"', checked.stderr)
            checked = self.check_bus(bus % proposed.replace('"FILL IN"', "27.5"))
            self.assertNotIn("unknown key", checked.stderr)
            self.assertEqual(checked.stdout.count("\nAxis "), len(FOUND[line]), checked.stdout + checked.stderr)


class NobodyAnswers(ScanStory):
    def test_the_user_is_told_where_to_look(self):
        self.simulate()
        for line, options, words in (
                ("kinco", ("--stations", "50-52", "--baud", "38400,19200"), ("nothing answered", "RX to TX", "--baud", "--parity", "slcan:")),
                ("can", ("--nodes", "50-52"), ("3 nodes asked", "cable", "bit rate", "500000", "120 ohm"))):
            ended = self.scan(line, *options, "--timeout-ms", "20")
            self.assertEqual((ended.returncode, ended.stdout), (1, ""))
            for word in ("each waited for 20 ms", "powered", *words):
                self.assertIn(word, ended.stderr)

    def test_drives_slower_than_the_time_given_are_told_apart_from_none(self):
        self.simulate(None, "--reply-delay-ms", "60")
        ended = self.scan("can", "--nodes", "3-60", "--timeout-ms", "20")
        self.assertEqual(ended.returncode, 1)
        self.assertRegex(ended.stderr, r"[1-9] answers came that nobody waited for .* --timeout-ms")

    def test_one_that_falls_silent_is_told_and_left(self):
        self.simulate()
        for line, words in (("kinco", "station 3"), ("can", "node 3")):
            self.sim.ask(f"reply-delay {line} 20")
            program = self.keep(Program("axisgate scan", [AXISGATE, "scan", self.device(line), *LINES[line][1]]))
            until("the first is read", lambda line=line: int(self.sim.ask(f"exchanges {line}")) > 10)
            self.sim.ask(f"unresponsive {line}/3 on")
            self.assertEqual(program.ended(), 0)
            self.assertRegex(program.text(), f"{words}: it fell silent while it was asked")
            self.assertRegex(program.text(), r"\n.* 4  .*kinco-md")


class WhatCannotBeUsed(ScanStory):
    def test_a_port_that_a_gateway_has_is_refused_and_left_alone(self):
        self.lines = {"lift": "jd@1", "feeder": "md@1"}
        self.start()
        ended = self.scan("lift", "--stations", "1-3")
        self.assertEqual(ended.returncode, 1)
        self.assertIn(f"{self.path('lift')}: another process is using it", ended.stderr)
        self.assert_online(self.axis(1))

    def test_a_port_that_is_pulled_out_meanwhile_and_one_that_is_not_there(self):
        self.simulate()
        scans = {line: self.keep(Program("axisgate scan", [AXISGATE, "scan", self.device(line), "--timeout-ms", "5000"]))
                 for line in ("kinco", "can")}
        for program in scans.values():
            program.wait_for("% asked|nodes asked|at most where nobody answers")
        self.sim.terminate()
        for line, program in scans.items():
            self.assertEqual(program.ended(), 1)
            self.assertIn(self.path(line), program.text())
        ended = self.scan("no-such-port")
        self.assertEqual(ended.returncode, 1)
        self.assertIn("No such file or directory", ended.stderr)

    def test_ctrl_c_shows_what_was_found_so_far(self):
        self.simulate()
        for line, options in (("kinco", ("--stations", "3-120", "--baud", "38400", "--protocol", "kinco-serial", *SERIAL)),
                              ("can", ("--nodes", "3-127", *CAN))):
            command = [AXISGATE, "scan", self.device(line), *options]
            with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
                for text in process.stderr:
                    if f" {len(FOUND[line])} found" in text:
                        break
                process.send_signal(2)
                out, err = process.communicate(timeout=NEVER)
            self.assertEqual(process.returncode, 1)
            self.assertEqual(self.profiles(line, out), FOUND[line])
            self.assertRegex(err, "ended before all (stations|nodes) were asked")

    def test_without_the_right_to_open_it_the_group_is_named(self):
        self.simulate()
        # A copy that this user can reach, wherever the build is, and a device that belongs to a group.
        with tempfile.TemporaryDirectory(prefix="axisgate-rights-") as folder:
            os.chmod(folder, 0o755)
            program, device = f"{folder}/axisgate", os.path.realpath(self.path("kinco"))
            shutil.copy(AXISGATE, program)
            shutil.copytree(f"{SOURCE}/schemas/drives", f"{folder}/drives")
            os.chown(device, 0, 20)
            os.chmod(device, 0o660)
            ended = subprocess.run([program, "scan", device, "--profiles", f"{folder}/drives"], user=NOBODY_KNOWS, group=NOBODY_KNOWS,
                                   extra_groups=[], capture_output=True, text=True, timeout=NEVER, check=False)
        name = pwd.getpwuid(NOBODY_KNOWS).pw_name
        self.assertEqual(ended.returncode, 1)
        self.assertIn(f"{device}: Permission denied: it belongs to group dialout, and user {name} is not in it: "
                      f"usermod -aG dialout {name}", ended.stderr)


if __name__ == "__main__":
    main()
