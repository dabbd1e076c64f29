"""Thread that spins a node of a test (`launch_testing_ros.message_pump`)."""

from __future__ import annotations

import threading

from robolink.context import Context
from robolink.executors import SingleThreadedExecutor
from robolink.node import Node
from robolink.system import waits

_ENDS_WITHIN = 5.0
"""Timeout of its end, in s."""


class MessagePump:
    """Spins a node on a thread of its own.

    Args:
        node: The node.
        context: Its context; None is the default one.
    """

    def __init__(self, node: Node, context: Context | None = None) -> None:
        self._node, self._context = node, context
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._run, name="message pump", daemon=True)

    def start(self) -> None:
        """Begin to spin."""
        self._thread.start()

    def stop(self) -> None:
        """Spin no more. Raises TimeoutError if a callback does not end."""
        self._is_over.set()
        if not waits.join(self._thread, _ENDS_WITHIN):
            raise TimeoutError("a callback of the node does not end")

    def _run(self) -> None:
        executor = SingleThreadedExecutor(context=self._context)
        executor.add_node(self._node)
        while not self._is_over.is_set():
            executor.spin_once(timeout_sec=0.1)
        executor.remove_node(self._node)
