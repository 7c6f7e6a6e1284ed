# SPDX-License-Identifier: Apache-2.0
"""The commands that pages show, and one of them for a test that runs it as the page has it: `of_page("docs/upgrade.md", "apt install")`."""
import re
import shlex
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
# Who reads them in backquotes takes them for commands as well.
IN_BACKQUOTES = re.compile(r"`((?:[A-Z_]+=[^\s`]+ )*(?:[a-z][\w.-]*|(?:deploy|tests|build)/[\w./-]+) [^`]+)`")
NO_COMMAND = re.compile(r'[]{}["]|.*:=')  # JSON, structured text


def pages():
    return [*sorted(SOURCE.glob("*.md")), *(path for folder in ("docs", "deploy", "schemas", "tests") for path in sorted(SOURCE.glob(f"{folder}/**/*.md")))]


def is_open(text):
    """It goes on in the next line."""
    try:
        list(words_of(text))
    except ValueError:  # a quotation without its end
        return True
    return text.endswith("\\")


def in_blocks(text):
    """(typed, command): those in ```sh blocks and in indented lines, with the lines that belong together as one."""
    block, begun = None, ""
    for line in text.splitlines():
        if line.startswith("```"):
            block = line[3:] or "plain" if block is None else None
        elif block == "sh" or block is None and line.startswith("    "):
            begun = f"{begun}\n{line}" if begun else line.strip()
            if begun and not NO_COMMAND.match(begun) and is_open(begun):
                continue
            if begun and not NO_COMMAND.match(begun):
                yield block == "sh", begun.replace("\\\n", "")
            begun = ""


def commands(text):
    """(typed, command) of a page: `typed` stands in a ```sh block."""
    yield from in_blocks(text)
    rest = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    for found in IN_BACKQUOTES.findall(" ".join(rest.split())):
        yield False, found


def words_of(command):
    split = shlex.shlex(command, posix=True, punctuation_chars=";&|>")
    split.whitespace_split, split.commenters = True, "#"
    return split


def single(command):
    """The words of each program that a line calls."""
    inner = re.findall(r"\$\(([^)]*)\)", command)
    made = [[]]
    into_file = False
    for word in words_of(re.sub(r"\$\([^)]*\)", "INNER", command)):
        if word in (";", "&", "&&", "|", "||"):
            made.append([])
        elif word == ">" or into_file:
            into_file = word == ">"
        elif made[-1] or not re.match("[A-Z_]+=", word):
            made[-1].append(word)
    return [words for words in made if words] + [words for each in inner for words in single(each)]


def of_page(page, begins):
    """The command of that page that begins so; as it is typed, without what is said behind it."""
    text = (SOURCE / page).read_text(encoding="utf-8")
    found = sorted({command for _, command in commands(text) if command.startswith(begins)})
    assert len(found) == 1, f"{page} has {len(found)} commands that begin with '{begins}': {found}"
    return re.sub(r"\s+# .*", "", found[0])
