#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the joints of a gateway and what it says of them, with rclpy: axes_rclpy.py [GATEWAY]. GATEWAY is its name, where it has one.

Not run by axisgate's tests: Debian 12 has no ROS 2. They hold its topics and types against docs/dds/ros2.md.
"""
import sys

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from sensor_msgs.msg import JointState


class Axes(Node):
    def __init__(self, gateway):
        super().__init__("axisgate_axes")
        prefix = f"/{gateway}" if gateway else ""
        self.create_subscription(JointState, f"{prefix}/joint_states", self.on_joint_states, 10)
        self.create_subscription(DiagnosticArray, "/diagnostics", self.on_diagnostics, 10)
        self.messages = {}

    def on_joint_states(self, joints):
        """A value that is not there, or is not valid now, is NaN."""
        for name, position, velocity in zip(joints.name, joints.position, joints.velocity):
            print(f"{name}  position {position:.4f} rad  velocity {velocity:.4f} rad/s", flush=True)

    def on_diagnostics(self, array):
        """Each second, and on change: printed where it says something new."""
        for status in array.status:
            if self.messages.get(status.name) != status.message:
                self.messages[status.name] = status.message
                print(f"{status.name}: {status.message}", flush=True)


def main():
    rclpy.init()
    try:
        rclpy.spin(Axes(sys.argv[1] if len(sys.argv) > 1 else ""))
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
