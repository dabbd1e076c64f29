"""Recording of simulated runs: all that is published, in virtual time, and the same bytes for the same seed."""

from __future__ import annotations

import errno
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from robolink.bag.playing.publishers import is_latched
from robolink.bag.reader import open_bag
from robolink.bag.topic import BagError
from robolink.bag.writer import BagWriter
from robolink.interfaces.rcl_interfaces.msg import Log
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.visualization_msgs.msg import MarkerArray
from robolink.message import decode
from robolink.simulate import recording
from tests.support.simulations import simulated, workspace

ROUGH = """
messages:
  - {topic: /chatter, loss: 0.2, duplication: 0.1, latency: 0.05, jitter: 0.05}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return workspace(tmp_path, fails="nodes:\n  - {node: talker, parameters: {fails_at: 21}}\n  - {node: listener}\n")


def test_all_that_is_published_is_recorded_at_its_virtual_time(folder: Path, tmp_path: Path) -> None:
    plain = simulated(folder, seed=3)
    result = simulated(folder, seed=3, record=tmp_path / "bag")
    assert result.hash == plain.hash
    with open_bag(tmp_path / "bag") as bag:
        assert {name: count for name, count in bag.counts.items() if count} == {
            name: count for name, count in result.messages.items() if count
        }
        chatter = list(bag.messages(["/chatter"]))
        assert [decode(Int32, bytes(each.data)).data for each in chatter] == list(range(1, 101))
        assert [each.sequence for each in chatter] == list(range(1, 101))
        begin = chatter[0].log_time
        assert [each.log_time - begin for each in chatter] == [number * 10**8 for number in range(100)]
        assert {each.log_time for each in chatter} == {each.publish_time for each in chatter}
        (topic,) = (each for each in bag.topics if each.name == "/chatter")
        assert topic.message_definition.endswith("int32 data\n")
        assert [each.depth for each in topic.offered_qos] == [10]


@pytest.mark.slow
def test_the_same_seed_gives_the_same_bytes_and_another_one_others(folder: Path, tmp_path: Path) -> None:
    bags = []
    for number, seed in enumerate((3, 3, 4)):
        path = tmp_path / str(number) / "bag"
        simulated(folder, seed=seed, faults=ROUGH, record=path)
        bags.append({each.name: each.read_bytes() for each in sorted(path.iterdir())})
    assert list(bags[0]) == ["bag_0.mcap", "metadata.yaml"]
    assert bags[0] == bags[1]
    assert bags[0]["bag_0.mcap"] != bags[2]["bag_0.mcap"]


def test_lines_of_the_log_have_no_places_which_differ_between_machines(folder: Path, tmp_path: Path) -> None:
    simulated(folder, "fails", record=tmp_path / "bag")
    with open_bag(tmp_path / "bag") as bag:
        lines = [decode(Log, bytes(each.data)) for each in bag.messages(["/rosout"])]
    assert lines
    assert {(each.file, each.function, each.line) for each in lines} == {("", "", 0)}
    assert not any("Traceback" in each.msg for each in lines)


@pytest.mark.slow
def test_the_walls_of_a_simulated_world_are_there_for_viewers(folder: Path, tmp_path: Path) -> None:
    (folder / "configs" / "lab.yaml").write_text("nodes:\n  - {node: world, parameters: {world: lab}}\n")
    bags = []
    for number in range(2):
        path = tmp_path / str(number) / "bag"
        simulated(folder, "lab", record=path)
        bags.append((path / "bag_0.mcap").read_bytes())
        with open_bag(path) as bag:
            floor, walls, objects = (list(bag.messages([f"/world/{name}"])) for name in ("floor", "walls", "objects"))
            assert (len(floor), len(walls)) == (1, 1), "they stand"
            assert walls[0].log_time == bag.start_time
            assert "walls" in {each.ns for each in decode(MarkerArray, bytes(walls[0].data)).markers}
            frames = {each.header.frame_id for each in decode(MarkerArray, bytes(objects[-1].data)).markers if each.ns}
            assert any(each.endswith("base_link") for each in frames)
            times = [each.log_time - bag.start_time for each in objects]
            assert 10 <= len(times) <= 101, "some of them move, and are seen ten times a second at most"
            assert all(later - earlier >= 10**8 for earlier, later in pairwise(times))
            topics = [each for each in bag.topics if each.name.startswith("/world/")]
            assert all(is_latched(each) for each in topics)
    assert bags[0] == bags[1]


def test_a_bag_that_is_there_is_not_overwritten(folder: Path, tmp_path: Path) -> None:
    simulated(folder, record=tmp_path / "bag")
    with pytest.raises(BagError, match="exists already"):
        simulated(folder, record=tmp_path / "bag")


def test_a_full_disk_ends_the_run_with_its_reason_and_the_bag_is_closed(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write, count = BagWriter.write, 0

    def until_it_is_full(self: BagWriter, *arguments: Any) -> None:
        nonlocal count
        count += 1
        if count > 50:
            raise OSError(errno.ENOSPC, "No space left on device")
        write(self, *arguments)

    monkeypatch.setattr(BagWriter, "write", until_it_is_full)
    monkeypatch.setattr(recording, "MOST_WAITING", 100)
    with pytest.raises(OSError, match="No space left"):
        simulated(folder, record=tmp_path / "bag")
    with open_bag(tmp_path / "bag") as bag:
        assert bag.is_whole
        assert sum(bag.counts.values()) == 50
