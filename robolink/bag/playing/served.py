"""Player with rosbag2's services in its node: what `bag play` runs."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path

from robolink.bag.playing.player import Player
from robolink.bag.playing.services import PlayerServices
from robolink.bag.playing.settings import PlaySettings
from robolink.node import Node
from robolink.wire import EndpointKind

DISCOVERED_WITHIN = 0.2
"""Time in seconds that subscriptions have to find the player before its first message, so that none is missed."""

LAST = 0.1
"""Time in seconds that the publishers stay after the last message, so that it arrives."""


class ServedPlayer:
    """Player that others can steer by services of its node.

    Args:
        node: Node that publishes and serves; an executor has to spin it.
        paths: Bags: folders, or storage files.
        settings: What is played, when and how fast.

    Raises:
        BagError: (a ValueError) if a bag cannot be read.
        PlayError: (a ValueError) if a setting is out of range, or there is nothing to play.
    """

    def __init__(self, node: Node, paths: Sequence[str | Path], settings: PlaySettings) -> None:
        self._node, self.player = node, Player(node, paths, settings)
        self.playback = self.player.playback
        self._services: PlayerServices | None = None

    def start(self) -> None:
        """Begin to play once subscriptions have found the publishers; the second time, play it again."""
        if self._services is not None:
            self.playback.begin()
            return
        self._node.context.graph.endpoints(EndpointKind.SUBSCRIPTION)  # waits until what was there before is known
        time.sleep(DISCOVERED_WITHIN)
        self.player.start()
        self._services = PlayerServices(self._node, self.playback)  # now: `~/play` is for one that does not play

    def close(self) -> None:
        """End the playing, and close the bags. Safe to call twice."""
        if self.player.ended.is_set():
            time.sleep(LAST)
        self.player.close()
