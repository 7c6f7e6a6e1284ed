#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Commands one axis, with Eclipse Cyclone DDS: command_cyclonedds.py DOMAIN GATEWAY AXIS POSITION. Enables the axis, moves it to POSITION
(rad or m) and keeps it until Ctrl-C; then disables it. GATEWAY is "" for a gateway without a name.

Not run by axisgate's tests: Debian 12 has no package of the module cyclonedds (pip install cyclonedds). They hold its types against the IDL.
"""
import signal
import sys
import threading
import zlib

from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from axisgate_types import (ALREADY_SEEN, DISABLE, DONE, ENABLE, HAS_TARGET_POSITION, MOVE_ABSOLUTE, NOT_BEGUN, RELEASE, XCDR1,
                            AxisCommand, CommandReply, Heartbeat)

BEAT = 0.05  # seconds; the lease of an axis is 2 s unless the gateway's configuration says otherwise
BEATS_UNTIL_ASKED_AGAIN, TRIES = 20, 10

ended = threading.Event()


class Commander:
    """A writer of one axis's commands, which lives as long as it beats: without a sign of life the gateway stops the axis."""

    def __init__(self, domain, gateway, axis):
        participant = DomainParticipant(domain)
        reliable = Policy.Reliability.Reliable(duration(seconds=1))
        # First: a reader takes no reply that was written before it was there.
        self.replies = DataReader(participant, Topic(participant, "axisgate/command_reply", CommandReply),
                                  Qos(reliable, Policy.History.KeepLast(64), XCDR1))
        # A stronger writer takes the axis, a weaker or equal one does not.
        self.commands = DataWriter(participant, Topic(participant, "axisgate/axis_command", AxisCommand),
                                   Qos(reliable, Policy.Ownership.Exclusive, Policy.OwnershipStrength(10), XCDR1))
        self.heartbeats = DataWriter(participant, Topic(participant, "axisgate/heartbeat", Heartbeat),
                                     Qos(Policy.Reliability.BestEffort, XCDR1))
        self.heartbeat = Heartbeat(client=list(self.commands.guid.bytes))
        self.command = AxisCommand(gateway=gateway, gateway_key=zlib.crc32(gateway.encode()), axis=axis)

    def beat(self):
        self.heartbeat.counter = (self.heartbeat.counter + 1) % 2**32
        self.heartbeats.write(self.heartbeat)

    def ask(self, what, mask=0):
        """The reply's result. Asks again with the same id until one comes: it is carried out once. None: none has come."""
        self.command.request_id += 1
        self.command.command, self.command.mask = what, mask
        for turn in range(TRIES * BEATS_UNTIL_ASKED_AGAIN):
            if turn % BEATS_UNTIL_ASKED_AGAIN == 0:
                self.commands.write(self.command)
            self.beat()
            threading.Event().wait(BEAT)
            for reply in self.replies.take(N=64):
                if not isinstance(reply, CommandReply) or list(reply.writer) != self.heartbeat.client:
                    continue  # another client's
                if reply.request_id != self.command.request_id:
                    continue
                # The first reply was lost: its result is in detail. Below 2 that is not known yet.
                result = reply.detail if reply.result == ALREADY_SEEN else reply.result
                print(f"command {what}: result {result} {NOT_BEGUN.get(result, '')}", flush=True)
                if result >= DONE:
                    return result
        print(f"command {what}: no reply", flush=True)
        return None


def main():
    if len(sys.argv) != 5:
        sys.exit("usage: command_cyclonedds.py DOMAIN GATEWAY AXIS POSITION")
    domain, gateway, axis, position = int(sys.argv[1]), sys.argv[2], int(sys.argv[3]), float(sys.argv[4])
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: ended.set())
    commander = Commander(domain, gateway, axis)
    commander.command.target_position = position
    enabled = commander.ask(ENABLE)
    if enabled in NOT_BEGUN:
        sys.exit(1)  # somebody else may be moving it: a disable of ours would stop that motor
    try:
        if enabled == DONE and commander.ask(MOVE_ABSOLUTE, HAS_TARGET_POSITION) == DONE:
            while not ended.wait(BEAT):  # the reply says that the move has begun; AxisState, where it is
                commander.beat()
    finally:
        results = [commander.ask(DISABLE), commander.ask(RELEASE)]
    sys.exit(0 if results == [DONE, DONE] else 1)


if __name__ == "__main__":
    main()
