# SPDX-License-Identifier: Apache-2.0
"""What profiles and comments cite of a drive, and the numbers that docs/drive_sources.md has."""
import re

NAMES = {"JD": "JD", "MD": "MD", "LD2-CAN": "LD2", "LD2": "LD2", "KYDAS4860-2E": "Keya", "Keya": "Keya", "iD286pro": "iD286pro"}
PROFILES = {"kinco": "JD", "kinco-jd": "JD", "kinco-md": "MD", "leadshine-ld2-can": "LD2", "keya-kydas4860-2e": "Keya", "id286pro": "iD286pro"}
# Neither 0x80 nor 605Ah, neither 6099.05 nor 2010:03.
NUMBER = r"(?:rows \d+ and \d+|row \d+|[KC]\d{1,2}|\d{1,2}(?:\.\d{1,2}[abc]?)?|(?<=MD )[A-O]|(?<=, )[A-O])(?!\w|[.:]\w)"
NAME = rf"\b({'|'.join(NAMES)})"
CITE = re.compile(rf"{NAME} ({NUMBER}(?:(?:, | and | to ){NUMBER})*)")


def drive_sources(page):
    """By drive: the numbers of the page, also those within a group of objects, and those between two ("3.1 to 3.5")."""
    known = {}
    for section in re.split(r"^## ", page, flags=re.MULTILINE)[1:]:
        numbers = known.setdefault(section.split(":")[0].split(",")[0], set())
        for first, second in re.findall(r"^\| ([^|]*) \| ([^|]*) \|", section, re.MULTILINE):
            numbers.update(re.findall(r"row \d+|[KC]\d+|\d+(?:\.\d+)?", first))
            for begin, end in re.findall(r"\b(\d+\.\d+) to (\d+\.\d+)\b", first):
                chapter = begin.split(".")[0]
                numbers.update(f"{chapter}.{n}" for n in range(int(begin.split(".")[1]), int(end.split(".")[1]) + 1))
            numbers.update(re.findall(r"(?<![\w.])\d+\.\d+[abc]?(?![\w.])|\b[A-O]\b", second))
    return known


def cites_in(text, owner=None):
    """What a comment cites, (drive, number); of an entry of `owner`'s profile also numbers without the drive's name."""
    found = []

    def take(drive, numbers):
        for part in re.findall(rf"(?<![\w.:-]){NUMBER}", numbers):
            found.extend((drive, each) for each in ([f"row {row}" for row in re.findall(r"\d+", part)] if part.startswith("row") else [part]))

    if owner is None:
        for cite in CITE.finditer(text):
            take(NAMES[cite[1]], cite[0])
        return found
    for part in re.split(rf"(?={NAME} )", re.sub(r" \([^)]*\)", "", text)):
        if part in NAMES:
            continue
        name = re.match(NAME, part or "")
        owner = NAMES[name[1]] if name else owner
        take(owner, part or "")
    return found


def drive_cites(root):
    """All of them, (file and line, drive, number)."""
    for stem, owner in PROFILES.items():
        for number, line in enumerate((root / f"schemas/drives/{stem}.json").read_text(encoding="utf-8").splitlines(), 1):
            for source in re.findall(r'"source": "([^"\\]*)"', line):
                if "drive_sources" not in source:
                    yield from ((f"{stem}.json:{number}", *cite) for cite in cites_in(source, owner))
    for folder in ("adapters", "gateway", "tests"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in {".cpp", ".hpp", ".txt"} and "golden" not in path.parts:
                for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                    yield from ((f"{path.name}:{number}", *cite) for cite in cites_in(line))
