#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What deploy/build compiles: with the commands of the tests' build, so that nothing is compiled twice, with packages that
tests/setup --programs installs, and to the same bytes in another folder.

builds_test.py SOURCE_FOLDER BUILD_FOLDER [unittest's arguments]
"""
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE, BUILD = (Path(folder).absolute() for folder in sys.argv[1:3])
# Its assertions name their files.
UNIT = "axisgate_modbus_wire"


def commands(folder):
    """Each object's command, with `folder` as BUILD."""
    entries = json.loads((folder / "compile_commands.json").read_text(encoding="utf-8"))
    return {re.search(r" -o (\S+)", entry["command"])[1]: entry["command"].replace(str(folder), "BUILD") for entry in entries}


class Builds(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = BUILD / "packages-programs"
        subprocess.run(["rm", "-rf", cls.folder], check=True)
        subprocess.run([SOURCE / "deploy/build", "--configure", "--in", cls.folder], check=True)

    def test_it_compiles_as_the_tests_do(self):
        fewer, all_of_them = commands(self.folder), commands(BUILD)
        self.assertGreater(len(fewer), 50)
        self.assertGreater(len(all_of_them), len(fewer))
        for made, command in fewer.items():
            self.assertEqual(command.replace("../../../", "../../"), all_of_them.get(made), made)

    def test_it_asks_for_nothing_that_only_tests_or_dds_need(self):
        found = (self.folder / "CMakeCache.txt").read_text(encoding="utf-8")
        self.assertRegex(found, r"(?m)^nlohmann_json_DIR")
        self.assertNotRegex(found, r"(?im)^(gtest|fastrtps|fastcdr|fastddsgen|cyclonedds|benchmark)\w*:")

    def test_setup_installs_each_package_whose_headers_it_includes(self):
        words = dict(re.findall(r"^(programs)=\(([^)]*)\)", (SOURCE / "tests/setup").read_text(encoding="utf-8"), re.MULTILINE))["programs"].split()
        needs = subprocess.run(["apt-cache", "depends", "--recurse", "--no-recommends", "--no-suggests", "--no-conflicts", "--no-breaks", "--no-replaces", "--no-enhances", *words],
                               capture_output=True, text=True, check=True).stdout
        come = set(re.findall(r"^(\w[^\s:]*)", needs, re.MULTILINE))
        made = subprocess.run(["ninja", "-C", BUILD, "-t", "deps"], capture_output=True, text=True, check=True).stdout
        ours, headers = set(commands(self.folder)), set()
        for lines in made.split("\n\n"):
            target, *included = lines.strip().splitlines() or [""]
            if target.partition(":")[0] in ours:
                headers |= {os.path.normpath(line.strip()) for line in included if line.strip().startswith("/usr/")}
        self.assertGreater(len(headers), 500)
        owners = subprocess.run(["dpkg-query", "-S", *headers], capture_output=True, text=True, check=False).stdout
        packages = {name.partition(":")[0].strip() for line in owners.splitlines() for name in line.rpartition(": ")[0].split(",")}
        self.assertGreater(len(packages), 5)
        self.assertEqual(packages - come, set())

    def test_the_same_source_in_another_folder_is_the_same_object(self):
        entry = next(entry for entry in json.loads((BUILD / "compile_commands.json").read_text(encoding="utf-8"))
                     if f"/{UNIT}.dir/" in entry["file"] or f"/{UNIT}.dir/" in entry["command"])
        objects = []
        with tempfile.TemporaryDirectory() as folder:
            for number, place in enumerate(("one", "quite/another/place")):
                source = Path(folder, place)
                source.parent.mkdir(parents=True, exist_ok=True)
                source.symlink_to(SOURCE)
                unit = Path(folder, f"{number}/unit.cpp")
                unit.parent.mkdir()
                text = Path(entry["file"]).read_text(encoding="utf-8")
                unit.write_text(text.replace(str(SOURCE), str(source)), encoding="utf-8")
                command = re.sub(r"^.*?ccache ", "", entry["command"])
                command = re.sub(r" -(o|MF|MT) \S+| -MD| -c \S+| -include \S+cmake_pch.hxx| -Winvalid-pch", "", command).replace(str(SOURCE), str(source))
                subprocess.run([*shlex.split(command), "-include", BUILD / "CMakeFiles/axisgate_precompiled_product.dir/cmake_pch.hxx", f"-ffile-prefix-map={unit}=unit.cpp",
                                "-c", unit, "-o", unit.with_suffix(".o")], check=True, cwd=BUILD)
                objects.append(unit.with_suffix(".o").read_bytes())
        self.assertIn(b"gateway/upstream/modbus_tcp/wire/", objects[0])
        self.assertEqual(*objects)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
