#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The rules of ARCHITECTURE.md that no compiler checks. `rules.py RULE` prints each breach as FILE:LINE: text and exits 1."""
import re
import sys
from pathlib import Path

from class_sizes import class_sizes
from proofs import fault_proofs, rule_proofs
from sources import CODE, SOURCE_FOLDERS, files, lines

# The way of a value, wire to socket, and of a command, socket to wire. The first pattern that a folder fits holds: beside its own
# headers, and those of folders of the same pattern, it may include those that are named here. Which library includes which, its
# CMakeLists.txt says (DEPENDS).
LAYERS = [
    ("gateway/core", ()),
    ("gateway/image", ("gateway/core",)),
    ("gateway/listing", ("gateway/image", "gateway/core")),
    # Reads the command lines of all programs, whatever they are for.
    ("gateway/manual", ()),
    ("adapters/bus", ("gateway/core",)),
    ("adapters/asio", ("gateway/core",)),
    # A second link over the same serial ports: it shares how they are opened, locked and found again.
    ("adapters/modbus_rtu", ("adapters/serial", "adapters/bus", "gateway/core")),
    # A Lawicel adapter is a serial port: the CAN links share how those are opened and found again.
    ("adapters/can", ("adapters/serial", "adapters/bus", "gateway/core")),
    ("adapters/canopen", ("adapters/can", "adapters/bus", "gateway/core")),
    ("adapters/keya", ("adapters/can", "adapters/bus", "gateway/core")),
    ("adapters/serial", ("adapters/bus", "gateway/core")),
    ("adapters/kinco", ("adapters/bus", "gateway/core")),
    ("gateway/model", ("gateway/image", "gateway/core")),
    ("gateway/profile", ("gateway/model", "adapters/bus", "gateway/core")),
    ("gateway/drive", ("gateway/model", "gateway/image", "adapters/bus", "gateway/core")),
    ("gateway/upstream/modbus_tcp", ("gateway/image", "gateway/core")),
    # The DDS topics in two processes: what they say to each other, the gateway's half, the half with the DDS library, and whoever
    # starts that one and carries packets between the two.
    ("gateway/upstream/link", ("gateway/core",)),
    ("gateway/upstream/dds_link", ("gateway/upstream/link", "gateway/core")),
    ("gateway/upstream/web_link", ("gateway/upstream/link", "gateway/core")),
    # What any program of the gateway's own needs, and whoever keeps one.
    ("gateway/upstream/program", ("gateway/upstream/link", "gateway/core")),
    ("gateway/upstream/host", ("gateway/upstream/link", "gateway/image", "gateway/core")),
    ("gateway/upstream/dds_process", ("gateway/upstream/program", "gateway/upstream/link", "gateway/upstream/dds_link", "gateway/manual", "gateway/core")),
    ("gateway/upstream/dds_host", ("gateway/upstream/host", "gateway/upstream/dds", "gateway/upstream/dds_link", "gateway/upstream/link", "gateway/image", "gateway/core")),
    ("gateway/upstream/dds", ("gateway/upstream/feed", "gateway/upstream/dds_link", "gateway/image", "gateway/core")),
    ("gateway/upstream/web_process", (*(f"gateway/upstream/{r}" for r in ("web_link", "program", "link")), "gateway/listing", "gateway/manual", "gateway/image", "gateway/core")),
    ("gateway/upstream/web_host", ("gateway/upstream/host", "gateway/upstream/web", "gateway/upstream/web_link", "gateway/upstream/link", "gateway/image", "gateway/core")),
    ("gateway/upstream/web", ("gateway/upstream/feed", "gateway/upstream/web_link", "gateway/image", "gateway/core")),
    ("gateway/upstream/feed", ("gateway/image", "gateway/core")),
    # The simulated drives come from the makers' sheets: what they share with the gateway could be wrong on both sides.
    ("tests/simulated", ()),
    # What puts everything together.
    ("gateway/config", None),
    ("gateway/check", None),
    ("gateway/compose", None),
    ("gateway/process", None),
    ("gateway/commands", None),
    ("gateway/main.cpp", None),
    ("tests", None),
]

# Headers that only one place may know.
ONE_PLACE = {
    r"<modbus(/modbus)?\.h>": ("adapters/modbus_rtu/link/",),
    r"<linux/can": ("adapters/can/link/", "tests/axisgate_sim/", "tests/unit/can/", "tests/vcan/", "tests/bench/"),
    r"<fastdds|<fastrtps|PubSubTypes": ("gateway/upstream/dds_process/", "deploy/examples/", "tests/dds_peers/"),
    r"<termios\.h>|<sys/inotify\.h>|<linux/serial\.h>": ("adapters/serial/", "adapters/asio/key_mode"),
    r"<valijson/": ("gateway/profile/json/json_schema.cpp",),
    r"<CLI/": ("gateway/commands/command_", "gateway/upstream/dds_process/options.cpp", "gateway/upstream/web_process/options.cpp", "gateway/manual/command_tree.cpp"),
    r"<boost/beast": ("gateway/upstream/web_process/http/header_parser.cpp", "gateway/commands/record/page_client.cpp", "gateway/commands/support/archive.cpp"),
    r"<seccomp\.h>": ("gateway/upstream/web_process/system/confinement.cpp",), r"<prometheus/": ("gateway/upstream/web_process/metrics/families.",),
}

# Files that decide: bytes, frames and instants go in, actions come out. The exceptions are shells.
DECIDING = ("gateway/core/", "gateway/image/", "gateway/listing/", "gateway/model/", "gateway/profile/", "gateway/drive/", "gateway/config/", "gateway/check/",
            "gateway/compose/", "gateway/commands/commission/commission_plan", "gateway/commands/manual/plan/", "gateway/commands/parameters/plan/", "gateway/commands/record/plan/", "gateway/commands/scan/plan/", "gateway/commands/support/plan/", "gateway/commands/try/plan/",
            "gateway/commands/view/", "gateway/upstream/modbus_tcp/", "gateway/upstream/dds/", "gateway/upstream/dds_link/", "gateway/upstream/link/", "gateway/upstream/web_link/", "gateway/upstream/web/", "gateway/upstream/feed/",
            *(f"gateway/upstream/web_process/{room}/" for room in ("time", "values", "history", "capture", "http", "picture", "metrics", "files", "api", "stream")),
            "gateway/upstream/host/restart_", "adapters/bus/", "adapters/kinco/", "adapters/modbus_rtu/", "adapters/canopen/", "adapters/keya/", "adapters/can/")
SHELLS = ("gateway/upstream/modbus_tcp/server/", "adapters/modbus_rtu/link/", "adapters/can/link/", "gateway/upstream/web_process/http/header_parser.cpp")
IMPURE = re.compile(r'#include <(boost/asio|boost/beast|sys/socket|sys/epoll|poll\.h|thread|mutex|condition_variable|atomic|random)'
                    r'|(steady|system|high_resolution)_clock::now|std::chrono::\w*clock::now|\bsleep_for\b|\brand\(')

LONGEST_FILE = 400
# Written in halves so that this file does not name what it forbids.
FORBIDDEN_WORDS = re.compile("|".join(["/wo" "rk/", "/fa" "rm/", r"\.\./sha" "red", "before" "-stop", "GTEST_" "SKIP", "DIS" "ABLED_",
                                       "TO" "DO", "FIX" "ME", r"EXPECT_TRUE\(tr" r"ue\)"]))
INCLUDE = re.compile(r'^\s*#include "([^"]+)"')


def layer_of(name):
    """The pattern of LAYERS that `name` belongs to and what it may include; None where it may include everything."""
    for folder, allowed in LAYERS:
        if name == folder or name.startswith(f"{folder}/"):
            return folder, allowed
    return None, ()


def libraries(root):
    """By folder: the libraries it makes, and those they depend on, as the CMakeLists.txt say."""
    made, needed = {}, {}
    for path in sorted(root.glob("gateway/**/CMakeLists.txt")) + sorted(root.glob("adapters/**/CMakeLists.txt")):
        folder = path.parent.relative_to(root).as_posix()
        for call in re.finditer(r"axisgate_library\(\s*(\w+)(.*?)\)\n", path.read_text(encoding="utf-8"), re.DOTALL):
            depends = re.search(r"\bDEPENDS\b([\w\s]*?)(?:\bLIBRARIES\b|$)", call[2])
            made.setdefault(folder, set()).add(call[1])
            needed.setdefault(folder, set()).update(depends[1].split() if depends else ())
    return made, needed


def circle(graph):
    """A way from a folder back to itself, or None."""
    done, way = set(), []

    def visit(folder):
        if folder in way:
            return way[way.index(folder):] + [folder]
        if folder in done:
            return None
        way.append(folder)
        found = next(filter(None, map(visit, sorted(graph.get(folder, ())))), None)
        way.pop()
        done.add(folder)
        return found

    return next(filter(None, map(visit, sorted(graph))), None)


def arrows(root):
    made, needed = libraries(root)
    graph = {folder: {other for other in made if other != folder and made[other] & needed[folder]} for folder in made}
    for folder, names in sorted(made.items()):
        if len(names) > 1:
            yield f"{folder}/CMakeLists.txt:1: one folder is one library, and here are {', '.join(sorted(names))}"
    found = circle(graph)
    if found:
        yield f"{found[0]}/CMakeLists.txt:1: a circle of libraries: {' -> '.join(found)}"
    for name in files(root, {".cpp", ".hpp"}):
        folder, allowed = layer_of(name)
        own = name.rsplit("/", 1)[0]
        for number, line in lines(root, name):
            include = INCLUDE.match(line)
            if not include:
                continue
            other = include[1].rsplit("/", 1)[0]
            if folder is None:
                yield f"{name}:{number}: this folder has no rule in LAYERS: say what it may include"
            elif allowed is not None and not include[1].startswith(tuple(f"{a}/" for a in (folder, *allowed))):
                yield f"{name}:{number}: {folder} may not include {include[1]}"
            elif own in made and other in made and other != own and other not in graph[own]:
                yield f"{name}:{number}: {own}/CMakeLists.txt does not name the library of {include[1]} in DEPENDS"


# The namespace of a room; the first folder that a file fits holds. What stands inside may be nested deeper.
NAMESPACES = [
    ("gateway/core", "axisgate"), ("gateway/image", "axisgate"), ("adapters/asio", "axisgate"), ("gateway/main.cpp", None),
    ("gateway/upstream/modbus_tcp", "axisgate::modbus_tcp"), ("gateway/upstream/web", "axisgate::web"),
    ("gateway/upstream/link", "axisgate::link"), ("gateway/upstream/host", "axisgate::host"), ("gateway/upstream/program", "axisgate::program"), ("gateway/upstream/feed", "axisgate::feed"), ("gateway/upstream", "axisgate::dds"),
    ("tests/simulated", "axisgate::simulated"), ("tests/axisgate_sim", "axisgate::simulated"), ("tests/model", "axisgate::test::reference"),
    ("tests/bench", "axisgate::bench"), ("tests", None),
]
NAMESPACE = re.compile(r"^namespace (axisgate(?:::\w+)*) \{")


def namespaces(root):
    for name in files(root, {".cpp", ".hpp"}):
        parts = name.split("/")
        room = next((n for folder, n in NAMESPACES if name.startswith(folder)), f"axisgate::{parts[1]}")
        for number, line in lines(root, name):
            found = NAMESPACE.match(line)
            if room and found and found[1] != room and not found[1].startswith(f"{room}::"):
                yield f"{name}:{number}: what stands in this folder is in the namespace {room}"


def one_place(root):
    for name in files(root, {".cpp", ".hpp"}):
        for number, line in lines(root, name):
            for header, places in ONE_PLACE.items():
                if re.search(r"#include " + f"({header})", line) and not name.startswith(places + ("tests/",)):
                    yield f"{name}:{number}: only {places[0]} may include this: {line.strip()}"


def deciding(root):
    for name in files(root, {".cpp", ".hpp"}):
        if not name.startswith(DECIDING) or name.startswith(SHELLS):
            continue
        for number, line in lines(root, name):
            if IMPURE.search(line):
                yield f"{name}:{number}: a deciding file knows no I/O, thread or clock: {line.strip()}"


def headers(root):
    for name in files(root, {".hpp"}):
        if name.startswith("tests/"):
            continue
        text = (root / name).read_text(encoding="utf-8")
        opening = text.split("#pragma once")[0].removeprefix(f"// {LICENCE}\n")
        if "#pragma once" not in text or not all(line.startswith("//") for line in opening.splitlines()):
            yield f"{name}:1: a header opens with its three sentences, then #pragma once"
        elif len(re.findall(r"[.:](?:\s|$)", opening)) < 3 or "ever" not in opening or "romise" not in opening:
            yield f"{name}:1: a header opens with what it is, what it promises and what it never does"
        if "#include <nlohmann/json.hpp>" in text:
            yield f"{name}:1: a header takes <nlohmann/json_fwd.hpp>"


def lengths(root):
    for name in files(root, CODE):
        count = sum(LICENCE not in line for _, line in lines(root, name))
        if count > LONGEST_FILE:
            yield f"{name}:{count}: {count} lines, more than {LONGEST_FILE}: is it one thing?"


def words(root):
    top = [p.relative_to(root).as_posix() for p in root.iterdir() if p.is_file() and p.name != ".git" and p.suffix in {".md", ".txt", ".json", ""}]
    for name in list(files(root, CODE | {".md", ".json", ".service", ".rules", ".txt", ""})) + sorted(top):
        try:
            for number, line in lines(root, name):
                if FORBIDDEN_WORDS.search(line):
                    yield f"{name}:{number}: {line.strip()[:120]}"
        except UnicodeDecodeError:
            continue  # a binary file of a fuzz corpus


# The field's words (ARCHITECTURE.md, "Words"), and the private ones that once stood in their place. What stands in quotes in C++,
# or in backquotes on a page, is not looked at: it may be another's text, or the name that something had before.
C_TOKEN = re.compile(r"""(?P<note>//[^\n]*|/\*.*?\*/)|(?P<text>R"([^()\s\\]*)\(.*?\)\3"|"(?:\\.|[^"\\\n])*"|\d[\w'.]*|'(?:\\.|[^'\\\n])+')"""
                     r"|(?P<name>[A-Za-z_]\w*)", re.S)
PRIVATE_PROSE = {
    "resynchronisation read": r"\bfences?\b", "server or session": r"\bfaces?\b", "command sequence": r"\bconversations?\b",
    "duplicate node-ID": r"\btwins?\b", "invalidated": r"\bdoubt(?:ed|ful)\b", "cached": r"\b(?:counts?|counted|taken) as held\b",
    "unsolicited event": r"\b(?:an?|the|one|few|no|of) notices?\b",
}
PRIVATE_NAMES = {
    "resync": r"\b(?:\w+_)?fences?_?\b|\b(?:fence)_\w+|\w*Fences?(?![a-z])\w*", "session": r"\bface_?\b|\w*Face(?![a-z])\w*",
    "command_sequence": r"\w*[cC]onversation\w*", "duplicate": r"\b(?:\w+_)?twins?_?\b|\btwin_\w+|\w*Twin(?![a-z])\w*",
    "invalidate": r"\bdoubt\w*", "emulated": r"\bbind_made\b|\bkMade", "unsolicited": r"\b(?:on_|take_)?notices?_?\b|\bNotice(?:Kind)?\b",
}
# Words that mean something else elsewhere, with the folders where they were private.
PRIVATE_HERE = {
    ("gateway/", "adapters/"): {"unresponsive": r"\bmute_?\b"},
    ("gateway/drive/", "gateway/image/", "gateway/upstream/", "adapters/bus/"): {
        "write batch": r"\bGroup(?:Result|Callback)?\b|\bgroups?_?\b"},
    ("adapters/bus/", "gateway/drive/", "tests/unit/bus/"): {
        "bus job": r"\b[aA]n order\b|\bOrder(?:Id)?\b|\borders (?:per|of a)\b|\bon_order_\w+"},
}
# What headers say of their subject in a word that says nothing: in comments, and in the names of things and of files.
VAGUE_NOTES = {"again, from scratch": r"\banew\b", "unsolicited": r"\bunasked\b", "manual, or the client's origin": r"\bhand\b"}
VAGUE_NAMES = {
    "again": r"(?:\b|\w_)anew(?:\b|_\w*)|\w*Anew\w*", "unsolicited": r"(?:\b|\w+_)unasked(?:\b|_\w*)|\w*Unasked\w*",
    "manual": r"\bhand\b|\w*Hand(?=[A-Z])\w*|\b(?:command|add|by)_hand\w*|\bhand_(?!over\b)\w+",
    "release": r"\b(?:let|letting)_go\w*|\bLetGo\b", "publisher": r"\bshown_axis\b|\bShownAxis\b",
    "same_origin_and_role": r"\b(?:same|own)_hand\b", "on_unreachable": r"\blose_sight\b", "what is lost": r"\bforgotten_\b",
    "how the jog ended": r"\bjog_left_\b", "what is not new": r"\bholds_in_vain\b", "what is repeated": r"\bbrings_back\b",
    "what a write does": r"\bis_write\b", "the report that is taken": r"\btake_news\b",
}
# It means answering, reporting, sending, showing and telling apart; in the log alone it means one thing.
TOLD = {"answered, reported, sent, shown or logged": r"\b(?:\w+_)?[tT]old(?:_\w*)?\b|\w*[a-z]Told\w*"}
# A group of processes.
PRIVATE_ELSEWHERE = ("gateway/upstream/host/child_process.cpp",)


def private(text, rules_of):
    for instead, pattern in rules_of.items():
        found = re.search(pattern, text)
        if found:
            return f'"{found[0]}" is a private word: {instead}'
    return None


def field_words(root):
    pages = [path.relative_to(root).as_posix() for path in (*root.glob("*.md"), *root.glob("docs/**/*.md"))]
    for name in sorted(pages):
        for number, line in lines(root, name):
            if breach := private(re.sub(r"`[^`]*`", "", line.lower()), PRIVATE_PROSE):
                yield f"{name}:{number}: {breach}"
    for name in files(root, {".cpp", ".hpp"}):
        of_folder = [those.items() for folders, those in PRIVATE_HERE.items() if name.startswith(folders) and name not in PRIVATE_ELSEWHERE]
        here = dict(item for items in of_folder for item in items)
        text = (root / name).read_text(encoding="utf-8")
        for token in C_TOKEN.finditer(text):
            if token.lastgroup == "text" or token["text"] or not (token["note"] or token["name"]):
                continue
            known = PRIVATE_PROSE if token["note"] else PRIVATE_NAMES
            if breach := private(token[0].lower() if token["note"] else token[0], known) or private(token[0], here):
                yield f"{name}:{text.count(chr(10), 0, token.start()) + 1}: {breach}"
        if name.endswith(".hpp") and name.startswith(("gateway/", "adapters/")):
            yield from vague(name, text)


def vague(name, text):
    """Of a header: its own name, its comments and its identifiers."""
    told = {} if "log" in name.rsplit("/", 1)[1] else TOLD
    if breach := private(name.replace("/", " ").replace(".", " "), VAGUE_NAMES | told):
        yield f"{name}:1: {breach}"
    for token in C_TOKEN.finditer(text):
        if token.lastgroup == "text" or token["text"]:
            continue
        known = (VAGUE_NOTES if token["note"] else VAGUE_NAMES) | told
        said = re.sub(r"`[^`]*`", "", token[0].lower()) if token["note"] else token[0]
        if (token["note"] or token["name"]) and (breach := private(said, known)):
            yield f"{name}:{text.count(chr(10), 0, token.start()) + 1}: {breach}"


# What comments cite: a section that ARCHITECTURE.md lists, with a heading of it, a point of "How it is built", a promise.
SECTION = r"""(\d(?:\.\d)?)(?![\d/]|\.\d)(?:(?:\s|,?\s")([A-Z][^,;:.)"]*)"?)?"""
CITE = re.compile(rf"[Dd]esign {SECTION}(?:(?:,|,?\sand)\s(?:(?=\d\.)|(?<=and\s)){SECTION})*")
SECTION = re.compile(SECTION)
# Where sections are cited by their numbers alone.
BARE_CITES = ("tests/model/", "tests/obey/", "tests/judged/")
BARE = re.compile(r"(?<![\d.])(3\.\d)\s([A-Z][^,;:.)\"]*)")
POINTS = re.compile(r"[Dd]esign 7, points? (\d+)(?: and (\d+))?")
# Numbers of rules that no page of the repository has. Bytes in hex look alike: others stand beside them.
LOST = re.compile(r"Design-\d|design-\d|(?<![0-9A-F] )\b(?:[AB](?:[1-9]|1\d)|D[1-9]\d{0,2})\b(?! [0-9A-F]{2}\b)")
PROMISE = re.compile(r"\bP\d\b")


def cited(root):
    """Of ARCHITECTURE.md: the sections that may be cited with their headings, its points, its promises."""
    sections, points, promises, heading = {}, set(), set(), ""
    for _, line in lines(root, "ARCHITECTURE.md"):
        if line.startswith("## "):
            heading = line[3:]
        elif heading == "What comments cite" and (found := re.match(r"\| (\d(?:\.\d)?) \|[^|]*\|([^|]*)\|", line)):
            sections[found[1]] = list(filter(None, found[2].strip().split("; ")))
        elif heading == "How it is built" and (found := re.match(r"(\d+)\. ", line)):
            points.add(found[1])
        elif found := re.match(r"\| (P\d) ", line):
            promises.add(found[1])
    return sections, points, promises


def cites(root):
    """What is cited is there."""
    sections, points, promises = cited(root)
    pages = [path.relative_to(root).as_posix() for path in (*root.glob("*.md"), *root.glob("docs/**/*.md"))]
    for name in [*files(root, {".cpp", ".hpp", ".py", ".txt"}), *sorted(pages)]:
        if name.startswith("tests/architecture/"):
            continue
        # The marks of a comment's further lines are no part of what it says.
        text = re.sub(r"\n[ \t]*(?://[/<]*|#) ", lambda found: "\n" + " " * (len(found[0]) - 1), (root / name).read_text(encoding="utf-8"))
        text = re.sub(r"\n +", lambda found: " " * (len(found[0]) - 1) + "\n", text)
        lost = []
        for cite in CITE.finditer(text):
            lost += [(cite.start(), found) for found in SECTION.findall(cite[0])]
        if name.startswith(BARE_CITES):
            lost += [(found.start(), found.groups()) for found in BARE.finditer(text)]
        for at, (section, words) in lost:
            said = " ".join(words.split()).lower()
            if section not in sections or (said and not said.startswith(tuple(h.lower() for h in sections[section]))):
                yield f"{name}:{text.count(chr(10), 0, at) + 1}: ARCHITECTURE.md has no {section} {said}".rstrip()
        for found in POINTS.finditer(text):
            if not points.issuperset(filter(None, found.groups())):
                yield f"{name}:{text.count(chr(10), 0, found.start()) + 1}: ARCHITECTURE.md has no such point: {found[0]}"
        if not name.endswith((".cpp", ".hpp")):
            continue
        code = (root / name).read_text(encoding="utf-8")
        for token in C_TOKEN.finditer(code):
            said = token["note"] or (token[0] if name.startswith("tests/bench/") and token.lastgroup == "text" else "")
            lost = LOST.findall(token["note"] or "") + [p for p in PROMISE.findall(said) if p not in promises]
            if lost:
                yield f"{name}:{code.count(chr(10), 0, token.start()) + 1}: no page of the repository has {lost[0]}"


LICENCE = "SPDX-License-Identifier: Apache-2.0"


# How a comment opens and closes; by the end of a file's name. What is not named here opens with #.
COMMENTS = {("// ", ""): (".cpp", ".hpp", ".c", ".h", ".cpp.in", ".hpp.in", ".mjs", ".idl"), ("(* ", " *)"): (".st",),
            ("<!-- ", " -->"): (".urdf", ".xacro")}
HASHED = (".py", ".cmake", ".sh", ".service", ".rules", ".yaml", ".yml", "CMakeLists.txt", "Containerfile", "Dockerfile", ".clang-format",
          ".clang-tidy", ".clangd", ".editorconfig")


def licence(root):
    """Every source file says its licence in its first line, or in the one behind #! or <?xml."""
    tops = (root / name for name in ("CMakeLists.txt", ".clang-format", ".clang-tidy", ".clangd", ".editorconfig"))
    below = (path for folder in (*SOURCE_FOLDERS, ".ci", ".devcontainer", ".githooks", ".github") for path in sorted((root / folder).rglob("*")))
    for path in (*tops, *below):
        name = path.relative_to(root).as_posix()
        if not path.is_file() or "__pycache__" in path.parts:
            continue
        begin = path.read_bytes()[:300].decode(errors="replace").splitlines()
        behind = bool(begin) and begin[0].startswith(("#!", "<?xml"))
        marks = next((marks for marks, ends in COMMENTS.items() if name.endswith(ends)), None)
        if marks is None and not (name.endswith(HASHED) or (behind and begin[0].startswith("#!"))):
            continue
        opens, closes = marks or ("# ", "")
        wanted = f"{opens}{LICENCE}{closes}"
        if begin[behind:][:1] != [wanted]:
            yield f"{name}:{1 + behind}: the line before all others, behind #! or <?xml, is: {wanted}"


RULES = {"arrows": arrows, "namespaces": namespaces, "one_place": one_place, "deciding": deciding, "headers": headers, "lengths": lengths, "words": words,
         "field_words": field_words, "cites": cites, "licence": licence, "class_sizes": class_sizes,
         "fault_proofs": fault_proofs, "rule_proofs": rule_proofs}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in RULES:
        sys.exit(f"usage: rules.py {'|'.join(RULES)}")
    breaches = list(RULES[sys.argv[1]](Path.cwd()))
    print("\n".join(breaches) if breaches else f"{sys.argv[1]}: kept")
    sys.exit(1 if breaches else 0)
