#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Each command of each page is run by a test as it stands there, or held against what it calls: the program or script is there, knows
these options, and finds what is named. A command that neither is true of fails.

commands_test.py [unittest's arguments]; AXISGATE_SHOW=1 prints for each command what is done with it.
"""
import json
import os
import re
import subprocess
import sys
import unittest

from page_commands import SOURCE, commands, of_page, pages, single

# What is no more.
OF_THE_PAST = ("CHANGELOG.md",)


def read(path):
    return (SOURCE / path).read_text(encoding="utf-8")


def name_of(path):
    return str(path.relative_to(SOURCE))


def options_of(words):
    return [word.partition("=")[0] for word in words if re.match("--?[A-Za-z]", word)]


def unknown_to(text, words):
    """Options that the text, mostly a program's help, does not have."""
    return [option for option in options_of(words) if not re.search(rf"(?<![\w-]){re.escape(option)}(?![\w-])", text)]


def help_of(*command):
    return subprocess.run([*command, "--help"], capture_output=True, text=True, check=False, env={**os.environ, "LC_ALL": "C"}).stdout


# What holds a command that no test runs. Each returns what is wrong, or nothing.


def script(words):
    path = SOURCE / words[0]
    if not path.is_file() or not os.access(path, os.X_OK):
        return f"{words[0]} is no program of these sources"
    wrong = unknown_to(path.read_text(encoding="utf-8"), words[1:])
    return f"{words[0]} knows no {wrong}" if wrong else ""


def ours(words):
    """tests/docs/command_lines_test.cpp parses each line of axisgate."""
    return "" if words[1:] else "without a command"


def ours_of_dds(words):
    command, *options = words[1:]
    wrong = unknown_to(read("gateway/upstream/dds_process/options.cpp"), options)
    return f"axisgate-dds knows no {wrong}" if wrong or command not in ("topics", "serve") else ""


def packages_of_ours():
    return set(re.findall(r"CPACK_DEBIAN_\w+_PACKAGE_NAME \"?([\w-]+)", read("deploy/debian/cpack.cmake")))


def apt(words):
    known = " ".join(re.findall(r"^\w+=\(([^)$]*)\)", read("tests/setup"), re.MULTILINE)).split()
    names = [word.rpartition("/")[2].partition("_")[0] for word in words[2:] if not word.startswith("-")]
    wrong = [name for name in names if name not in known and name not in packages_of_ours()]
    if wrong or words[1] not in ("install", "remove", "purge"):
        return f"nobody makes, or has installed, {wrong}"
    # Which says of an option that it does not know it.
    done = subprocess.run(["apt-get", *options_of(words), "--version"], capture_output=True, text=True, check=False)
    return done.stderr if done.returncode else ""


# What pages have it do beside the commands that tests/containers types, with the options as podman 4.3.1 has them.
PODMAN = {"load": "", "tag": "", "rm": "", "generate": "--new --name --container-prefix --separator --restart-policy",
          "create": "--name --read-only --cap-drop --security-opt --device --group-add -v --network -p --stop-timeout --ulimit"}


def podman(words):
    made = set(re.findall(r"axisgate[\w-]*", read("deploy/container/build")))
    wrong = [word for word in words if word.startswith("localhost/") and re.split("[/:]", word)[1] not in made]
    wrong += unknown_to(PODMAN.get(words[1], ""), words[2:])
    return f"podman {words[1]} is not among {list(PODMAN)}, or knows no {wrong}" if wrong or words[1] not in PODMAN else ""


def lingering(words):
    return "" if words[1:] == ["enable-linger", "NAME"] else "nothing else is needed of it"


def folder(words):
    return "" if words[1:] == ["-p", "~/.config/systemd/user"] else "no folder that a page needs"


def systemctl(words):
    if words[1:] in (["--user", "daemon-reload"], ["--user", "enable", "--now", "gateway"], ["--user", "start", "gateway"], ["enable", "podman-restart"]):
        return ""  # docs/containers.md: units that podman writes or brings along
    unit = read("deploy/systemd/axisgate.service")
    verb, *rest = [word for word in words[1:] if not word.startswith("-")]
    needs = {"enable": "[Install]", "reload": "ExecReload=", "restart": "ExecStart=", "status": "[Service]", "kill": "[Service]"}
    if rest != ["axisgate"] or verb not in needs or needs[verb] not in unit:
        return f"the unit is called axisgate, and can do {list(needs)}"
    wrong = unknown_to(help_of("systemctl"), words)
    return f"systemctl knows no {wrong}" if wrong else ""


def tool(words):
    """Of Debian, with its own help; what it is given is the reader's."""
    wrong = unknown_to(help_of(words[0]), words[1:])
    return f"{words[0]} knows no {wrong}" if wrong else ""


def analyze(words):
    return "" if words[1:] == ["security"] and "systemd-analyze security" in read("tests/architecture/CMakeLists.txt") else "no test calls it so"


def manual(words):
    made = set(re.findall(r"share/man/man[1-8]/([\w.-]+)\.[1-8]\.gz", read("deploy/package.cmake"))) | packages_of_ours()
    return "" if words[1] in made else f"{words[1]} has no manual page"


def cmake(words):
    if "--preset" not in words:  # the examples of DDS: Docs.dds_examples configures them, and tests/dds_peers builds the same sources
        return "" if words in (["cmake", "-S", ".", "-B", "build"], ["cmake", "--build", "build"]) and "Docs.dds_examples" in read("tests/docs/CMakeLists.txt") else "no test"
    known = {preset["name"] for kind in ("configurePresets", "buildPresets", "testPresets") for preset in json.loads(read("CMakePresets.json"))[kind]}
    return "" if words[words.index("--preset") + 1] in known else f"no preset is called {words[-1]}"


def kubernetes(words):
    """deploy/kubernetes/render prints what is applied, a StatefulSet of one for each cell, whose pod is NAME-0."""
    if words[1] == "apply":
        return "" if words[2:] == ["-f", "axisgate.json"] else "what is rendered is axisgate.json"
    return "" if words[1] == "exec" and words[2].endswith("-0") and words[3] == "--" and '"StatefulSet"' in read("deploy/kubernetes/render") else "no such pod"


def compose(words):
    """tests/containers/images_test.py has docker-compose read it, and tests/containers/cell_test.py starts what it says."""
    return "" if words[1:3] == ["compose", "-f"] and (SOURCE / words[3]).is_file() and words[4:] == ["up"] else "no such set"


def discovery(words):
    """tests/integration/dds_networks_test.py starts the same server by the name that fastdds has for it."""
    wrong = unknown_to(re.search(r'"fast-discovery-server".*', read("tests/integration/dds_networks_test.py"))[0].replace('"', " "), words)
    return f"no test starts a server with {wrong}" if wrong or words[1] != "discovery" else ""


def ros2(words):
    """Debian 12 has no ROS 2. The topics are those that the page's table has, which tests/integration/dds_ros2_test.py reads and writes."""
    table = read("docs/dds/ros2.md")
    topics = [word for word in words if word.startswith("/")]
    wrong = [topic for topic in topics if f"`{topic.replace('/lift/', '/NAME/')}`" not in table]
    types = [word.replace("/msg/", "/") for word in words if "/msg/" in word]
    return f"no topic {wrong}" if wrong or any(f"| {made} |" not in table for made in types) or words[1] != "topic" else ""


def export(words):
    """What a reader's own program needs."""
    return "" if re.match(r"ROS_DISCOVERY_SERVER=[\d.]+:\d+$", words[1]) and words[1].partition("=")[2] in read("docs/dds/networks.md") else "who reads it?"


def signal(words):
    return "" if words[1:] in (["-9"], ["-STOP"]) else "no such signal"


def there(words):
    """What is copied is in a package (pages_test.py), and what is edited then is checked."""
    return "" if words[-1] == "/etc/axisgate/gateway.json" else f"{words[-1]}: nobody reads it"


HELD = {"axisgate": ours, "axisgate-dds": ours_of_dds, "apt": apt, "apt-get": apt, "systemctl": systemctl, "journalctl": tool, "stat": tool, "dpkg-deb": tool,
        "systemd-analyze": analyze, "man": manual, "cmake": cmake, "ctest": cmake, "kubectl": kubernetes, "docker": compose, "fastdds": discovery,
        "ros2": ros2, "export": export, "kill": signal, "editor": there,
        "podman": podman, "gunzip": tool, "loginctl": lingering, "mkdir": folder}


def typed_pages():
    """Those that tests/integration/manual_test.py goes through, typing what stands in ```sh."""
    return {os.path.normpath(f"docs/{page}") for page in re.findall(r'self\.read\("([^"]+)"', read("tests/integration/manual_test.py"))}


def taken_from_pages():
    """(page, begin of the command, test) of each that a test takes from its page and runs."""
    return [(page, begins, name_of(path)) for path in sorted(SOURCE.glob("tests/**/*_test.py")) if path != SOURCE / "tests/docs/commands_test.py"
            for page, begins in re.findall(r'of_page\("([^"]+)",\s*"([^"]+)"\)', path.read_text(encoding="utf-8"))]


class Commands:
    def __init__(self):
        self.typed, self.taken = typed_pages(), taken_from_pages()

    def done_with(self, page, is_typed, command):
        """How it is run or held, or what is wrong with it: one of the two."""
        if is_typed and page in self.typed:
            return "typed by tests/integration/manual_test.py", ""
        for of, begins, test in self.taken:
            if page == of and command.startswith(begins):
                return f"tried by {test}", ""
        wrong = []
        for words in single(command):
            hold = script if re.match("(deploy|tests)/", words[0]) else HELD.get(words[0])
            wrong.append(hold(words) if hold else f"no test runs {words[0]}, and nothing here knows it")
        return "held against what it calls", "; ".join(filter(None, wrong))


class PagesCommands(unittest.TestCase):
    def test_each_is_run_or_held_against_what_it_calls(self):
        known, found = Commands(), []
        for path in pages():
            page = name_of(path)
            if page in OF_THE_PAST:
                continue
            for typed, command in commands(path.read_text(encoding="utf-8")):
                how, wrong = known.done_with(page, typed, command)
                found.append(page)
                self.assertFalse(wrong, f"{page}: {command}")
                if os.environ.get("AXISGATE_SHOW"):
                    print(f"{page}: {' '.join(command.split())}: {how}", file=sys.stderr)
        self.assertGreater(len(found), 150)

    def test_what_is_run_by_itself_is_a_script_that_knows_its_options(self):
        """By continuous integration, and where a development container is made."""
        run = [line for path in sorted(SOURCE.glob(".github/workflows/*.yml")) for line in re.findall(r"^ +- run: (.*)$", path.read_text(encoding="utf-8"), re.M)]
        run += [command for key, command in json.loads(read(".devcontainer/devcontainer.json")).items() if key.endswith("Command")]
        ours_of_them = [words for command in run for words in single(command) if re.match(r"(tests|\.ci)/", words[0])]
        self.assertEqual([wrong for words in ours_of_them if (wrong := script(words))], [])
        self.assertIn([".ci/run"], ours_of_them)
        self.assertGreater(len(ours_of_them), 4)

    def test_what_a_test_takes_from_a_page_is_there(self):
        for page, begins, _ in taken_from_pages():
            of_page(page, begins)

    def test_a_wrong_command_is_found(self):
        known = Commands()
        for command in ("deploy/nothing", "deploy/package --wrong", "apt install ./axisgate-mqtt_*.deb", "apt install --wrong ./axisgate_*.deb", "apt upgrade axisgate",
                        "systemctl enable gateway", "systemctl mask axisgate", "systemctl enable --wrong axisgate", "journalctl --wrong axisgate", "man axisgate-mqtt",
                        "cmake --preset wrong", "kubectl apply -f other.json", "kubectl exec CELL-1 -- x", "docker compose -f deploy/nothing.yaml up", "fastdds discovery -z 0",
                        "fastdds shm", "ros2 topic echo /nothing", "ros2 topic pub /lift/enable std_msgs/msg/Int8 x", "export WRONG=1", "kill -1", "podman run x",
                        "podman load --wrong x", "podman tag localhost/axisgate-mqtt:1 x", "loginctl disable-linger NAME", "systemctl --user enable other", "mkdir x",
                        "axisgate check x && deploy/nothing", "axisgate-dds topics --wrong", "axisgate-dds nothing", "axisgate-sim --line ./a:jd@1", "cmake --build other", "editor /etc/other"):
            self.assertTrue(known.done_with("docs/installation.md", True, command)[1], command)

    def test_they_are_read_as_a_shell_reads_them(self):
        text = "`deploy/package --built x`, `stop_latched`\n\n    apt install a  # b\n    {\"a\": 1}\n\n```sh\na b \\\n  c && d > e | f 'g\nh'  # i\n```\n```text\nz z\n```\n"
        found = list(commands(text))
        self.assertEqual(found, [(False, "apt install a  # b"), (True, "a b   c && d > e | f 'g\nh'  # i"), (False, "deploy/package --built x")])
        self.assertEqual(single(found[1][1]), [["a", "b", "c"], ["d"], ["f", "g\nh"]])
        self.assertEqual(single("gcc x $(pkg-config --libs y) && A=b c"), [["gcc", "x", "INNER"], ["c"], ["pkg-config", "--libs", "y"]])


if __name__ == "__main__":
    unittest.main()
