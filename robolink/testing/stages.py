"""Choice of the runner of a system under test, by the name of its transport."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robolink.testing.stage import Stage


def make_stage(transport: str, seed: int) -> Stage:
    """Make the runner of a transport. Raises ValueError for another name than memory and zenoh."""
    if transport == "zenoh":
        from robolink.testing.processes import Processes  # late, as below: a test needs one of the two

        return Processes()
    if transport == "memory":
        from robolink.testing.one_process import OneProcess

        return OneProcess(seed)
    raise ValueError(f"no transport '{transport}' for tests: expected memory or zenoh")
