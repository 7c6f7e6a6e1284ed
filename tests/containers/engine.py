# SPDX-License-Identifier: Apache-2.0
"""Podman and its containers, as the tests use them."""
import json
import os
import re
import shlex
import subprocess

import yaml

from processes import NEVER, Program, until

# What podman needs on machines where root may not raise limits; no container uses more.
LIMITS = ["--ulimit", "nofile=1024:1024", "--ulimit", "nproc=4096:4096", "--cgroup-parent", "/axisgate-containers"]


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
    """One container."""

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


class Cell:
    """The containers of deploy/compose.yaml, as deploy/container/cell starts them; each by the name of its service."""

    def __init__(self, engine, source, config):
        self.script = f"{source}/deploy/container/cell"
        # Restarts are the test's own, so that it knows of them.
        self.environment = {**os.environ, "AXISGATE_ENGINE": shlex.join(engine.command), "AXISGATE_CONFIG": config,
                            "AXISGATE_RUN_OPTIONS": shlex.join([*LIMITS, "--restart=no"])}
        with open(f"{source}/deploy/compose.yaml", encoding="utf-8") as file:
            self.containers = {name: Container(engine, f"cell_{name}") for name in yaml.safe_load(file)["services"]}

    def __getattr__(self, name):
        return self.__dict__["containers"][name]

    def typed(self, *words):
        """Its exit code, and all that it says."""
        done = subprocess.run([self.script, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=self.environment,
                              timeout=NEVER * 8, check=False)
        return done.returncode, done.stdout

    def up(self):
        code, text = self.typed("up")
        assert code == 0, text

    def down(self):
        self.typed("down")
