"""rosbag2_py's recorder and player, as programs of older and newer distributions use them."""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink import Node
from robolink.bag.reader import open_bag
from robolink.companions.rosbag2_py import (
    MessageOrder,
    Player,
    PlayOptions,
    Recorder,
    RecordOptions,
    ServiceRequestsSource,
    StorageOptions,
)
from robolink.companions.rosbag2_py._transport import settings_of
from robolink.interfaces.rosbag2_interfaces.srv import IsPaused
from robolink.interfaces.std_msgs.msg import String
from robolink.qos import QoSProfile
from tests.support.players import START, counting
from tests.support.seen_by_commands import LATCHED, a_node_that_commands_see, latch, spinning

PATIENCE = 30.0


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Node]:
    monkeypatch.chdir(tmp_path)
    counting(tmp_path / "walk", 3)
    with a_node_that_commands_see(monkeypatch) as node, spinning(node):
        yield node


@pytest.fixture
def heard(robot: Node) -> queue.SimpleQueue[str]:
    return listen(robot, "/count")


def listen(robot: Node, topic: str) -> queue.SimpleQueue[str]:
    found: queue.SimpleQueue[str] = queue.SimpleQueue()
    robot.create_subscription(String, topic, lambda message: found.put(message.data), 100)
    return found


def test_a_player_that_was_made_with_its_options_is_steered(robot: Node, heard: queue.SimpleQueue[str]) -> None:
    player = Player(StorageOptions("walk"), PlayOptions(start_paused=True), "warn", "walker")
    assert not player.wait_for_playback_to_start(0)
    player.start_spin()
    player.play()
    assert player.wait_for_playback_to_start()
    paused = robot.create_client(IsPaused, "/walker/is_paused")
    assert paused.wait_for_service(PATIENCE)
    assert paused.call(IsPaused.Request(), timeout_sec=PATIENCE).paused
    assert player.is_paused()
    assert (player.get_starting_time(), player.get_playback_duration()) == (START, 2 * 10**9)
    assert player.play_next()
    assert player.burst(1) == 1
    assert [heard.get(timeout=PATIENCE) for _ in range(2)] == ["0", "1"]
    player.seek(START)
    assert not player.wait_for_playback_to_finish(0)
    assert player.burst(num_messages=3) == 3
    player.resume()
    assert player.wait_for_playback_to_finish(PATIENCE)
    assert [heard.get(timeout=PATIENCE) for _ in range(3)] == ["0", "1", "2"]
    player.stop_spin()


def test_a_player_plays_again_and_stops(robot: Node, heard: queue.SimpleQueue[str]) -> None:
    player = Player([StorageOptions("walk")], PlayOptions(rate=1000.0))
    for _ in range(2):
        player.play()
        assert player.wait_for_playback_to_finish_exclusively(PATIENCE)
        assert [heard.get(timeout=PATIENCE) for _ in range(3)] == ["0", "1", "2"]
    player.pause()
    player.play()
    player.stop()
    assert player.wait_for_playback_to_finish(PATIENCE)


def test_an_older_program_waits_for_the_end(robot: Node) -> None:
    heard = listen(robot, "/other")
    options = PlayOptions()
    options.rate, options.topic_remapping_options = 1000.0, ["--ros-args", "--remap", "/count:=/other"]
    Player("warn").play(StorageOptions("walk"), options)
    assert [heard.get(timeout=PATIENCE) for _ in range(3)] == ["0", "1", "2"]


def test_an_older_program_bursts_until_it_is_cancelled(robot: Node, heard: queue.SimpleQueue[str]) -> None:
    player, options, bursts = Player(), PlayOptions(start_paused=True), queue.SimpleQueue[int]()
    running = threading.Thread(target=lambda: bursts.put(player.burst(StorageOptions("walk"), options, 2)))
    running.start()
    assert [heard.get(timeout=PATIENCE) for _ in range(2)] == ["0", "1"]
    player.cancel()
    running.join(PATIENCE)
    assert bursts.get(timeout=PATIENCE) == 2


def test_options_of_playing_become_settings() -> None:
    options = PlayOptions()
    options.topics_to_filter, options.services_to_filter = ["/scan"], ["/set/_service_event"]
    options.exclude_service_events_to_filter, options.actions_to_filter = ["/get/_service_event"], ["/go"]
    options.clock_publish_on_topic_publish, options.clock_topics = True, ["/scan"]
    options.playback_duration, options.playback_until_timestamp = 5.0, 7
    options.message_order = MessageOrder.SENT_TIMESTAMP
    options.publish_service_requests = True
    options.service_requests_source = ServiceRequestsSource.CLIENT_INTROSPECTION
    options.topic_qos_profile_overrides = {"/scan": QoSProfile(depth=3)}
    found = settings_of(options)
    assert not found.selection.all_topics
    assert (found.selection.topics, found.selection.services, found.selection.actions) == (
        ("/scan",),
        ("/set",),
        ("/go",),
    )
    assert found.selection.exclude_services == ("/get",)
    assert (found.clock_topics, found.clock_rate, found.duration, found.until) == (frozenset({"/scan"}), 0.0, 5.0, 7)
    assert (found.order, found.service_requests) == ("sent", "client_introspection")
    assert found.qos_overrides["/scan"].depth == 3
    options.clock_topics = []
    assert settings_of(options).clock_topics is None
    assert settings_of(PlayOptions()).selection.all_topics
    assert settings_of(PlayOptions()).duration is None


def test_what_cannot_be_played_is_a_runtime_error(robot: Node) -> None:
    with pytest.raises(RuntimeError, match="no bag 'none'"):
        Player(StorageOptions("none"), PlayOptions())
    with pytest.raises(RuntimeError, match="rate: expected"):
        Player().play(StorageOptions("walk"), PlayOptions(rate=0.0))
    with pytest.raises(RuntimeError, match="Player is not initialized"):
        Player().play()
    with pytest.raises(RuntimeError, match="did you mean"):
        Player("wran")


def test_a_recorder_that_was_made_with_its_options_is_steered(robot: Node) -> None:
    latch(robot, "/chatter", String(data="hello"))
    recorder = Recorder(StorageOptions("bag"), RecordOptions(topics=["chatter"], start_paused=True), "warn", "keeper")
    recorder.start_spin()
    recorder.record()
    paused = robot.create_client(IsPaused, "/keeper/is_paused")
    assert paused.wait_for_service(PATIENCE)
    assert paused.call(IsPaused.Request(), timeout_sec=PATIENCE).paused
    assert recorder.is_paused()
    recorder.resume()
    recorder.pause()
    recorder.resume()
    recorder.stop()
    recorder.stop_spin()
    with open_bag("bag") as bag:
        assert [each.name for each in bag.topics] == ["/chatter"]
        assert bag.topics[0].offered_qos[0].depth == LATCHED.depth


def test_what_cannot_be_recorded_is_a_runtime_error(robot: Node) -> None:
    with pytest.raises(RuntimeError, match="nothing is selected"):
        Recorder(StorageOptions("bag"), RecordOptions())
    with pytest.raises(RuntimeError, match="Recorder is not initialized"):
        Recorder().record()
    with pytest.raises(RuntimeError, match="exists already"):
        Recorder("warn").record(StorageOptions("walk"), RecordOptions(all_topics=True))
