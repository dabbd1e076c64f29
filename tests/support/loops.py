"""Coroutines of tests: run to their end on a new event loop, with a limit."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any, TypeVar

T = TypeVar("T")

PATIENCE = 20.0
"""Longest time in seconds that a coroutine takes before its test fails."""


def run(work: Coroutine[Any, Any, T]) -> T:
    """Run a coroutine to its end; TimeoutError if that does not come."""
    return asyncio.run(asyncio.wait_for(work, PATIENCE))


async def until(holds: Callable[[], object]) -> None:
    """Let others go on until a condition holds."""
    while not holds():
        await asyncio.sleep(0.001)
