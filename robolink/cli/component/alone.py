"""Container with one component, in the process of the command itself."""

from __future__ import annotations

import sys
import threading
import time
import uuid
from typing import Any

from robolink.cli.component import asking
from robolink.cli.shared.output import say
from robolink.exceptions import RobolinkError
from robolink.system import clocks
from robolink.utilities import try_shutdown
from robolink.workspace import find_executable, load_node

BEGINS_WITHIN = 20.0
"""Timeout of the container's announcement, in s."""


def run(wanted: asking.Wanted, container: str = "") -> None:
    """Run a container, and a component in it, until Ctrl-C.

    Args:
        wanted: The component.
        container: Name of the container's node; '' takes one that nobody has.

    Raises:
        RobolinkError: if the component cannot be loaded.
    """
    name = container or f"standalone_container_{uuid.uuid4().hex[:12]}"
    failures: list[RobolinkError] = []
    thread = threading.Thread(target=_load, args=(name, wanted, failures), name="loading", daemon=True)
    serve: Any = load_node(find_executable("rclcpp_components", "component_container"))
    sys.argv = ["component_container", "--ros-args", "-r", f"__node:={name}"]
    thread.start()
    serve()
    if failures:
        raise failures[0]


def _load(name: str, wanted: asking.Wanted, failures: list[RobolinkError]) -> None:
    """Load the component as soon as the container is there; end the container if that fails."""
    try:
        deadline = clocks.monotonic() + BEGINS_WITHIN
        while f"/{name}" not in asking.containers() and clocks.monotonic() < deadline:
            time.sleep(0.05)
        answer = asking.load(f"/{name}", wanted)
        say(f"Loaded component {answer.unique_id} into '{name}' container node as '{answer.full_node_name}'")
    except RobolinkError as error:
        failures.append(error)
        try_shutdown()
