# SPDX-License-Identifier: Apache-2.0
"""What the stories of the DDS server need: a machine with a serial and a CANopen drive, a DDS domain of its own, and peers of two
vendors (tests/dds_peers) that read the topics and command axes.
"""
import itertools
import json
import math
import os
import socket
import subprocess
import threading
import time
import zlib

from lease_stage import Machine
from processes import NEVER, Program, until
from stage import SIMULATOR, main  # noqa: F401 main: for the stories

PEERS = os.path.join(os.path.dirname(os.path.dirname(SIMULATOR)), "dds_peers")
VENDORS = ("fast", "cyclone")
FAST, CYCLONE = VENDORS

# schemas/axisgate.idl
MASK = ["mode", "target_position", "target_velocity", "target_torque", "max_torque", "profile_velocity", "profile_acceleration",
        "profile_deceleration", "jog_velocity", "homing_method", "set_position_value"]
COMMAND = {"none": 0, "enable": 1, "disable": 2, "quick_stop": 3, "halt": 4, "fault_reset": 5, "move_absolute": 6, "move_relative": 7,
           "run_velocity": 8, "run_torque": 9, "home": 10, "set_position": 11, "save_parameters": 12, "release": 13, "take_over": 14,
           "jog_forward": 31, "jog_reverse": 32, "jog_end": 33}
(DONE, REFUSED_BY_DRIVE, OUTCOME_UNKNOWN, SUPERSEDED, NEVER_STARTED, NOT_OWNER, STOPPED_BY_ANOTHER, STATE_UNSUITABLE) = range(2, 10)
NOT_SUPPORTED, BAD_VALUE, ROLE, NOT_NOW, NO_AXIS, SEEN = range(16, 22)
FAULT, WARNING, LINK, LEASE, HOMED, BOOT, COMMAND_EVENT, WRAPPED = range(8)
TURN = 2 * math.pi
RPM = TURN / 60  # rad/s
ALARM_DDS_DOWN = 1 << 7


def reserve_domain():
    """A domain that no other test of this machine has, kept by a name in the kernel as long as the test runs. Above 100 the ports
    would be those of outgoing connections."""
    for domain in itertools.chain(range(1 + os.getpid() % 100, 101), range(1, 101)):
        claim = socket.socket(socket.AF_UNIX)
        try:
            claim.bind(f"\0axisgate-dds-domain-{domain}")
            return domain, claim
        except OSError:
            claim.close()
    raise AssertionError("all domains are taken")


# Axes that are not there. Each peer has its own.
NOWHERE = itertools.count(1000)


class Peer(Program):
    """One DDS participant. What it tells is kept in order; every wait is for something told."""

    def __init__(self, vendor, domain, wrapper=(), *arguments, gateway=""):
        self.vendor = vendor
        self.told = []
        self.news = threading.Condition()
        self.ids = itertools.count(1)
        self.guids = {}
        self.nowhere = next(NOWHERE)
        self.gateway = gateway
        super().__init__(f"{vendor}_peer", [*wrapper, os.path.join(PEERS, f"{vendor}_peer"), str(domain), *arguments],
                         stdin=subprocess.PIPE)
        self.wait("ready", "")

    def _read(self):
        for line in self.process.stdout:
            self.lines.append(line.rstrip("\n"))
            if line.startswith("{"):
                with self.news:
                    self.told.append(json.loads(line))
                    self.news.notify_all()

    def say(self, *words):
        self.process.stdin.write(" ".join(map(str, words)) + "\n")
        self.process.stdin.flush()

    def all(self, on, topic, look=lambda told: True, since=0):
        return [told for told in self.told[since:] if told["on"] == on and told["topic"] == topic and look(told)]

    def wait(self, on, topic, look=lambda told: True, since=0, seconds=NEVER):
        """The first one told since then that is looked for."""
        deadline = time.monotonic() + seconds
        with self.news:
            while True:
                for told in self.told[since:]:
                    if told["on"] == on and told["topic"] == topic and look(told):
                        return told
                since = max(since, len(self.told))
                left = deadline - time.monotonic()
                if left <= 0 or not self.news.wait(left):
                    raise AssertionError(f"{self.name} never told '{on}' of {topic}; it told last: {self.told[-3:]}")

    def now(self):
        """A place in what it has told: to wait for what comes after it."""
        return len(self.told)

    # Reading.

    def read(self, topic, *options):
        self.say("reader", topic, *options)
        self.wait("matched", topic, lambda told: told["count"] > 0)
        return self

    def samples(self, topic, since=0, **where):
        return [told["data"] for told in self.all("sample", topic, since=since) if fits(told["data"], where)]

    def sample(self, topic, look=lambda data: True, since=0, **where):
        """The first sample since then with these values."""
        return self.wait("sample", topic, lambda told: fits(told["data"], where) and look(told["data"]), since)["data"]

    # Commanding.

    def writer(self, topic, *options):
        since = self.now()
        self.say("writer", topic, *options)
        self.guids[topic] = self.wait("writer", topic, since=since)["guid"]
        self.wait("matched", topic, lambda told: told["count"] > 0, since)

    def command_with(self, *options):
        """A writer of commands and a reader of their replies. What is written before the other side knows both has no reply, so it
        asks for an axis that is not there until it is told so."""
        if not self.all("matched", "command_reply"):
            self.read("command_reply")
        self.writer("axis_command", *options)
        self.knock("axis_command", "command_reply")
        return self

    def ask_objects(self):
        self.read("object_reply")
        self.writer("object_request")
        self.knock("object_request", "object_reply")

    def knock(self, topic, answers):
        def answered():
            request = self.write(topic, axis=self.nowhere)
            try:
                self.wait("sample", answers, lambda told: told["data"]["request_id"] >= request
                          and told["data"]["writer"] == self.guids[topic], seconds=0.5)
                return True
            except AssertionError:
                return False

        until(f"{answers} comes", answered)

    def write(self, topic, request_id=None, verb="write", **members):
        """The sample's request id. `writedispose`, of Cyclone DDS alone: the last sample of its instance, together with its disposal."""
        number = next(self.ids) if request_id is None else request_id
        members = {"gateway": self.gateway, "gateway_key": zlib.crc32(self.gateway.encode()), **members}
        self.say(verb, topic, f"request_id={number}", *(f"{name}={value}" for name, value in members.items()))
        return number

    def ask(self, axis, command="none", request_id=None, **members):
        """A command; what is named beside it goes into the mask. Its request id."""
        mask = sum(1 << MASK.index(name) for name in members)
        return self.write("axis_command", request_id, axis=axis, command=COMMAND[command], mask=mask, **members)

    def answers(self, number, since=0, topic="command_reply"):
        """All replies to this request of the writer that there is now."""
        guid = self.guids[topic.replace("command_reply", "axis_command").replace("object_reply", "object_request")]
        return self.samples(topic, since, request_id=number, writer=guid)

    def answer(self, number, since=0, topic="command_reply"):
        """The reply: (result, detail)."""
        guid = self.guids[topic.replace("command_reply", "axis_command").replace("object_reply", "object_request")]
        reply = self.sample(topic, since=since, request_id=number, writer=guid)
        return reply["result"], reply["detail"]

    def do(self, axis, command="none", wanted=DONE, **members):
        """Asks and waits for this result."""
        result, detail = self.answer(self.ask(axis, command, **members))
        assert result == wanted, f"{self.name}: {command} {members} of axis {axis}: result {result}, detail {detail:#x}"
        return detail

    def object(self, axis, index, subindex=0, **members):
        """One request and its reply."""
        number = self.write("object_request", axis=axis, index=index, subindex=subindex, **members)
        return self.sample("object_reply", request_id=number, writer=self.guids["object_request"])

    def beat(self, counter, lease_ms=0, client=None, verb="write"):
        """One sample of heartbeat for its writer of commands."""
        self.say(verb, "heartbeat", f"client={client or self.guids['axis_command']}", f"counter={counter}", f"lease_ms={lease_ms}")

    def delete(self, topic="axis_command"):
        self.say("delete", topic)

    def leave(self):
        """In good order."""
        self.say("quit")
        assert self.ended() == 0, self.text()

    def clean_up(self):
        self.process.stdin.close()
        super().clean_up()


def fits(data, where):
    return all(data[name] == value for name, value in where.items())


class DdsStory(Machine):
    """Axis 1 is a Kinco JD on a serial line, axis 2 a Leadshine on CANopen. All of a story's peers are in its domain."""

    lines_of = ("serial", "leadshine")
    dds = {}
    # A machine that is busy with something else must not look like a client that is gone, nor a command like an old one.
    lease = {"timeout_ms": 60000}
    max_age_ms = 60000
    gateway_name = ""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.domain, claim = reserve_domain()
        cls.addClassCleanup(claim.close)

    def configure(self, *arguments, **options):
        super().configure(*arguments, **options)
        with open(self.config, encoding="utf-8") as file:
            config = json.load(file)
        keys = {"domain": self.domain, "commands": True, "start_deadline_ms": 60000, "reply_deadline_ms": 60000,
                "max_age_ms": self.max_age_ms, **self.dds}
        if not keys["commands"]:
            del keys["start_deadline_ms"], keys["reply_deadline_ms"], keys["max_age_ms"]
        if self.gateway_name:
            config["gateway"] = {"name": self.gateway_name}
        config["dds"] = {name: value for name, value in keys.items() if value is not None}
        with open(self.config, "w", encoding="utf-8") as file:
            json.dump(config, file, indent=2)
        return self.config

    def peer_of(self, vendor):
        peer = self.keep(Peer(vendor, self.domain, gateway=self.gateway_name))
        peer.name = f"{vendor}_peer {len(self.programs)}"
        return peer

    def each_vendor(self):
        """The name of each; where a story fails, the one it was at is told."""
        for vendor in VENDORS:
            self.at = vendor
            yield vendor
        self.at = None

    def commander(self, vendor, *options):
        """A peer that may command."""
        return self.peer_of(vendor).command_with(*options)

    def dds_process(self):
        """The number of axisgate-dds: the gateway's only child of that name."""
        listed = subprocess.run(["ps", "--no-headers", "-o", "pid,comm", "--ppid", str(self.gateway.pid)],
                                capture_output=True, text=True, check=False).stdout
        pids = [int(line.split()[0]) for line in listed.splitlines() if line.split()[1].startswith("axisgate-dds")]
        return pids[0] if pids else None

    # What a DDS master does.

    def prepare_by_dds(self, peer, number):
        """Ramps: half a second to the speeds of these stories."""
        peer.do(number, profile_acceleration=1000 * RPM, profile_deceleration=1000 * RPM)

    def run_by_dds(self, peer, number, rpm=300):
        self.prepare_by_dds(peer, number)
        peer.do(number, "enable")
        peer.do(number, "run_velocity", target_velocity=rpm * RPM)
        self.until_it_turns(number)

    def let_go(self, peer, number):
        """Stopped, without torque and free for the next."""
        peer.do(number, "disable")
        self.until_it_stands(number)
        peer.do(number, "release")

    # What is true afterwards.

    def assert_one_answer(self, peer, number, result):
        """The reply has come, and no second one before that of a request asked after it."""
        self.assertEqual(peer.answer(number)[0], result)
        peer.answer(peer.ask(peer.nowhere, "enable"))
        self.assertEqual([reply["result"] for reply in peer.answers(number)], [result])

    def registers(self, number):
        """The block of an axis, as the watcher reads it."""
        return self.watched(number).block()
