# SPDX-License-Identifier: Apache-2.0
"""`axisgate scan` on a serial port: who is there is found, nothing is written, and a port that cannot be used is named."""
import os
import pwd
import re
import shutil
import subprocess
import tempfile

from processes import NEVER, Program, until
from stage import AXISGATE, SOURCE, Story, main

NOBODY_KNOWS = 65534  # a user without rights, of every system


class ScanStory(Story):
    lines = {"kinco": "jd@3,md@4", "rtu": "rtu:md@2,id286pro@3"}

    def scan(self, line, *options):
        return self.command_line("scan", self.path(line), *map(str, options))

    def rows(self, text):
        """Protocol, rate, station and the profile that fits, of each line of the table."""
        found = re.findall(r"^(\S+) +(\d+) +(\d+)  (\S+)", text.partition("\n\n")[0], re.M)
        return [(protocol, int(baud), int(station), profile) for protocol, baud, station, profile in found]


class WhoIsThere(ScanStory):
    def setUp(self):
        super().setUp()
        self.simulate()

    def test_each_drive_is_found_with_its_protocol_and_a_profile(self):
        # Patience for a busy machine: a station is silent for the scan after so long.
        ended = self.scan("kinco", "--baud", 38400, "--stations", "3-4", "--timeout-ms", 2500)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertEqual(self.rows(ended.stdout), [("kinco-serial", 38400, 3, "kinco-jd"), ("kinco-serial", 38400, 4, "kinco-md")])
        ended = self.scan("rtu", "--baud", 19200, "--stations", "2-3", "--timeout-ms", 2500)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertEqual(self.rows(ended.stdout), [("modbus-rtu", 19200, 2, "kinco-md"), ("modbus-rtu", 19200, 3, "id286pro")])

    def test_nothing_is_written_and_nothing_moves(self):
        before = {name: self.sim.state(name) for name in ("kinco/3", "kinco/4", "rtu/2", "rtu/3")}
        for line in self.lines:
            self.assertEqual(self.scan(line, "--baud", "19200,38400", "--stations", "2-4", "--timeout-ms", 1500).returncode, 0)
        for name, state in before.items():
            self.assertEqual(self.sim.state(name), state)
        for name in ("kinco/3", "kinco/4", "rtu/2"):
            self.assertEqual(self.sim.writes(name), 0)

    def test_only_what_was_asked_for_is_asked(self):
        ended = self.command_line("scan", "--baud", "9600", "--stations", "4", "--protocol", "kinco-serial", "--timeout-ms", "2500",
                                  self.path("kinco"))
        self.assertEqual(self.rows(ended.stdout), [("kinco-serial", 9600, 4, "kinco-md")])
        self.assertIn("1 rate(s), 1 station(s): 1 reads, 3 s at most", ended.stderr)
        ended = self.scan("kinco", "--baud", 9600, "--stations", 4, "--protocol", "modbus-rtu", "--timeout-ms", 100)
        self.assertEqual(ended.returncode, 1)
        self.assertEqual(ended.stdout, "")

    def test_what_it_proposes_is_a_configuration(self):
        ended = self.scan("rtu", "--baud", 19200, "--stations", "2-3", "--protocol", "modbus-rtu", "--timeout-ms", 2500)
        bus = ended.stdout.partition("a bus of a configuration")[2].partition("\n")[2]
        bus = bus.replace('"profile": "kinco-md"', '"profile": "kinco-md", "constants": {"peak_current_a": 36}')
        config = self.path("proposed.json")
        with open(config, "w", encoding="utf-8") as file:
            file.write('{"modbus_tcp": [{"listen": "127.0.0.1:1502"}], "buses": [' + bus + "]}")
        checked = self.command_line("check", config)
        self.assertNotIn("unknown key", checked.stderr)
        self.assertEqual(checked.stdout.count("\nAxis "), 2, checked.stdout + checked.stderr)

    def test_a_station_that_falls_silent_is_told_and_left(self):
        self.sim.ask("reply-delay kinco 20")
        program = self.keep(Program("axisgate scan", [AXISGATE, "scan", self.path("kinco"), "--stations", "3-4", "--baud", "38400",
                                                      "--protocol", "kinco-serial", "--timeout-ms", "2500"]))
        until("station 3 is read", lambda: int(self.sim.ask("exchanges kinco")) > 10)
        self.sim.ask("unresponsive kinco/3 on")
        self.assertEqual(program.ended(), 0)
        self.assertRegex(program.text(), "station 3: it fell silent while it was asked")
        self.assertRegex(program.text(), r"\nkinco-serial +38400 +4  kinco-md")


class WhatCannotBeUsed(ScanStory):
    def test_nobody_answers(self):
        self.simulate()
        ended = self.scan("kinco", "--stations", "50-52", "--baud", "38400,19200", "--timeout-ms", 20)
        self.assertEqual(ended.returncode, 1)
        self.assertEqual(ended.stdout, "")
        for word in ("nothing answered", "each waited for 20 ms", "powered", "RX to TX", "--baud", "--parity", "slcan:"):
            self.assertIn(word, ended.stderr)

    def test_a_port_that_a_gateway_has_is_refused_and_left_alone(self):
        self.lines = {"lift": "jd@1", "feeder": "md@1"}
        self.start()
        ended = self.scan("lift", "--stations", "1-3")
        self.assertEqual(ended.returncode, 1)
        self.assertIn(f"{self.path('lift')}: another process is using it", ended.stderr)
        self.assert_online(self.axis(1))

    def test_a_port_that_is_pulled_out_meanwhile_and_one_that_is_not_there(self):
        self.simulate()
        program = self.keep(Program("axisgate scan", [AXISGATE, "scan", self.path("kinco"), "--timeout-ms", "5000"]))
        program.wait_for("% asked|at most where nobody answers")
        self.sim.terminate()
        self.assertEqual(program.ended(), 1)
        self.assertIn(self.path("kinco"), program.text())
        ended = self.scan("no-such-port")
        self.assertEqual(ended.returncode, 1)
        self.assertIn("No such file or directory", ended.stderr)

    def test_ctrl_c_shows_what_was_found_so_far(self):
        self.simulate()
        command = [AXISGATE, "scan", self.path("kinco"), "--stations", "3-120", "--baud", "38400", "--protocol", "kinco-serial",
                   "--timeout-ms", "2500"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            for line in process.stderr:
                if " 2 found" in line:
                    break
            process.send_signal(2)
            out, err = process.communicate(timeout=NEVER)
        self.assertEqual(process.returncode, 1)
        self.assertEqual([row[2] for row in self.rows(out)], [3, 4])
        self.assertIn("ended before all stations were asked", err)

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
            ended = subprocess.run([program, "scan", device, "--profiles", f"{folder}/drives"], user=NOBODY_KNOWS, group=NOBODY_KNOWS, extra_groups=[],
                                   capture_output=True, text=True, timeout=NEVER, check=False)
        name = pwd.getpwuid(NOBODY_KNOWS).pw_name
        self.assertEqual(ended.returncode, 1)
        self.assertIn(f"{device}: Permission denied: it belongs to group dialout, and user {name} is not in it: "
                      f"usermod -aG dialout {name}", ended.stderr)


if __name__ == "__main__":
    main()
