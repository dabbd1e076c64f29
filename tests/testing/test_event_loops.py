"""Nodes that wait in event loops of asyncio: in real time, which is told with the place."""

from __future__ import annotations

import asyncio
import selectors
import sys

import pytest

from robolink import Node
from robolink.testing import System


class Asker(Node):
    """Runs an event loop of its own, twice as it is, once with a wait."""

    def __init__(self) -> None:
        super().__init__("asker")
        self.create_timer(0.1, lambda: asyncio.run(asyncio.sleep(0)))
        self.create_timer(0.25, self.on_timer)

    def on_timer(self) -> None:
        asyncio.run(asyncio.sleep(0.3))


@pytest.mark.skipif(sys.platform == "win32", reason="asyncio waits by other means there")
def test_a_wait_of_asyncio_is_named_with_its_place(tested: System) -> None:
    tested.start(Asker)
    tested.run(0.2)
    assert "real time" not in tested.story.whole()
    tested.run(0.1)
    line = Asker.on_timer.__code__.co_firstlineno + 1
    assert f"real time was used, which is virtual here: asker asyncio ({__file__}:{line})" in tested.story.whole()


def test_pythons_own_select_comes_back(tested: System) -> None:
    during = selectors.DefaultSelector.select
    tested.close()
    assert selectors.DefaultSelector.select is not during
