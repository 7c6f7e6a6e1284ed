#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""docs/profile_reference.md is every key of schemas/drive-profile.schema.json, with examples out of the profiles that are shipped.

profile_reference.py SOURCE_FOLDER [unittest's arguments]; AXISGATE_WRITE_PAGES=1 prints the page anew.
"""
import json
import os
import re
import sys
import unittest
from pathlib import Path

SOURCE = Path(sys.argv.pop(1)).absolute()
SCHEMA = json.loads((SOURCE / "schemas/drive-profile.schema.json").read_text(encoding="utf-8"))
PAGE = SOURCE / "docs/profile_reference.md"
EVERYWHERE = ("text", "source")  # said once, at the top of the page
LONGEST_EXAMPLE = 90
UNITS = {"_ms": "ms", "_us": "µs"}

HEAD = """# Every key of a profile

<!-- Printed from schemas/drive-profile.schema.json by tests/profiles/profile_reference.py: AXISGATE_WRITE_PAGES=1 prints it anew. -->

For looking up. How a profile comes about is told in [new_drive.md](new_drive.md); what belongs together, in
[schemas/README.md](../schemas/README.md). Every entry may have `"text"`, in words for a person, and `"source"`, where the manual says so.
Examples are out of the profiles that are shipped. A key in *italics* stands for a name that you choose.

"""


def resolved(node):
    """(name of the definition or None, what it says; what stands beside a reference counts first)."""
    name = None
    while "$ref" in node:
        name = node["$ref"].rpartition("/")[2]
        node = {**SCHEMA["definitions"][name], **{key: value for key, value in node.items() if key != "$ref"}}
    return name, node


def is_object(node):
    return "properties" in node or "patternProperties" in node or isinstance(node.get("additionalProperties"), dict)


def types(node):
    said = node.get("type", [])
    return [said] if isinstance(said, str) else said


def members(node):
    """(key, what is said of it, is it a name to be chosen) of an object."""
    for key, value in node.get("properties", {}).items():
        if key not in EVERYWHERE and not key.startswith("$"):
            yield key, value, False
    for value in node.get("patternProperties", {}).values():
        yield node.get("expects", "a name").split(",")[0].split(":")[0], value, True
    if isinstance(node.get("additionalProperties"), dict):
        yield "a name", node["additionalProperties"], True


def rows(node):
    """(keys, what is said of them, are they names to be chosen): keys of which the same is said are one row."""
    out = []
    for key, value, chosen in members(node):
        if out and out[-1][1] == value and not chosen:
            out[-1][0].append(key)
        else:
            out.append(([key], value, chosen))
    return out


class Section:
    def __init__(self, title, node):
        self.title, self.node = title, node
        self.examples = {}

    def anchor(self):
        return re.sub(r"[^\w\- ]", "", self.title.lower()).replace(" ", "-")


class Reference:
    def __init__(self):
        self.sections = {}
        self.root = self.section_of("The file", SCHEMA)
        for path in sorted((SOURCE / "schemas/drives").glob("*.json"), key=lambda path: (path.stem != "cia402", path.stem)):
            self.look_for_examples(SCHEMA, json.loads(path.read_text(encoding="utf-8")), "The file")

    def section_of(self, title, node):
        if title not in self.sections:
            self.sections[title] = Section(title, node)
            for key, value, _ in members(node):
                self.find_below(self.below(title, key, value), value)
        return self.sections[title]

    @staticmethod
    def below(title, key, value):
        name, _ = resolved(value)
        path = key if " " not in key else "*"
        return name or (path if title == "The file" else f"{title}.{path}")

    def find_below(self, title, value):
        _, node = resolved(value)
        if is_object(node):
            self.section_of(title, node)
        if "items" in node:
            self.find_below(resolved(node["items"])[0] or title, node["items"])

    def look_for_examples(self, said, given, title):
        _, node = resolved(said)
        if isinstance(given, list) and "items" in node:
            for each in given:
                self.look_for_examples(node["items"], each, resolved(node["items"])[0] or title)
        if not isinstance(given, dict) or title not in self.sections:
            return
        known = {key: (key, value) for key, value, chosen in members(node) if not chosen}
        chosen = [(key, value) for key, value, named in members(node) if named]
        for name, value in given.items():
            key, below = known.get(name, chosen[0] if chosen and name not in EVERYWHERE else (None, None))
            if key is None:
                continue
            shown = json.dumps({name: value}, ensure_ascii=False)[1:-1]
            kept = self.sections[title].examples.get(key)
            if value is not None and (kept is None or len(kept) > LONGEST_EXAMPLE > len(shown)):
                self.sections[title].examples[key] = shown
            self.look_for_examples(below, value, self.below(title, key, below))

    def target(self, title, key, value):
        """The section that says more, if one does."""
        found = self.below(title, key, value)
        _, node = resolved(value)
        if "items" in node and not is_object(node):
            found = resolved(node["items"])[0] or found
        return self.sections.get(found)


def kinds(node, key):
    """In words: what may stand there."""
    _, node = resolved(node)
    out = []
    if "enum" in node:
        out.append(", ".join(f"`{json.dumps(value)}`" for value in node["enum"]))
    unit = next((f" {unit}" for suffix, unit in UNITS.items() if key.endswith(suffix)), "")
    for kind in types(node):
        if kind in ("integer", "number") and "expects" in node:
            continue  # it says so
        if kind in ("integer", "number"):
            low, high = node.get("minimum"), node.get("maximum")
            what = "whole number" if kind == "integer" else "number"
            reach = f" {low} to {high}" if low is not None and high is not None else f" from {low}" if low is not None else ""
            out.append(what + reach + unit)
        elif kind == "array":
            least, most = node.get("minItems"), node.get("maxItems")
            reach = "" if most is None else f" of {most}" if least == most else f" of {least or 0} to {most}"
            out.append("list" + reach)
        elif kind == "string" and "enum" not in node:
            out.append("text" if "expects" not in node else node["expects"].replace("|", "\\|"))
        elif kind == "boolean":
            out.append("`true`, `false`")
        elif kind == "object":
            out.append("`{...}`")
        elif kind == "null":
            out.append("`null`")
    return " or ".join(out)


def default_of(key, node, required):
    _, said = resolved(node)
    if key in required:
        return "required"
    if "default" in said:
        return f"`{json.dumps(said['default'])}`"
    found = re.search(r"Default: ([^.;]*(?:\.\d[^.;]*)?)", said.get("description", ""))
    return found[1] if found else ""


def meaning(node):
    text = resolved(node)[1].get("description", "")
    text = re.sub(r" ?Default: [^.]*(?:\.\d[^.]*)?\.", "", text)
    # Keys and values as they are written.
    return re.sub(r'(\{"[^{}]*(?:\{[^{}]*\}[^{}]*)*\}|\["[^\[\]]*\]|(?<!\w)"[^"]+")', r"`\1`", text).replace("|", "\\|")


def table(reference, section):
    lines = []
    text = meaning(section.node)
    if section is not reference.root:
        lines += [f"## {section.title}", ""] + ([text, ""] if text else [])
    lines += ["| key | meaning | may be | default | example |", "|---|---|---|---|---|"]
    required = section.node.get("required", [])
    for keys, value, chosen in rows(section.node):
        key = keys[0]
        target = reference.target(section.title, key, value)
        shown = f"*{key}*" if chosen else ", ".join(f"`{each}`" for each in keys)
        shown = f"[{shown}](#{target.anchor()})" if target is not None else shown
        given = resolved(value)[1].get("examples", [None])[0]
        example = section.examples.get(key, "" if given is None else json.dumps({key: given}, ensure_ascii=False)[1:-1])
        if len(example) > LONGEST_EXAMPLE:
            example = example[:LONGEST_EXAMPLE].rpartition(" ")[0] + " ..."
        example = example.replace("|", "\\|")
        lines.append(f"| {shown} | {meaning(value)} | {kinds(value, key)} | {default_of(key, value, required)} | {f'`{example}`' if example else ''} |")
    return "\n".join(lines) + "\n"


def page():
    reference = Reference()
    return HEAD + "\n".join(table(reference, section) for section in reference.sections.values())


class ProfileReference(unittest.TestCase):
    maxDiff = None

    def test_the_page_is_what_the_schema_says(self):
        printed = page()
        if os.environ.get("AXISGATE_WRITE_PAGES"):
            PAGE.write_text(printed, encoding="utf-8")
        self.assertEqual(PAGE.read_text(encoding="utf-8"), printed)

    def test_each_key_says_what_it_means(self):
        reference = Reference()
        mute = [f"{section.title}: {key}" for section in reference.sections.values() for key, value, _ in members(section.node) if not meaning(value)]
        self.assertEqual(mute, [])
        self.assertGreater(sum(len(list(members(section.node))) for section in reference.sections.values()), 150)


if __name__ == "__main__":
    unittest.main()
