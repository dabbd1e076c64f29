"""Windows of turtlesim: the page of `robolink view`, served by the node's own process, or a picture in the terminal."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from robolink.exceptions import RobolinkError
from robolink.extensions.optional import MissingPartError, page
from robolink.parameter import Parameter
from robolink.running.timebase import VirtualTime
from robolink.system.terminal import open_in_browser

if TYPE_CHECKING:
    from robolink.counterparts.turtlesim.picture import Pixels
    from robolink.counterparts.turtlesim.turtlesim_node import TurtleSim
    from robolink.node import Node

PERIOD = 0.1
"""Seconds between two pictures."""

LOG_LINES = 6
"""Lines of the terminal that are left to the log."""

LEAST = 20
"""Smallest width and height of the picture, in half blocks."""


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
        except MissingPartError as error:
            node.get_logger().warning(f"no window: {error}")
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


class NoTerminalWindowError(RobolinkError, OSError):
    """There is no terminal to draw in, or it is too small."""


@contextlib.contextmanager
def terminal_room() -> Iterator[int]:
    """Clear the terminal for a picture, above a region in which the log scrolls; yield the picture's width and height.

    They are in half blocks. Raises NoTerminalWindowError if standard output is not a terminal, or too small a one.
    """
    size = _size()
    os.system("")
    top = size // 2 + 1
    _write(f"\x1b[2J\x1b[{top};{top + LOG_LINES - 1}r\x1b[{top};1H")
    try:
        yield size
    finally:
        _write(f"\x1b[r\x1b[{top + LOG_LINES};1H\n")


def draw_in_terminal(node: TurtleSim, size: int) -> None:
    """Draw the window of `node` at the top of the terminal when it has changed, `size` half blocks wide and high."""
    shown = ""

    def draw() -> None:
        nonlocal shown
        text = half_blocks(node.canvas.picture(each.drawn for each in node.turtles.values()), size)
        if text != shown:
            shown = text
            _write(f"\x1b7\x1b[H{text}\x1b8")

    node.create_timer(PERIOD, draw, clock=node.steady)


def half_blocks(picture: Pixels, size: int) -> str:
    """Return a picture as lines of text: each character is two of its `size` x `size` parts, one above the other."""
    parts = _means(picture, size)
    lines = []
    for upper, lower in zip(parts[0::2].tolist(), parts[1::2].tolist(), strict=True):
        line, before = "", None
        for above, below in zip(upper, lower, strict=True):
            if (above, below) != before:  # most are as the one before: a tenth of the text
                before = (above, below)
                line += "\x1b[38;2;{};{};{}m".format(*above) + "\x1b[48;2;{};{};{}m".format(*below)
            line += "▀"
        lines.append(f"{line}\x1b[0m")
    return "\r\n".join(lines)


def _means(picture: Pixels, size: int) -> NDArray[Any]:
    """Return the mean colours of size x size parts of a picture."""
    rows, columns = (np.linspace(0, length, size, endpoint=False).astype(int) for length in picture.shape[:2])
    sums = np.add.reduceat(np.add.reduceat(picture.astype(np.int32), rows, axis=0), columns, axis=1)
    heights, widths = (
        np.diff([*each, length]) for each, length in ((rows, picture.shape[0]), (columns, picture.shape[1]))
    )
    means: NDArray[Any] = sums // (heights[:, None] * widths)[..., None]
    return means


def _size() -> int:
    """Return the width and height of the picture that the terminal has room for, in half blocks: an even number."""
    if sys.stdout is None or not sys.stdout.isatty():
        raise NoTerminalWindowError("--terminal draws in a terminal, and standard output is none")
    columns, lines = shutil.get_terminal_size()
    size = min(columns, 2 * (lines - LOG_LINES)) // 2 * 2
    if size < LEAST:
        raise NoTerminalWindowError(f"--terminal needs {LEAST} columns and {LEAST // 2 + LOG_LINES} lines at least")
    return size


def _write(text: str) -> None:
    sys.stdout.write(text)
    sys.stdout.flush()
