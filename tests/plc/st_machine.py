# SPDX-License-Identifier: Apache-2.0
"""Runs what st_parser.py has read: each function block becomes a class of Python whose `run` is one call of it.

It is stricter than any controller, so that what passes here passes there: both sides of an operator and of an assignment are of one type
(no type is converted unasked), a number that leaves its type's range ends the run, and so do a division by zero, an index outside its array,
and a second call of TON by another clock. Members of an object are named as in the text.
"""
import keyword

from st_parser import CONVERSIONS, ArrayType, Outside, Parser

RANGES = {"INT": (-0x8000, 0x7FFF), "UINT": (0, 0xFFFF), "DINT": (-0x80000000, 0x7FFFFFFF), "UDINT": (0, 0xFFFFFFFF),
          "WORD": (0, 0xFFFF), "DWORD": (0, 0xFFFFFFFF)}
NUMBERS = ("INT", "UINT", "DINT", "UDINT", "LREAL")
BITS = ("BOOL", "WORD", "DWORD")
# Those that the standard gives one meaning: same bits, a wider type, a rounded number, or the rightmost bits.
KNOWN_CONVERSIONS = {"WORD_TO_UINT", "UINT_TO_WORD", "WORD_TO_DWORD", "DWORD_TO_WORD", "DWORD_TO_DINT", "DINT_TO_DWORD",
                     "DWORD_TO_UDINT", "UDINT_TO_DWORD", "DINT_TO_LREAL", "UDINT_TO_LREAL", "LREAL_TO_DINT", "LREAL_TO_UDINT"}
TON = {"IN": ("BOOL", "VAR_INPUT"), "PT": ("TIME", "VAR_INPUT"), "Q": ("BOOL", "VAR_OUTPUT"), "ET": ("TIME", "VAR_OUTPUT")}


class Broken(Exception):
    """What a controller would do wrong, or each in its own way."""


def in_range(kind, value):
    low, high = RANGES[kind]
    if not low <= value <= high:
        raise Broken(f"{value} is no {kind}")
    return value


def rounded(kind, value):
    """To the nearest; controllers differ about halves, so the text must not depend on them."""
    return in_range(kind, int(round(value)))


def bits_to_dint(value):
    return value - (1 << 32) if value >> 31 else value


class Ton:
    """IEC 61131-3, 2.5.2.3.4: Q is TRUE once IN has been so for PT. Times in ms."""

    def __init__(self, machine):
        self.machine, self.since = machine, None
        self.IN, self.PT, self.Q, self.ET = False, 0, False, 0  # pylint: disable=invalid-name

    def run(self):
        if not self.IN:
            self.since, self.Q, self.ET = None, False, 0
            return
        if self.since is None:
            self.since = self.machine.now
        self.ET = min(self.machine.now - self.since, self.PT)
        self.Q = self.ET >= self.PT


class Writer:
    """The Python of one unit."""

    def __init__(self, machine, unit):
        self.machine, self.unit = machine, unit
        self.names = {each.name: each for each in unit.declarations}
        self.lines, self.depth = [], 0

    def fail(self, line, why):
        raise Outside(f"{self.machine.name}:{line}: {why}")

    def put(self, text):
        self.lines.append("    " * self.depth + text)

    def source(self):
        self.put(f"class {self.unit.name}:")
        self.depth = 1
        self.put("def __init__(self, machine):")
        self.depth = 2
        self.put("self.machine = machine")
        for each in self.unit.declarations:
            if keyword.iskeyword(each.name) or each.name in ("run", "machine"):
                self.fail(0, f"{each.name} is a word of Python")
            self.put(f"self.{each.name} = {self.initial(each)}")
        if self.unit.kind != "STRUCT":
            self.depth = 1
            self.put("def run(self):")
            self.depth = 2
            self.block(self.unit.body)
        return "\n".join(self.lines) + "\n"

    def initial(self, declared):
        if declared.section == "VAR_IN_OUT":
            return "None"
        if declared.initial is not None:
            return repr(self.literal(0, declared.initial, declared.type)[0])
        return self.zero(declared.type)

    def zero(self, kind):
        if isinstance(kind, ArrayType):
            if kind.first != 0:
                self.fail(0, "an array begins at 0")
            return f"[{', '.join([self.zero(kind.element)] * (kind.last + 1))}]"
        if kind == "BOOL":
            return "False"
        if kind == "LREAL":
            return "0.0"
        if kind in RANGES or kind == "TIME":
            return "0"
        if kind != "TON" and kind not in self.machine.units:
            self.fail(0, f"no type is called {kind}")
        return f"{'Ton' if kind == 'TON' else kind}(machine)"

    # Statements.

    def block(self, statements):
        for statement in statements:
            getattr(self, statement[0])(*statement[1:])
        if not statements:
            self.put("pass")

    def assign(self, line, target, value):
        place, kind, section = self.place(target)
        if section in ("VAR_INPUT of this", "VAR_OUTPUT of another"):
            self.fail(line, "an input is not written from within, nor an output from without")
        text, found = self.value(value, kind)
        if found != kind:
            self.fail(line, f"{found} into {kind}")
        if isinstance(kind, ArrayType) or kind in self.machine.units or kind == "TON":
            self.fail(line, "not every controller takes two declarations of an array, or a structure, for one type")
        self.put(f"{place} = {text}")

    def call(self, line, target, arguments):
        place, kind, _ = self.place(target)
        inputs = self.machine.inputs_of(kind)
        if inputs is None:
            self.fail(line, f"{kind} is no function block")
        given = [name for name, _ in arguments]
        if len(set(given)) != len(given):
            self.fail(line, "an input is given twice")
        for name, value in arguments:
            if name not in inputs:
                self.fail(line, f"{kind} has no input {name}")
            wanted, section = inputs[name]
            text, found = self.value(value, wanted)
            if found != wanted:
                self.fail(line, f"{name}: {found} into {wanted}")
            if section == "VAR_IN_OUT" and value[0] != "variable":
                self.fail(line, f"{name} wants a variable")
            self.put(f"{place}.{name} = {text}")
        for name, (_, section) in inputs.items():
            if section == "VAR_IN_OUT" and name not in given:
                self.fail(line, f"{name} is not given")
        self.put(f"{place}.run()")

    def if_(self, line, branches, otherwise):
        for number, (condition, body) in enumerate(branches):
            text, kind = self.value(condition, "BOOL")
            if kind != "BOOL":
                self.fail(line, f"IF of {kind}")
            self.put(f"{'elif' if number else 'if'} {text}:")
            self.depth += 1
            self.block(body)
            self.depth -= 1
        if otherwise:
            self.put("else:")
            self.depth += 1
            self.block(otherwise)
            self.depth -= 1

    def for_(self, line, name, first, last, body):
        declared = self.names.get(name)
        if declared is None or declared.type != "INT":
            self.fail(line, f"{name} is no INT")
        self.put(f"for self.{name} in range({first}, {last + 1}):")
        self.depth += 1
        self.block(body)
        self.depth -= 1

    def __getattr__(self, name):
        return {"if": self.if_, "for": self.for_}[name]

    # Values: their Python and their type. `wanted` is the type of an untyped literal.

    def place(self, variable):
        _, line, parts = variable
        declared = self.names.get(parts[0])
        if declared is None:
            self.fail(line, f"{parts[0]} is not declared")
        text, kind, section = f"self.{parts[0]}", declared.type, declared.section
        section = "VAR_INPUT of this" if section == "VAR_INPUT" else section
        for part in parts[1:]:
            if isinstance(part, str):
                members = self.machine.members_of(kind)
                if part not in members:
                    self.fail(line, f"{kind} has no {part}")
                kind, of_block = members[part]
                if of_block in ("VAR", "VAR_IN_OUT"):
                    self.fail(line, f"{part} is of the block alone")
                section = f"{of_block} of another" if of_block else section
                text += f".{part}"
                continue
            if not isinstance(kind, ArrayType):
                self.fail(line, "an index of no array")
            if part[0] == "literal" and not kind.first <= part[3] <= kind.last:
                self.fail(line, "an index outside its array")
            index, found = self.value(part, "INT")
            if found != "INT":
                self.fail(line, f"an index of {found}")
            text, kind = f"{text}[index({index}, {kind.last})]", kind.element
        return text, kind, section

    def literal(self, line, literal, wanted):
        how, value = literal
        fits = {"bool": ("BOOL",), "time": ("TIME",), "real": ("LREAL",), "bits": ("WORD", "DWORD"),
                "integer": ("INT", "UINT", "DINT", "UDINT")}[how]
        kind = wanted if wanted in fits else fits[0]
        if kind in RANGES and not RANGES[kind][0] <= value <= RANGES[kind][1]:
            self.fail(line, f"{value} is no {kind}")
        return value, kind

    def value(self, node, wanted=None):
        how, line = node[:2]
        if how == "literal":
            value, kind = self.literal(line, node[2:], wanted)
            return repr(value), kind
        if how == "variable":
            return self.place(node)[:2]
        return {"unary": self.unary, "binary": self.binary, "function": self.function}[how](line, *node[2:], wanted)

    def unary(self, line, operator, operand, wanted):
        text, kind = self.value(operand, wanted)
        if operator == "NOT":
            if kind not in BITS:
                self.fail(line, f"NOT of {kind}")
            return (f"(not {text})", kind) if kind == "BOOL" else (f"({text} ^ {RANGES[kind][1]})", kind)
        if kind not in ("INT", "DINT", "LREAL"):
            self.fail(line, f"- of {kind}")
        return (f"(-{text})", kind) if kind == "LREAL" else (f"in_range('{kind}', -{text})", kind)

    def binary(self, line, operator, left, right, wanted):
        compares = operator in ("=", "<>", "<", ">", "<=", ">=")
        hint = None if compares else wanted
        # An untyped literal takes the type of the other side.
        if left[0] == "literal" and right[0] != "literal":
            b, kind = self.value(right, hint)
            a, other = self.value(left, kind)
        else:
            a, kind = self.value(left, hint)
            b, other = self.value(right, kind)
        if kind != other or isinstance(kind, ArrayType):
            self.fail(line, f"{kind} {operator} {other}")
        if compares:
            if kind not in NUMBERS + BITS + ("TIME",) or (kind == "BOOL" and operator not in ("=", "<>")):
                self.fail(line, f"{operator} of {kind}")
            return f"({a} {dict([('=', '=='), ('<>', '!=')]).get(operator, operator)} {b})", "BOOL"
        if operator in ("AND", "OR", "XOR"):
            if kind not in BITS:
                self.fail(line, f"{operator} of {kind}")
            if kind == "BOOL":
                return f"({a} {dict(AND='and', OR='or', XOR='!=')[operator]} {b})", kind
            return f"({a} {dict(AND='&', OR='|', XOR='^')[operator]} {b})", kind
        if kind not in NUMBERS or (operator in ("/", "MOD") and kind != "LREAL") or operator == "MOD":
            self.fail(line, f"{operator} of {kind}")
        return (f"({a} {operator} {b})", kind) if kind == "LREAL" else (f"in_range('{kind}', {a} {operator} {b})", kind)

    def function(self, line, name, arguments, wanted):
        if name == "ABS":
            text, kind = self.value(arguments[0], wanted)
            if kind != "LREAL" or len(arguments) != 1:
                self.fail(line, f"ABS of {kind}")
            return f"abs({text})", kind
        if name in ("SHL", "SHR"):
            text, kind = self.value(arguments[0], wanted)
            count, of = self.value(arguments[1], "INT")
            if kind not in RANGES or kind not in BITS or of != "INT" or len(arguments) != 2 or arguments[1][0] != "literal":
                self.fail(line, f"{name} of {kind}, {of}")
            return (f"(({text} << {count}) & {RANGES[kind][1]})", kind) if name == "SHL" else (f"({text} >> {count})", kind)
        source, target = CONVERSIONS.fullmatch(name).groups()
        if name not in KNOWN_CONVERSIONS or len(arguments) != 1:
            self.fail(line, f"{name} is not of the subset")
        text, kind = self.value(arguments[0], source)
        if kind != source:
            self.fail(line, f"{name} of {kind}")
        if source == "LREAL":
            return f"rounded('{target}', {text})", target
        return {"DWORD_TO_WORD": f"({text} & 65535)", "DWORD_TO_DINT": f"bits_to_dint({text})", "DINT_TO_DWORD": f"({text} & 0xFFFFFFFF)",
                "DINT_TO_LREAL": f"float({text})", "UDINT_TO_LREAL": f"float({text})"}.get(name, text), target


class Machine:
    """The types and programs of some texts. `now`, in ms, is set by whoever runs them, before each cycle."""

    def __init__(self, *texts):
        self.now = 0
        self.units, self.names = {}, {"Ton": Ton, "in_range": in_range, "rounded": rounded, "bits_to_dint": bits_to_dint, "index": index}
        for self.name, text in texts:
            for unit in Parser(text, self.name).units():
                if unit.name in self.units:
                    raise Outside(f"{self.name}: {unit.name} is declared twice")
                self.units[unit.name] = unit
                exec(Writer(self, unit).source(), self.names)  # pylint: disable=exec-used

    def new(self, name):
        """An instance of a program, block or structure, as after a cold start."""
        return self.names[name](self)

    def members_of(self, kind):
        if kind == "TON":
            return TON
        if isinstance(kind, ArrayType) or kind not in self.units:
            return {}
        return {each.name: (each.type, each.section) for each in self.units[kind].declarations}

    def inputs_of(self, kind):
        """None for what is no function block."""
        if kind != "TON" and (isinstance(kind, ArrayType) or kind not in self.units or self.units[kind].kind != "FUNCTION_BLOCK"):
            return None
        return {name: row for name, row in self.members_of(kind).items() if row[1] in ("VAR_INPUT", "VAR_IN_OUT")}

    def places(self, program):
        """Of a program's variables AT %IW and %QW."""
        return {each.place: each.name for each in self.units[program].declarations if each.place}


def index(number, last):
    if not 0 <= number <= last:
        raise Broken(f"index {number} outside 0..{last}")
    return number
