#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The hook before a commit (.githooks/pre-commit) looks at what is staged, and leaves alone what is not; in a repository with one rule."""
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).absolute().parents[2]
UGLY, NEAT = "int   a( );\n", "int a();\n"
RULE = """import pathlib, sys
RULES = {"words": None}
if __name__ == "__main__":
    bad = [path for path in pathlib.Path("gateway").rglob("*.cpp") if "bad" in path.read_text()]
    print("bad word in", *bad)
    sys.exit(bool(bad))
"""


class Hook(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for name in (".githooks/pre-commit", ".clang-format", ".clang-tidy", "tests/architecture/format"):
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / name, self.root / name)
        self.write("tests/architecture/rules.py", RULE)
        self.write(".gitignore", "/build/\n")
        self.write("gateway/a.cpp", NEAT)
        # Of none of those that a hook or a test above this one may have.
        self.environment = {key: value for key, value in os.environ.items() if not key.startswith(("GIT_", "AXISGATE_"))}
        self.environment |= {"GIT_CONFIG_GLOBAL": "/dev/null", "GIT_CONFIG_NOSYSTEM": "1"}
        self.git("init", "--quiet")
        for key, value in (("user.name", "n"), ("user.email", "n@example.org"), ("core.hooksPath", ".githooks")):
            self.git("config", key, value)
        self.git("add", "--all")
        self.git("commit", "--quiet", "--no-verify", "--message", "begin")

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def read(self, name):
        return (self.root / name).read_text(encoding="utf-8")

    def git(self, *arguments, check=True):
        done = subprocess.run(["git", *arguments], cwd=self.root, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, check=False)
        self.assertFalse(check and done.returncode, done.stdout)
        return done.stdout

    def commit(self, *arguments):
        """What the hook says; whether there is a commit."""
        before = self.git("rev-parse", "HEAD")
        said = self.git("commit", "--quiet", "--message", "x", *arguments, check=False)
        return said, self.git("rev-parse", "HEAD") != before

    def test_a_file_that_is_staged_as_it_stands_is_formatted(self):
        self.write("gateway/a.cpp", UGLY)
        self.git("add", "--all")
        said, done = self.commit()
        self.assertTrue(done, said)
        self.assertIn("gateway/a.cpp is formatted", said)
        self.assertEqual((self.read("gateway/a.cpp"), self.git("show", "HEAD:gateway/a.cpp"), self.git("status", "--short")), (NEAT, NEAT, ""))

    def test_a_file_that_is_staged_in_part_is_left_alone(self):
        self.write("gateway/a.cpp", UGLY)
        self.git("add", "--all")
        self.write("gateway/a.cpp", UGLY + UGLY)
        said, done = self.commit()
        self.assertFalse(done)
        self.assertIn("tests/architecture/format --fix gateway/a.cpp", said)
        self.assertEqual((self.read("gateway/a.cpp"), self.git("show", ":gateway/a.cpp")), (UGLY + UGLY, UGLY))

    def test_what_is_not_staged_is_not_looked_at(self):
        self.write("gateway/a.cpp", "int b();\n")
        self.git("add", "--all")
        self.write("gateway/a.cpp", UGLY + "int bad;\n")
        self.write("gateway/c.cpp", UGLY + "int bad;\n")
        said, done = self.commit()
        self.assertTrue(done, said)
        self.assertEqual((said, self.git("show", "HEAD:gateway/a.cpp"), self.read("gateway/a.cpp")),
                         ("pre-commit: no clang-tidy: it needs tests/setup and cmake --preset ide\n", "int b();\n", UGLY + "int bad;\n"))

    def test_a_file_that_is_committed_by_its_name_is_looked_at_and_left_alone(self):
        self.write("gateway/a.cpp", UGLY)
        said, done = self.commit("gateway/a.cpp")
        self.assertFalse(done)
        self.assertIn("gateway/a.cpp is not formatted", said)
        self.assertEqual((self.read("gateway/a.cpp"), self.git("status", "--short")), (UGLY, " M gateway/a.cpp\n"))

    def test_a_broken_rule_is_told(self):
        self.write("gateway/a.cpp", "int bad();\n")
        self.git("add", "--all")
        self.write("gateway/a.cpp", NEAT)
        said, done = self.commit()
        self.assertFalse(done)
        self.assertIn("rule words is broken (python3 tests/architecture/rules.py words):\nbad word in gateway/a.cpp\n", said)

    def test_clang_tidy_looks_at_changed_lines_as_they_are_staged(self):
        old, new = "inline long a(int n) { return n * 2L; }\nconst long kOld = 64 * 1024;\n", "const long kNew = 64 * 1024;\n"
        self.write("gateway/a.cpp", old)
        self.git("add", "--all")
        self.git("commit", "--quiet", "--no-verify", "--message", "old")
        self.write("gateway/a.cpp", old + new)
        self.git("add", "--all")
        self.write("gateway/a.cpp", new + old)
        root = self.root.resolve()
        self.write("build/ide/compile_commands.json", json.dumps(
            [{"directory": f"{root}/build/ide", "file": f"{root}/gateway/a.cpp", "command": f"c++ -I{root} -c {root}/gateway/a.cpp"}]))
        said, done = self.commit()
        self.assertFalse(done)
        self.assertIn("gateway/a.cpp:3:19: error: performing an implicit widening conversion", said)
        self.assertNotIn("gateway/a.cpp:2:", said)


if __name__ == "__main__":
    unittest.main()
