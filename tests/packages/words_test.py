#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a program's --help says, its manual page says in the same words, and its completions offer: no more and no less.

words_test.py PROGRAM [unittest's arguments]
"""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = Path(sys.argv[1]).absolute()
NAME = PROGRAM.name
# What is offered behind these words.
WORDS = {
    "axisgate": {
        ("run", "--log-level", ""): {"error", "warning", "info", "debug"},
        ("run", "--log-level", "=", "w"): {"warning"},
        ("map", "x.json", "--format", ""): {"table", "md", "csv", "json", "st"},
        ("top", "--count", ""): set(),
        ("profile", "ch"): {"check"},
    },
    "axisgate-dds": {("ser",): {"serve"}},
    "axisgate-web": {("ser",): {"serve"}},
    "axisgate-sim": {("--reply-",): {"--reply-delay-ms"}},
}
NAMES = re.compile(r"(?<![\w-])--?[A-Za-z][\w-]*")


def printed(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=True).stdout


def normal(text):
    return " ".join(text.split())


class Help:
    """One command's --help, read as a person reads it."""

    def __init__(self, way):
        self.way = way
        head, *self.parts = re.split(r"\n(?=(?:Positionals|Options|Subcommands):\n)", printed(*way, "--help"))
        self.what = normal(re.sub(r"Usage:.*", "", head, flags=re.DOTALL))
        self.footer = ""
        if self.parts:
            self.parts[-1], _, self.footer = self.parts[-1].partition("\n\n")
        self.arguments, self.options, self.commands = (self.entries(part) for part in ("Positionals", "Options", "Subcommands"))

    def entries(self, part):
        """(what stands in front, its description) of each entry."""
        for text in self.parts:
            if text.startswith(part + ":\n"):
                joined = re.sub(r"\n {3,}", "   ", text.partition("\n")[2])
                pairs = (re.split(r" {2,}", line.strip(), maxsplit=1) for line in joined.splitlines() if line.strip())
                return [(pair[0], normal(pair[1]) if len(pair) > 1 else "") for pair in pairs]
        return []

    def option_names(self):
        return {name for front, _ in self.options for name in NAMES.findall(front)}

    def command_names(self):
        return {front for front, _ in self.commands}


def all_helps(way=()):
    here = Help(way)
    yield here
    for name in sorted(here.command_names()):
        yield from all_helps((*way, name))


def shown(roff):
    """A manual page as it is shown, without its layout."""
    lines = (line for line in roff.splitlines() if not re.match(r"\.(\\\"|TH|nh|ad|TP|PP|br)", line))
    text = re.sub(r"\\f[BIR]", "", "\n".join(lines))
    for code, sign in (("\\-", "-"), ("\\(aq", "'"), ("\\(ga", "`"), ("\\(ha", "^"), ("\\(ti", "~"), ("\\&", ""), ("\\e", "\\")):
        text = text.replace(code, sign)
    return text


class Words(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.helps = list(all_helps())

    def section(self, page, way):
        """What the page says of this command."""
        if not way:
            return page.partition(".SH COMMANDS")[0]
        begin = page.index(f'.SS "{" ".join((NAME, *way))}"\n')
        return re.split(r"\n\.S[SH] ", page[begin + 1 :])[0]

    def test_the_manual_page_says_what_help_says(self):
        page = shown(printed("--generate", "man"))
        self.assertGreater(len(self.helps[0].options), 0)
        for one in self.helps:
            with self.subTest(command=one.way):
                section = normal(self.section(page, one.way))
                self.assertIn(one.what.removeprefix(f"{NAME}: "), section)
                for front, what in one.options + one.arguments:
                    self.assertIn(what, section)
                    for name in NAMES.findall(front) or [front.split()[0]]:
                        self.assertIn(name, section)
                self.assertEqual(one.option_names() - set(NAMES.findall(section)), set())
                for line in one.footer.splitlines() if one.commands == [] or not one.way else []:
                    self.assertIn(normal(line), section)

    def test_the_synopsis_has_each_command(self):
        synopsis = shown(printed("--generate", "man")).partition(".SH SYNOPSIS\n")[2].partition(".SH")[0]
        for one in self.helps:
            if not one.commands:
                self.assertIn(" ".join((NAME, *one.way, "[OPTIONS]")), synopsis)

    def complete(self, *words, folder="/"):
        """What bash offers for the last of these words."""
        script = """
          source /dev/stdin
          function=$(complete -p "$1"); function=${function#*-F }; function=${function% *}
          COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMPREPLY=(old)
          "$function" "$1" "${!#}" "${COMP_WORDS[COMP_CWORD - 1]}"
          printf '%s\\n' "${COMPREPLY[@]}"
          """
        done = subprocess.run(["bash", "--norc", "-c", script, "bash", NAME, *words], input=printed("--generate", "bash"),
                              capture_output=True, text=True, check=True, cwd=folder)
        self.assertEqual(done.stderr, "")
        return set(done.stdout.split())

    def test_bash_offers_each_command_and_each_option_at_its_place(self):
        for one in self.helps:
            with self.subTest(command=one.way):
                self.assertEqual(self.complete(*one.way, "-"), one.option_names())
                if one.commands:
                    self.assertEqual(self.complete(*one.way, ""), one.command_names())

    def test_bash_offers_files_where_one_is_taken(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "gateway.json").touch()
            for one in self.helps:
                for front, _ in one.options + one.arguments:
                    words = [NAMES.findall(front.partition(" Excludes: ")[0])[-1]] if front.startswith("-") else []
                    if re.search(r"\b(FILE|CONFIG)\b", front) and front != "HOST:PORT":
                        with self.subTest(command=one.way, of=front):
                            self.assertIn("gateway.json", self.complete(*one.way, *words, "gate", folder=folder))

    def test_bash_offers_the_words_of_an_option(self):
        for words, offered in WORDS.get(NAME, {}).items():
            self.assertEqual(self.complete(*words), offered)

    def test_zsh_knows_each_command_and_each_option(self):
        text = printed("--generate", "zsh")
        self.assertTrue(text.startswith(f"#compdef {NAME}\n"))
        for one in self.helps:
            function = "_" + "_".join((NAME, *one.way)).replace("-", "_")
            begin = text.index(f"\n{function}() {{")
            body = text[begin : text.index("\n}\n", begin)]
            for option in one.option_names():
                self.assertRegex(body, rf"'\*?{option}\[", one.way)
            for command in one.command_names():
                self.assertIn(f"'{command}:", body)

    def test_help_does_not_show_how_these_are_made(self):
        for one in self.helps:
            self.assertNotIn("--generate", one.option_names())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
