#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Moves one axis, with rclpy: command_rclpy.py AXIS POSITION [GATEWAY]. Enables the axis of that name, moves it to POSITION (rad or m) and
keeps it there until Ctrl-C; then disables it. GATEWAY is its name, where it has one. For an axis that nobody else commands: a disable is
heard from everybody.

Not run by axisgate's tests: Debian 12 has no ROS 2. They hold its topics, types and words against docs/dds/ros2.md and the gateway's own.
"""
import math
import signal
import sys
import time

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool

PERIOD = 0.05  # seconds; an axis whose stream is silent for 2 s is stopped, unless the gateway's configuration says otherwise
PATIENCE = 10  # seconds until an enable or a disable must have been seen
SAMPLES_IN_STEP = 10
DISABLED, ENABLED = "disabled", ("standstill", "discrete motion", "continuous motion")

ended = []


class Commander(Node):
    def __init__(self, axis, gateway):
        super().__init__("axisgate_commander")
        prefix = f"/{gateway}" if gateway else ""
        self.axis = axis
        self.status_name = f"{gateway or 'axisgate'}: {axis}"
        self.position, self.state = math.nan, None
        topic = "".join(c if c.isascii() and c.isalnum() else "_" for c in axis)  # ROS 2 knows letters, digits and underscores
        self.create_subscription(JointState, f"{prefix}/joint_states", self.on_joint_states, 10)
        self.create_subscription(DiagnosticArray, "/diagnostics", self.on_diagnostics, 10)
        self.enable = self.create_publisher(Bool, f"{prefix}/{topic}/enable", 10)
        self.stream = self.create_publisher(JointState, f"{prefix}/joint_commands", 10)

    def on_joint_states(self, joints):
        for name, position in zip(joints.name, joints.position):
            if name == self.axis:
                self.position = position

    def on_diagnostics(self, array):
        for status in array.status:
            if status.name == self.status_name:
                self.state = next((pair.value for pair in status.values if pair.key == "state"), None)

    def send(self, target):
        self.stream.publish(JointState(name=[self.axis], position=[target]))

    def turn(self):
        """Hears what there is, for a PERIOD."""
        end = time.monotonic() + PERIOD
        while (left := end - time.monotonic()) > 0:
            rclpy.spin_once(self, timeout_sec=left)

    def until(self, look, doing=lambda: None):
        """False: it did not come in time, or somebody has pressed Ctrl-C."""
        last = time.monotonic() + PATIENCE
        while not look():
            if ended or time.monotonic() > last:
                return False
            doing()
            self.turn()
        return True

    def hold_here(self):
        """The stream begins where the axis is: before that the gateway takes no position of it."""
        if not math.isnan(self.position):
            self.send(self.position)

    def is_known(self):
        return not math.isnan(self.position) and self.state is not None and self.enable.get_subscription_count() > 0

    def against(self):
        """What stands against a beginning; empty: nothing does."""
        if not self.until(self.is_known):
            return "the gateway does not tell of this axis, or takes no commands"
        return "" if self.state == DISABLED else f"the axis is not ours to enable: {self.state}"

    def move(self, target):
        """Until Ctrl-C. What went wrong; empty: nothing did."""
        self.enable.publish(Bool(data=True))
        if not self.until(lambda: self.state in ENABLED, self.hold_here):
            return "" if ended else f"it was not enabled: {self.state}"
        for _ in range(SAMPLES_IN_STEP):
            self.hold_here()
            self.turn()
        while not ended:
            if self.state not in ENABLED:
                return f"it was stopped: {self.state}"
            self.send(target)
            self.turn()
        return ""

    def disable(self):
        """Asked again until it is seen: a topic has no reply."""
        ended.clear()
        return self.until(lambda: self.state == DISABLED, lambda: self.enable.publish(Bool(data=False)))


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit("usage: command_rclpy.py AXIS POSITION [GATEWAY]")
    axis, target, gateway = sys.argv[1], float(sys.argv[2]), sys.argv[3] if len(sys.argv) == 4 else ""
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)  # Ctrl-C is ours: the axis is disabled before the node ends
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: ended.append(True))
    commander = Commander(axis, gateway)
    wrong = commander.against()
    if wrong:
        sys.exit(wrong)  # nothing was asked of the axis
    try:
        wrong = commander.move(target)
    finally:
        disabled = commander.disable()
    sys.exit(wrong or (0 if disabled else f"it is not seen disabled: {commander.state}"))


if __name__ == "__main__":
    main()
