"""Start the systems that launch files describe: `entries` reads them, `command` turns their nodes into processes.

`validate` and `graph` only look at them. Names are imported when they are first used: a node's process wants none of
a launcher's.
"""

from typing import TYPE_CHECKING

from robolink.lacking import lazily

if TYPE_CHECKING:
    from robolink.launch.command import Launched, launch, plan, processes
    from robolink.launch.description import LaunchDescription, NodeDescription
    from robolink.launch.entries import read_launch_file
    from robolink.launch.entry import Entry

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
    "LaunchDescription": "description",
    "Launched": "command",
    "NodeDescription": "description",
    "launch": "command",
    "plan": "command",
    "processes": "command",
    "read_launch_file": "entries",
}

__getattr__, __dir__ = lazily(__name__, _HOMES, ())
