# SPDX-License-Identifier: Apache-2.0
"""`axisgate scan` on a serial CAN adapter: who is there is found, nobody is disturbed, and what cannot be used is named."""
import re
import subprocess

from processes import NEVER, Program, until
from stage import AXISGATE, Story, main

SHOWN = ("node", "name", "vendor", "product", "revision", "serial", "heartbeat", "profile")


class ScanStory(Story):
    lines = {"can": "lawicel:ld2@3,md@4,jd@5"}

    def device(self):
        return "slcan:" + self.path("can")

    def scan(self, *options, device=None):
        patience = () if "--timeout-ms" in options else ("--timeout-ms", "1000")  # a busy machine's answers come late
        return self.command_line("scan", device or self.device(), *options, *patience)

    def table(self, text):
        """The rows of the table by node."""
        lines = text.splitlines()
        self.assertEqual(tuple(lines[0].split()), SHOWN)
        rows = [re.split(r"  +", line.strip()) for line in lines[1 : lines.index("")]]
        return {int(row[0]): dict(zip(SHOWN, row)) for row in rows}


class WhoIsThere(ScanStory):
    def setUp(self):
        super().setUp()
        self.simulate()

    def test_each_drive_is_found_with_the_profile_that_fits_it(self):
        ended = self.scan("--nodes", "1-20")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        found = self.table(ended.stdout)
        self.assertEqual(sorted(found), [3, 4, 5])
        for node, profile, name in ((3, "leadshine-ld2-can", "LD2-CAN"), (4, "kinco-md", "MD"), (5, "kinco-jd", "JD")):
            self.assertRegex(found[node]["profile"], rf"^{profile} \((\d+) of \1 objects\)$")
            self.assertEqual(int(found[node]["vendor"], 16), self.sim.object(f"can/{node}", "1018.01"))
            self.assertTrue(found[node]["name"].startswith(name), found[node]["name"])

    def test_what_it_proposes_is_a_configuration(self):
        proposed = self.scan("--nodes", "3-5").stdout.partition('"drives" of a configuration')[2].partition("\n")[2]
        constants = {"kinco-md": '"constants": {"peak_current_a": 36}', "kinco-jd": '"constants": {"peak_current_a": 27.5}'}
        for profile, words in constants.items():
            proposed = proposed.replace(f'"profile": "{profile}"', f'"profile": "{profile}", {words}')
        config = self.path("proposed.json")
        with open(config, "w", encoding="utf-8") as file:
            file.write(f'{{"modbus_tcp": [{{"listen": "127.0.0.1:1502"}}], "buses": [{{"name": "can", "adapter": "canopen", "device": "{self.device()}", '
                       f'"bitrate": 500000, "drives": [{proposed}]}}]}}')
        checked = self.command_line("check", config)
        self.assertEqual(checked.returncode, 0, checked.stderr)
        self.assertEqual(checked.stdout.count("\nAxis "), 3, checked.stdout)

    def test_it_reads_only_and_starts_nobody(self):
        states = {node: self.sim.ask(f"nmt can/{node}") for node in (3, 4, 5)}
        self.assertEqual(self.scan("--nodes", "1-10").returncode, 0)
        for node, state in states.items():
            self.assertEqual(self.sim.ask(f"nmt can/{node}"), state)
            self.assertEqual(self.sim.writes(f"can/{node}"), 0)
            self.assertEqual(self.sim.writes(f"can/{node}", "1016.01", "1017.00", "1800.01", "1A00.00", "100C.00", "6007.00"), 0)

    def test_a_heartbeat_tells_the_state(self):
        self.sim.ask("set can/4 1017.00 50")
        found = self.table(self.scan("--nodes", "3-5").stdout)
        self.assertEqual(found[4]["heartbeat"], "pre-operational")
        self.assertEqual(found[3]["heartbeat"], "-")

    def test_only_the_nodes_of_the_range_are_asked(self):
        ended = self.scan("--nodes", "4")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertEqual(list(self.table(ended.stdout)), [4])

    def test_a_node_that_falls_silent_is_told_and_left(self):
        self.sim.ask("reply-delay can 20")
        # Patience for a busy machine: a node is silent for it after so long.
        program = self.keep(Program("axisgate scan", [AXISGATE, "scan", self.device(), "--nodes", "4-5", "--timeout-ms", "1000"]))
        until("node 4 is read", lambda: int(self.sim.ask("exchanges can")) > 10)
        self.sim.ask("unresponsive can/4 on")
        self.assertEqual(program.ended(), 0)
        self.assertRegex(program.text(), "node 4: it fell silent while it was asked")
        self.assertRegex(program.text(), r"\n +5 .*kinco-jd")


class NobodyAnswers(ScanStory):
    def test_the_user_is_told_where_to_look(self):
        self.simulate()
        ended = self.scan("--nodes", "50-52", "--timeout-ms", "20")
        self.assertEqual(ended.returncode, 1)
        self.assertEqual(ended.stdout, "")
        self.assertIn("3 nodes asked, each waited for 20 ms", ended.stderr)
        for word in ("powered", "cable", "bit rate", "500000", "120 ohm"):
            self.assertIn(word, ended.stderr)

    def test_drives_slower_than_the_time_given_are_told_apart_from_none(self):
        self.simulate(None, "--reply-delay-ms", "60")
        ended = self.scan("--nodes", "3-60", "--timeout-ms", "20")
        self.assertEqual(ended.returncode, 1)
        self.assertRegex(ended.stderr, r"[1-9] answers came that nobody waited for .* --timeout-ms")
        self.assertEqual(list(self.table(self.scan("--nodes", "3", "--timeout-ms", "1000").stdout)), [3])


class WhatCannotBeUsed(ScanStory):
    def test_an_adapter_that_another_program_has(self):
        self.simulate()
        drive = {"profile": "leadshine-ld2-can", "node": 3, "axes": [{"axis": 3, "lease": None}]}
        self.configure(buses=[{"name": "can", "adapter": "canopen", "device": self.device(), "bitrate": 500000, "drives": [drive]}])
        self.run_gateway()
        self.client = self.connect()
        self.until_online()
        ended = self.scan()
        self.assertEqual(ended.returncode, 1)
        self.assertIn("another process is using it", ended.stderr)
        self.assert_online(self.axis(3))

    def test_an_adapter_that_is_pulled_out_meanwhile(self):
        self.simulate()
        program = self.keep(Program("axisgate scan", [AXISGATE, "scan", self.device(), "--timeout-ms", "10000"]))
        program.wait_for("nodes asked")
        self.sim.terminate()
        self.assertEqual(program.ended(), 1)
        self.assertIn(self.path("can"), program.text())

    def test_a_bus_off_meanwhile_ends_the_scan_with_the_reason(self):
        self.simulate()
        program = self.keep(Program("axisgate scan", [AXISGATE, "scan", self.device(), "--timeout-ms", "1000"]))
        program.wait_for("nodes asked")
        self.sim.ask("bus-off can on")
        self.assertEqual(program.ended(), 1)
        self.assertRegex(program.text(), "bus-off|nobody acknowledges")
        self.assertIn("120 ohm", program.text())

    def test_ctrl_c_shows_what_was_found_so_far(self):
        self.simulate()
        command = [AXISGATE, "scan", self.device(), "--nodes", "3-127", "--timeout-ms", "2000"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            for line in process.stderr:
                if " 3 found" in line:
                    break
            process.send_signal(2)
            out, err = process.communicate(timeout=NEVER)
        self.assertEqual(process.returncode, 1)
        self.assertEqual(sorted(self.table(out)), [3, 4, 5])
        self.assertIn("ended before all nodes were asked", err)


if __name__ == "__main__":
    main()
