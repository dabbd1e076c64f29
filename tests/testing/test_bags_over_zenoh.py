"""Bags of systems over Zenoh, in real time: recorded while several threads publish, and played into processes."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from robolink.bag.reader import open_bag
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.message import decode
from robolink.qos import HistoryPolicy, QoSProfile
from robolink.testing import System
from tests.support.players import counting

pytestmark = pytest.mark.processes

EVERYTHING = QoSProfile(history=HistoryPolicy.KEEP_ALL)
COUNT = 1500
ECHO = '''
"""Publish on /echo what comes on /count."""

from robolink import Node
from robolink.interfaces.std_msgs.msg import String


class Echo(Node):
    def __init__(self) -> None:
        super().__init__("echo")
        self.echo = self.create_publisher(String, "/echo", 10)
        self.create_subscription(String, "/count", self.echo.publish, 10)
'''


def test_a_bag_is_played_into_processes_and_what_they_do_is_recorded(tmp_path: Path) -> None:
    (tmp_path / "echo.py").write_text(ECHO, encoding="utf-8")
    with System(transport="zenoh") as system:
        system.start(tmp_path / "echo.py")
        echoes = system.messages("/echo")
        recording = system.record(tmp_path / "bag", ["/echo"])
        playback = system.play(counting(tmp_path / "five"), rate=20.0, loop=True)
        system.wait_until(lambda: len(echoes) >= 5 and recording.messages >= 5, 60.0)
        playback.stop()
        system.wait_until(lambda: playback.is_over, 60.0)
        metadata = recording.stop()
    with open_bag(tmp_path / "bag") as bag:
        assert bag.is_whole
        assert bag.metadata.message_count == metadata.message_count >= 5
        said = {decode(String, bytes(each.data)).data for each in bag.messages(["/echo"])}
    assert said == {"0", "1", "2", "3", "4"}


def test_messages_of_many_threads_are_recorded_each_once(tmp_path: Path) -> None:
    with System(transport="zenoh") as system:
        recording = system.record(tmp_path / "bag", ["/a", "/b"])
        names = ("/a", "/b")
        publishers = {name: system.node.create_publisher(Int32, name, EVERYTHING) for name in names}
        threads = [threading.Thread(target=_count, args=(publishers[name],)) for name in names]
        system.wait_until(lambda: all(each._outlets._all[0].matched for each in publishers.values()), 60.0)
        for each in threads:
            each.start()
        while any(each.is_alive() for each in threads):
            assert recording.messages <= 2 * COUNT  # writes, too, while others do
        for each in threads:
            each.join()
        system.wait_until(lambda: recording.messages >= 2 * COUNT, 60.0)
        recording.stop()
    with open_bag(tmp_path / "bag") as bag:
        found = {name: [decode(Int32, bytes(each.data)).data for each in bag.messages([name])] for name in names}
        assert bag.problems == []
    assert {name: sorted(numbers) for name, numbers in found.items()} == {name: list(range(COUNT)) for name in names}


def _count(publisher: object) -> None:
    for number in range(COUNT):
        publisher.publish(Int32(data=number))  # type: ignore[attr-defined]
