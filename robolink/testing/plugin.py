"""pytest plugin of robolink: a system of nodes as a fixture, and the seed that replays a failure.

pytest loads this in every project where robolink is installed, so nothing of robolink is imported before a test asks
for one of the fixtures, and a project's own fixtures of the same names go first.
"""

from __future__ import annotations

import contextlib
import os
import random
import re
import sys
import zlib
from collections.abc import Generator, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from types import TracebackType

    from robolink.node import Node
    from robolink.testing.clock import SystemClock
    from robolink.testing.system import System

SEED = "--robolink-seed"
"""Option of pytest for the seed of every system."""
RECORD = "--robolink-record"
"""Option of pytest for the folder of the bags of tests that fail."""
SEEDS = 100_000
"""Count of the seeds from which the default and the random one come."""
MOST_SEED = 2**32 - 1
"""Upper bound of a seed."""
RANDOM = "random"
HASH_SEED = "PYTHONHASHSEED"
"""Environment variable that fixes the order of a set of texts."""
TRANSPORTS = ("memory", "zenoh")


def _seed(text: str) -> int | str:
    if text == RANDOM:
        return text
    if text.isascii() and text.isdecimal() and int(text) <= MOST_SEED:
        return int(text)
    raise ValueError(text)


_seed.__name__ = f"whole number up to {MOST_SEED}, or '{RANDOM}'"  # how argparse calls what it expected


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add robolink's command-line options to pytest."""
    group = parser.getgroup("robolink", "systems of robolink's nodes")
    group.addoption(
        SEED,
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
    group.addoption(
        RECORD,
        metavar="FOLDER",
        help="record the system of every test into a bag in FOLDER, and keep those of tests that fail",
    )

    with contextlib.suppress(ValueError):  # ROS 2's own plugin has it, too
        group.addoption(
            "--launch-args",
            nargs="*",
            default=[],
            metavar="NAME:=VALUE",
            help="launch arguments of launch tests, files with generate_test_description()",
        )


def pytest_configure(config: pytest.Config) -> None:
    """Register the marks of launch tests."""
    config.addinivalue_line(
        "markers", "launch(fixture, shutdown=False): a test beside, or after, a launch_pytest fixture"
    )
    for name in ("launch_test", "rostest"):
        config.addinivalue_line("markers", f"{name}: the function that describes the processes of a launch test")


_LAUNCH_TEST = re.compile(rb"^def generate_test_description\(", re.MULTILINE)
_LAUNCH_PYTEST = re.compile(rb"\blaunch_pytest\b|\bmark\.launch\b")


def pytest_pycollect_makemodule(module_path: Path, parent: pytest.Collector) -> pytest.Module | None:
    """Return the collector of a file that is a launch test; None leaves others, and ROS 2's own, to other plugins."""
    text = _text_of(module_path)
    if _LAUNCH_PYTEST.search(text):
        _use_launch_pytest(parent.config.pluginmanager)
        return None
    if parent.config.pluginmanager.hasplugin("launch_testing") or not _LAUNCH_TEST.search(text):
        return None
    from robolink import compat

    if not compat.activate():
        return None
    from robolink.testing.launch_tests import LaunchTestModule

    return LaunchTestModule.from_parent(parent, path=module_path)


def _text_of(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError:  # pytest itself says why it cannot be read
        return b""


def _use_launch_pytest(plugins: pytest.PytestPluginManager) -> None:
    """Load robolink's plugin of launch_pytest, unless ROS 2's own is there, or it has been loaded."""
    if plugins.hasplugin("launch_pytest"):
        return
    from robolink import compat

    if compat.activate():
        from robolink.testing.launch_pytest import plugin

        plugins.register(plugin, "launch_pytest")


_SYSTEM = pytest.StashKey["System"]()
_HAS_FAILED = pytest.StashKey[bool]()
"""Stash key of the flag that a test has ended early: it failed, or was skipped."""


def _seed_for(item: pytest.Item) -> int:
    """Return a test's seed: the same in every run, wherever its file lies, unless one was asked for."""
    seed: int | str | None = item.config.getoption(SEED)
    if isinstance(seed, int):
        return seed
    return random.randrange(SEEDS) if seed == RANDOM else zlib.crc32(item.name.encode()) % SEEDS


def _name_from_here(item: pytest.Item) -> str:
    """Return a test's name in the folder where pytest was started: its own name for it begins at the project's root."""
    _, colons, inside = item.nodeid.partition("::")
    try:
        file = os.path.relpath(item.path, item.config.invocation_params.dir)
    except ValueError:  # on another drive of Windows
        return item.nodeid
    return Path(file).as_posix() + colons + inside


@pytest.fixture
def system(request: pytest.FixtureRequest) -> Iterator[System]:
    """A system without nodes, for this test alone; at its end nothing of it is left."""
    from robolink.testing.system import System

    item = request.node
    seed, transport = _seed_for(item), request.config.getoption("--robolink-transport")
    where = "" if transport == TRANSPORTS[0] else f" --robolink-transport {transport}"
    hashes = os.environ.get(HASH_SEED, "")
    before = f"{HASH_SEED}={hashes} " if hashes.isdecimal() else ""
    replay = f"{before}pytest '{_name_from_here(item)}' {SEED} {seed}{where}"
    with System(seed=seed, transport=transport, replay=replay) as made:
        item.stash[_SYSTEM], item.stash[_HAS_FAILED] = made, False
        folder = item.config.getoption(RECORD)
        if folder:
            made.bags.record_for_failure(Path(folder), item.name)
        yield made
        made.check()
        if item.stash[_HAS_FAILED]:
            made.close()  # its faults may have had no time to meet anything


@pytest.fixture
def node(system: System) -> Node:
    """A node of the test's own in the system, for publishers, subscriptions and clients."""
    return system.node


@pytest.fixture
def virtual_time(system: System) -> SystemClock:
    """The system's clock, which passes only when the test lets it: `now` and `run(seconds)`."""
    if not system.virtual:
        pytest.skip("real processes have no virtual time: this test needs --robolink-transport memory")
    return system.clock


@pytest.hookimpl(hookwrapper=True)  # the older kind of wrapper, so that no project is kept from an older pytest
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[Any]) -> Generator[None, Any, None]:
    """Add to a failed test what its system was doing; skip one that asks processes for what they cannot do."""
    made = item.stash.get(_SYSTEM, None)
    if made is not None and call.excinfo is not None and not item.config.getoption("fulltrace"):
        _leave_out_ways(call.excinfo.value)
    report: pytest.TestReport = (yield).get_result()
    if made is None or call.excinfo is None:  # of unittest's tests pytest says only now what they raised
        return
    item.stash[_HAS_FAILED] = True
    from robolink.testing.expectations import ExpectationError, OnlyInMemoryError

    error = call.excinfo.value
    if isinstance(error, OnlyInMemoryError):
        report.outcome = "skipped"
        report.longrepr = (str(item.path), item.location[1] or 0, f"Skipped: {error}")
    elif report.failed:
        if not isinstance(error, ExpectationError):  # which says so itself
            report.sections.append(("robolink", made.story.whole()))
        report.sections += [("robolink", f"the bag of this test: {each}") for each in made.bags.keep()]


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Note once, below failures that have a replay, what their seed does not decide."""
    reports = (each for kind in ("failed", "error") for each in terminalreporter.stats.get(kind, ()))
    if sys.flags.hash_randomization and not os.environ.get(HASH_SEED) and any(map(_has_replay, reports)):
        terminalreporter.write_line(f"robolink: the order of sets of texts is chance; {HASH_SEED}=0 makes it the same")


def _has_replay(report: Any) -> bool:
    return any(f" {SEED} " in text for text in (report.longreprtext, *(each for _, each in report.sections)))


def pytest_exception_interact(call: pytest.CallInfo[Any], report: pytest.CollectReport | pytest.TestReport) -> None:
    """Add advice to a file of tests that could not import rclpy's names."""
    error = call.excinfo.value.__cause__ if call.excinfo else None
    if isinstance(report, pytest.CollectReport) and isinstance(error, ModuleNotFoundError):
        name = (error.name or "").partition(".")[0]
        if _is_ros(name):
            advice = f"`import robolink.compat` first, here or in conftest.py, and {name} is robolink's"
            report.sections.append(("robolink", advice))


def _is_ros(name: str) -> bool:
    from robolink.interfaces.standard import packages

    return name in ("rclpy", "tf2_ros", "message_filters") or name in packages()


_ROBOLINK = Path(__file__).parents[1]
_WAYS = (_ROBOLINK / "testing", _ROBOLINK / "host")
"""Folders of the frames between a test and its nodes' code, which help neither."""


def _leave_out_ways(error: BaseException) -> None:
    """Remove robolink's own frames from an error's traceback; from one that explains itself, its place too."""
    from robolink.exceptions import RobolinkError

    step = error.__traceback__
    while step is not None:
        after = step.tb_next
        while after is not None and _is_in(_WAYS, after):
            after = after.tb_next
        if isinstance(error, RobolinkError) and not any(not _is_in((_ROBOLINK,), each) for each in _steps(after)):
            after = None
        step.tb_next = after
        step = after


def _steps(step: TracebackType | None) -> Iterator[TracebackType]:
    while step is not None:
        yield step
        step = step.tb_next


def _is_in(folders: Iterable[Path], step: TracebackType) -> bool:
    file = Path(step.tb_frame.f_code.co_filename)
    return any(file.is_relative_to(each) for each in folders)
