"""Node of the launcher itself, for actions and programs that talk to others (`launch_ros.ros_adapters`)."""

from __future__ import annotations

import contextlib
import os
import threading
from collections.abc import Iterable
from typing import TYPE_CHECKING

from robolink.launch.ros.launch.bases import LaunchContext, LaunchError
from robolink.launch.ros.launch.event_handlers import OnShutdown

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.executors import SingleThreadedExecutor
    from robolink.node import Node

_LOCAL = "ros_adapter"
"""Local of the context in which it is, as in ROS 2."""


class ROSAdapter:
    """Node that is spun on a thread of its own.

    Args:
        argv: Arguments of its context.
        autostart: False leaves it to `start`.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, autostart: bool = True) -> None:
        self.argv = list(argv or ())
        self.ros_context: Context | None = None
        self.ros_node: Node | None = None
        self.ros_executor: SingleThreadedExecutor | None = None
        self._thread: threading.Thread | None = None
        if autostart:
            self.start()

    def start(self) -> None:
        """Make the node and spin it. Raises LaunchError if it runs already."""
        from robolink.context import Context  # late: launch files are read without the network
        from robolink.executors import SingleThreadedExecutor
        from robolink.node import Node

        if self._thread is not None:
            raise LaunchError("this ROSAdapter runs already")
        self.ros_context = Context()
        self.ros_context.init(self.argv)
        self.ros_node = Node(f"launch_ros_{os.getpid()}", context=self.ros_context)
        self.ros_executor = SingleThreadedExecutor(context=self.ros_context)
        self.ros_executor.add_node(self.ros_node)
        self._thread = threading.Thread(target=self._run, name=_LOCAL, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        from robolink.exceptions import ExternalShutdownException

        assert self.ros_executor is not None
        with contextlib.suppress(ExternalShutdownException):
            self.ros_executor.spin()

    def shutdown(self) -> None:
        """End it. Raises LaunchError if it does not run."""
        if self._thread is None:
            raise LaunchError("this ROSAdapter does not run")
        assert self.ros_context is not None
        assert self.ros_node is not None
        self.ros_context.try_shutdown()
        self._thread.join()
        self.ros_node.destroy_node()
        self._thread = None


def get_ros_adapter(context: LaunchContext) -> ROSAdapter:
    """Return the adapter of a launch's `context`, which makes one if need be, and ends it with the launch."""
    known: ROSAdapter | None = context.get_locals_as_dict().get(_LOCAL)
    if known is not None:
        return known
    made = ROSAdapter()
    context.extend_globals({_LOCAL: made})
    context.register_event_handler(OnShutdown(on_shutdown=lambda event, context: made.shutdown()))
    return made


def get_ros_node(context: LaunchContext) -> Node:
    """Return the node of a launch's `context`, as `get_ros_adapter` does."""
    node = get_ros_adapter(context).ros_node
    assert node is not None
    return node
