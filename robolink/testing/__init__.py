"""Whole systems of nodes in a test: started, observed, disturbed and replayed, in one process and in virtual time.

    from robolink.testing import System

    with System(seed=1) as system:
        system.launch("follow")
        system.expect("odom", lambda odom: odom.pose.pose.position.x > 3.0, within=60.0)

With pytest the fixture `system` is one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.text.suggestions import lazily

if TYPE_CHECKING:
    from robolink.testing.expectations import ExpectationError, NodeFailure
    from robolink.testing.system import System

__all__ = ["ExpectationError", "NodeFailure", "System"]

__getattr__, __dir__ = lazily(
    "robolink.testing",
    {"ExpectationError": "expectations", "NodeFailure": "expectations", "System": "system"},
    ["expectations", "system"],
)
