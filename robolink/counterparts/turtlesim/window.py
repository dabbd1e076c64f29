"""Window of turtlesim: the page of `robolink view`, served by the node's own process and opened in the browser."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING

from robolink.exceptions import RobolinkError
from robolink.extensions.optional import page
from robolink.parameter import Parameter
from robolink.running.timebase import VirtualTime
from robolink.system.terminal import open_in_browser

if TYPE_CHECKING:
    from robolink.node import Node


@contextlib.contextmanager
def window(node: Node, picture: str) -> Iterator[None]:
    """Serve the page for the block, on a free port, and open it if a person and a screen are there.

    In virtual time there is none. Where it cannot be served, a warning says why, and the turtles swim unseen.

    Args:
        node: Node that is shown.
        picture: Topic of its picture.
    """
    if isinstance(node.context.time, VirtualTime):
        yield
        return
    with contextlib.ExitStack() as stack:
        try:
            address = _served(node, stack)
        except RobolinkError as error:
            node.get_logger().warning(f"no window: {error}; 'robolink view' shows the turtles")
        else:
            _show(f"{address}#turtlesim:{picture}+services")
        yield


def _served(node: Node, stack: contextlib.ExitStack) -> str:
    """Serve the page until the stack is closed, and return its address."""
    from robolink.node import Node

    looker = Node(
        f"_robolink_view_{os.getpid()}",
        context=node.context,
        use_global_arguments=False,
        enable_rosout=False,
        start_parameter_services=False,
        parameter_overrides=[Parameter("start_type_description_service", value=False)],
    )
    stack.callback(looker.destroy_node)
    return stack.enter_context(page(looker)).address


def _show(address: str) -> None:
    """Print the address on the terminal, not into the log, since it has the token."""
    if sys.stdout is None:  # a program without any terminal
        return
    opened = sys.stdout.isatty() and open_in_browser(address)
    words = "the turtles are in your browser" if opened else "see the turtles in a browser"
    sys.stdout.write(f"{words}: {address}\n")
    sys.stdout.flush()
