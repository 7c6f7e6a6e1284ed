# SPDX-License-Identifier: Apache-2.0
"""Adapters that are nearly right, on every serial protocol: a transceiver that makes bytes when it turns round, one that hears itself,
one that is looped."""
from modbus import DISABLED, STANDSTILL
from processes import until
from stage import Story, bus, drive, main

GLITCHES = ("0x00 1 0", "0xFF 8 0", "0x00 2 4", "0xFF 1 25")  # byte, how many, ms before the answer; 0: glued to it
ENOUGH = 20
JD_RTU, JD_KINCO = 1, 3  # axes
ONLY_COPIES = "only copies of our own requests come: the adapter hears itself, or the line is looped"


class PoorAdapter(Story):
    lines = {"rtu": "rtu:jd@1", "stepper": "rtu:id286pro@1", "kinco": "jd@1", "rs232": "keya-rs232", "rs485": "keya-rs485@1"}
    drives = {"rtu": "rtu/1", "stepper": "stepper/1", "kinco": "kinco/1", "rs232": "rs232/1", "rs485": "rs485/1"}

    def buses_at(self, baud):
        def keya(first, **node):
            axes = [{"axis": first + motor, "name": f"wheel-{first + motor}", "motor": "AB"[motor], "lease": None} for motor in (0, 1)]
            return {"profile": "keya-kydas4860-2e", "constants": {}, "axes": axes, **node}

        return [bus(self.path("rtu"), drive("jd", 1, JD_RTU), adapter="modbus-rtu", baud=baud),
                bus(self.path("stepper"), drive("id286pro", 1, 2), adapter="modbus-rtu", baud=baud),
                bus(self.path("kinco"), drive("jd", 1, JD_KINCO), baud=baud),
                bus(self.path("rs232"), keya(4), adapter="keya-rs232"),  # each of its interfaces has one rate
                bus(self.path("rs485"), keya(6, node=1), adapter="keya-rs485")]

    def serve(self, baud, words):
        """A gateway that meets the drives with their faults from the first byte on."""
        self.simulate(None, "--baud-timing", str(baud))
        for word in words:
            self.sim.ask(word)
        self.configure(None, self.buses_at(baud))
        self.run_gateway()
        self.client = self.connect()

    def all_buses(self):
        return [self.client.bus(number) for number in range(len(self.lines))]

    def assert_obeys(self, number):
        axis = self.axis(number)
        axis.command("enable")
        axis.until(axis_state=STANDSTILL)
        axis.command("disable")
        axis.until(axis_state=DISABLED)


class Glitches(PoorAdapter):
    def online_at(self, baud, shift):
        kinds = [GLITCHES[(shift + number) % len(GLITCHES)] for number in range(len(self.lines))]
        self.serve(baud, [f"glitch {name} {kind} on" for name, kind in zip(self.drives.values(), kinds)])
        self.until_online()
        until("bytes were skipped on each line", lambda: all(each["dropped_bytes"] >= ENOUGH for each in self.all_buses()))
        self.assertEqual([each["bad_frames"] for each in self.all_buses()], [0] * len(self.lines))
        self.assert_obeys(JD_RTU)
        self.assertFalse(self.gateway.found("two drives"))

    def test_at_9600_baud(self):
        self.online_at(9600, 0)

    def test_at_19200_baud(self):
        self.online_at(19200, 1)

    def test_at_38400_baud(self):
        self.online_at(38400, 2)

    def test_at_115200_baud(self):
        self.online_at(115200, 3)


class Echo(PoorAdapter):
    def online_at(self, baud, delay):
        self.serve(baud, [f"echo {line} on" for line in self.lines] + [f"reply-delay {line} {delay}" for line in self.lines])
        self.until_online()
        until("copies were dropped on each line", lambda: all(each["echoes"] >= ENOUGH for each in self.all_buses()))
        self.assertEqual([each["bad_frames"] for each in self.all_buses()], [0] * len(self.lines))
        self.assert_obeys(JD_RTU)
        self.assert_obeys(JD_KINCO)

    def test_with_the_answer_at_once(self):
        self.online_at(19200, 0)

    def test_with_the_answer_5_ms_behind(self):
        self.online_at(115200, 5)

    def test_with_the_answer_5_ms_behind_on_a_slow_line(self):
        self.online_at(9600, 5)


class Looped(PoorAdapter):
    def test_is_named_and_nobody_is_online_before_the_drives_are_heard(self):
        self.serve(115200, [f"echo {line} only" for line in self.lines])
        for line in self.lines:
            self.gateway.wait_for(f"bus {line}: {ONLY_COPIES}")
        self.assertEqual(self.client.gateway()["axes_online"], 0)
        until("copies were counted on each line", lambda: all(each["echoes"] >= 3 for each in self.all_buses()))
        for line in self.lines:
            self.sim.ask(f"echo {line} off")
        self.until_online()
        self.assert_obeys(JD_RTU)


class ScanOfPoorAdapters(PoorAdapter):
    def scan(self, line):
        return self.command_line("scan", self.path(line), "--baud", "19200", "--stations", "1", "--timeout-ms", "2500")

    def test_says_the_same(self):
        self.simulate(None, "--baud-timing", "19200")
        for line in ("rtu", "kinco"):
            self.sim.ask(f"echo {line} on")
            self.sim.ask(f"glitch {line}/1 0x00 2 0 on")
            ended = self.scan(line)
            self.assertEqual(ended.returncode, 0, ended.stderr)
            self.assertIn("the line echoes", ended.stderr)
            self.sim.ask(f"echo {line} only")
            ended = self.scan(line)
            self.assertEqual(ended.returncode, 1)
            self.assertIn("the adapter hears itself, or the line is looped", ended.stderr)


if __name__ == "__main__":
    main()
