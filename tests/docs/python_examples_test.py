#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The examples in Python that cannot be run here, since Debian 12 has neither cyclonedds nor rclpy for Python: that they are Python, and
that their types, topics, QoS and numbers are those of the IDL, of docs/dds/ros2.md and of the one table of words.

python_examples_test.py SOURCE_FOLDER [unittest's arguments]
"""
import ast
import re
import sys
import unittest
from pathlib import Path

SOURCE = Path(sys.argv.pop(1)).absolute()
EXAMPLES = SOURCE / "deploy/examples"
IDL = (SOURCE / "schemas/axisgate.idl").read_text(encoding="utf-8")
TYPES = ast.parse((EXAMPLES / "dds/axisgate_types.py").read_text(encoding="utf-8"))
SIMPLE = {"octet": "uint8", "short": "int16", "unsigned short": "uint16", "long": "int32", "unsigned long": "uint32", "unsigned long long": "uint64",
          "double": "float64", "boolean": "bool", "Time": "Time", "Guid": "array[uint8, 16]"}


def of_the_idl(name):
    """(members with their types as cyclonedds calls them, keys, whether it is final)"""
    final, body = re.search(rf"(@final )?struct {name} {{(.*?)}};", IDL, re.DOTALL).groups()
    members, keys = [], []
    for key, kind, bound, member in re.findall(r"(@key )?([a-zA-Z][a-zA-Z ]*?)(?:<(\d+)>)? (\w+);", re.sub(r"//.*", "", body)):
        members.append((member, f"bounded_str[{bound}]" if kind == "string" else SIMPLE[kind]))
        keys += [member] if key else []
    return members, keys, bool(final)


def of_the_example(struct):
    members = [(node.target.id, ast.unparse(node.annotation)) for node in struct.body if isinstance(node, ast.AnnAssign)]
    keys = [node.value.args[0].value for node in struct.body if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
            and node.value.func.id == "key"]
    return members, keys, any(isinstance(mark, ast.Name) and mark.id == "final" for mark in struct.decorator_list)


def constants(tree):
    """NAME = value, and NAME, NAME = value, value"""
    found = {}
    for node in tree.body:
        if isinstance(node, ast.Assign):
            target, = node.targets
            names = target.elts if isinstance(target, ast.Tuple) else [target]
            values = node.value.elts if isinstance(target, ast.Tuple) else [node.value]
            found |= {name.id: value for name, value in zip(names, values, strict=True)}
    return found


def number(name):
    return ast.literal_eval(constants(TYPES)[name])


def words_of(kind):
    """The names of the table of words."""
    return re.findall(rf'{{{kind}, \d+, "([^"]*)"', (SOURCE / "gateway/core/word_table.cpp").read_text(encoding="utf-8"))


class Python(unittest.TestCase):
    def test_every_example_is_python(self):
        found = sorted(EXAMPLES.rglob("*.py"))
        self.assertGreater(len(found), 5)
        for path in found:
            compile(path.read_text(encoding="utf-8"), path, "exec")

    def test_those_that_no_test_runs_say_so(self):
        for path in ("dds/axes_cyclonedds.py", "dds/command_cyclonedds.py", "ros2/axes_rclpy.py", "ros2/command_rclpy.py"):
            self.assertIn("Not run by axisgate's tests", (EXAMPLES / path).read_text(encoding="utf-8"), path)


class Types(unittest.TestCase):
    maxDiff = None

    def test_each_has_the_members_of_the_idl_in_their_order(self):
        structs = [node for node in TYPES.body if isinstance(node, ast.ClassDef)]
        self.assertGreater(len(structs), 4)
        for struct in structs:
            with self.subTest(struct.name):
                self.assertEqual(of_the_example(struct), of_the_idl(struct.name))
                self.assertEqual([ast.literal_eval(word.value) for word in struct.keywords], [f"axisgate.{struct.name}"])

    def test_numbers_are_those_of_the_idl(self):
        for name, value in constants(TYPES).items():
            if name.startswith("HAS_"):
                self.assertIn(f"const unsigned long {name} = {value.value};", IDL)
        told = re.sub(r"\s*//\s*", " ", IDL)
        for name in ("ENABLE", "DISABLE", "MOVE_ABSOLUTE", "RELEASE"):
            self.assertRegex(told, rf"\b{number(name)} {name.lower()}\b")
        self.assertRegex(told, rf"\b{number('DONE')} done\b")
        self.assertRegex(told, rf"\b{number('ALREADY_SEEN')} already seen\b")
        for result, text in number("NOT_BEGUN").items():
            text = {7: "not owner", 18: "the role may not do this", 22: "another gateway"}.get(result, text)
            self.assertRegex(told, rf"\b{result} {text}")

    def test_each_topic_has_its_type_and_a_quality_that_matches(self):
        """What the gateway offers and asks for stands before each struct."""
        for path in ("dds/axes_cyclonedds.py", "dds/command_cyclonedds.py"):
            text = (EXAMPLES / path).read_text(encoding="utf-8")
            topics = re.findall(r'Topic\(participant, "([^"]+)", (\w+)\)', text)
            self.assertGreater(len(topics), 0)
            for topic, kind in topics:
                self.assertRegex(IDL, rf"// Topic {topic}[^}}]*?@final struct {kind} ", path)
            self.assertEqual(text.count("XCDR1)"), len(topics), "each reader and writer says how its samples are written")
            self.assertEqual(text.count("Topic("), len(topics))


class Ros(unittest.TestCase):
    PAGE = (SOURCE / "docs/dds/ros2.md").read_text(encoding="utf-8")

    def test_topics_and_types_are_those_of_the_page(self):
        for path in ("axes_rclpy.py", "command_rclpy.py"):
            text = (EXAMPLES / "ros2" / path).read_text(encoding="utf-8")
            used = re.findall(r'create_(?:subscription|publisher)\((\w+), f?"([^"]+)"', text)
            self.assertEqual(len(used), text.count("self.create_"))
            for kind, topic in used:
                topic = topic.replace("{prefix}", "").replace("{topic}", "NAME")
                row = next(line for line in self.PAGE.splitlines() if line.startswith("|") and f"`{topic}`" in line)
                package = re.search(rf"from (\w+)\.msg import {kind}$", text, re.MULTILINE)[1]
                self.assertIn(f"| {package}/{kind} |", row)

    def test_states_are_called_as_the_gateway_calls_them(self):
        tree = ast.parse((EXAMPLES / "ros2/command_rclpy.py").read_text(encoding="utf-8"))
        known = words_of("axis_state")
        states = [ast.literal_eval(constants(tree)["DISABLED"]), *ast.literal_eval(constants(tree)["ENABLED"])]
        self.assertEqual([state for state in states if state not in known], [])
        self.assertNotIn("stopping", states)


if __name__ == "__main__":
    unittest.main()
