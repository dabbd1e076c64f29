"""Bags in tests of systems: recorded, replayed into a node with byte-equal commands, and kept when a test fails."""

from __future__ import annotations

import errno
import hashlib
from pathlib import Path
from typing import Any

import pytest

from robolink.bag.playing import PlayError
from robolink.bag.playing.publishers import is_latched
from robolink.bag.reader import open_bag
from robolink.bag.topic import BagError
from robolink.bag.writer import BagWriter
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.visualization_msgs.msg import MarkerArray
from robolink.message import decode, encode
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.testing import System
from tests.support.players import counting

pytest_plugins = ("pytester",)


@pytest.mark.slow
def test_a_replay_gives_the_same_commands_byte_for_byte(tmp_path: Path) -> None:
    with System(seed=1) as system:
        system.launch("follow")
        recording = system.record(tmp_path / "walk")
        system.run(20.0)
        recording.stop()
    with open_bag(tmp_path / "walk") as bag:
        recorded = [bytes(each.data) for each in bag.messages(["/cmd_vel"])]
        assert bag.counts["/scan"] == 200
        assert all(each.type_hash and each.message_definition and each.offered_qos for each in bag.topics)
    assert len(recorded) == 200

    hashes = set()
    for _ in range(3):
        with System(seed=1) as system:
            system.start("wall_follower")
            commands = system.messages("/cmd_vel")
            playback = system.play(tmp_path / "walk", ["/scan", "/odom"])
            system.run(20.2)
            assert playback.is_over
        given = [encode(each) for each in commands]
        assert given[: len(recorded)] == recorded
        hashes.add(hashlib.sha256(b"".join(given)).hexdigest())
    assert len(hashes) == 1


@pytest.mark.slow
def test_a_bag_shows_the_simulated_world(tmp_path: Path) -> None:
    with System(seed=1) as system:
        system.start("world", parameters={"world": "lab"})
        recording = system.record(tmp_path / "all")
        only = system.record(tmp_path / "only", ["/ada/odom", "/world/walls"])
        system.run(1.0)
        recording.stop()
        only.stop()
        assert not system.node.get_publishers_info_by_topic("/world/walls"), "nobody publishes them in virtual time"
    with open_bag(tmp_path / "all") as bag:
        assert (bag.counts["/world/floor"], bag.counts["/world/walls"]) == (1, 1)
        assert bag.counts["/world/objects"] >= 9, "things move"
        (topic,) = (each for each in bag.topics if each.name == "/world/walls")
        assert is_latched(topic)
        (walls,) = bag.messages(["/world/walls"])
        assert "walls" in {each.ns for each in decode(MarkerArray, bytes(walls.data)).markers}
    with open_bag(tmp_path / "only") as bag:
        assert set(bag.counts) == {"/ada/odom", "/world/walls"}


def test_playing_is_steered_and_remapped(system: System, tmp_path: Path) -> None:
    heard = system.messages("/other")
    playback = system.play(counting(tmp_path / "bag"), remappings={"/count": "/other"}, rate=2.0)
    system.run(0.6)
    playback.pause()
    system.run(5.0)
    assert [each.data for each in heard] == ["0", "1"]
    playback.resume()
    system.run(5.0)
    assert [each.data for each in heard] == ["0", "1", "2", "3", "4"]
    assert system.nodes == ["/rosbag2_player"]
    with pytest.raises(PlayError, match="no topic is selected"):
        system.play(tmp_path / "bag", ["/none"])


def test_recording_begins_with_what_is_latched_and_ends_with_the_system(tmp_path: Path) -> None:
    with System() as system:
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        system.publish("/map", String(data="map"), latched)
        system.run(1.0)
        recording = system.record(tmp_path / "bag", ["map", "/late"])
        system.publish("/late", String(data="late"))
        system.publish("/other", String(data="other"))
        system.run(1.0)
        assert recording.messages == 2
    with open_bag(tmp_path / "bag") as bag:
        assert bag.counts == {"/map": 1, "/late": 1}


def test_a_recording_without_a_path_is_deleted_at_the_end() -> None:
    with System() as system:
        recording = system.record()
        assert recording.path.exists()
    assert not recording.path.exists()


TESTS = """
from robolink.interfaces.std_msgs.msg import Int32, String

def test_fails(system):
    system.publish("/a", String(data="x"))
    system.run(1.0)
    assert False

def test_passes(system):
    system.publish("/a", String(data="x"))
    system.run(1.0)
"""


@pytest.mark.slow
def test_a_failing_test_keeps_its_bag_and_says_where(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(TESTS)
    result = pytester.runpytest_inprocess("--robolink-record", "kept", "-p", "no:cacheprovider")
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(["the bag of this test: kept*test_fails"])
    assert [each.name for each in (pytester.path / "kept").iterdir()] == ["test_fails"]
    with open_bag(pytester.path / "kept" / "test_fails") as bag:
        assert bag.counts["/a"] == 1


def test_a_second_type_of_a_topic_is_left_out_and_told(system: System, tmp_path: Path) -> None:
    said, counted = (system.node.create_publisher(each, "/said", 10) for each in (String, Int32))
    with system.record(tmp_path / "bag", ["/said"]) as recording:
        said.publish(String(data="a"))
        counted.publish(Int32(data=1))
        counted.publish(Int32(data=2))
        system.run(0.1)
        assert recording.messages == 1
    with open_bag(tmp_path / "bag") as bag:
        assert [decode(String, bytes(each.data)).data for each in bag.messages()] == ["a"]


def test_a_full_disk_ends_the_recording_and_not_the_system(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write = BagWriter.write

    def until_it_is_full(self: BagWriter, *arguments: Any) -> None:
        if self.message_count >= 3:
            raise OSError(errno.ENOSPC, "No space left on device", "bag_0.mcap")
        write(self, *arguments)

    monkeypatch.setattr(BagWriter, "write", until_it_is_full)
    with pytest.warns(RuntimeWarning, match="No space left on device"):
        _record_too_much(tmp_path / "bag")
    with open_bag(tmp_path / "bag") as bag:
        assert bag.counts == {"/said": 3}


def _record_too_much(bag: Path) -> None:
    with System() as system:
        publisher = system.node.create_publisher(String, "/said", 10)
        heard = system.messages("/said")
        recording = system.record(bag, ["/said"])
        for number in range(2000):
            publisher.publish(String(data=str(number)))
        system.run(0.1)
        assert heard
        with pytest.raises(BagError, match=r"bag ends early: .*No space left on device"):
            recording.stop()
