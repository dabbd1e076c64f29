"""rosbag2's services of a player, and the node that serves them while it plays."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink.bag.playing.playback import TURN
from robolink.bag.playing.player import Player
from robolink.bag.playing.settings import PlayError, PlaySettings
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.interfaces.rosbag2_interfaces.srv import (
    Burst,
    GetRate,
    IsPaused,
    Pause,
    Play,
    PlayNext,
    Resume,
    Seek,
    SetRate,
    Stop,
    TogglePaused,
)
from robolink.node import Node
from robolink.task import Future
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.bag.playing.playback import Playback


BREAK = 0.001
"""Seconds between two turns of a burst."""


class PlayerServices:
    """Services of a player.

    They are `~/play`, `~/pause`, `~/resume`, `~/toggle_paused`, `~/is_paused`, `~/play_next`, `~/burst`, `~/seek`,
    `~/set_rate`, `~/get_rate` and `~/stop`.

    Args:
        node: Node that serves them; an executor has to spin it.
        playback: What they steer.
    """

    def __init__(self, node: Node, playback: Playback) -> None:
        self._node, self._playback = node, playback
        group = self._group = ReentrantCallbackGroup()  # a long burst keeps none of the others waiting
        self._made = [
            node.create_service(Play, "~/play", self._play, callback_group=group),
            node.create_service(Pause, "~/pause", self._pause, callback_group=group),
            node.create_service(Resume, "~/resume", self._resume, callback_group=group),
            node.create_service(TogglePaused, "~/toggle_paused", self._toggle, callback_group=group),
            node.create_service(IsPaused, "~/is_paused", self._is_paused, callback_group=group),
            node.create_service(PlayNext, "~/play_next", self._play_next, callback_group=group),
            node.create_service(Burst, "~/burst", self._burst, callback_group=group),
            node.create_service(Seek, "~/seek", self._seek, callback_group=group),
            node.create_service(SetRate, "~/set_rate", self._set_rate, callback_group=group),
            node.create_service(GetRate, "~/get_rate", self._get_rate, callback_group=group),
            node.create_service(Stop, "~/stop", self._stop, callback_group=group),
        ]

    def destroy(self) -> None:
        """End the services."""
        for each in self._made:
            each.destroy()

    def _play(self, request: Any, response: Any) -> Any:
        length, until = _nanoseconds(request.playback_duration), _nanoseconds(request.playback_until_timestamp)
        # Zero is what a request has where nobody filled it in: then there is no end, as with a negative value.
        response.success = self._playback.begin_at(
            max(0, _nanoseconds(request.start_offset)) / 1e9,
            length / 1e9 if length > 0 else None,
            until if until > 0 else None,
        )
        return response

    def _pause(self, _: Any, response: Any) -> Any:
        self._playback.pause()
        return response

    def _resume(self, _: Any, response: Any) -> Any:
        self._playback.resume()
        return response

    def _toggle(self, _: Any, response: Any) -> Any:
        self._playback.toggle_paused()
        return response

    def _is_paused(self, _: Any, response: Any) -> Any:
        response.paused = self._playback.is_paused
        return response

    def _play_next(self, _: Any, response: Any) -> Any:
        response.success = self._playback.play_next()
        return response

    async def _burst(self, request: Any, response: Any) -> Any:
        """Deliver messages turn by turn, so that other services and Ctrl-C get theirs: a loop may never end."""
        selected, done = request.num_messages, 0
        while not selected or done < selected:
            turn = min(TURN, selected - done) if selected else TURN
            delivered = self._playback.burst(turn, around=bool(selected))
            done += delivered
            if delivered < turn or not self._node.context.ok():
                break
            await self._pause_for_others()
        response.actually_burst = done
        return response

    async def _pause_for_others(self) -> None:
        """Let a millisecond pass, in which the executor serves others."""
        over: Future[None] = Future()
        timer = self._node.create_timer(BREAK, lambda: over.set_result(None), callback_group=self._group)
        try:
            await over
        finally:
            self._node.destroy_timer(timer)

    def _seek(self, request: Any, response: Any) -> Any:
        response.success = self._playback.seek(_nanoseconds(request.time))
        return response

    def _set_rate(self, request: Any, response: Any) -> Any:
        try:
            self._playback.set_rate(request.rate)
        except PlayError as error:
            self._node.get_logger().warning(str(error))
            response.success = False
        else:
            response.success = True
        return response

    def _get_rate(self, _: Any, response: Any) -> Any:
        response.rate = self._playback.rate
        return response

    def _stop(self, _: Any, response: Any) -> Any:
        self._playback.stop()
        return response


def _nanoseconds(stamp: Any) -> int:
    return int(stamp.sec) * 10**9 + int(stamp.nanosec)


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
