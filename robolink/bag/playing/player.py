"""Player of bags: publishes their messages again, and /clock, in the name of a node."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from pathlib import Path

from robolink.bag.playing.pacing import pacer
from robolink.bag.playing.playback import Playback, Playlist
from robolink.bag.playing.publishers import Publishers, Requests
from robolink.bag.playing.settings import PlaySettings
from robolink.bag.reader import open_bag
from robolink.bag.topic import BagMessage
from robolink.exceptions import RobolinkError
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.node import Node
from robolink.qos import QoSProfile, ReliabilityPolicy
from robolink.system import waits
from robolink.time import Time
from robolink.time_source import CLOCK_TOPIC

CLOCK_QOS = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)


class Player:
    """Player of one or several bags, which are merged by their times.

        player = Player(node, ["walk"], PlaySettings(rate=2.0))
        player.start()
        player.wait()
        player.close()

    In real time it has a thread of its own; in virtual time it goes by a timer of the node, which then must be spun.
    `playback` pauses, seeks, steps and stops it.

    Args:
        node: Node that publishes; its remappings count.
        paths: Bags: folders, or storage files.
        settings: What is played, when and how fast.
        on_end: Called once after the last message, on the thread that plays.

    Raises:
        BagError: (a ValueError) if a bag cannot be read, or two have different types for one topic.
        PlayError: (a ValueError) if a setting is out of range, or there is nothing to play.
    """

    def __init__(
        self,
        node: Node,
        paths: Sequence[str | Path],
        settings: PlaySettings | None = None,
        on_end: Callable[[], object] = lambda: None,
    ) -> None:
        self.settings = settings = (settings or PlaySettings()).checked()
        self.ended = threading.Event()
        """Set after the last message, or after `stop`."""
        self._node, self._on_end, self._time = node, on_end, node.context.time
        self._bags = [open_bag(each) for each in paths]
        try:
            selection = settings.selection
            if settings.publishes_clock:
                selection = selection._replace(exclude_topics=(*selection.exclude_topics, CLOCK_TOPIC))
            self.playlist = Playlist(self._bags, selection, settings.order, settings.read_ahead).checked()
            warn = node.get_logger().warning
            self._look_at_offset(warn)
            topics, source = list(self.playlist.topics.values()), settings.service_requests
            published = [each for each in topics if not (source and each.is_service_event)]
            self._publishers = Publishers(node, published, settings.qos_overrides, warn)
            self._requests = Requests(node, topics, source, warn) if source else None
        except BaseException:
            self._close_bags()
            raise
        self._clock = node.create_publisher(Clock, CLOCK_TOPIC, CLOCK_QOS) if settings.publishes_clock else None
        self._tick = round(1e9 / settings.clock_rate) if settings.clock_rate else 0
        self._next_tick = self._time.steady()
        self.playback = Playback(self.playlist, self._deliver, self._time.steady, settings, self._wake)
        self._pacer = pacer(node, self._advance)

    @property
    def problems(self) -> list[str]:
        """One line for each part of the bags that cannot be read, as far as it was tried."""
        return [line for bag in self._bags for line in bag.problems]

    def start(self) -> None:
        """Begin to play."""
        self._next_tick = self._time.steady()
        self.playback.begin()
        self._pacer.start()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait in real time, `timeout` seconds at most, until everything is played; True if it is."""
        return waits.wait(self.ended, timeout)

    def close(self) -> None:
        """End the playing, the publishers and the bags. Safe to call twice."""
        self.playback.stop()
        self._pacer.close()
        self._publishers.destroy()
        if self._requests is not None:
            self._requests.destroy()
        if self._clock is not None:
            self._clock.destroy()
        self._close_bags()

    def _look_at_offset(self, warn: Callable[[str], object]) -> None:
        offset, length = self.settings.start_offset, (self.playlist.end_time - self.playlist.start_time) / 1e9
        if offset > length:
            warn(f"the start offset of {offset:g} s is behind the end: the bag is {length:g} s long")

    def _close_bags(self) -> None:
        for each in self._bags:
            each.close()

    def _wake(self) -> None:
        if not self.playback.is_over:
            self.ended.clear()
        self._pacer.wake()

    def _advance(self) -> int | None:
        """Publish what is due; return when to come again."""
        try:
            tick = self._ticked() if self._tick else None
            due = self.playback.advance()
        except (RobolinkError, OSError) as error:  # the network has ended, or the bag's disk is gone
            tick = due = None
            self.playback.stop()
            if self._node.context.ok():
                self._node.get_logger().error(f"playing ends: {error}")
        if self.playback.is_over:
            if not self.ended.is_set():
                self.ended.set()
                self._on_end()
            return None
        if due is None or tick is None:
            return due if tick is None else tick
        return min(due, tick)

    def _ticked(self) -> int:
        """Publish /clock if it is due; return when it is due again."""
        now = self._time.steady()
        if now >= self._next_tick:
            self._tell_time(self.playback.time)
            self._next_tick += self._tick * (1 + (now - self._next_tick) // self._tick)
        return self._next_tick

    def _tell_time(self, time: int) -> None:
        assert self._clock is not None
        self._clock.publish(Clock(clock=Time(nanoseconds=time).to_msg()))

    def _deliver(self, message: BagMessage, time: int) -> None:
        topics = self.settings.clock_topics
        if topics is None or message.topic in topics:
            self._tell_time(time)
        if not self._publishers.publish(message.topic, message.data) and self._requests is not None:
            self._requests.send(message.topic, message.data)
