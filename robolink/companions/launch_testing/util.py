"""Helpers of launch files that are tests (`launch_testing.util`)."""

from __future__ import annotations

from robolink.companions.launch.bases import Action

__all__ = ["KeepAliveProc"]


class KeepAliveProc(Action):
    """Process that only keeps a launch going until its tests are done: nothing is run.

    Args:
        **kwargs: `condition`.
    """
