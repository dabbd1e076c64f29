"""Kills of a process that writes an MCAP file at 10 MB/s: `tests.support.mcap_kills` makes a hundred."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.mcap_kills import kill
from tests.support.mcap_readers import Readers


@pytest.mark.processes
@pytest.mark.parametrize("seconds", [0.0, 0.5])
def test_a_killed_writer_leaves_a_file_that_all_open(tmp_path: Path, seconds: float) -> None:
    with Readers() as readers:
        found = kill(tmp_path / "killed.mcap", seconds, "", readers)
    assert found.wrong == {}
    assert found.messages == 0 or found.lost < 3.0  # 0.3 s where nothing else runs; the first 0.2 s show nothing
