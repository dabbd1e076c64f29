"""Thread with the launcher's own node, which is made when it is first needed."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

from robolink.exceptions import RobolinkError
from robolink.launch.entry import NODE
from robolink.system import waits

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.executors import SingleThreadedExecutor
    from robolink.node import Node

_LEAVING = 5.0
"""Timeout of leaving the network, in s."""


class NodeThread:
    """Node that is spun on a thread of its own.

    Args:
        make_context: Returns the initialised context of the node.
        say: Called with the reason, if the network cannot be joined.
    """

    def __init__(self, make_context: Callable[[], Context], say: Callable[[str], object]) -> None:
        self._make_context, self._say = make_context, say
        self._executor: SingleThreadedExecutor | None = None
        self._node: Node | None = None
        self._thread: threading.Thread | None = None
        self._has_failed = False

    def __call__(self, act: Callable[[Node], object]) -> None:
        """Call `act` with the node on its thread; with no effect where the network cannot be joined."""
        if self._executor is None and not self._has_failed:
            self._start()
        if self._executor is not None:
            self._executor.create_task(lambda: act(self._own))

    @property
    def _own(self) -> Node:
        assert self._node is not None
        return self._node

    def _start(self) -> None:
        from robolink.executors import SingleThreadedExecutor
        from robolink.node import Node

        try:
            context = self._make_context()
            executor = SingleThreadedExecutor(context=context)
            self._node = Node(NODE, context=context, enable_rosout=False, start_parameter_services=False)
        except (RobolinkError, ValueError) as error:
            self._has_failed = True
            self._say(f"nodes with a lifecycle cannot be asked for transitions: {error}")
            return
        executor.add_node(self._node)
        self._executor = executor
        self._thread = threading.Thread(target=self._spin, args=(context,), name=NODE, daemon=True)
        self._thread.start()

    def _spin(self, context: Context) -> None:
        from robolink.exceptions import ExternalShutdownException

        assert self._executor is not None
        try:
            while context.ok():
                self._executor.spin_once(timeout_sec=0.5)
        except ExternalShutdownException:
            pass

    def __enter__(self) -> NodeThread:
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the network."""
        if self._thread is not None and self._node is not None:
            self._node.context.try_shutdown()
            waits.join(self._thread, _LEAVING)
