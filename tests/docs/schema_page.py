# SPDX-License-Identifier: Apache-2.0
"""Prints a page of all keys of a JSON Schema, a table for each object: meaning, what may stand there, default, example. docs/configuration.md
and docs/profile_reference.md are printed so.

Beside draft-7 it reads, of a key: "unit", what a number counts, where the key's name does not end in it; and "otherwise", what holds without
the key where there is no "default".
"""
import json
import re

LONGEST_EXAMPLE = 90
UNITS = {"_ms": "ms", "_us": "µs", "_s": "s", "_mb": "MiB"}
# Keys and values as they are written.
WRITTEN = re.compile(r'(\{"[^{}]*(?:\{[^{}]*\}[^{}]*)*\}|\["[^\[\]]*\]|(?<!\w)"[^"]+")')
DEFAULT = re.compile(r" ?Default: ((?:[^.]|\.(?=\d))*)\.")


def is_object(node):
    return "properties" in node or "patternProperties" in node or isinstance(node.get("additionalProperties"), dict)


def types(node):
    said = node.get("type", [])
    return [said] if isinstance(said, str) else said


def unit_of(node, key):
    return node.get("unit") or next((unit for suffix, unit in UNITS.items() if key.endswith(suffix)), "")


def as_written(text):
    return WRITTEN.sub(r"`\1`", text).replace("|", "\\|")


class Section:
    def __init__(self, title, node):
        self.title, self.node = title, node
        self.examples = {}

    def anchor(self):
        return re.sub(r"[^\w\- ]", "", self.title.lower()).replace(" ", "-")


class Page:
    """`everywhere`: keys that each object may have, which the page tells once itself."""

    def __init__(self, schema, everywhere=()):
        self.schema, self.everywhere = schema, everywhere
        self.sections = {}
        self.root = self.section_of("The file", schema)

    def resolved(self, node):
        """(name of the definition or None, what it says; what stands beside a reference counts first)."""
        name = None
        while "$ref" in node:
            name = node["$ref"].rpartition("/")[2]
            node = {**self.schema["definitions"][name], **{key: value for key, value in node.items() if key != "$ref"}}
        return name, node

    def members(self, node):
        """(key, what is said of it, is it a name to be chosen) of an object."""
        for key, value in node.get("properties", {}).items():
            if key not in self.everywhere and not key.startswith("$"):
                yield key, value, False
        for value in node.get("patternProperties", {}).values():
            yield node.get("expects", "a name").split(",")[0].split(":")[0], value, True
        if isinstance(node.get("additionalProperties"), dict):
            yield "a name", node["additionalProperties"], True

    def rows(self, node):
        """(keys, what is said of them, are they names to be chosen): keys of which the same is said are one row."""
        out = []
        for key, value, chosen in self.members(node):
            if out and out[-1][1] == value and not chosen:
                out[-1][0].append(key)
            else:
                out.append(([key], value, chosen))
        return out

    def keys(self):
        """(section, key, what is said of it) of the whole page."""
        return [(section, key, self.resolved(value)[1]) for section in self.sections.values() for key, value, chosen in self.members(section.node)
                if not chosen]

    def section_of(self, title, node):
        if title not in self.sections:
            self.sections[title] = Section(title, node)
            for key, value, _ in self.members(node):
                self.find_below(self.below(title, key, value), value)
        return self.sections[title]

    def below(self, title, key, value):
        name, _ = self.resolved(value)
        path = key if " " not in key else "*"
        return name or (path if title == "The file" else f"{title}.{path}")

    def find_below(self, title, value):
        _, node = self.resolved(value)
        if is_object(node):
            self.section_of(title, node)
        if "items" in node:
            self.find_below(self.resolved(node["items"])[0] or title, node["items"])

    def look_for_examples(self, said, given, title="The file"):
        """In `given`, a file that the schema is for."""
        _, node = self.resolved(said)
        if isinstance(given, list) and "items" in node:
            for each in given:
                self.look_for_examples(node["items"], each, self.resolved(node["items"])[0] or title)
        if not isinstance(given, dict) or title not in self.sections:
            return
        known = {key: (key, value) for key, value, chosen in self.members(node) if not chosen}
        chosen = [(key, value) for key, value, named in self.members(node) if named]
        for name, value in given.items():
            key, below = known.get(name, chosen[0] if chosen and name not in self.everywhere else (None, None))
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
        _, node = self.resolved(value)
        if "items" in node and not is_object(node):
            found = self.resolved(node["items"])[0] or found
        return self.sections.get(found)

    def kinds(self, node, key):
        """In words: what may stand there."""
        _, node = self.resolved(node)
        out = []
        if "enum" in node:
            out.append(", ".join(f"`{json.dumps(value)}`" for value in node["enum"]))
        unit = unit_of(node, key)
        for kind in types(node):
            if kind in ("integer", "number") and "expects" in node:
                continue  # it says so
            if kind in ("integer", "number"):
                low, high = node.get("minimum"), node.get("maximum")
                what = "whole number" if kind == "integer" else "number"
                above = f" above {node['exclusiveMinimum']}" if "exclusiveMinimum" in node else ""
                reach = f" {low} to {high}" if low is not None and high is not None else f" from {low}" if low is not None else above
                most = f", at most {high}" if above and high is not None else ""
                out.append(what + reach + most + (f" {unit}" if unit in UNITS.values() else f": {unit}" if unit else ""))
            elif kind == "array":
                least, most = node.get("minItems"), node.get("maxItems")
                reach = "" if most is None else f" of {most}" if least == most else f" of {least or 0} to {most}"
                entries = unit_of(node.get("items", {}), "")
                out.append("list" + reach + (f" {entries}" if entries else ""))
            elif kind == "string" and "enum" not in node:
                out.append("text" if "expects" not in node else node["expects"].replace("|", "\\|"))
            elif kind == "boolean":
                out.append("`true`, `false`")
            elif kind == "object":
                out.append("`{...}`")
            elif kind == "null":
                out.append("`null`")
        return " or ".join(out)

    def default_of(self, key, node, required):
        _, said = self.resolved(node)
        if key in required:
            return "required"
        shown = json.dumps(said["default"]) if "default" in said else None
        found = DEFAULT.search(said.get("description", ""))
        if found and found[1] not in (shown, str(said.get("default"))):
            return as_written(found[1])
        return f"`{shown}`" if shown else as_written(said.get("otherwise", ""))

    def meaning(self, node):
        return as_written(DEFAULT.sub("", self.resolved(node)[1].get("description", "")))

    def example_of(self, section, key, value):
        given = self.resolved(value)[1].get("examples", [None])[0]
        example = section.examples.get(key, "" if given is None else json.dumps({key: given}, ensure_ascii=False)[1:-1])
        if len(example) > LONGEST_EXAMPLE:
            example = example[:LONGEST_EXAMPLE].rpartition(" ")[0] + " ..."
        return example.replace("|", "\\|")

    def table(self, section):
        lines = []
        text = self.meaning(section.node)
        if section is not self.root:
            lines += [f"## {section.title}", ""] + ([text, ""] if text else [])
        lines += ["| key | meaning | may be | default | example |", "|---|---|---|---|---|"]
        required = section.node.get("required", [])
        for keys, value, chosen in self.rows(section.node):
            key = keys[0]
            target = self.target(section.title, key, value)
            shown = f"*{key}*" if chosen else ", ".join(f"`{each}`" for each in keys)
            shown = f"[{shown}](#{target.anchor()})" if target is not None else shown
            example = self.example_of(section, key, value)
            lines.append(f"| {shown} | {self.meaning(value)} | {self.kinds(value, key)} | {self.default_of(key, value, required)} "
                         f"| {f'`{example}`' if example else ''} |")
        return "\n".join(lines) + "\n"

    def tables(self):
        return "\n".join(self.table(section) for section in self.sections.values())
