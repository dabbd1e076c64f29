"""Nodes that wait in event loops of asyncio: in virtual time; a loop that they make in other ways is told."""

from __future__ import annotations

import asyncio
import selectors
import sys

import pytest

from robolink import Node
from robolink.testing import System


class Asker(Node):
    """Waits in an event loop in its callback."""

    def __init__(self) -> None:
        super().__init__("asker")
        self.create_timer(0.25, self.on_timer)

    def on_timer(self) -> None:
        asyncio.run(asyncio.sleep(100.0))


class AsksByItself(Asker):
    """Makes the loop by the name of its class, which is Python's own."""

    def on_timer(self) -> None:
        loop = asyncio.SelectorEventLoop()
        loop.run_until_complete(asyncio.sleep(0.01))
        loop.close()


def test_a_wait_of_asyncio_takes_virtual_time(tested: System) -> None:
    tested.start(Asker)
    tested.run(1000.0)
    assert "real time" not in tested.story.whole()


@pytest.mark.skipif(sys.platform == "win32", reason="asyncio waits by other means there")
def test_a_loop_in_real_time_is_named_with_its_place(tested: System) -> None:
    tested.start(AsksByItself)
    tested.run(0.3)
    line = AsksByItself.on_timer.__code__.co_firstlineno + 2
    assert f"real time was used, which is virtual here: asker asyncio ({__file__}:{line})" in tested.story.whole()


def test_pythons_own_select_comes_back(tested: System) -> None:
    during = selectors.DefaultSelector.select
    tested.close()
    assert selectors.DefaultSelector.select is not during
