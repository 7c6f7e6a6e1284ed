#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""docs/configuration.md is every key of schemas/gateway.schema.json, behind a worked case of units, gears and limits, whose numbers
tests/config/program_test.cpp has `axisgate check` say.

configuration_page.py SOURCE_FOLDER [unittest's arguments]; AXISGATE_WRITE_PAGES=1 prints the page anew.
"""
import copy
import json
import os
import sys
import unittest
from pathlib import Path

from schema_page import DEFAULT, Page, is_object, types, unit_of

SOURCE = Path(sys.argv.pop(1)).absolute()
SCHEMA = json.loads((SOURCE / "schemas/gateway.schema.json").read_text(encoding="utf-8"))
PAGE = SOURCE / "docs/configuration.md"

HEAD = """# Every key of a configuration

<!-- Printed from schemas/gateway.schema.json by tests/docs/configuration_page.py: AXISGATE_WRITE_PAGES=1 prints it anew. -->

One JSON file describes the whole gateway. Comments (`//` and `/* */`) are allowed; a key that is not known is a mistake, and so is a key
given twice. A mistake is told with file, line, column, the way to the key and what to write, all mistakes at once:

```text
gateway.json:9:9: /buses/0/drives/0/axes/0/lease: must be object or null, is number: write {"timeout_ms": 2000}
```

The tables come in the order in which a configuration is written: [who may connect](#listener), [the line](#bus), [what is on it](#drive),
[the axes](#axis) with their [limits](#axislimits) and [lease](#axislease); then [the page](#web) and [DDS](#dds). The same text is the
manual page gateway.json(5). [quick_start.md](quick_start.md) has a first configuration,
[deploy/example/gateway.json](../deploy/example/gateway.json) one with a bus of each kind.

## Units, gears and limits

Registers count whole numbers. Speeds and ramps are always the motor's, in front of every gear: velocities in 0.001 rpm, accelerations in
0.1 rpm/s, torques in 0.1 % of the rated torque. Positions count in a unit of your own: `"units_per_rev"` says how many of it one turn of the
motor is.

A motor turns a gear 1:20 (20 turns of the motor are one of the spindle), and the spindle moves a slide 5 mm a turn, along 400 mm:

- One turn of the motor moves the slide 5 mm / 20 = 0.25 mm. Positions are to be micrometres: `"units_per_rev": 250`. Where the division
  leaves a rest, it is a fraction: with 37 turns of the motor for 12 of the spindle 5000 * 12 / 37, `{"numerator": 60000, "denominator": 37}`.
- 0 to 400 mm are 0 to 400000 of these units: `"position": [0, 400000]`.
- A velocity in m/s, by the 0.00025 m of one motor turn and 60 s a minute, is rpm; 1000 times that stands in the register. The motor may turn
  3000 rpm, so the slide is limited to 0.0125 m/s: `"velocity": 3000000`.
- From standstill to 3000 rpm in half a second are 6000 rpm/s: `"acceleration": 60000`.
- DDS shows metres with `"dds_unit": "m"` and `"metres_per_rev": "0.00025"`; `axisgate check` then says the limit in m/s as well.

```json
{
  "modbus_tcp": [{"listen": "127.0.0.1:1502"}],
  "buses": [{
    "name": "slide", "adapter": "kinco-serial", "device": "/dev/ttyUSB0",
    "drives": [{
      "profile": "kinco-jd", "node": 1, "constants": {"peak_current_a": 27.5},
      "axes": [{
        "axis": 1, "name": "slide",
        "units_per_rev": 250, // micrometres of one motor turn
        "limits": {"position": [0, 400000], "velocity": 3000000, "acceleration": 60000}
      }]
    }]
  }]
}
```

Of this axis `axisgate check` says:

```text
units           250 per motor turn; in turns, a register reaches ±8589934.6, the drive's counter ±214748.4
limits          velocity 3000 rpm; position 0 to 400000 (0.00 to 1600.00 turns); acceleration 6000 rpm/s
```

A limit of 0.5 m/s does not fit this gear, and `axisgate check` says so; without the gear it does:

| gear | metres of one motor turn | wanted | motor | `"velocity"` | |
|---|---|---|---|---|---|
| 1:20 | 0.00025 | 0.0125 m/s | 3000 rpm | 3000000 | |
| 1:20 | 0.00025 | 0.5 m/s | 120000 rpm | 120000000 | faster than motors turn |
| none | 0.005 | 0.5 m/s | 6000 rpm | 6000000 | |

Whether the numbers are right, a careful jog shows: the axis must go as far as its position says, and as fast as its velocity.

## The file

"""


def without_ends(page):
    """Keys of which a reader could not tell what holds without them."""
    for section, key, said in page.keys():
        required = key in section.node.get("required", [])
        if not required and "default" not in said and "otherwise" not in said and not DEFAULT.search(said.get("description", "")):
            yield f"{section.title}: {key}"


def without_range(page):
    """Numbers without unit or bounds, among keys and entries of lists."""
    for section, key, said in page.keys():
        for node in (said, said.get("items", {})):
            if not {"integer", "number"} & set(types(node)) or "$ref" in node:
                continue
            low = "minimum" in node or "exclusiveMinimum" in node
            if not unit_of(node, key) or not low or "maximum" not in node and "string" not in types(node):
                yield f"{section.title}: {key}"


class ConfigurationPage(unittest.TestCase):
    maxDiff = None

    def test_the_page_is_what_the_schema_says(self):
        printed = HEAD + Page(SCHEMA).tables()
        if os.environ.get("AXISGATE_WRITE_PAGES"):
            PAGE.write_text(printed, encoding="utf-8")
        self.assertEqual(PAGE.read_text(encoding="utf-8"), printed)

    def test_each_key_says_what_it_means_and_what_holds_without_it(self):
        page = Page(SCHEMA)
        self.assertGreater(len(page.keys()), 110)
        self.assertEqual([f"{section.title}: {key}" for section, key, _ in page.keys()
                          if not page.meaning(dict(section.node["properties"])[key])], [])
        self.assertEqual(list(without_ends(page)), [])

    def test_each_key_has_an_example_that_may_stand_there(self):
        for section, key, said in Page(SCHEMA).keys():
            with self.subTest(section=section.title, key=key):
                example = said["examples"][0]
                if "enum" in said:
                    self.assertIn(example, said["enum"])
                kinds = {"integer": int, "number": (int, float), "string": str, "boolean": bool, "array": list, "object": dict, "null": type(None)}
                if types(said):
                    self.assertIsInstance(example, tuple(kind for name in types(said) for kind in (kinds[name] if isinstance(kinds[name], tuple) else (kinds[name],))))
                if isinstance(example, (int, float)):
                    self.assertGreaterEqual(example, said.get("minimum", example))
                    self.assertLessEqual(example, said.get("maximum", example))
                if is_object(said) and "properties" in said and isinstance(example, dict):
                    self.assertLessEqual(set(example), set(said["properties"]))

    def test_each_number_has_its_range_and_its_unit(self):
        self.assertEqual(list(without_range(Page(SCHEMA))), [])

    def test_a_key_that_says_too_little_is_found(self):
        schema = copy.deepcopy(SCHEMA)
        schema["definitions"]["axis"]["properties"]["jog"] = {"type": "integer", "minimum": 1}
        page = Page(schema)
        self.assertEqual(list(without_ends(page)), ["axis: jog"])
        self.assertEqual(list(without_range(page)), ["axis: jog"])


if __name__ == "__main__":
    unittest.main()
