"""A session takes only so many pools of shared memory from others, since Zenoh never lets go of one."""

from __future__ import annotations

import itertools
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink import logging
from robolink.impl.log_output import Record
from robolink.transport import shared_memory
from robolink.transport.shared_memory import LEAST_FREE, MOST_POOLS, POOL, PoolLimit, Segment, free_space, held_segments

OPENED = 1000.0
OWN, OLDER = Segment("own", 12288, OPENED + 0.01), Segment("older", 12288, OPENED - 50)


class Held:
    """Pools that a process holds, and those that it has removed; each look comes long after the one before."""

    def __init__(self, *files: Segment, step: float = 100.0) -> None:
        self.files, self.free, self.removed = list(files), LEAST_FREE, list[str]()
        clock = itertools.count(1.0, step).__next__
        self.limit = PoolLimit(OPENED, lambda: self.files, lambda: self.free, self.removed.append, clock)

    def hold(self, pools: int) -> None:
        """Make so many pools, and the bookkeeping of their publishers."""
        self.files += [Segment(f"pool{number}", 2**24, OPENED + number) for number in range(pools)]
        self.files += [Segment(f"bookkeeping{number}", 1310720, OPENED + number) for number in range(pools)]


@pytest.fixture
def log_lines() -> Iterator[list[Record]]:
    """Collect what is logged, with what other tests' fixture leaves out."""
    found: list[Record] = []
    logging.set_console_handler(None)
    logging.add_handler(found.append)
    yield found
    logging.remove_handler(found.append)


def test_a_session_that_holds_enough_takes_no_more_and_says_so_once(log_lines: list[Record]) -> None:
    held = Held(OWN, OLDER)
    held.hold(MOST_POOLS - 1)
    held.limit.look()
    assert held.removed == []
    held.hold(1)
    for _ in range(3):
        held.limit.look()
    assert held.removed == ["own"]
    (line,) = (each.message for each in log_lines)
    assert "8 pools of shared memory are held" in line


def test_the_files_of_peers_that_started_at_once_are_left_alone(log_lines: list[Record]) -> None:
    peers = [Segment(f"peer{number}", 12288, OPENED + 0.001 * number) for number in range(9)]
    held = Held(OLDER, OWN, *peers)
    held.hold(MOST_POOLS)
    held.limit.look()
    assert held.removed == ["own"]
    assert len(log_lines) == 1


def test_a_full_dev_shm_is_a_reason_too(log_lines: list[Record]) -> None:
    held = Held(OWN)
    held.limit.look()
    assert held.removed == []
    held.free -= 1
    held.limit.look()
    assert held.removed == ["own"]
    assert len(log_lines) == 1


def test_a_session_that_shares_no_memory_has_no_limit(log_lines: list[Record]) -> None:
    held = Held(OLDER)
    held.hold(MOST_POOLS)
    held.free = 0
    held.limit.look()
    assert held.removed == []
    assert log_lines == []


def test_looks_that_come_too_soon_cost_nothing() -> None:
    held = Held(OWN, step=0.1)
    held.limit.look()
    held.hold(MOST_POOLS)
    held.limit.look()
    assert held.removed == []


def test_what_this_process_holds_can_be_listed() -> None:
    assert all(each.size < POOL and each.path.startswith("/dev/shm/") for each in held_segments())
    assert free_space() >= 0
    if sys.platform != "linux":
        assert held_segments() == []


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux lists what a process holds")
def test_a_removed_pool_counts_as_long_as_it_is_held(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    folder.mkdir()
    (tmp_path / "shm").symlink_to(folder)
    monkeypatch.setattr(shared_memory, "FOLDER", str(tmp_path / "shm"))
    with (folder / "1.zenoh").open("wb") as kept, (folder / "2.zenoh").open("wb") as removed:
        for file, size in ((kept, 3), (removed, 5)):
            file.truncate(size)
        (folder / "2.zenoh").unlink()
        assert [(each.path, each.size) for each in held_segments()] == [
            (str(folder / "1.zenoh"), 3),
            (str(folder / "2.zenoh"), 5),
        ]
    assert held_segments() == []
