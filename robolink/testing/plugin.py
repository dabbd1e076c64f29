"""robolink's plugin for pytest: a system of nodes as a fixture, and the seed that replays what failed.

pytest loads this in every project where robolink is installed, so nothing of robolink is imported before a test asks
for one of the fixtures, and a project's own fixtures of the same names go first.
"""

from __future__ import annotations

import random
import zlib
from collections.abc import Generator, Iterator
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.testing.clock import SystemClock
    from robolink.testing.system import System

SEEDS = 100_000
RANDOM = "random"
TRANSPORTS = ("memory", "zenoh")


def _seed(text: str) -> int | str:
    if text == RANDOM:
        return text
    if text.isascii() and text.isdecimal():
        return int(text)
    raise ValueError(text)


_seed.__name__ = f"whole number, or '{RANDOM}'"  # how argparse calls what it expected


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options that tests of robot systems have."""
    group = parser.getgroup("robolink", "systems of robolink's nodes")
    group.addoption(
        "--robolink-seed",
        type=_seed,
        metavar="N",
        help="the seed of every system, as a failure names it; 'random' draws one for each test."
        " By default each test has one of its own, made of its name",
    )
    group.addoption(
        "--robolink-transport",
        choices=TRANSPORTS,
        default=TRANSPORTS[0],
        help="memory: in this process and in virtual time (default); zenoh: real processes in real time",
    )


_SYSTEM = pytest.StashKey["System"]()


def _seed_for(item: pytest.Item) -> int:
    """Give a test's seed: the same in every run, wherever its file lies, unless one was asked for."""
    asked: int | str | None = item.config.getoption("--robolink-seed")
    if isinstance(asked, int):
        return asked
    return random.randrange(SEEDS) if asked == RANDOM else zlib.crc32(item.name.encode()) % SEEDS


@pytest.fixture
def system(request: pytest.FixtureRequest) -> Iterator[System]:
    """Give a system without nodes, for this test alone; at its end nothing of it is left."""
    from robolink.testing.system import System

    item = request.node
    seed, transport = _seed_for(item), request.config.getoption("--robolink-transport")
    where = "" if transport == TRANSPORTS[0] else f" --robolink-transport {transport}"
    with System(seed=seed, transport=transport, replay=f"pytest '{item.nodeid}' --robolink-seed {seed}{where}") as made:
        item.stash[_SYSTEM] = made
        yield made


@pytest.fixture
def node(system: System) -> Node:
    """Give a node of the test's own in the system: for publishers, subscriptions and clients."""
    return system.node


@pytest.fixture
def virtual_time(system: System) -> SystemClock:
    """Give the system's time, which passes only when the test lets it: `now` and `run(seconds)`."""
    if not system.virtual:
        pytest.skip("real processes have no virtual time: this test needs --robolink-transport memory")
    return system.clock


@pytest.hookimpl(hookwrapper=True)  # the older kind of wrapper, so that no project is kept from an older pytest
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[Any]) -> Generator[None, Any, None]:
    """Add to a failed test what its system was doing; skip one that asks processes for what they cannot do."""
    made = item.stash.get(_SYSTEM, None)
    if made is None or call.excinfo is None or call.when != "call":
        yield
        return
    from robolink.testing.expectations import ExpectationError, OnlyInMemoryError

    error = call.excinfo.value
    if isinstance(error, OnlyInMemoryError):
        call.excinfo = pytest.CallInfo.from_call(lambda: pytest.skip(str(error)), "call").excinfo
    report: pytest.TestReport = (yield).get_result()
    if report.skipped:
        report.longrepr = (str(item.path), item.location[1] or 0, f"Skipped: {error}")
    if report.failed and not isinstance(error, ExpectationError):  # which says so itself
        report.sections.append(("robolink", made.story()))
