# SPDX-License-Identifier: Apache-2.0
"""Starts the services of deploy/compose.yaml with podman, each as the file says, and with nothing that it does not say.

podman-compose does not do: Debian's ignores the options of volumes. What this file does not know of a compose file it refuses, so
nothing in deploy/compose.yaml is left untried.
"""
import json
import os
import re
import subprocess

import yaml

from processes import NEVER, Program, until

# What podman needs on machines where root may not raise limits; no container uses more.
LIMITS = ["--ulimit", "nofile=1024:1024", "--ulimit", "nproc=4096:4096", "--cgroup-parent", "/axisgate-containers"]


def expanded(text):
    """${NAME:-default}, as compose files have it."""
    return re.sub(r"\$\{(\w+):-([^}]*)\}", lambda found: os.environ.get(found[1]) or found[2], text)


class Engine:
    """podman, with the options that it is called with everywhere."""

    def __init__(self, command):
        self.command = command

    def done(self, *words):
        return subprocess.run([*self.command, *words], capture_output=True, text=True, timeout=NEVER * 2, check=False,
                              stdin=subprocess.DEVNULL)

    def __call__(self, *words):
        done = self.done(*words)
        assert done.returncode == 0, f"podman {' '.join(words)}: {done.returncode}\n{done.stdout}{done.stderr}"
        return done.stdout.strip()

    def json(self, *words):
        return json.loads(self(*words))


class Follower(Program):
    """What a container says from now on."""

    def __init__(self, engine, container):
        super().__init__(f"logs of {container}", [*engine.command, "logs", "--follow", "--tail", "1", container])

    def sees(self, what, look, since=0, seconds=NEVER):
        """The first JSON line from `since` on for which `look` is true."""
        at = since

        def next_one():
            nonlocal at
            lines = self.lines
            while at < len(lines):
                line = lines[at]
                at += 1
                if line.startswith("{") and look(told := json.loads(line)):
                    return told
            return None

        return until(f"{self.name}: {what}", next_one, seconds)

    def now(self):
        return len(self.lines)


class Container:
    """One service. Restarts are the test's own, so that it knows of them."""

    def __init__(self, engine, name):
        self.engine = engine
        self.name = name

    def create(self, options, image, command):
        self.engine("create", "--pull=never", "--name", self.name, *LIMITS, *options, image, *command)

    def start(self):
        self.engine("start", self.name)

    def kill(self):
        """As a crash: none of its processes is left. It may have ended by itself."""
        self.engine.done("kill", "--signal", "KILL", self.name)
        self.engine("wait", self.name)

    def stop(self):
        """As its service says; the exit code."""
        self.engine("stop", self.name)
        return int(self.engine("wait", self.name))

    def running(self):
        return self.engine("inspect", "--format", "{{.State.Running}}", self.name) == "true"

    def pid(self):
        return int(self.engine("inspect", "--format", "{{.State.Pid}}", self.name))

    def healthy(self):
        return self.engine.done("healthcheck", "run", self.name).returncode == 0

    def text(self):
        done = self.engine.done("logs", "--tail", "200", self.name)
        return done.stdout + done.stderr

    def says(self, pattern):
        return until(f"{self.name} says '{pattern}'", lambda: re.search(pattern, self.text()))

    def follow(self):
        return Follower(self.engine, self.name)

    def remove(self):
        self.engine.done("rm", "--force", "--time", "0", self.name)


def seconds(text):
    found = re.fullmatch(r"(\d+)s", text)
    assert found, f"'{text}': this reader knows seconds alone"
    return found[1]


class Set:
    """The containers of a compose file, by the names of their services."""

    def __init__(self, engine, path, project):
        self.engine = engine
        self.folder = os.path.dirname(path)
        self.project = project
        with open(path, encoding="utf-8") as file:
            self.file = yaml.safe_load(expanded(file.read()))
        unknown = {key for key in self.file if not key.startswith("x-")} - {"services", "networks", "volumes"}
        assert not unknown, f"{path}: this reader does not know {unknown}"
        self.containers = {}

    def up(self, *services):
        for name, network in self.file["networks"].items():
            subnet, = (entry["subnet"] for entry in network["ipam"]["config"])
            self.engine("network", "create", "--subnet", subnet, self.full(name))
        for name, volume in self.file["volumes"].items():
            options = [word for key, value in ((volume or {}).get("driver_opts") or {}).items() for word in ("--opt", f"{key}={value}")]
            self.engine("volume", "create", *options, self.full(name))
        for name in services or self.file["services"]:
            self.create(name)
            self.containers[name].start()
        return self

    def create(self, name):
        """Its dependencies must be there, as `depends_on` says."""
        service = dict(self.file["services"][name])
        needed = service.pop("depends_on", [])
        for other in needed:
            assert other in self.containers, f"{name} depends on {other}, which comes later in the file"
            if not isinstance(needed, list) and needed[other]["condition"] == "service_healthy":
                until(f"{other} is healthy", self.containers[other].healthy)
        image, command = service.pop("image"), [str(word) for word in service.pop("command", [])]
        service.pop("restart", None)
        options = [word for key, value in service.items() for word in getattr(self, f"option_{key}")(value, name)]
        container = self.containers[name] = Container(self.engine, self.full(name))
        container.create(options, image, command)
        return container

    def __getattr__(self, name):
        if name.startswith("option_"):
            raise AssertionError(f"this reader of compose files does not know the key {name[len('option_'):]}")
        return self.__dict__["containers"][name]

    def full(self, name):
        return f"{self.project}_{name}"

    def down(self):
        for container in reversed(self.containers.values()):
            container.remove()
        for name in self.file["volumes"]:
            self.engine.done("volume", "rm", "--force", self.full(name))
        for name in self.file["networks"]:
            self.engine.done("network", "rm", "--force", self.full(name))

    # One function for each key of a service: podman's words for it.

    def option_read_only(self, value, _):
        return ["--read-only", "--read-only-tmpfs=false"] if value else []

    def option_cap_drop(self, value, _):
        return [f"--cap-drop={each}" for each in value]

    def option_security_opt(self, value, _):
        return [f"--security-opt={each.replace(':', '=')}" for each in value]

    def option_network_mode(self, value, _):
        return ["--network", f"container:{self.full(value[8:])}" if value.startswith("service:") else value]

    def option_networks(self, value, name):
        network, = value
        return ["--network", self.full(network), "--network-alias", name]

    def option_ports(self, value, _):
        return [word for each in value for word in ("--publish", each)]

    def option_ipc(self, value, _):
        return ["--ipc", f"container:{self.full(value[8:])}" if value.startswith("service:") else value]

    def option_shm_size(self, value, _):
        return ["--shm-size", value]

    def option_stop_grace_period(self, value, _):
        return ["--stop-timeout", seconds(value)]

    def option_entrypoint(self, value, _):
        return ["--entrypoint", json.dumps(value)]

    def option_healthcheck(self, value, _):
        assert value == {"disable": True}
        return ["--no-healthcheck"]

    def option_volumes(self, value, _):
        options = []
        for each in value:
            source, target, *how = each.split(":")
            if source in self.file["volumes"]:
                source = self.full(source)
                how.append("dev")  # as deploy/compose.yaml says of podman
            elif not os.path.isabs(source):
                source = os.path.join(self.folder, source)
            options += ["--volume", ":".join([source, target, *[",".join(how)][:bool(how)]])]
        return options
