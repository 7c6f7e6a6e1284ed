#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What deploy/package makes of a build folder: packages with all that they should hold, that need no more than they say.

debs_test.py SOURCE_FOLDER BUILD_FOLDER [unittest's arguments]
"""
import gzip
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE, BUILD = (Path(folder).absolute() for folder in sys.argv[1:3])
GATEWAY, DDS, WEB, SIMULATOR = "axisgate", "axisgate-dds", "axisgate-web", "axisgate-sim"
OF_EACH = ("bin/{0}", "share/man/man1/{0}.1.gz", "share/bash-completion/completions/{0}", "share/zsh/vendor-completions/_{0}",
           "share/doc/{0}/copyright", "share/doc/{0}/changelog.gz", "share/doc/{0}/changelog.Debian.gz")
OF_ONE = {
    GATEWAY: ("/lib/systemd/system/axisgate.service", "/lib/udev/rules.d/71-axisgate-lines.rules", "/etc/axisgate/",
              "/usr/share/man/man5/gateway.json.5.gz", "/usr/share/axisgate/schemas/gateway.schema.json",
              "/usr/share/axisgate/schemas/drive-profile.schema.json", "/usr/share/doc/axisgate/examples/gateway.json",
              "/usr/share/doc/axisgate/examples/70-axisgate.rules", "/usr/share/doc/axisgate/examples/80-can0.network",
              "/usr/share/doc/axisgate/SECURITY.md", "/usr/share/doc/axisgate/docs/installation.md", "/usr/share/doc/axisgate/docs/README.md",
              "/usr/share/doc/axisgate/docs/drives/kinco-jd.md", "/usr/share/doc/axisgate/docs/dds/ros2.md",
              "/usr/share/doc/axisgate/deploy/plc/axisgate.st", "/usr/share/doc/axisgate/deploy/plc/axisgate.xml",
              "/usr/share/doc/axisgate/deploy/examples/modbus/gateway.json", "/usr/share/doc/axisgate/deploy/examples/node-red/flow.json",
              "/usr/share/doc/axisgate/deploy/examples/new_drive/acme-servo.eds"),
    DDS: ("/usr/share/axisgate/schemas/axisgate.idl", "/usr/share/doc/axisgate-dds/examples/axisgate-dds.nft",
          "/usr/share/doc/axisgate-dds/examples/README.md"),
    WEB: tuple(f"/usr/share/axisgate/monitoring/{name}" for name in ("prometheus.yml", "rules.yml", "dashboard.json", "alertmanager.yml")),
    SIMULATOR: (),
}


def output(*command, **options):
    done = subprocess.run(command, capture_output=True, text=True, **options)
    assert done.returncode == 0, f"{command}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout


def make(folder, *options, **environment):
    done = subprocess.run([SOURCE / "deploy/package", "--built", BUILD, *options, folder], capture_output=True, text=True,
                          env={**os.environ, **environment})
    if done.returncode:
        raise AssertionError(f"deploy/package has failed:\n{done.stdout}{done.stderr}")
    debs = {output("dpkg-deb", "-f", line, "Package").strip(): Path(line) for line in done.stdout.splitlines()}
    assert len(debs) == len(done.stdout.splitlines())
    return debs


class Debs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-debs-")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.debs = make(cls.folder / "debs", SOURCE_DATE_EPOCH="1700000000")
        cls.files = {}
        for name, deb in cls.debs.items():
            lines = [line.split(maxsplit=5) for line in output("dpkg-deb", "-c", deb).splitlines()]
            cls.files[name] = {line[5].removeprefix("."): (line[0], line[1]) for line in lines}
            subprocess.run(["dpkg-deb", "-x", deb, cls.folder / name], check=True)

    def field(self, package, name):
        return output("dpkg-deb", "-f", self.debs[package], name).strip()

    def read(self, package, path):
        path = self.folder / package / path.lstrip("/")
        return gzip.open(path, "rt").read() if path.suffix == ".gz" else path.read_text(encoding="utf-8")

    def test_there_are_four_and_each_holds_its_files(self):
        self.assertEqual(set(self.debs), {GATEWAY, DDS, WEB, SIMULATOR})
        for name, files in self.files.items():
            expected = {"/usr/" + path.format(name) for path in OF_EACH} | set(OF_ONE[name])
            self.assertEqual(expected - set(files), set(), name)
        shipped = {path.name for path in (SOURCE / "schemas/drives").glob("*.json")}
        held = {Path(path).name for path in self.files[GATEWAY] if "/schemas/drives/" in path and path.endswith(".json")}
        self.assertEqual(held, shipped)

    def test_every_page_is_there_and_its_links_lead_to_pages_or_to_the_sources(self):
        """What only the sources have is named here: nobody finds it missing by chance."""
        folder = self.folder / GATEWAY / "usr/share/doc/axisgate"
        made = {path.relative_to(SOURCE).as_posix() for path in (SOURCE / "docs").rglob("*.md")}
        self.assertEqual(made - {path.relative_to(folder).as_posix() for path in folder.rglob("*.md")}, set())
        sources = ("CONTRIBUTING.md", "ARCHITECTURE.md", "CHANGELOG.md", "LICENSE", "tests/", "schemas/", "deploy/can", "deploy/container", "deploy/kubernetes",
                   "deploy/example/", "deploy/examples/dds", "deploy/firewall", "deploy/udev")
        dead = set()
        for page in folder.rglob("*.md"):
            for target in re.findall(r"\]\(([^)\s#]+)", re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)):
                other = os.path.relpath((page.parent / target).resolve(), folder.resolve())
                if "://" not in target and not (folder / other).exists() and not other.startswith(sources):
                    dead.add(f"{page.relative_to(folder)}: {target}")
        self.assertEqual(dead, set())

    def test_no_file_is_in_two_of_them_or_where_it_has_no_business(self):
        everything = [path for files in self.files.values() for path in files if not path.endswith("/")]
        self.assertEqual(len(everything), len(set(everything)))
        odd = [path for path in everything if not re.match(r"/usr/(bin/axisgate|share/(axisgate|man|doc|bash-completion|zsh)/)|/lib/", path)]
        self.assertEqual(odd, [])

    def test_files_are_roots_and_others_cannot_write_them(self):
        for files in self.files.values():
            for path, (mode, owner) in files.items():
                right = "drwxr-xr-x" if path.endswith("/") else "-rwxr-xr-x" if path.startswith("/usr/bin/") else "-rw-r--r--"
                self.assertEqual((mode, owner), (right, "root/root"), path)

    def test_only_axisgate_dds_needs_the_dds_library(self):
        version = self.field(GATEWAY, "Version")
        self.assertRegex(self.field(DDS, "Depends"), r"libfastrtps")
        self.assertIn(f"axisgate (= {version})", self.field(DDS, "Depends"))
        self.assertIn(f"axisgate (= {version})", self.field(WEB, "Depends"))
        self.assertIn("libseccomp2", self.field(WEB, "Depends"))
        self.assertIn("libprometheus-cpp-core1.0", self.field(WEB, "Depends"))
        self.assertNotRegex(self.field(WEB, "Depends"), "prometheus-cpp-pu")
        for name in (GATEWAY, WEB, SIMULATOR):
            needed = self.field(name, "Depends")
            self.assertRegex(needed, r"libc6 \(>= ")
            self.assertNotRegex(needed, "fast|axisgate-dds" if name == WEB else "fast|axisgate-dds|axisgate-web|seccomp|prometheus")
            self.assertNotRegex(self.field(name, "Recommends"), ".")
        self.assertIn("libmodbus5", self.field(GATEWAY, "Depends"))
        self.assertIn("adduser", self.field(GATEWAY, "Depends"))

    def test_no_configuration_is_brought_along(self):
        """A gateway that starts with an example could move somebody's motor."""
        self.assertEqual([path for path in self.files[GATEWAY] if path.startswith("/etc/") and not path.endswith("/")], [])

    def test_the_unit_and_the_manual_pages_are_those_of_this_version(self):
        self.assertEqual(self.read(GATEWAY, "/lib/systemd/system/axisgate.service"),
                         (SOURCE / "deploy/systemd/axisgate.service").read_text(encoding="utf-8"))
        for name in self.debs:
            program = self.folder / name / "usr/bin" / name
            self.assertEqual(self.read(name, f"/usr/share/man/man1/{name}.1.gz"), output(program, "--generate", "man"))
            self.assertEqual(self.read(name, f"/usr/share/bash-completion/completions/{name}"), output(program, "--generate", "bash"))
            self.assertEqual(self.read(name, f"/usr/share/zsh/vendor-completions/_{name}"), output(program, "--generate", "zsh"))
            first = self.read(name, f"/usr/share/doc/{name}/changelog.Debian.gz").splitlines()[0]
            self.assertTrue(first.startswith(f"{name} ({self.field(name, 'Version')}) "), first)

    def test_gateway_json_5_names_each_section_of_a_configuration(self):
        page = self.read(GATEWAY, "/usr/share/man/man5/gateway.json.5.gz")
        schema = json.loads((SOURCE / "schemas/gateway.schema.json").read_text(encoding="utf-8"))
        # "$schema" is for editors.
        sections = set(schema["properties"]) - {"$schema"}
        self.assertEqual(set(re.findall(r"^\.TP\n\.B (\S+)$", page, re.MULTILINE)), sections)

    def test_the_programs_find_their_profiles_where_they_are_unpacked(self):
        config = {"modbus_tcp": [{"listen": "127.0.0.1:1502"}], "buses": [{"name": "lift", "adapter": "kinco-serial", "device": "/dev/axisgate/lift",
                             "drives": [{"profile": "kinco-jd", "node": 1, "constants": {"peak_current_a": 27.5}, "axes": [{"axis": 1}]}]}]}
        path = self.folder / "gateway.json"
        path.write_text(json.dumps(config), encoding="utf-8")
        self.assertIn("lift", output(self.folder / GATEWAY / "usr/bin/axisgate", "check", path))

    def test_one_source_and_one_time_give_the_same_packages(self):
        again = make(self.folder / "again", SOURCE_DATE_EPOCH="1700000000")
        for name, deb in self.debs.items():
            self.assertEqual(again[name].read_bytes(), deb.read_bytes(), name)

    def test_another_version_is_another_version_everywhere(self):
        newer = make(self.folder / "newer", "--version", "77.1")
        self.assertEqual({output("dpkg-deb", "-f", deb, "Version").strip() for deb in newer.values()}, {"77.1-1"})
        self.assertIn("axisgate (= 77.1-1)", output("dpkg-deb", "-f", newer[DDS], "Depends"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
