#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""docs/profile_reference.md is every key of schemas/drive-profile.schema.json, with examples out of the profiles that are shipped.

profile_reference.py SOURCE_FOLDER [unittest's arguments]; AXISGATE_WRITE_PAGES=1 prints the page anew.
"""
import json
import os
import sys
import unittest
from pathlib import Path

SOURCE = Path(sys.argv.pop(1)).absolute()
sys.path.insert(0, str(SOURCE / "tests/docs"))
from schema_page import Page  # noqa: E402

SCHEMA = json.loads((SOURCE / "schemas/drive-profile.schema.json").read_text(encoding="utf-8"))
PAGE = SOURCE / "docs/profile_reference.md"
EVERYWHERE = ("text", "source")  # said once, at the top of the page

HEAD = """# Every key of a profile

<!-- Printed from schemas/drive-profile.schema.json by tests/profiles/profile_reference.py: AXISGATE_WRITE_PAGES=1 prints it anew. -->

For looking up. How a profile comes about is told in [new_drive.md](new_drive.md); what belongs together, in
[schemas/README.md](../schemas/README.md). Every entry may have `"text"`, in words for a person, and `"source"`, where the manual says so.
Examples are out of the profiles that are shipped. A key in *italics* stands for a name that you choose.

"""


def reference():
    page = Page(SCHEMA, EVERYWHERE)
    for path in sorted((SOURCE / "schemas/drives").glob("*.json"), key=lambda path: (path.stem != "cia402", path.stem)):
        page.look_for_examples(SCHEMA, json.loads(path.read_text(encoding="utf-8")))
    return page


class ProfileReference(unittest.TestCase):
    maxDiff = None

    def test_the_page_is_what_the_schema_says(self):
        printed = HEAD + reference().tables()
        if os.environ.get("AXISGATE_WRITE_PAGES"):
            PAGE.write_text(printed, encoding="utf-8")
        self.assertEqual(PAGE.read_text(encoding="utf-8"), printed)

    def test_each_key_says_what_it_means(self):
        page = reference()
        mute = [f"{section.title}: {key}" for section in page.sections.values() for key, value, _ in page.members(section.node)
                if not page.meaning(value)]
        self.assertEqual(mute, [])
        self.assertGreater(len(page.keys()), 150)


if __name__ == "__main__":
    unittest.main()
