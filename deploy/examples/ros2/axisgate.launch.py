# SPDX-License-Identifier: Apache-2.0
"""ros2_control before the axes of a gateway on this computer: ros2 launch ./axisgate.launch.py

The gateway publishes /joint_states itself: there is no joint_state_broadcaster, which would publish it again.
"""
from pathlib import Path

from launch import LaunchDescription
from launch_ros.actions import Node

HERE = Path(__file__).resolve().parent


def generate_launch_description():
    description = {"robot_description": (HERE / "robot.urdf").read_text(encoding="utf-8")}
    return LaunchDescription([
        Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=[description]),
        # Humble takes the description as a parameter, Jazzy from the topic of the same name.
        Node(package="controller_manager", executable="ros2_control_node",
             parameters=[description, str(HERE / "controllers.yaml")],
             remappings=[("~/robot_description", "/robot_description")]),
        Node(package="controller_manager", executable="spawner", arguments=["position_controller"]),
    ])
