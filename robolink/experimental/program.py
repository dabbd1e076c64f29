"""Program of one AsyncNode class: the node is made and run on an event loop of its own."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from robolink.experimental.async_node import AsyncNode


def run_node(make: Callable[[], Any], on_made: Callable[[AsyncNode], object] = lambda node: None) -> None:
    """Make an AsyncNode and run it to its end.

    Args:
        make: Function that makes it, within the running event loop.
        on_made: Callback with the node, before it runs.

    Raises:
        Exception: what a callback raises; an ExceptionGroup if several have.
    """
    try:
        asyncio.run(_run(make, on_made))
    except Exception as error:
        only: Any = error
        while len(inner := getattr(only, "exceptions", [])) == 1:  # an ExceptionGroup of one
            (only,) = inner
        if only is error:
            raise
        raise only from None


async def _run(make: Callable[[], Any], on_made: Callable[[AsyncNode], object]) -> None:
    node = make()
    on_made(node)
    await node.run()
