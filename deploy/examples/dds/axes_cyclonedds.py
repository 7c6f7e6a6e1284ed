#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints each state of each axis, with Eclipse Cyclone DDS: axes_cyclonedds.py [DOMAIN]. Ends with Ctrl-C.

Not run by axisgate's tests: Debian 12 has no package of the module cyclonedds (pip install cyclonedds). They hold its types against the IDL.
"""
import signal
import sys
import threading

from cyclonedds.domain import DomainParticipant
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from axisgate_types import XCDR1, AxisState

ONLINE = 2  # link_state
POSITION, VELOCITY = 1 << 2, 1 << 3  # bits of valid: the value is good now


def main():
    ended = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: ended.set())
    participant = DomainParticipant(int(sys.argv[1]) if len(sys.argv) > 1 else 0)
    # Reliable and transient-local: the last state of every axis comes at once.
    qos = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.Durability.TransientLocal, XCDR1)
    reader = DataReader(participant, Topic(participant, "axisgate/axis_state", AxisState), qos)
    while not ended.wait(0.05):
        for axis in reader.take(N=500):
            if not isinstance(axis, AxisState):
                continue  # a gateway has ended
            old = [" (old)" if not axis.valid & bit else "" for bit in (POSITION, VELOCITY)]
            print(f"{axis.gateway} axis {axis.axis} {axis.name}  {'online' if axis.link_state == ONLINE else 'NOT ONLINE'}"
                  f"  statusword {axis.statusword:04x}  position {axis.position:.4f}{old[0]}  velocity {axis.velocity:.4f}{old[1]}"
                  f"  error {axis.error_code:04x}", flush=True)


if __name__ == "__main__":
    main()
