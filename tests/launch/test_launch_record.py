"""`robolink launch --record`: a recorder is there before the nodes, and its bag is whole in the end."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from robolink.bag.reader import open_bag
from robolink.bag.topic import BagError
from robolink.interfaces.std_msgs.msg import Int32
from robolink.launch.beside import behind, recorder
from robolink.message import decode
from robolink.supervisor import Process
from tests.support.commands import Command
from tests.support.simulations import workspace


def test_processes_wait_for_the_recorder(tmp_path: Path) -> None:
    (waiting,) = behind([Process("talker", ["talker"])])
    assert waiting.rules.held
    assert waiting.rules.awaits == {recorder("").name}
    assert recorder(str(tmp_path / "bag")).argv[-3:-1] == ["-o", str(tmp_path / "bag")]


def test_the_recorder_has_the_keys_of_an_enclave() -> None:
    assert recorder("bag", "/teacher").argv[-2:] == ["--enclave", "/teacher"]
    assert "--enclave" not in recorder("bag").argv


def test_a_folder_that_is_there_is_refused_before_anything_starts(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(BagError, match="exists already"):
        recorder(str(tmp_path))


@pytest.mark.processes
def test_a_launched_system_is_recorded_from_its_first_message_on(tmp_path: Path, domain: int) -> None:
    folder = workspace(tmp_path)
    bag = tmp_path / "bag"
    with Command(domain, "launch", str(folder / "configs" / "talk.yaml"), "--record", str(bag)) as launched:
        launched.wait_for("Subscribed to topic '/heard'")
        deadline = time.monotonic() + 30.0
        while not _numbers(bag) and time.monotonic() < deadline:
            time.sleep(0.05)
        launched.interrupt()
        assert launched.end() == 0
    with open_bag(bag) as opened:
        assert opened.is_whole
    numbers = _numbers(bag)
    assert numbers == list(range(1, len(numbers) + 1))
    assert len(numbers) > 0


def _numbers(bag: Path) -> list[int]:
    with open_bag(bag) as opened:
        return [decode(Int32, bytes(each.data)).data for each in opened.messages(["/chatter"])]
