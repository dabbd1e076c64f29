"""Background spinning of the node of a recorder or player, whose services are answered meanwhile."""

from __future__ import annotations

import contextlib
import threading

from robolink.exceptions import ExternalShutdownException
from robolink.executors import SingleThreadedExecutor
from robolink.node import Node
from robolink.system import waits


class BackgroundSpin:
    """Thread that spins a node until `close`; also for a `with`.

    Args:
        node: Node to spin.
    """

    def __init__(self, node: Node) -> None:
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)
        self._thread = threading.Thread(target=self._spin, name="robolink bag services", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the spinning. Safe to call twice."""
        self._executor.shutdown()
        waits.join(self._thread)

    def __enter__(self) -> BackgroundSpin:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _spin(self) -> None:
        with contextlib.suppress(ExternalShutdownException):
            self._executor.spin()
