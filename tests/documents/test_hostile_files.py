"""Hostile files are answered soon, without much memory, and in a line: measured on a process that reads each."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from tests.support.hostile_files import ALL, Hostile, ask

pytestmark = pytest.mark.processes

CPU_SECONDS = 4.0
"""Most processor time of one answer, in seconds: 2 where nothing else runs, and other tests lengthen it a little."""
SECONDS = 45.0
"""Most time of one answer, in seconds: nothing waits for ever. Other work of the machine lengthens it at will."""
MEGABYTES = 300
"""Most memory of one answer, in MB."""


@pytest.mark.parametrize(
    "name", [pytest.param(each, marks=pytest.mark.annex("webots") if each.startswith("Webots") else ()) for each in ALL]
)
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


def _files(folder: Path) -> None:
    for part in ("nodes", "configs"):
        (folder / part).mkdir()
    (folder / "nodes/nests.py").write_text("-" * 150_000 + "1")
    (folder / "nodes/large.py").write_text("a=1;" * 1_000_000)
    if sys.platform != "win32":
        os.mkfifo(folder / "nodes/fifo.py")


def test_a_list_of_nodes_has_those_that_cannot_be_read(tmp_path: Path) -> None:
    answer = ask(Hostile(_files, ("run", "--list"), ""), tmp_path)
    assert answer.code == 0
    unread = [line.split()[0] for line in answer.text.splitlines() if line.endswith("(cannot be read)")]
    assert unread == [*([] if sys.platform == "win32" else ["fifo"]), "large", "nests"]
    assert answer.seconds < SECONDS
    assert answer.megabytes < MEGABYTES
