"""ROS 2's test_msgs: its types are the files beside this folder, made into classes when they are first imported."""

from pathlib import Path

from robolink.workspace import use_interfaces

use_interfaces(Path(__file__).parents[3])
