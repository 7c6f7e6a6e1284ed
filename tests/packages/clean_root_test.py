# SPDX-License-Identifier: Apache-2.0
"""The packages as a user has them: see tests/packages/run, which calls this.

clean_root_test.py SOURCE_FOLDER BUILD_FOLDER WORK_FOLDER CLEAN_ROOT_TAR [unittest's arguments]
"""
import json
import os
import re
import socket
import subprocess
import sys
import time
import unittest
from pathlib import Path

from clean_root import CleanRoot, Network, Program, Unit, run, until
from installed_commands import MANUAL, Installed

SOURCE, BUILD, WORK, TAR = (Path(path).absolute() for path in sys.argv[1:5])
sys.path.insert(0, f"{SOURCE}/tests/docs")
from page_commands import of_page, single  # noqa: E402

GATEWAY_ADDRESS, PLC_ADDRESS = "192.168.1.10", "192.168.1.20"  # as the example has them
CONFIGURATION = "etc/axisgate/gateway.json"
ONLINE = 2
ADOPTED = 1 << 1
CONTROLWORD = "6040.00"


def make(*options):
    """The packages, by name."""
    lines = run(SOURCE / "deploy/package", "--built", BUILD, *options, WORK / "debs").split()
    return {Path(line).name.partition("_")[0]: Path(line) for line in lines}


class Lintian(unittest.TestCase):
    def test_finds_no_error(self):
        debs = make()
        done = subprocess.run(["lintian", "--allow-root", "--fail-on", "error", "--display-info", *debs.values()], capture_output=True,
                              text=True, check=False)
        found = [line for line in done.stdout.splitlines() if re.match("[EWI]:", line)]
        print("lintian:", *found, sep="\n  ")
        self.assertEqual([line for line in found if line.startswith("E:")], [])
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_zsh_reads_the_completions(self):
        for name, deb in make().items():
            run("dpkg-deb", "-x", deb, WORK / f"unpacked-{name}")
            run("zsh", "-n", WORK / f"unpacked-{name}/usr/share/zsh/vendor-completions/_{name}")


class UdevTest(unittest.TestCase):
    """The rules of the package, read by Debian's udev for a device that every machine has."""

    def shown(self, own_rules):
        folder = self.root.path / "etc/udev/rules.d"
        (folder / "70-axisgate.rules").write_text(own_rules)
        return self.root.run("udevadm", "test", "--action=add", "/sys/class/tty/tty")

    def test_a_line_that_has_a_name_is_the_gateways_and_no_other(self):
        self.root = CleanRoot(WORK / "udev", TAR)
        self.addCleanup(self.root.close)
        run("mount", "--rbind", "/sys", self.root.path / "sys")
        self.root.apt("update")
        self.root.apt("install", "udev", self.root.put(make()["axisgate"]))
        number = self.root.run("getent", "group", "axisgate").split(":")[2]
        named = self.shown('SUBSYSTEM=="tty", KERNEL=="tty", SYMLINK+="axisgate/lift-serial"\n')
        self.assertRegex(named, rf"71-axisgate-lines.rules:\d+ GROUP {number}\n")
        self.assertRegex(named, r"71-axisgate-lines.rules:\d+ MODE 0660\n")
        self.assertIn("ID_MM_DEVICE_IGNORE=1", named)
        other = self.shown('SUBSYSTEM=="tty", KERNEL=="tty", SYMLINK+="other"\n')
        self.assertNotRegex(other, "71-axisgate-lines.rules:|ID_MM_DEVICE_IGNORE")
        # The page's two commands do nothing in a changed root: are they words of Debian's?
        for program, command, *options in single(of_page("docs/installation.md", "udevadm control")):
            known = (self.root.path / "usr/bin" / program).read_bytes()
            self.assertEqual([word for word in (command, *options) if word.encode() not in known], [])
        # Whoever copies the example has no line of it misread.
        example = (self.root.path / "usr/share/doc/axisgate/examples/70-axisgate.rules").read_text(encoding="utf-8")
        self.assertNotRegex(self.shown(example), "70-axisgate.rules:[^\\n]*(nvalid|nknown|ignoring)")


class ManualTest(unittest.TestCase):
    """The manual of the packages, on a computer that has nothing but them and what its pages have installed."""

    @classmethod
    def setUpClass(cls):
        cls.root = CleanRoot(WORK / "manual", TAR)
        cls.addClassCleanup(cls.root.close)
        debs, begin = make(), time.monotonic()
        cls.root.apt("update")
        cls.root.apt("install", *(cls.root.put(debs[name]) for name in ("axisgate", "axisgate-sim")))
        print(f"measured: axisgate and axisgate-sim installed in {time.monotonic() - begin:.1f} s, with apt-get update", file=sys.stderr)
        cls.root.apt("install", *(cls.root.put(debs[name]) for name in ("axisgate-dds", "axisgate-web")))
        # What the pages call, and what the story that types them is written in.
        cls.root.apt("install", "mbpoll", "socat", "python3", "python3-pymodbus", "python3-serial-asyncio", "gcc", "libc6-dev", "libmodbus-dev", "pkg-config")
        for path in SOURCE.glob("tests/integration/*.py"):
            to = cls.root.path / "root/stories" / path.name
            to.parent.mkdir(exist_ok=True)
            to.write_bytes(path.read_bytes())

    def test_each_command_is_one_of_the_packages(self):
        count, wrong = Installed([self.root.path], self.root.run).mistakes()
        self.assertEqual(wrong, [])
        self.assertGreater(count, 150)

    def test_what_is_typed_shows_what_the_pages_have(self):
        for what in ("Manual.test_quick_start", "Manual", "Drives"):
            begin = time.monotonic()
            self.root.run("/usr/bin/python3", "-B", "/root/stories/manual_test.py", "/usr/bin/axisgate", "/usr/bin/axisgate-sim", f"/{MANUAL}", what)
            print(f"measured: {what} typed in {time.monotonic() - begin:.1f} s", file=sys.stderr)


class CleanRootTest(unittest.TestCase):
    """One life of the packages: its steps in the order of their numbers, each on what the one before has left."""

    broken = None

    @classmethod
    def setUpClass(cls):
        cls.debs = make()
        cls.newer = make("--version", "1000.1")
        cls.newest = make("--version", "1000.2")
        cls.root = CleanRoot(WORK / "root", TAR)
        cls.addClassCleanup(cls.root.close)
        cls.root.apt("update")
        cls.gateway_side, cls.plc_side = Network(), Network()
        for network in (cls.gateway_side, cls.plc_side):
            cls.addClassCleanup(network.close)
        cls.gateway_side.cable_to(cls.plc_side, GATEWAY_ADDRESS, PLC_ADDRESS)
        cls.unit = Unit(cls.root, cls.gateway_side)
        cls.addClassCleanup(cls.unit.close)
        cls.before = cls.root.listing()
        cls.packages_before = set(cls.root.installed())

    def setUp(self):
        if self.broken:
            self.fail(f"not tried: {self.broken} has failed before")

    def run(self, result=None):
        done = super().run(result)
        if not result.wasSuccessful() and not self.broken:
            type(self).broken = self._testMethodName
            for program in self.unit.programs:
                print(f"--- {program.name}\n{program.text()}", file=sys.stderr)
            print(f"--- the stand-in of systemd: {self.unit.failure}", file=sys.stderr)
        return done

    # What the PLC's computer sees and does.

    def mbpoll(self, *words):
        return run(*self.plc_side.command("mbpoll", "-m", "tcp", "-p", "502", "-0", "-1", "-o", "10", *words))

    def read(self, register, kind="4"):
        """One register of axis 1, by mbpoll."""
        text = self.mbpoll("-q", "-t", kind, "-B", "-r", 100 + register, GATEWAY_ADDRESS)
        return int(re.search(rf"^\[{100 + register}\]:\s+(-?\d+)", text, re.MULTILINE)[1])

    def position(self):
        return self.read(2, "4:int")

    def inputs(self, number):
        text = self.mbpoll("-q", "-t", "1", "-r", 100 + number, GATEWAY_ADDRESS)
        return int(re.search(r"^\[\d+\]:\s+(\d)", text, re.MULTILINE)[1])

    def write(self, register, value):
        self.mbpoll("-t", "4:int", "-B", "-r", 100 + register, GATEWAY_ADDRESS, value)

    def coil(self, number, value):
        self.mbpoll("-t", "0", "-r", 100 + number, GATEWAY_ADDRESS, value)

    def online(self):
        return self.read(18) == ONLINE

    # What the drive has seen.

    def ask(self, command):
        with socket.socket(socket.AF_UNIX) as control:
            control.connect(str(self.root.path / "run/simulator"))
            control.sendall(command.encode() + b"\n")
            answer = control.makefile().readline().rstrip("\n")
        self.assertTrue(answer.startswith("ok"), f"{command}: {answer}")
        return answer[3:]

    def controlwords(self):
        return int(self.ask(f"writes lift-serial/1 {CONTROLWORD}"))

    def test_01_installing_starts_nothing_and_needs_no_dds(self):
        self.root.put(self.debs["axisgate"], "build/packages/debs")
        self.root.type(".", of_page("docs/installation.md", "apt install ./build/packages/debs/axisgate_*.deb"))
        for name in ("axisgate", "axisgate-sim"):
            self.root.put(self.debs[name], "first")
        self.root.type("first", of_page("docs/quick_start.md", "apt install ./axisgate_*.deb"))
        packages = self.root.installed()
        self.assertEqual({packages["axisgate"], packages["axisgate-sim"]}, {"ii"})
        self.assertEqual([name for name in packages if re.search("fast|dds", name)], [])
        self.assertEqual(self.root.processes_of("axisgate"), [])
        self.assertIsNone(self.unit.program)
        calls = self.unit.calls()
        self.assertEqual([call for call in calls if re.search(r"(^| )(start|restart|enable)( |$)", call)], [])
        self.assertEqual(list((self.root.path / "etc/systemd/system").glob("**/axisgate*")), [])
        self.assertEqual(os.listdir(self.root.path / "etc/axisgate"), [])
        self.assertIn("dialout", self.root.run("id", "-nG", "axisgate"))
        self.assertRegex(self.root.run("getent", "passwd", "axisgate"), "nologin")

    def test_02_the_example_is_edited_and_accepted(self):
        """As it is, and then one line of it, with a simulated drive at its end."""
        self.root.type(".", of_page("docs/installation.md", "cp /usr/share/doc/axisgate/examples/gateway.json"))
        self.root.type(".", of_page("docs/installation.md", "axisgate check /etc/axisgate/gateway.json"))
        text = (self.root.path / "usr/share/doc/axisgate/examples/gateway.json").read_text(encoding="utf-8")
        config = json.loads(re.sub(r"(^|\s)//.*", "", text))
        config["buses"] = config["buses"][:1]
        config["buses"][0]["timeout_ms"] = 1000  # a busy machine may keep a simulated drive from answering for so long
        config["buses"][0]["drives"][0]["axes"][0]["lease"] = None  # mbpoll comes and goes
        for listener in config["modbus_tcp"]:
            listener.update(client="address", reply_deadline_ms=8000)
        (self.root.path / CONFIGURATION).write_text(json.dumps(config, indent=2), encoding="utf-8")
        self.assertIn("lift", self.root.run("setpriv", "--reuid=axisgate", "--regid=axisgate", "--clear-groups",
                                            "axisgate", "check", "/" + CONFIGURATION))

    def test_03_the_gateway_runs_as_the_unit_does(self):
        (self.root.path / "dev/axisgate").mkdir()
        simulator = Program("axisgate-sim", self.root.command("axisgate-sim", "--line", "/dev/axisgate/lift-serial:jd@1",
                                                              "--control", "/run/simulator", network=self.gateway_side))
        self.addClassCleanup(simulator.clean_up)
        self.unit.programs.append(simulator)
        simulator.wait_for("^control ")
        # As udev gives a serial port to its group.
        self.root.run("chgrp", "dialout", "/dev/axisgate/lift-serial")
        self.root.run("chmod", "0660", "/dev/axisgate/lift-serial")
        self.unit.start()
        number = int(self.root.run("id", "-u", "axisgate"))
        self.assertEqual(os.stat(f"/proc/{self.unit.program.pid}").st_uid, number)
        until("axis 1 online", self.online)
        self.assertEqual(self.controlwords(), 0)

    def test_04_an_axis_is_driven_from_outside(self):
        self.coil(0, 1)
        until("enabled", lambda: self.inputs(2))
        begin = self.position()
        self.write(48, 60000)  # one turn a second
        self.write(42, 800000)  # far: some minutes
        self.coil(4, 1)
        until("moving", lambda: self.position() > begin)

    def test_05_an_upgrade_adopts_the_axis_while_it_moves(self):
        # What the page does before: would the new one take the configuration?
        self.root.put(self.newer["axisgate"], "newer")
        self.root.type("newer", of_page("docs/upgrade.md", "dpkg-deb -x"))
        self.assertIn("is valid", self.root.type("newer", f"new/usr/bin/axisgate check /{CONFIGURATION}"))
        text = (self.root.path / CONFIGURATION).read_bytes()
        old, words, begin = self.unit.program, self.controlwords(), self.position()
        self.root.apt("install", self.root.put(self.newer["axisgate"]))
        self.assertIsNone(self.unit.failure)
        self.assertEqual([call for call in self.unit.calls() if "axisgate.service" in call], ["try-restart axisgate.service"])
        self.assertIsNot(self.unit.program, old)
        self.assertEqual((self.root.path / CONFIGURATION).read_bytes(), text)
        until("axis 1 online", self.online)
        self.assertTrue(self.inputs(2), "enabled")
        self.assertTrue(self.read(34, "4:int") & ADOPTED)
        self.assertEqual(self.controlwords(), words, "nothing was commanded")
        self.assertGreater(self.position(), begin)
        between = self.position()
        until("still moving", lambda: self.position() > between)
        # And it obeys the new one.
        self.coil(2, 1)
        until("stopped", lambda: not self.inputs(7))

    def test_06_a_configuration_that_a_new_version_refuses_leaves_the_old_one_running(self):
        text = (self.root.path / CONFIGURATION).read_text(encoding="utf-8")
        (self.root.path / CONFIGURATION).write_text(text.replace('"buses"', '"busses"'), encoding="utf-8")
        running = self.unit.program
        told = self.root.apt("install", self.root.put(self.newest["axisgate"]))
        self.assertIn("does not accept /etc/axisgate/gateway.json", told)
        self.assertIs(self.unit.program, running)
        self.assertIsNone(running.process.poll())
        self.assertEqual([call for call in self.unit.calls() if "axisgate.service" in call], [])
        until("axis 1 online", self.online)
        (self.root.path / CONFIGURATION).write_text(text, encoding="utf-8")

    def test_07_a_gateway_that_was_stopped_stays_so_in_an_upgrade(self):
        self.unit.stop()
        self.root.apt("install", "--reinstall", self.root.put(self.newest["axisgate"]))
        self.assertIsNone(self.unit.program)
        self.assertEqual(self.root.processes_of("axisgate"), [])
        self.unit.calls()

    def test_08_the_other_programs_come_with_their_packages(self):
        path = self.root.path / CONFIGURATION
        config = {**json.loads(path.read_text(encoding="utf-8")), "dds": {}, "web": {}}
        path.write_text(json.dumps(config), encoding="utf-8")
        for name in ("axisgate-dds", "axisgate-web"):
            self.root.apt("install", self.root.put(self.newest[name]))
        self.assertIsNone(self.unit.program)
        self.unit.start()
        self.unit.program.wait_for("axisgate-dds .* runs")
        self.unit.program.wait_for("axisgate-web .* runs")
        until("axis 1 online", self.online)
        until("a topic of the axis", self.topics_show_it)

        # All in one upgrade: the gateway is replaced when the other programs are new as well.
        log = self.root.path / "var/log/dpkg.log"
        log.write_text("")
        all_of_it = make("--version", "1000.3")
        for name in ("axisgate", "axisgate-dds", "axisgate-web"):
            self.root.put(all_of_it[name], "all")
        self.root.type("all", of_page("docs/upgrade.md", "apt install ./axisgate_*.deb"))
        self.assertIsNone(self.unit.failure)
        text = log.read_text()
        self.assertLess(text.index(" upgrade axisgate-dds:"), text.index(" configure axisgate:"))
        self.unit.program.wait_for("axisgate-dds .* runs")
        self.unit.program.wait_for("axisgate-web .* runs")

    def topics_show_it(self):
        command = self.root.command("axisgate", "topics", "--once", network=self.gateway_side)
        return "lift" in subprocess.run(command, capture_output=True, text=True, check=False).stdout

    def test_09_a_removal_stops_the_service_and_keeps_the_configuration(self):
        # What `systemctl enable` leaves.
        wants = self.root.path / "etc/systemd/system/multi-user.target.wants"
        wants.mkdir(parents=True, exist_ok=True)
        (wants / "axisgate.service").symlink_to("/lib/systemd/system/axisgate.service")
        self.root.type(".", of_page("docs/installation.md", "apt remove"))
        self.root.apt("remove", "axisgate-sim")
        self.assertIsNone(self.unit.program)
        self.assertIsNone(self.unit.failure)
        self.assertEqual(self.root.processes_of("axisgate"), [])
        self.assertTrue((self.root.path / CONFIGURATION).exists())
        self.assertNotIn("ii", self.root.installed().get("axisgate-dds", ""))

    def test_10_a_purge_leaves_nothing(self):
        (self.root.path / "var/lib/axisgate").mkdir(exist_ok=True)
        (self.root.path / "var/lib/axisgate/state").touch()
        foreign = self.root.path / "etc/axisgate/own-drive.json"
        foreign.touch()
        self.root.type(".", of_page("docs/installation.md", "apt purge"))
        self.root.apt("autoremove", "--purge")
        self.assertEqual(os.listdir(foreign.parent), [foreign.name], "what nobody of us wrote stays")
        foreign.unlink()
        foreign.parent.rmdir()
        self.assertEqual(set(self.root.installed()), self.packages_before)
        after = self.root.listing()
        self.assertEqual(sorted(set(after) - set(self.before)), [], "left behind")
        self.assertEqual(sorted(set(self.before) - set(after)), [], "taken away")
        self.assertEqual([path for path, text in after.items() if text != self.before[path]], [], "changed")


if __name__ == "__main__":
    program = unittest.main(argv=[sys.argv[0], *(sys.argv[5:] or ["--verbose"])], exit=False)
    bad = len(program.result.failures) + len(program.result.errors)
    count = program.result.testsRun
    print(f"{100 * (count - bad) // count if count else 0}% tests passed, {bad} tests failed out of {count}", flush=True)
    sys.exit(0 if program.result.wasSuccessful() and count else 1)
