# SPDX-License-Identifier: Apache-2.0
"""Reads the subset of IEC 61131-3 structured text that the function blocks are written in, and refuses the rest with its line: what
a controller of some maker alone would take must not get into them. st_machine.py runs what this has read.

In the subset: TYPE of STRUCT, FUNCTION_BLOCK, PROGRAM with VAR_INPUT, VAR_OUTPUT, VAR_IN_OUT and VAR; assignment, IF, FOR, calls of
function blocks with named inputs. An identifier is written one way throughout and is no word of the standard, of either edition.
"""
import re
from collections import namedtuple

Declaration = namedtuple("Declaration", "name type initial place section")
Unit = namedtuple("Unit", "kind name declarations body")  # kind: STRUCT, FUNCTION_BLOCK, PROGRAM
ArrayType = namedtuple("ArrayType", "first last element")

TOKENS = re.compile(r"""
    (?P<space>\s+)
  | (?P<comment>\(\*.*?\*\))
  | (?P<time>T\#\d+(?:ms|s)\b)
  | (?P<bits>16\#[0-9A-F]+\b)
  | (?P<real>\d+\.\d+)
  | (?P<integer>\d+)
  | (?P<place>%[IQ]W\d+\b)
  | (?P<word>[A-Za-z][A-Za-z0-9_]*)
  | (?P<sign>:=|<=|>=|<>|\.\.|[-+*/=<>()\[\]:;,.])
""", re.X | re.S)

ELEMENTARY = ("BOOL", "INT", "UINT", "DINT", "UDINT", "WORD", "DWORD", "LREAL", "TIME")
USED = set("""TYPE END_TYPE STRUCT END_STRUCT FUNCTION_BLOCK END_FUNCTION_BLOCK PROGRAM END_PROGRAM VAR VAR_INPUT VAR_OUTPUT VAR_IN_OUT
    END_VAR ARRAY OF AT IF THEN ELSIF ELSE END_IF FOR TO DO END_FOR AND OR XOR NOT MOD TRUE FALSE""".split())
# Words of the standard and of Siemens' SCL that have no place in the subset: refused as statements and as names.
RESERVED = set("""ABSTRACT ACTION BEGIN BY BYTE CASE CHAR CLASS CONFIGURATION CONSTANT CONTINUE CTD CTU CTUD DATE DATE_AND_TIME DT EN END_ACTION
    END_CASE END_CLASS END_CONFIGURATION END_FUNCTION END_INTERFACE END_METHOD END_NAMESPACE END_REPEAT END_RESOURCE END_STEP
    END_TRANSITION END_WHILE ENO EXIT EXTENDS F_EDGE F_TRIG FINAL FROM FUNCTION GOTO IMPLEMENTS INITIAL_STEP INTERFACE INTERNAL INTERVAL
    LABEL LDATE LDT LINT LTIME LTOD LWORD METHOD NAMESPACE NIL NON_RETAIN NULL ON OVERLAP OVERRIDE POINTER PRIORITY PRIVATE PROTECTED PUBLIC
    R_EDGE R_TRIG READ_ONLY READ_WRITE REAL REF REF_TO REFERENCE REGION REPEAT RESOURCE RETAIN RETURN RS SINGLE SINT SR STEP STRING SUPER TASK THIS
    TIME_OF_DAY TOD TOF TP TRANSITION ULINT UNTIL USING USINT VAR_ACCESS VAR_CONFIG VAR_EXTERNAL VAR_GLOBAL VAR_TEMP WCHAR WHILE WITH
    WSTRING""".split())
FUNCTIONS = {"ABS", "SHL", "SHR"}
CONVERSIONS = re.compile(rf"({'|'.join(ELEMENTARY)})_TO_({'|'.join(ELEMENTARY)})")
SECTIONS = {"FUNCTION_BLOCK": ("VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT", "VAR"), "PROGRAM": ("VAR",)}


class Outside(Exception):
    """The text is not of the subset."""


class Parser:
    def __init__(self, text, name="text"):
        self.name = name
        self.spelt = {}
        self.tokens = list(self.split(text))
        self.at = 0

    def split(self, text):
        position, line = 0, 1
        while position < len(text):
            match = TOKENS.match(text, position)
            if not match:
                raise Outside(f"{self.name}:{line}: no word of the subset: {text[position:position + 20]!r}")
            if match.lastgroup not in ("space", "comment"):
                yield match.lastgroup, match.group(), line
            line += match.group().count("\n")
            position = match.end()
        yield "end", "", line

    # One token at a time.

    def fail(self, why):
        raise Outside(f"{self.name}:{self.tokens[self.at][2]}: {why}")

    def peek(self, *texts):
        return self.tokens[self.at][1] in texts

    def kind(self):
        return self.tokens[self.at][0]

    def take(self):
        self.at += 1
        return self.tokens[self.at - 1][1]

    def accept(self, *texts):
        return self.take() if self.peek(*texts) else None

    def expect(self, *texts):
        if not self.peek(*texts):
            self.fail(f"{' or '.join(texts)} expected, not {self.tokens[self.at][1]!r}")
        return self.take()

    def identifier(self):
        word = self.tokens[self.at][1]
        if self.kind() != "word":
            self.fail(f"a name expected, not {word!r}")
        upper = word.upper()
        if upper in USED | RESERVED | FUNCTIONS | set(ELEMENTARY) or "__" in word or word.endswith("_") or CONVERSIONS.fullmatch(upper):
            self.fail(f"{word} is no name in every controller")
        if self.spelt.setdefault(upper, word) != word:
            self.fail(f"{word} is spelt {self.spelt[upper]} elsewhere")
        return self.take()

    # Declarations.

    def units(self):
        found = []
        while self.kind() != "end":
            opening = self.expect("TYPE", "FUNCTION_BLOCK", "PROGRAM")
            if opening == "TYPE":
                name = self.identifier()
                self.expect(":")
                self.expect("STRUCT")
                found.append(Unit("STRUCT", name, self.declarations("END_STRUCT", ""), []))
                self.expect(";")
                self.expect("END_TYPE")
                continue
            name, declared = self.identifier(), []
            while section := self.accept("VAR", "VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT"):
                if section not in SECTIONS[opening]:
                    self.fail(f"no {section} in a {opening}")
                of_section = self.declarations("END_VAR", section)
                if len({each.place is None for each in of_section}) > 1:
                    self.fail("variables at a place have a section of their own")
                declared += of_section
            found.append(Unit(opening, name, declared, self.statements(f"END_{opening}")))
            self.expect(f"END_{opening}")
        return found

    def declarations(self, end, section):
        found = []
        while not self.accept(end):
            name = self.identifier()
            place = None
            if self.accept("AT"):
                if self.kind() != "place":
                    self.fail("%IW or %QW expected")
                place = self.take()
            self.expect(":")
            kind = self.type()
            initial = self.literal() if self.accept(":=") else None
            self.expect(";")
            if any(each.name == name for each in found):
                self.fail(f"{name} is declared twice")
            found.append(Declaration(name, kind, initial, place, section))
        return found

    def type(self):
        if self.accept("ARRAY"):
            self.expect("[")
            first = self.number()
            self.expect("..")
            last = self.number()
            self.expect("]")
            self.expect("OF")
            return ArrayType(first, last, self.type())
        if self.peek(*ELEMENTARY, "TON"):
            return self.take()
        return self.identifier()

    def number(self):
        if self.kind() != "integer":
            self.fail("a number expected")
        return int(self.take())

    def literal(self):
        negative = bool(self.accept("-"))
        kind = self.kind()
        if kind not in ("time", "bits", "real", "integer") and not self.peek("TRUE", "FALSE"):
            self.fail("a literal expected")
        text = self.take()
        if kind == "word":
            return "bool", text == "TRUE"
        if kind == "time":
            amount = re.fullmatch(r"T#(\d+)(ms|s)", text)
            return "time", int(amount[1]) * (1 if amount[2] == "ms" else 1000)
        if kind == "bits":
            return "bits", int(text[3:], 16)
        value = float(text) if kind == "real" else int(text)
        return kind, -value if negative else value

    # Statements: tuples that begin with what they are and their line.

    def statements(self, *ends):
        found = []
        while not self.peek(*ends):
            found.append(self.statement())
        return found

    def statement(self):
        line = self.tokens[self.at][2]
        if self.accept("IF"):
            return self.if_statement(line)
        if self.accept("FOR"):
            name = self.identifier()
            self.expect(":=")
            first = self.number()
            self.expect("TO")
            last = self.number()
            self.expect("DO")
            body = self.statements("END_FOR")
            self.expect("END_FOR")
            self.expect(";")
            return "for", line, name, first, last, body
        target = self.variable()
        if self.accept("("):
            arguments = []
            while not self.accept(")"):
                if arguments:
                    self.expect(",")
                name = self.take() if self.peek("IN", "PT") else self.identifier()
                self.expect(":=")
                arguments.append((name, self.expression()))
            self.expect(";")
            return "call", line, target, arguments
        self.expect(":=")
        value = self.expression()
        self.expect(";")
        return "assign", line, target, value

    def if_statement(self, line):
        branches = []
        while True:
            condition = self.expression()
            self.expect("THEN")
            branches.append((condition, self.statements("ELSIF", "ELSE", "END_IF")))
            if not self.accept("ELSIF"):
                break
        otherwise = self.statements("END_IF") if self.accept("ELSE") else []
        self.expect("END_IF")
        self.expect(";")
        return "if", line, branches, otherwise

    # Expressions, from the weakest operator to the strongest (IEC 61131-3, table 71).

    LEVELS = (("OR",), ("XOR",), ("AND",), ("=", "<>"), ("<", ">", "<=", ">="), ("+", "-"), ("*", "/", "MOD"))

    def expression(self, level=0):
        if level == len(self.LEVELS):
            return self.unary()
        left = self.expression(level + 1)
        while operator := self.accept(*self.LEVELS[level]):
            line = self.tokens[self.at - 1][2]
            left = ("binary", line, operator, left, self.expression(level + 1))
        return left

    def unary(self):
        line = self.tokens[self.at][2]
        if operator := self.accept("NOT", "-"):
            return "unary", line, operator, self.unary()
        if self.accept("("):
            inside = self.expression()
            self.expect(")")
            return inside
        if self.kind() in ("time", "bits", "real", "integer") or self.peek("TRUE", "FALSE"):
            return "literal", line, *self.literal()
        word = self.tokens[self.at][1]
        if word in FUNCTIONS or CONVERSIONS.fullmatch(word):
            self.take()
            self.expect("(")
            arguments = [self.expression()]
            while self.accept(","):
                arguments.append(self.expression())
            self.expect(")")
            return "function", line, word, arguments
        return self.variable()

    def variable(self):
        line = self.tokens[self.at][2]
        parts = [self.identifier()]
        while True:
            if self.accept("."):
                parts.append(self.identifier())
            elif self.accept("["):
                parts.append(self.expression())
                self.expect("]")
            else:
                return "variable", line, parts
