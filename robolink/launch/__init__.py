"""Start the systems that launch files describe: `file` reads them, `command` turns their nodes into processes."""

from robolink.launch.command import launch, plan
from robolink.launch.description import LaunchDescription, NodeDescription
from robolink.launch.file import read_launch_file

__all__ = ["LaunchDescription", "NodeDescription", "launch", "plan", "read_launch_file"]
