"""Helpers of launch tests that know middlewares (`launch_testing_ros.tools`)."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from robolink.companions.launch_testing import tools

__all__ = ["basic_output_filter"]


def basic_output_filter(
    filtered_prefixes: Iterable[str] | None = None,
    filtered_patterns: Iterable[str] | None = None,
    filtered_rmw_implementation: str | None = None,
) -> Callable[[str], str]:
    """Return a function that leaves lines out of an output.

    Args:
        filtered_prefixes: As for `launch_testing.tools.basic_output_filter`.
        filtered_patterns: As there.
        filtered_rmw_implementation: Of no effect: robolink's nodes have no other middleware, and it writes no lines.
    """
    return tools.basic_output_filter(filtered_prefixes, filtered_patterns)
