"""Validity at every moment: writes and power that are cut, by four readers; `tests.support.mcap_cuts` has more."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.bag.mcap import Reader
from tests.support.mcap_cuts import Tally, crashes, cut_power, cut_writes, run
from tests.support.mcap_readers import Readers

UNSURE = "@mcap/core, linear"
"""The one reader that minds an old end in the file, for as long as the end moves: until the next write but two."""
pytestmark = pytest.mark.processes  # node reads the files, where it is


@pytest.mark.parametrize("compression", ["", "zstd"])
def test_a_write_that_is_cut_loses_nothing_older(tmp_path: Path, compression: str) -> None:
    with Readers() as readers:
        tally = Tally(readers, tmp_path)
        cut_writes(tally, run(tmp_path, compression, 900, "never"), 40)
    assert tally.wrong == []
    assert sum(tally.cuts.values()) >= 40
    assert not [each for each in tally.unrepaired if each[0] == "large write" and each[1] != UNSURE]


def test_messages_larger_than_all_room_leave_the_file_valid_while_they_are_written(tmp_path: Path) -> None:
    """They have no place in a slot, and overwrite the end of before: nothing may lead there any more."""
    with Readers() as readers:
        tally = Tally(readers, tmp_path)
        cut_writes(tally, run(tmp_path, "", 40, "never", (5, 700_000)), 100)
    assert tally.wrong == []
    assert not [each for each in tally.unrepaired if each[0] == "large write" and each[1] != UNSURE]


@pytest.mark.parametrize("sync", ["strict", "thread"])
def test_a_power_cut_loses_nothing_that_was_synced(tmp_path: Path, sync: str) -> None:
    with Readers() as readers:
        tally = Tally(readers, tmp_path)
        cut_power(tally, run(tmp_path, "", 900, sync), 25)
    assert tally.wrong == []
    if sync == "strict":
        assert not [each for each in tally.unrepaired if each[1] != UNSURE]


def test_the_end_moves_and_no_power_cut_loses_what_was_synced(tmp_path: Path) -> None:
    made, path = run(tmp_path, "", 1700, "thread"), tmp_path / "cut.mcap"

    def numbers(image: bytes | bytearray) -> set[int]:
        path.write_bytes(image)
        with Reader(path) as reader:
            return {each.sequence for each in reader.messages()}

    synced: tuple[bytes, set[int]] = b"", set()
    lost = []
    for image, safe, where in crashes(made, 500):
        if safe != synced[0]:
            synced = bytes(safe), numbers(safe)
        if missing := synced[1] - numbers(image):
            lost.append(f"{where}: {len(missing)} messages")
    assert lost == []
