# SPDX-License-Identifier: Apache-2.0
"""Each command of the installed manual against what the packages hold: its programs know their commands and options, and what it names of
ours is there. tests/docs/commands_test.py holds the same pages against the sources.
"""
import functools
import os
import re
import sys
from pathlib import Path

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../docs"))
from page_commands import SOURCE, commands, single  # noqa: E402

MANUAL = "usr/share/doc/axisgate"
# Who has only the packages has none of these, and the page says that they are of the sources.
OF_THE_SOURCES = re.compile(r"deploy/(demo|package|container/build)|build/|tests/|\.ci/")
# Where the packages have what lies elsewhere in the sources.
ELSEWHERE = {"deploy/examples/dds/": "usr/share/doc/axisgate-dds/examples/"}


class Installed:
    def __init__(self, roots, run):
        """`roots`: folders that together are the packages' file system. `run`: a program's path in there and its arguments; its output."""
        self.roots, self.run = [Path(root) for root in roots], run

    def has(self, path):
        return any(list(root.glob(path.lstrip("/"))) for root in self.roots)

    def pages(self):
        """(its path from the manual's folder, its text)."""
        for root in self.roots:
            for path in sorted((root / MANUAL).rglob("*.md")):
                yield path.relative_to(root / MANUAL), path.read_text(encoding="utf-8")

    @functools.cache
    def help_of(self, *words):
        return self.run(f"/usr/bin/{words[0]}", *words[1:], "--help")

    def of_program(self, words):
        if not self.has(f"/usr/bin/{words[0]}"):
            return f"no package has {words[0]}"
        called = words[:1]
        for word in words[1:]:
            known = re.findall(r"^  (\w[\w-]*)", self.help_of(*called).partition("Subcommands:")[2], re.M)
            if word not in known:
                break
            called.append(word)
        options = [word.partition("=")[0] for word in words[1:] if re.match("--?[A-Za-z]", word)]
        wrong = [option for option in options if not re.search(rf"(?<![\w-]){re.escape(option)}(?![\w-])", self.help_of(*called))]
        return f"{' '.join(called)} knows no {wrong}" if wrong else ""

    def wrong_with(self, page, words):
        """Empty: nothing is."""
        if re.match("axisgate(-|$)", words[0]):
            return self.of_program(words)
        if words[0] == "man" and not self.has(f"/usr/share/man/man*/{words[1]}.*.gz"):
            return f"no package has a manual page {words[1]}"
        if words[0] == "systemctl" and "axisgate" in words and not self.has("/lib/systemd/system/axisgate.service"):
            return "no package has the unit"
        for word in words:
            beside = (SOURCE / page).parent / word
            if word.startswith(("/usr/share/axisgate", "/usr/share/doc/axisgate")) and not self.has(word):
                return f"no package has {word}"
            if re.match("[\\w.-]+$", word) and beside.is_file() and not self.has(f"{MANUAL}/{page.parent}/{word}"):
                return f"{word} is not beside the page"
            if re.match(r"(deploy|tests|\.ci)/", word) and not OF_THE_SOURCES.match(word):
                there = next((word.replace(ours, theirs, 1) for ours, theirs in ELSEWHERE.items() if word.startswith(ours)), f"{MANUAL}/{word}")
                if not self.has(there):
                    return f"no package has {there}"
        return ""

    def mistakes(self):
        """(how many commands there are, page: command: what is wrong with it)."""
        count, wrong = 0, []
        for page, text in self.pages():
            for _, command in commands(text):
                count += 1
                wrong += [f"{page}: {command}: {why}" for words in single(command) if (why := self.wrong_with(page, words))]
        return count, wrong
