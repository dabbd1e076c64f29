"""Publish a state for each joint of a robot, in the place of the program with a window: parameters are its sliders."""

from __future__ import annotations

from pathlib import Path

from robolink.counterparts.joint_state_publisher.joint_state_publisher import JointStatePublisher
from robolink.counterparts.program import spin_program
from robolink.counterparts.urdf.parser import read_text
from robolink.node import Node

SLIDERS = (
    "the sliders are on the page of 'robolink view', among the parameters of {node}; in a terminal: 'robolink param set"
    " {node} zeros.JOINT 0.5'"
)


def make(words: list[str]) -> Node:
    """Make the node, whose name is joint_state_publisher in ROS too, and say what serves as sliders."""
    node = JointStatePublisher(read_text(Path(words[0]), anywhere=True) if words else "")
    node.get_logger().info(SLIDERS.format(node=node.get_name()))
    return node


def main(args: list[str] | None = None) -> None:
    """Publish the joints of the robot on the topic robot_description, or in the file that is the first argument."""
    spin_program(make, args)


if __name__ == "__main__":
    main()
