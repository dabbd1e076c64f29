"""Waits of tests for what other threads and processes do."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from tests.support.commands import PATIENCE


def wait_until(holds: Callable[[], Any], within: float = PATIENCE) -> None:
    """Wait until it holds; it is asked again and again, so it may be about anything, not the graph alone."""
    deadline = time.monotonic() + within
    while not holds():
        assert time.monotonic() < deadline, "it never came true"
        time.sleep(0.005)
