#!/usr/bin/env python3
"""The rules of ARCHITECTURE.md that no compiler checks. `rules.py RULE` prints each breach as FILE:LINE: text and exits 1."""
import re
import sys
from pathlib import Path

# Whose headers a folder may include, beside its own: upstream -> image <- drive -> bus <- each adapter; all -> core; app wires all.
ARROWS = {
    "gateway/core": set(),
    "gateway/image": {"gateway/core"},
    # Reads the command lines of all programs, whatever they are for.
    "gateway/manual": set(),
    "gateway/drive": {"gateway/image", "adapters/bus", "gateway/core"},
    # The DDS face in two processes: what they say to each other, the gateway's half, the half with the DDS library, and whoever
    # starts that one and carries packets between the two.
    "gateway/upstream/dds_link": {"gateway/core"},
    "gateway/upstream/dds": {"gateway/upstream/dds_link", "gateway/image", "gateway/core"},
    "gateway/upstream/dds_process": {"gateway/upstream/dds_link", "gateway/manual", "gateway/core"},
    "gateway/upstream/dds_host": {"gateway/upstream/dds", "gateway/upstream/dds_link", "gateway/image", "gateway/core"},
    "gateway/upstream/*": {"gateway/image", "gateway/core"},
    "adapters/bus": {"gateway/core"},
    "adapters/asio": {"gateway/core"},
    # A second link over the same serial ports: it shares how they are opened, locked and found again.
    "adapters/modbus_rtu": {"adapters/serial", "adapters/bus", "gateway/core"},
    # A Lawicel adapter is a serial port: the CAN links share how those are opened and found again.
    "adapters/can": {"adapters/serial", "adapters/bus", "gateway/core"},
    "adapters/canopen": {"adapters/can", "adapters/bus", "gateway/core"},
    "adapters/keya": {"adapters/can", "adapters/bus", "gateway/core"},
    "adapters/*": {"adapters/bus", "gateway/core"},
    # The simulated drives come from the makers' sheets: what they share with the gateway could be wrong on both sides.
    "tests/simulated": set(),
}
EVERYTHING = ("gateway/app", "gateway/main.cpp", "tests")

# Headers that only one place may know.
ONE_PLACE = {
    r"<modbus(/modbus)?\.h>": ("adapters/modbus_rtu/",),
    r"<linux/can": ("adapters/can/", "tests/axisgate_sim/", "tests/unit/can/", "tests/vcan/", "tests/bench/"),
    r"<fastdds|<fastrtps|PubSubTypes": ("gateway/upstream/dds_process/", "deploy/examples/", "tests/dds_peers/"),
    r"<termios\.h>|<sys/inotify\.h>|<linux/serial\.h>": ("adapters/serial/", "adapters/asio/key_mode"),
    r"<valijson/": ("gateway/drive/json_schema.cpp",),
    r"<CLI/": ("gateway/app/command_", "gateway/upstream/dds_process/options.cpp", "gateway/manual/command_tree.cpp"),
}

# Files that decide: bytes, frames and instants go in, actions come out. The exceptions are shells.
DECIDING = ("gateway/core/", "gateway/image/", "gateway/drive/", "gateway/upstream/modbus_tcp/", "gateway/upstream/dds/", "gateway/upstream/dds_link/", "gateway/upstream/dds_host/restart_", "adapters/bus/", "adapters/kinco/", "adapters/modbus_rtu/rtu_", "adapters/canopen/", "adapters/keya/",
            "adapters/can/can_", "adapters/can/lawicel", "gateway/app/config_", "gateway/app/bus_budget", "gateway/app/check.", "gateway/app/hand_keys", "gateway/app/hand_plan", "gateway/app/hand_view",
            "gateway/app/scan_plan")
SHELLS = tuple(f"gateway/upstream/modbus_tcp/{shell}" for shell in ("server", "listener", "connection"))
IMPURE = re.compile(r'#include <(boost/asio|boost/beast|sys/socket|sys/epoll|poll\.h|thread|mutex|condition_variable|atomic|random)'
                    r'|(steady|system|high_resolution)_clock::now|std::chrono::\w*clock::now|\bsleep_for\b|\brand\(')

LONGEST_FILE = 400
SOURCE_FOLDERS = ("adapters", "gateway", "tests", "deploy", "schemas")
CODE = {".cpp", ".hpp", ".py", ".cmake"}
# Written in halves so that this file does not name what it forbids.
FORBIDDEN_WORDS = re.compile("|".join(["/wo" "rk/", "/fa" "rm/", r"\.\./sha" "red", "before" "-stop", "GTEST_" "SKIP", "DIS" "ABLED_",
                                       "TO" "DO", "FIX" "ME", r"EXPECT_TRUE\(tr" r"ue\)"]))
INCLUDE = re.compile(r'^\s*#include "([^"]+)"')


def files(root, suffixes):
    """All files of the repository with these suffixes, as paths relative to its root."""
    for folder in SOURCE_FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.is_file() and path.suffix in suffixes and "__pycache__" not in path.parts:
                yield path.relative_to(root).as_posix()


def lines(root, name):
    return enumerate((root / name).read_text(encoding="utf-8").splitlines(), 1)


def rule_of(name):
    """The folder that `name` belongs to and what it may include; None where it may include everything."""
    for pattern, allowed in ARROWS.items():
        depth = pattern.count("/") + 1
        folder = "/".join(name.split("/")[:depth])
        if name.count("/") >= depth and (folder == pattern or (pattern.endswith("*") and folder.startswith(pattern[:-1]))):
            return folder, allowed
    if not name.startswith(EVERYTHING):
        return None, set()
    return None, None


def arrows(root):
    for name in files(root, {".cpp", ".hpp"}):
        folder, allowed = rule_of(name)
        if allowed is None:
            continue
        for number, line in lines(root, name):
            include = INCLUDE.match(line)
            if include and folder is None:
                yield f"{name}:{number}: this folder has no rule in ARROWS: say what it may include"
            elif include and not include[1].startswith(tuple(f"{a}/" for a in {folder} | allowed)):
                yield f"{name}:{number}: {folder} may not include {include[1]}"


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
        opening = text.split("#pragma once")[0]
        if "#pragma once" not in text or not all(line.startswith("//") for line in opening.splitlines()):
            yield f"{name}:1: a header opens with its three sentences, then #pragma once"
        elif len(re.findall(r"[.:](?:\s|$)", opening)) < 3 or "ever" not in opening or "romise" not in opening:
            yield f"{name}:1: a header opens with what it is, what it promises and what it never does"
        if "#include <nlohmann/json.hpp>" in text:
            yield f"{name}:1: a header takes <nlohmann/json_fwd.hpp>"


def lengths(root):
    for name in files(root, CODE):
        count = sum(1 for _ in lines(root, name))
        if count > LONGEST_FILE:
            yield f"{name}:{count}: {count} lines, more than {LONGEST_FILE}: is it one thing?"


def words(root):
    top = [p.relative_to(root).as_posix() for p in root.iterdir() if p.is_file() and p.suffix in {".md", ".txt", ".json", ""}]
    for name in list(files(root, CODE | {".md", ".json", ".service", ".rules", ".txt", ""})) + sorted(top):
        try:
            for number, line in lines(root, name):
                if FORBIDDEN_WORDS.search(line):
                    yield f"{name}:{number}: {line.strip()[:120]}"
        except UnicodeDecodeError:
            continue  # a binary file of a fuzz corpus


RULES = {"arrows": arrows, "one_place": one_place, "deciding": deciding, "headers": headers, "lengths": lengths, "words": words}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in RULES:
        sys.exit(f"usage: rules.py {'|'.join(RULES)}")
    breaches = list(RULES[sys.argv[1]](Path.cwd()))
    print("\n".join(breaches) if breaches else f"{sys.argv[1]}: kept")
    sys.exit(1 if breaches else 0)
