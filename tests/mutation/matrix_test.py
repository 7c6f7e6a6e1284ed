#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The table of which test notices which mutant, and what it proposes to delete."""
import importlib.machinery
import importlib.util
import sys
import unittest
from pathlib import Path
from types import SimpleNamespace

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import matrix

LOADER = importlib.machinery.SourceFileLoader("mutation_sweep", str(HERE / "sweep"))
SWEEP = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutation_sweep", LOADER))
sys.modules["mutation_sweep"] = SWEEP
LOADER.exec_module(SWEEP)


def case(name, layer, notices, lines=10, file="tests/unit/a_test.cpp", comes_to=9, is_open=True):
    return SWEEP.Case(name, file, layer, 0.0, lines, comes_to, frozenset(notices), is_open)


def kept(cases, proofs=()):
    return {each.name for each in SWEEP.keep(cases, set(proofs))}


class Sources(unittest.TestCase):
    def test_a_body_is_as_long_as_its_lines(self):
        text = "TEST(A, one) { a(); }\nTEST_P(B, two) {\n  if (x) {\n  }\n}\n\nTEST_F(C,\n       three) {\n}\n"
        self.assertEqual({name: lines for name, (_, lines) in matrix.bodies("a.cpp", text).items()}, {"A.one": 1, "B.two": 4, "C.three": 3})

    def test_a_name_with_parameters_is_that_of_its_body(self):
        for name in ("B.two", "Each/B.two/KincoJdCan", "Each/B.two/0", "B/0.two"):
            self.assertEqual(matrix.body_of(name), "B.two")

    def test_each_folder_is_of_a_layer(self):
        for path, layer in (("tests/unit/drive/a.cpp", "unit"), ("tests/obey/a.cpp", "obey"), ("tests/fuzz/a.cpp", "judged"), ("tests/profiles/a.cpp", "files")):
            self.assertEqual(matrix.layer_of(path), layer)


class Table(unittest.TestCase):
    def test_what_is_written_is_read_again(self):
        cases = matrix.Cases(SimpleNamespace(name="p", path=Path("/x/build/dev/tests/unit/p")))
        cases.seconds = {"E/A.one/1": 0.25, "E/A.one/2": 0.5, "A.slow": 2.0}
        cases.reached = {"E/A.one/1": {7}, "E/A.one/2": {7, 8}, "A.slow": {7}}
        seen = {(7, "p"): (0, {"E/A.one/1": ""}), (8, "p"): (0, {"E/A.one/2": "hang"})}
        tests = {"tests/unit": {"A.one": ("tests/unit/a_test.cpp", 4), "A.slow": ("tests/unit/a_test.cpp", 9)}}
        one, slow = SWEEP.read(matrix.table({"p": cases}, seen, tests, 1.0))
        self.assertEqual((one.name, one.layer, one.seconds, one.lines, one.comes_to, one.notices), ("A.one", "unit", 0.75, 4, 2, {7, 8}))
        self.assertTrue(one.open)
        self.assertFalse(slow.open)

    def test_of_a_program_that_was_not_played_to_the_end_nothing_is_proposed(self):
        text = "program\tp\ttests/unit\tplayed 1 of 2\nfile\ta\nA.one\tunit\t0\t4\t1\t2\t7\n"
        self.assertFalse(SWEEP.read(text)[0].open)
        self.assertTrue(SWEEP.read(text, partly=True)[0].open)


class Sweep(unittest.TestCase):
    def test_each_mutant_keeps_one_of_two_layers_the_cheapest(self):
        self.assertEqual(kept([case("a", "unit", [1], 20), case("b", "unit", [1], 5), case("c", "obey", [1], 9), case("d", "obey", [1], 30)]), {"b", "c"})

    def test_what_one_layer_alone_notices_keeps_one(self):
        self.assertEqual(kept([case("a", "unit", [1]), case("b", "unit", [1], 5)]), {"b"})

    def test_what_later_ones_have_made_needless_falls(self):
        self.assertEqual(kept([case("a", "unit", [1, 2, 3], 20), case("b", "unit", [1, 4], 12), case("c", "unit", [2, 3, 5], 13)]), {"b", "c"})

    def test_proofs_transcripts_vectors_and_the_unknown_stay(self):
        others = [case("proof", "unit", []), case("told", "golden", [], file="tests/golden/golden_test.cpp"),
                  case("sheet", "unit", [], file="tests/unit/keya/keya_vectors_test.cpp"), case("unknown", "unit", [], is_open=False)]
        self.assertEqual(kept([*others, case("idle", "unit", [])], ["proof"]), {"proof", "told", "sheet", "unknown"})

    def test_what_stays_by_rule_counts(self):
        self.assertEqual(kept([case("proof", "unit", [1], 90), case("b", "unit", [1], 5), case("c", "obey", [1], 5)], ["proof"]), {"proof", "c"})

    def test_the_proposal_names_what_falls(self):
        cases = [case("a", "unit", [1], 20), case("b", "unit", [1], 5)]
        self.assertIn("  tests/unit/a_test.cpp: 1 of 2 cases, 20 of 25 lines, 0.0 s", ["  " + line for line in SWEEP.proposal(cases, SWEEP.keep(cases, set()))])


if __name__ == "__main__":
    unittest.main()
