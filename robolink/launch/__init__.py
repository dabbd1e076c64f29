"""Launch files: `reading` parses and expands them, `planning` makes the process list, `command` runs it.

`looking` inspects a system without starting it. Names are imported when they are first used: a node's process needs
none of a launcher's modules.
"""

from typing import TYPE_CHECKING

from robolink.text.suggestions import lazily

if TYPE_CHECKING:
    from robolink.launch.command import launch
    from robolink.launch.entry import Entry
    from robolink.launch.planning import Launched, plan, processes
    from robolink.launch.reading.description import LaunchDescription, NodeDescription
    from robolink.launch.reading.entries import read_launch_file

__all__ = [
    "Entry",
    "LaunchDescription",
    "Launched",
    "NodeDescription",
    "launch",
    "plan",
    "processes",
    "read_launch_file",
]

_HOMES = {
    "Entry": "entry",
    "LaunchDescription": "reading.description",
    "Launched": "planning",
    "NodeDescription": "reading.description",
    "launch": "command",
    "plan": "planning",
    "processes": "planning",
    "read_launch_file": "reading.entries",
}

__getattr__, __dir__ = lazily(__name__, _HOMES, ())
