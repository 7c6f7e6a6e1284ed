#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The tool that puts faults into the gateway: what it makes of a table and of a source."""
import importlib.machinery
import importlib.util
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
LOADER = importlib.machinery.SourceFileLoader("mutation_run", str(HERE / "run"))
TOOL = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutation_run", LOADER))
LOADER.exec_module(TOOL)

SOURCE = """int a() {
  if (b < c)
    return d();
  e();
  return d();
}
"""


def mutated(table):
    """The source without the lines that come before it."""
    return TOOL.mutated("a.cpp", SOURCE, TOOL.read_table("file a.cpp\n" + table)).split("\n", 2)[2]


class Mutants(unittest.TestCase):
    def test_an_expression_stands_beside_its_replacement(self):
        self.assertIn("if ((axisgate_mutant(7) ? (b <= c) : (b < c)))\n", mutated("7 why\n- b < c\n+ b <= c"))

    def test_a_statement_that_is_replaced_by_nothing_is_missing(self):
        self.assertIn("{ if (axisgate_mutant(7)) {  } else { e(); } }", mutated("7 why\n- e();\n+"))

    def test_of_a_longer_text_only_what_is_marked_is_replaced(self):
        changed = mutated("7 why\n- e(); return «d()»;\n+ f()")
        self.assertIn("return d();\n  e();\n  return (axisgate_mutant(7) ? (f()) : (d()));", changed)

    def test_a_text_may_be_broken_into_lines_otherwise(self):
        self.assertIn("axisgate_mutant(7)", mutated("7 why\n- if (b < c) return d();\n+"))

    def test_mutants_of_one_text_and_of_a_part_of_it_stand_one_in_another(self):
        changed = mutated("7 why\n- b < c\n+ b <= c\n8 why\n- «b» < c\n+ 0\n9 why\n- b < c\n+ true")
        self.assertIn("(axisgate_mutant(9) ? (true) : ((axisgate_mutant(7) ? (b <= c) : "
                      "((axisgate_mutant(8) ? (0) : (b)) < c))))", changed)

    def test_the_rest_and_its_line_numbers_stay(self):
        changed = mutated("7 why\n- e();\n+")
        self.assertEqual(changed.count("\n"), SOURCE.count("\n"))
        self.assertEqual(TOOL.mutated("a.cpp", SOURCE, []).split("\n", 2)[2], SOURCE)

    def test_a_text_that_is_not_there_or_there_twice_is_refused(self):
        for text in ("x()", "return d();"):
            with self.assertRaisesRegex(TOOL.Wrong, "mutant 7"):
                mutated(f"7 why\n- {text}\n+")

    def test_texts_that_overlap_are_refused(self):
        with self.assertRaisesRegex(TOOL.Wrong, "overlaps"):
            mutated("7 why\n- if (b < c) return d();\n+\n8 why\n- return d(); e();\n+")

    def test_a_table_with_a_number_twice_or_half_an_entry_is_refused(self):
        for table in ("7 why\n- a\n+ b\n7 why\n- b\n+ a", "7 why\n- a", "what is this"):
            with self.assertRaises(TOOL.Wrong):
                TOOL.read_table("file a.cpp\n" + table)

    def test_every_mutant_has_its_place_in_the_sources(self):
        by_path = {}
        for mutant in TOOL.read_table((HERE / "mutants.txt").read_text()):
            by_path.setdefault(mutant.path, []).append(mutant)
        for path, mutants in by_path.items():
            TOOL.mutated(path, (TOOL.ROOT / path).read_text(), mutants)
        self.assertGreaterEqual(sum(map(len, by_path.values())), 120)


if __name__ == "__main__":
    unittest.main()
