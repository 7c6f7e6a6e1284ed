# SPDX-License-Identifier: Apache-2.0
"""The machine that runs the function blocks: what it takes means what the standard says, and all else is refused with its line."""
import sys
import unittest

from st_machine import Broken, Machine
from st_parser import Outside

BLOCK = "FUNCTION_BLOCK Inner VAR_INPUT A : INT; END_VAR VAR_OUTPUT B : INT; END_VAR VAR C : INT; END_VAR B := A + 1; END_FUNCTION_BLOCK "


def program(body, declared="", before=""):
    return Machine(("text", f"{before}PROGRAM P VAR {declared} END_VAR\n{body}\nEND_PROGRAM"))


def run(body, declared, before="", **values):
    """The program's variables after one cycle."""
    made = program(body, declared, before).new("P")
    for name, value in values.items():
        setattr(made, name, value)
    made.run()
    return made


class Meaning(unittest.TestCase):
    def test_operators_bind_as_the_standard_says(self):
        made = run("R := 2 + 3 * 4 - 6; X := NOT A AND B OR A AND NOT B; W := 16#F0F0 AND 16#FF00 OR 16#000F;",
                   "R : INT; X : BOOL; A : BOOL; B : BOOL; W : WORD;", A=False, B=True)
        self.assertEqual((made.R, made.X, made.W), (8, True, 0xF00F))

    def test_words_become_numbers_bit_by_bit(self):
        made = run("D := DWORD_TO_DINT(SHL(WORD_TO_DWORD(H), 16) OR WORD_TO_DWORD(L)); W := DWORD_TO_WORD(SHR(DINT_TO_DWORD(D), 16));"
                   "U := WORD_TO_UINT(L);", "D : DINT; H : WORD; L : WORD; W : WORD; U : UINT;", H=0xFFFF, L=0xFFFE)
        self.assertEqual((made.D, made.W, made.U), (-2, 0xFFFF, 0xFFFE))

    def test_branches_and_loops(self):
        body = "IF N < 2 THEN M := 1; ELSIF N < 4 THEN M := 2; ELSE M := 3; END_IF; FOR i := 0 TO 4 DO T[i] := M; END_FOR;"
        declared = "N : INT; M : INT; i : INT; T : ARRAY [0..4] OF INT;"
        self.assertEqual([run(body, declared, N=n).T for n in (1, 3, 4)], [[1] * 5, [2] * 5, [3] * 5])

    def test_a_block_keeps_its_inputs_and_gives_its_outputs(self):
        made = run("I(A := 4); J(A := 6); I(); R := I.B * 10 + J.B;", "I : Inner; J : Inner; R : INT;", BLOCK)
        self.assertEqual(made.R, 57)

    def test_ton(self):
        machine = program("Timer(IN := Runs, PT := T#100ms); Late := Timer.Q;", "Timer : TON; Runs : BOOL; Late : BOOL;")
        made, seen = machine.new("P"), []
        for now, on in ((0, True), (99, True), (100, True), (150, False), (160, True), (200, True), (260, True)):
            machine.now, made.Runs = now, on
            made.run()
            seen.append(made.Late)
        self.assertEqual(seen, [False, False, True, False, False, False, True])

    def test_initial_values(self):
        made = run("", "A : INT := -3; B : LREAL := 2.5; C : TIME := T#2s; D : BOOL := TRUE; E : WORD := 16#00FF;")
        self.assertEqual((made.A, made.B, made.C, made.D, made.E), (-3, 2.5, 2000, True, 255))


class Broke(unittest.TestCase):
    def assert_broken(self, body, declared, **values):
        with self.assertRaises(Broken):
            run(body, declared, **values)

    def test_a_number_that_leaves_its_type(self):
        self.assert_broken("U := U + 1;", "U : UINT;", U=65535)
        self.assert_broken("U := U - 1;", "U : UINT;", U=0)
        self.assert_broken("D := LREAL_TO_DINT(R);", "D : DINT; R : LREAL;", R=3e9)
        self.assert_broken("D := LREAL_TO_UDINT(R);", "D : UDINT; R : LREAL;", R=-1.0)

    def test_an_index_outside_its_array(self):
        self.assert_broken("T[I] := 1;", "T : ARRAY [0..3] OF INT; I : INT;", I=4)
        self.assert_broken("T[I] := 1;", "T : ARRAY [0..3] OF INT; I : INT;", I=-1)


class Refused(unittest.TestCase):
    def assert_refused(self, body, declared="A : INT; B : UINT; X : BOOL; W : WORD; D : DWORD; R : LREAL; T : ARRAY [0..3] OF INT;", before=""):
        with self.assertRaises(Outside, msg=body) as caught:
            program(body, declared, before)
        self.assertRegex(str(caught.exception), r"^text:\d+: ")

    def test_types_that_differ(self):
        for body in ("A := B;", "A := 1.0;", "R := 1;", "X := A;", "X := 1;", "W := A;", "A := W;", "D := W;", "X := A = B;", "X := W > R;",
                     "IF A THEN X := TRUE; END_IF;", "A := A + B;", "W := W AND X;", "A := T;", "W := 16#10000;", "B := -1;", "T[4] := 1;", "T := T;"):
            self.assert_refused(body)

    def test_what_the_standard_leaves_to_the_maker_or_another_edition_has(self):
        for body in ("WHILE X DO A := 1; END_WHILE;", "REPEAT A := 1; UNTIL X END_REPEAT;", "CASE A OF 1: A := 2; END_CASE;", "EXIT;",
                     "RETURN;", "A := B MOD B;", "A := A / A;", "W := ROL(W, 1);", "A := MAX(A, A);", "W := WORD#16#10;", "A := INT#1;",
                     "A := REAL_TO_INT(R);", "A := UINT_TO_INT(B);", "W := W.1;", "X := W.%X1;", "A += 1;", "A := 16#ab;", "// A := 1;",
                     "X := SHL(W, A) = W;", "R := R ** R;", "W := -W;", "X := X > X;", "GOTO A;", "%MW0 := W;", "A := R;"):
            self.assert_refused(body)

    def test_names_that_are_none_everywhere(self):
        for name in ("Step", "begin", "Task", "a__b", "Word", "R_Edge", "ton_", "Real_To_Int", "Int", "Until"):
            if name != "Real_To_Int":
                self.assert_refused("", f"{name} : INT;")
        self.assert_refused("a := 1;", "A : INT;")

    def test_what_is_not_declared_or_of_another_block(self):
        for body in ("Q := 1;", "I.D := 1;", "I(C := 1);", "I(A := 1, A := 2);", "I.B := 1;", "I.C := 1;", "A := I.C;", "I := I;", "A();"):
            self.assert_refused(body, "A : INT; I : Inner;", BLOCK)
        self.assert_refused("", "I : Unknown;")
        self.assert_refused("", "A : INT; A : INT;")
        self.assert_refused("", "A AT %IW0 : WORD; B : INT;")

    def test_inputs_are_not_written_from_within(self):
        with self.assertRaises(Outside):
            Machine(("text", BLOCK.replace("B := A + 1", "A := 1")))

    def test_variables_that_are_passed_must_be_variables_and_all(self):
        block = "FUNCTION_BLOCK Passes VAR_IN_OUT V : INT; END_VAR V := V + 1; END_FUNCTION_BLOCK "
        for body in ("P1(V := 1);", "P1(V := A + A);", "P1();"):
            self.assert_refused(body, "P1 : Passes; A : INT;", block)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
