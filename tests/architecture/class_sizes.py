# SPDX-License-Identifier: Apache-2.0
"""How many functions and fields each class of the product's headers declares, and which may still have more than a class should."""
import re

from sources import files

MOST_FUNCTIONS, MOST_FIELDS = 45, 18
# A record has fewer functions than this: its fields are what it is made of, as many as its table has.
FEWEST_FUNCTIONS = 7
# Those that are larger: (functions, fields) as they are. A figure here only ever becomes smaller, and no class is added.
LARGER = {
    "axisgate::compose::Gateway": (31, 20),
    "axisgate::commands::ManualPlan": (51, 30),
    "axisgate::bus::Bus": (37, 19),
    "axisgate::can::SocketCanLink": (18, 25),
    "axisgate::drive::BringUp": (27, 23),
    "axisgate::drive::CommandSequence": (47, 19),
    "axisgate::modbus_rtu::RtuWire": (24, 19),
}

TOKEN = re.compile(r"""(?P<gone>\s+|//[^\n]*|/\*.*?\*/|\[\[.*?\]\])|R"([^()\s\\]*)\(.*?\)\2"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])+'"""
                   r"""|[A-Za-z_]\w*|\.?\d[\w.']*|->\*?|::|<<=?|<=>|<=|>=|==|!=|&&|\|\||\.\.\.|.""", re.S)
DIRECTIVE = re.compile(r"^[ \t]*#(?:\\\n|[^\n])*", re.M)
CLOSES = {"(": ")", "{": "}", "[": "]"}
KEYS = {"class", "struct", "union"}
ACCESS = {"public", "private", "protected"}
# What is followed by something in brackets that is not a list of parameters.
WITH_BRACKETS = {"alignas", "decltype", "noexcept", "explicit", "requires", "__attribute__"}
# Declare no member: what begins so is passed over.
NO_MEMBER = {"using", "typedef", "friend", "static_assert"}
# `unsigned : 3` has no name.
PLAIN_TYPES = {"unsigned", "signed", "int", "char", "short", "long", "bool", "const"}


class Class:
    def __init__(self, name, line):
        self.name, self.line, self.functions, self.fields = name, line, 0, 0


def tokens_of(text):
    """(token, line): without comments, attributes and directives; `operator` and its sign as one."""
    text = DIRECTIVE.sub(lambda found: "\n" * found[0].count("\n"), text)
    found, line = [], 1
    for token in TOKEN.finditer(text):
        if token["gone"] is None:
            found.append((token[0], line))
        line += token[0].count("\n")
    joined, at = [], 0
    while at < len(found):
        token, line = found[at]
        at += 1
        if token == "operator":
            if [word for word, _ in found[at:at + 2]] == ["(", ")"]:
                at += 2
            while found[at][0] != "(":
                at += 1
            token = "operator_"
        joined.append((token, line))
    return joined


class Reader:
    """Reads declarations, one after another; passes over whatever is no declaration: bodies, initializers, template arguments."""

    def __init__(self, text):
        self.tokens, self.at, self.classes = tokens_of(text), 0, []

    def next(self):
        return self.tokens[self.at][0] if self.at < len(self.tokens) else ""

    def pass_over(self):
        """What stands between a bracket and the one that closes it, both included."""
        closes = [CLOSES[self.next()]]
        self.at += 1
        while closes and self.at < len(self.tokens):
            if self.next() in CLOSES:
                closes.append(CLOSES[self.next()])
            elif self.next() == closes[-1]:
                closes.pop()
            self.at += 1

    def pass_over_arguments(self):
        """Of a template, if this < opens them: they close before anything that cannot stand in them."""
        begin, depth = self.at, 0
        while self.at < len(self.tokens) and self.next() not in (";", ")", "]", "}"):
            if self.next() in CLOSES:
                self.pass_over()
                continue
            depth += {"<": 1, ">": -1}.get(self.next(), 0)
            self.at += 1
            if depth == 0:
                return
        self.at = begin + 1

    def read(self, scope, owner):
        """All declarations up to the end of this scope; `owner`: the class whose members they are, none: a namespace's."""
        while self.next() not in ("", "}"):
            self.declaration(scope, owner)
        self.at += 1

    def declaration(self, scope, owner):
        if self.next() in ACCESS and self.tokens[self.at + 1][0] == ":":
            self.at += 2
            return
        if self.next() == ";":
            self.at += 1
            return
        counted = self.next() not in NO_MEMBER
        parts, made_type = [[]], False  # what is declared, comma by comma; brackets stand for what is in them
        valued = listed = False  # behind = ; behind the : of a constructor
        while self.next() not in ("", ";", "}"):
            token = self.next()
            part = parts[-1]
            if token == "<" and part and (part[-1].isidentifier() or part[-1] == "template"):
                self.pass_over_arguments()
                if part[-1] == "template":
                    part.pop()
            elif token in WITH_BRACKETS:
                self.at += 1
                if self.next() == "(":
                    self.pass_over()
                    if token == "decltype":
                        part.append("decltype_")
            elif token == "(":
                begin = self.tokens[self.at + 1][0]
                self.pass_over()
                if not valued and not listed:
                    part.append("(*)" if begin in ("*", "&", "^") else "()")
            elif token == "{":
                words = [word for word in part if word.isidentifier()]
                if not valued and not made_type and ("namespace" in words or words == ["extern"]):
                    name = "::".join(words[words.index("namespace") + 1:]) if "namespace" in words else ""
                    self.at += 1
                    self.read([*scope, name] if name else scope, None)
                    return
                if not valued and not made_type and "enum" in words:
                    self.pass_over()
                    parts, made_type = [[]], True
                elif not valued and not made_type and KEYS & set(parts[0]) and "()" not in part:
                    self.class_body(scope, owner, parts[0])
                    parts, made_type = [[]], True
                elif not valued and "()" in part and not (listed and self.tokens[self.at - 1][0] not in (")", "}")):
                    self.pass_over()
                    self.count(owner if counted else None, parts[:1])
                    return
                else:
                    self.pass_over()
            elif token == "[":
                self.pass_over()
            elif token == "," and not listed:
                parts.append([])
                valued = False
                self.at += 1
            else:
                valued = valued or token == "="
                listed = listed or (token == ":" and "()" in part and not valued)
                if not valued and not listed:
                    part.append(token)
                self.at += 1
        if self.next() == ";":
            self.at += 1
        if made_type and not parts[0]:
            return
        only_named = len(parts) == 1 and parts[0] and parts[0][0] in (*KEYS, "enum") and len([w for w in parts[0] if w.isidentifier()]) == 2
        if counted and (made_type or not only_named or "*" in parts[0] or "&" in parts[0]):
            self.count(owner, parts)

    def class_body(self, scope, owner, head):
        line = self.tokens[self.at][1]
        key = next(at for at, word in enumerate(head) if word in KEYS)
        named = head[key + 1:head.index(":")] if ":" in head else head[key + 1:]
        name = "".join(word for word in named if word != "final")
        self.at += 1
        if name or owner is None:
            made = Class("::".join([*scope, name or "(unnamed)"]), line)
            self.classes.append(made)
            self.read([*scope, name or "(unnamed)"], made)
            return
        # Without a name: what is declared behind it is a field of this type; if nothing is, its members are the owner's.
        made = Class("::".join([*scope, "(unnamed)"]), line)
        self.read([*scope, "(unnamed)"], made)
        if self.next() == ";":
            owner.functions += made.functions
            owner.fields += made.fields
        else:
            self.classes.append(made)

    @staticmethod
    def count(owner, parts):
        if owner is None or not any(parts):
            return
        static = "static" in parts[0]
        for part in parts:
            if "()" in part and "(*)" not in part[:part.index("()")]:
                owner.functions += 1
            elif not static and not (":" in part and all(word in PLAIN_TYPES for word in part[:part.index(":")])):
                owner.fields += 1


def classes_of(text):
    reader = Reader(text)
    while reader.at < len(reader.tokens):
        reader.read([], None)
    return reader.classes


def class_sizes(root, larger=None):
    """A class has so many functions and fields at most; those that had more may only become smaller."""
    larger = dict(LARGER if larger is None else larger)
    for name in files(root, {".hpp"}):
        if not name.startswith(("gateway/", "adapters/")):
            continue
        for made in classes_of((root / name).read_text(encoding="utf-8")):
            place, has = f"{name}:{made.line}: {made.name}", (made.functions, made.fields)
            record = made.functions < FEWEST_FUNCTIONS
            fits = made.functions <= MOST_FUNCTIONS and (record or made.fields <= MOST_FIELDS)
            listed = larger.pop(made.name, None)
            if listed is None and not fits:
                yield (f"{place} declares {has[0]} functions and has {has[1]} fields; {MOST_FUNCTIONS} and {MOST_FIELDS} at most: "
                       "is it one thing?")
            elif listed is not None and fits:
                yield f"{place} fits the rule now: take it out of LARGER in tests/architecture/class_sizes.py"
            elif listed is not None:
                for what, now, then in zip(("functions", "fields"), has, listed):
                    if now > then:
                        yield f"{place} has {now} {what}, and may have no more than it had, {then}"
                    elif now < then:
                        yield f"{place} has {now} {what} now: lower it to {now} in tests/architecture/class_sizes.py"
    for gone in larger:
        yield f"tests/architecture/class_sizes.py:1: there is no class {gone}: take it out of LARGER"
