"""Hostile files are answered soon, without much memory, and in a line: measured on a process that reads each."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.hostile_files import ALL, ask

SECONDS = 10.0
"""2 s on a machine that does nothing else (`python -m tests.hostile_files` prints it); here other tests run, too."""
CPU_SECONDS = 4.0
"""The same for the time that the process works, which others lengthen less."""
MEGABYTES = 300


@pytest.mark.parametrize("name", ALL)
def test_a_hostile_file_is_answered_soon_and_in_a_line(name: str, tmp_path: Path) -> None:
    if sys.platform == "win32" and ("FIFO" in name or "device" in name):
        pytest.skip("Windows has no FIFOs, and no devices among its files")
    answer = ask(ALL[name], tmp_path)
    assert ALL[name].answer in answer.text
    assert answer.code in (1, 2)
    assert answer.text.count("\n") == ALL[name].lines
    assert len(answer.text) < 300 * (ALL[name].lines + 1)
    assert answer.seconds < SECONDS
    assert answer.cpu < CPU_SECONDS
    assert answer.megabytes < MEGABYTES
