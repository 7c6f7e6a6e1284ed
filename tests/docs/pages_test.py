#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The manual hangs together: every link leads somewhere, every page is in the index, every drive has its page, what is cited of a drive is
a number of docs/drive_sources.md, and what is printed is what the files say today. AXISGATE_WRITE_PAGES=1 prints it anew.

pages_test.py SOURCE_FOLDER [unittest's arguments]
"""
import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

from drive_cites import cites_in, drive_cites, drive_sources
from drive_tables import printed, profile

SOURCE = Path(sys.argv.pop(1)).absolute()
LINK = re.compile(r"(?<!!)\[[^\]]*\]\(([^)\s]+)\)")
# What is of this checkout, and what its packages install.
FILE = re.compile(r"(?<![\w/.~-])((?:deploy|docs|schemas|tests|gateway|adapters)/[\w./*+-]*\w)")
INSTALLED = re.compile(r"/(?:usr/share/doc/axisgate/examples|lib/udev/rules\.d)/([\w.-]+\w)")
KEY = re.compile(r'"([a-z][a-z0-9_]*)" ?:')
PRINTED = re.compile(r"(<!-- printed: (.*?) -->\n)(.*?)(<!-- end -->)", re.DOTALL)


def pages():
    return [*sorted(SOURCE.glob("*.md")), *sorted(SOURCE.glob("docs/**/*.md")), *sorted(SOURCE.glob("deploy/**/*.md"))]


def outside_code(text):
    return re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)


def code(text):
    """What stands in backquotes and in blocks, indented ones too; not what is shown (```text)."""
    blocks = [block for block in re.findall(r"^```.*?^```", text, flags=re.DOTALL | re.MULTILINE) if not block.startswith("```text")]
    rest = outside_code(text)
    return blocks + re.findall(r"^    .*$", rest, flags=re.MULTILINE) + re.findall(r"`([^`]+)`", rest)


def missing_files(text):
    for shown in code(text):
        for name in FILE.findall(shown):
            if not any(SOURCE.glob(name)) and not any(SOURCE.glob(f"{name}.*")):
                yield name
        for name in INSTALLED.findall(shown):
            if not any(SOURCE.glob(f"deploy/**/{name}")):
                yield name


def known_keys():
    """Those of configurations and profiles, by their schemas, and of cells."""
    files = (*SOURCE.glob("schemas/**/*.json"), SOURCE / "deploy/kubernetes/cells.json")
    return {key for path in files for key in KEY.findall(path.read_text(encoding="utf-8").replace("$axis", "axis"))}


def is_named_by_its_reader(key):
    """A constant of a drive with two motors."""
    return re.sub(r"_[ab](?=_|$)", "_axis", key) in known_keys()


def anchors(path):
    """As GitHub makes them from headings."""
    found = re.findall(r"^#+ (.*)$", outside_code(path.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in found}


def dead_links(path):
    for target in LINK.findall(outside_code(path.read_text(encoding="utf-8"))):
        if "://" in target or target.startswith("mailto:"):
            continue
        name, _, anchor = target.partition("#")
        other = (path.parent / name).resolve() if name else path
        if not other.exists():
            yield f"{target} is not there"
        elif anchor and other.suffix == ".md" and anchor not in anchors(other):
            yield f"{target}: no heading is called so"


class Manual(unittest.TestCase):
    maxDiff = None

    def test_every_link_leads_somewhere(self):
        self.assertEqual([f"{path.relative_to(SOURCE)}: {why}" for path in pages() for why in dead_links(path)], [])

    def test_a_dead_link_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "page.md"
            path.write_text("# One head\n[a](page.md#one-head) [b](other.md) [c](#two) `[d](x)`\n```\n[e](y)\n```\n", encoding="utf-8")
            self.assertEqual([why.split()[0] for why in dead_links(path)], ["other.md", "#two:", "x"])

    def test_every_file_that_a_page_shows_is_there(self):
        # CHANGELOG.md tells of what is no more, CONTRIBUTING.md of what is to be added.
        self.assertEqual([f"{path.relative_to(SOURCE)}: {name}" for path in pages() if path.name not in ("CHANGELOG.md", "CONTRIBUTING.md")
                          for name in missing_files(path.read_text(encoding="utf-8"))], [])

    def test_every_key_that_a_page_shows_is_one(self):
        known = known_keys()
        lost = {f"{path.relative_to(SOURCE)}: {key}" for path in pages() if path.name != "CHANGELOG.md"
                for shown in code(path.read_text(encoding="utf-8")) for key in KEY.findall(shown) if key not in known and not is_named_by_its_reader(key)}
        self.assertEqual(lost, set())
        self.assertGreater(len(known), 100)

    def test_a_file_or_key_that_is_not_there_is_found(self):
        text = "`deploy/nothing.json` `deploy/plc/axisgate.st`\n\n    cp /usr/share/doc/axisgate/examples/no.rules x\n"
        self.assertEqual(list(missing_files(text)), ["no.rules", "deploy/nothing.json"])
        self.assertEqual([key for shown in code('```json\n{"lisp": 1, "listen": 2}\n```\n') for key in KEY.findall(shown)], ["lisp", "listen"])
        self.assertFalse({"lisp"} & known_keys())

    def test_every_page_is_in_the_index(self):
        index = SOURCE / "docs/README.md"
        linked = {(index.parent / target.partition("#")[0]).resolve() for target in LINK.findall(index.read_text(encoding="utf-8"))}
        self.assertEqual([str(path.relative_to(SOURCE)) for path in sorted(SOURCE.glob("docs/**/*.md")) if path != index and path not in linked], [])

    def test_every_drive_has_its_page(self):
        drives = {path.stem for path in (SOURCE / "schemas/drives").glob("*.json") if not profile(SOURCE, path.stem).get("base_only")
                  or "title" in profile(SOURCE, path.stem) and path.stem not in ("cia402", "kinco")}
        self.assertEqual({path.stem for path in (SOURCE / "docs/drives").glob("*.md")}, drives)

    def test_what_is_cited_of_a_drive_is_a_number_of_the_page_of_sources(self):
        known, lost, counted = drive_sources((SOURCE / "docs/drive_sources.md").read_text(encoding="utf-8")), [], 0
        for place, drive, number in drive_cites(SOURCE):
            counted += 1
            if number not in known[drive]:
                lost.append(f"{place}: {drive} {number}")
        self.assertEqual(lost, [])
        self.assertGreater(counted, 500)

    def test_what_is_cited_of_a_drive_is_found(self):
        self.assertEqual(cites_in("(JD 2.3, K7 and MD K, C5; LD2-CAN C10, 605Ah = 6; JD 0x80, MD 6099.05)"),
                         [("JD", "2.3"), ("JD", "K7"), ("MD", "K"), ("MD", "C5"), ("LD2", "C10")])
        self.assertEqual(cites_in("4.2, rows 8 and 9, 5 (6080h); MD O", "Keya"),
                         [("Keya", "4.2"), ("Keya", "row 8"), ("Keya", "row 9"), ("Keya", "5"), ("MD", "O")])
        self.assertEqual(drive_sources("## MD: x\n| 1, 4.1 to 4.3 | y | z |\n| 6 | by groups: A (8.1) | z |\n"), {"MD": {"1", "4.1", "4.2", "4.3", "6", "A", "8.1"}})

    def test_every_page_with_commands_is_tried(self):
        """Those about DDS by stories of their own."""
        story = (SOURCE / "tests/integration/manual_test.py").read_text(encoding="utf-8")
        with_commands = [os.path.relpath(path, SOURCE / "docs") for path in pages() if re.search("^```sh$", path.read_text(encoding="utf-8"), re.MULTILINE)]
        self.assertGreater(len(with_commands), 8)
        untried = [name for name in with_commands if f'self.read("{name}"' not in story and not name.startswith(("dds/", "../deploy/examples/dds/"))]
        self.assertEqual(untried, ["../CONTRIBUTING.md"], "CONTRIBUTING.md is about building, which the tests cannot do within themselves")

    def test_what_is_printed_is_what_the_files_say(self):
        counted = 0
        for path in pages():
            text = path.read_text(encoding="utf-8")
            made = PRINTED.sub(lambda found: f"{found[1]}\n{printed(SOURCE, found[2])}\n\n{found[4]}", text)
            counted += len(PRINTED.findall(text))
            if os.environ.get("AXISGATE_WRITE_PAGES") and made != text:
                path.write_text(made, encoding="utf-8")
            else:
                self.assertEqual(text, made, f"{path.relative_to(SOURCE)}: write it anew with AXISGATE_WRITE_PAGES=1 and this test")
        self.assertGreater(counted, 30)


if __name__ == "__main__":
    unittest.main()
