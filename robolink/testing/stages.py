"""The choice of what a system under test runs on, by the name of its transport."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robolink.testing.stage import Stage


def make_stage(transport: str, seed: int) -> Stage:
    """Make the stage that a name stands for, memory or zenoh. Raises ValueError for another name."""
    if transport == "zenoh":
        from robolink.testing.processes import Processes  # late, as below: a test needs one of the two

        return Processes()
    if transport == "memory":
        from robolink.testing.one_process import OneProcess

        return OneProcess(seed)
    raise ValueError(f"no transport '{transport}' for tests: expected memory or zenoh")
