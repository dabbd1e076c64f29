"""Network session of one recorder or player in a program: a context and a node, which a thread may spin."""

from __future__ import annotations

from collections.abc import Sequence

from robolink.bag.background_spin import BackgroundSpin
from robolink.bag.topic import BagError
from robolink.context import Context
from robolink.exceptions import nearest
from robolink.logging import LoggingSeverity
from robolink.node import Node

LOOK = 0.1
"""Seconds between two looks at what may have ended a recording or a playback."""


class Session:
    """Session with one node.

    Args:
        name: Name of the node.
        level: Level from which it logs.
        arguments: Arguments of ROS for the node, such as remappings.
    """

    def __init__(self, name: str, level: LoggingSeverity, arguments: Sequence[str] = ()) -> None:
        self._context = Context()
        self._context.init()
        self._spin: BackgroundSpin | None = None
        self.node = Node(name, context=self._context, cli_args=list(arguments) or None, start_parameter_services=False)
        self.node.get_logger().set_level(level)

    @property
    def is_over(self) -> bool:
        """True once the network has ended."""
        return not self._context.ok()

    def start_spin(self) -> None:
        """Spin the node on a thread, which answers its services; nothing if one does already."""
        if self._spin is None:
            self._spin = BackgroundSpin(self.node)

    def stop_spin(self) -> None:
        """End that thread, if there is one."""
        spin, self._spin = self._spin, None
        if spin is not None:
            spin.close()

    def close(self) -> None:
        """End the session. Safe to call twice."""
        self.stop_spin()
        self._context.try_shutdown()


def level_of(name: str) -> LoggingSeverity:
    """Return the level of a name. Raises BagError (a RuntimeError) for an unknown one."""
    levels = LoggingSeverity.__members__
    if name.upper() not in levels:
        raise BagError(f"no log level named '{name[:50]}'{nearest(name.upper(), levels)}")
    return levels[name.upper()]
