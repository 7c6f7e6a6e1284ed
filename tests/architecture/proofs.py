# SPDX-License-Identifier: Apache-2.0
"""What pages promise has tests that prove it: docs/faults.md and docs/rules name them, and each name must be that of a test."""
import re

from sources import CODE, files, lines

FAULTS = 37
C_TEST = re.compile(r"^\s*TEST(?:_F|_P)?\(\s*(\w+)\s*,\s*(\w+)\s*\)", re.M)
STORIES = {"stories": "tests/integration", "vcan_stories": "tests/vcan", "modbus_clients": "tests/integration/modbus_clients"}


def tests_of(root):
    """All tests by the names that docs/faults.md and docs/rules use."""
    checks = (root / "tests/architecture/CMakeLists.txt").read_text(encoding="utf-8") if (root / "tests/architecture").is_dir() else ""
    names = {f"Architecture.{rule}" for found in re.findall(r"foreach\(rule ([\w ]+)\)", checks) for rule in found.split()}
    for path in (root / "tests/unit/modbus_tcp/dialogues").glob("*.txt"):
        names.update(f"{path.stem}: {title}" for title in re.findall(r"^== (.*)$", path.read_text(encoding="utf-8"), re.M))
    for path in (root / "tests").rglob("*_test.cpp"):
        names.update(".".join(found) for found in C_TEST.findall(path.read_text(encoding="utf-8")))
    for prefix, folder in STORIES.items():
        # A story of tests/integration that speaks to CAN runs on real interfaces as well.
        for path in (root / folder).glob("*_test.py"):
            cls = ""
            for found in re.finditer(r"^class (\w+)|^    def (test_\w+)", path.read_text(encoding="utf-8"), re.M):
                cls = found[1] or cls
                if found[2]:
                    names.add(f"{prefix}.{path.stem.removesuffix('_test')}.{cls}.{found[2]}")
    return names


def fault_proofs(root):
    """Each fault of docs/faults.md has a test that exists."""
    name = "docs/faults.md"
    known, title, proofs, faults = tests_of(root), 0, 0, 0
    for number, line in [*lines(root, name), (0, "## end")]:
        if line.startswith("## "):
            if title and not proofs:
                yield f"{name}:{title}: a fault without a test that proves it"
            title, proofs = number, 0
            faults += number > 0
            if number and not line.startswith(f"## {faults}. "):
                yield f"{name}:{number}: this is fault {faults}"
        elif line.startswith("- "):
            proofs += 1
            if line[2:].strip("`") not in known:
                yield f"{name}:{number}: there is no test {line[2:]}"
    if faults != FAULTS:
        yield f"{name}:1: {faults} faults, and there are {FAULTS}"


RULES_AND_DECISIONS = 50 * 1024  # bytes: whoever adds a rule looks which one says it already
RULE = re.compile(r"\| ([A-Z]+-\d+) \|")


def rule_proofs(root):
    """Each rule of docs/rules has an id of its own, a reason and tests that exist; what is cited is there; all is read in an evening."""
    tests = tests_of(root)
    known = tests | {f"{name.rpartition('.')[0]}.*" for name in tests if ": " not in name}
    size, ids = sum(path.stat().st_size for folder in ("docs/rules", "docs/adr") for path in (root / folder).glob("*.md")), {}
    if size > RULES_AND_DECISIONS:
        yield f"docs/rules:1: rules and decisions have {size} bytes, more than {RULES_AND_DECISIONS}"
    for path in sorted((root / "docs/rules").glob("*.md")):
        name = path.relative_to(root).as_posix()
        for number, line in lines(root, name):
            if not (found := RULE.match(line)):
                continue
            cells = line.strip("| ").split(" | ")
            proofs = re.findall(r"`([^`]+)`", cells[-1])
            if found[1] in ids:
                yield f"{name}:{number}: {found[1]} is at {ids[found[1]]} as well"
            ids.setdefault(found[1], f"{name}:{number}")
            if len(cells) != 4 or not all(cells) or not proofs:
                yield f"{name}:{number}: a rule is an id, a sentence, a reason and its proof"
            yield from (f"{name}:{number}: there is no test {proof}" for proof in proofs if proof not in known)
    prefixes = "|".join(sorted({name.partition("-")[0] for name in ids}))
    if not prefixes:
        yield "docs/rules:1: there is no rule"
        return
    cite = re.compile(rf"(?<![\w-])(?:{prefixes})-\d+\b")
    pages = [path.relative_to(root).as_posix() for path in (*root.glob("*.md"), *root.glob("docs/**/*.md"))]
    for name in [*files(root, CODE | {".txt"}), *sorted(pages)]:
        for number, line in lines(root, name) if not name.startswith("tests/architecture/") else ():
            yield from (f"{name}:{number}: docs/rules has no {gone}" for gone in cite.findall(line) if gone not in ids)
