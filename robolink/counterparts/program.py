"""Main function of a node of this room: reads the command line, spins the node, ends in good order; small helps."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable

import robolink
from robolink.callback_groups import CallbackGroup
from robolink.exceptions import ExternalShutdownException, RobolinkError
from robolink.node import Node
from robolink.task import Future
from robolink.utilities import remove_ros_args


class UsageError(RobolinkError, ValueError):
    """Arguments on the command line that a program does not take."""


def spin_program(make: Callable[[list[str]], Node], args: list[str] | None = None) -> None:
    """Make a node, and spin it until its context ends.

    Args:
        make: Makes the node from the program's own arguments, without its name and without those for ROS.
        args: Command line with the program's name; None for `sys.argv`.
    """
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = make(own_words(args))
        try:
            robolink.spin(node)
        finally:
            node.destroy_node()


def spin_times(make: Callable[[], Node], count: int) -> None:
    """Make a node, and let `count` of its callbacks run; it ends earlier with its context, which has begun."""
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = make()
        for _ in range(count):
            if not robolink.ok():
                break
            robolink.spin_once(node)
        node.destroy_node()


def own_words(args: list[str] | None = None) -> list[str]:
    """Return a program's own arguments, without its name and without those for ROS; `args` as in `spin_program`."""
    return remove_ros_args(sys.argv if args is None else args)[1:]


def wrapped_int64(value: int) -> int:
    """Return an integer wrapped to 64 signed bits.

    >>> wrapped_int64(2**63)
    -9223372036854775808
    """
    return (value + 2**63) % 2**64 - 2**63


async def pause(node: Node, seconds: float, group: CallbackGroup) -> None:
    """Let `seconds` pass by the clock of a node, in a coroutine.

    Args:
        node: The node.
        seconds: How long; what is over already, as on a clock that runs on while it is computed, lasts no time.
        group: Callback group of the timer, in which nothing may wait for this coroutine.
    """
    done: Future[None] = Future()

    def wake() -> None:
        if not done.done():
            done.set_result(None)

    timer = node.create_timer(max(0.0, seconds), wake, callback_group=group)
    try:
        await done
    finally:
        node.destroy_timer(timer)
