"""Recorder and player in a program under the module name that rosbag2 has for them, and the conversion of bags."""

from __future__ import annotations

import contextlib
import threading
import weakref
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from pathlib import Path

from robolink.bag.converting import convert
from robolink.bag.output_options import read_outputs
from robolink.bag.playing import PlaySettings
from robolink.bag.playing.services import ServedPlayer
from robolink.bag.playing.settings import RECEIVED, SENT
from robolink.bag.reader import open_bag
from robolink.bag.selection import Selection
from robolink.bag.topic import BagError
from robolink.companions.rosbag2_py._recorder import LOOK, Recorder, RecordOptions, Session, level_of, services_of
from robolink.companions.rosbag2_py._storage import StorageOptions
from robolink.exceptions import DocumentError
from robolink.logging import LoggingSeverity
from robolink.qos import QoSProfile
from robolink.system import waits

__all__ = [
    "MessageOrder",
    "PlayOptions",
    "Player",
    "RecordOptions",
    "Recorder",
    "ServiceRequestsSource",
    "bag_rewrite",
]


def bag_rewrite(input_options: Sequence[StorageOptions], output_config_file: str) -> None:
    """Write bags from bags, as `ros2 bag convert` does.

    Args:
        input_options: Bags to read.
        output_config_file: YAML file with `output_bags`.

    Raises:
        BagError: (a RuntimeError) for a bag that cannot be read or made, or a file that is not as it should be.
    """
    with contextlib.ExitStack() as stack:
        try:
            outputs = read_outputs(Path(output_config_file))
        except DocumentError as error:
            raise BagError(str(error)) from None
        convert([stack.enter_context(open_bag(Path(each.uri))) for each in input_options], outputs)


class ServiceRequestsSource(IntEnum):
    """Side of a service whose recorded events a player sends as requests."""

    SERVICE_INTROSPECTION = 0
    CLIENT_INTROSPECTION = 1


class MessageOrder(IntEnum):
    """Time by which a player plays messages."""

    RECEIVED_TIMESTAMP = 0
    SENT_TIMESTAMP = 1


@dataclass
class PlayOptions:
    """Options of a player, under rosbag2's names: times in seconds, `playback_until_timestamp` in nanoseconds.

    Services are named by the topics of their events. What waits for acknowledgements, lends messages, shows progress
    and reads keys in rosbag2 is accepted and has no effect.
    """

    read_ahead_queue_size: int = 1000
    node_prefix: str = ""
    rate: float = 1.0
    topics_to_filter: list[str] = field(default_factory=list)
    services_to_filter: list[str] = field(default_factory=list)
    actions_to_filter: list[str] = field(default_factory=list)
    regex_to_filter: str = ""
    exclude_regex_to_filter: str = ""
    exclude_topics_to_filter: list[str] = field(default_factory=list)
    exclude_service_events_to_filter: list[str] = field(default_factory=list)
    exclude_actions_to_filter: list[str] = field(default_factory=list)
    topic_qos_profile_overrides: dict[str, QoSProfile] = field(default_factory=dict)
    loop: bool = False
    topic_remapping_options: list[str] = field(default_factory=list)
    clock_publish_frequency: float = 0.0
    clock_publish_on_topic_publish: bool = False
    clock_topics: list[str] = field(default_factory=list)
    delay: float = 0.0
    playback_duration: float = -1.0
    playback_until_timestamp: int = -1
    start_paused: bool = False
    start_offset: float = 0.0
    disable_keyboard_controls: bool = False
    progress_bar_update_rate: int = 3
    progress_bar_separation_lines: int = 3
    wait_acked_timeout: int = -1
    disable_loan_message: bool = False
    publish_service_requests: bool = False
    service_requests_source: ServiceRequestsSource = ServiceRequestsSource.SERVICE_INTROSPECTION
    message_order: MessageOrder = MessageOrder.RECEIVED_TIMESTAMP


Bags = StorageOptions | Sequence[StorageOptions]
"""One bag to play, or several, which are merged by their times."""


class Player:
    """Player of bags.

        player = Player(StorageOptions("walk"), PlayOptions())
        player.start_spin()
        player.play()
        player.wait_for_playback_to_finish()

    Older programs make it without options, and `play` and `burst` then take them and block.

    Args:
        storage_options: The bags; in older programs the log level stands here.
        play_options: Topics to play, when and how fast.
        log_level: Level from which its node logs: debug, info, warn, error or fatal.
        node_name: Name of its node.

    Raises:
        RuntimeError: for an unknown level, a bag that cannot be read, or options that are out of range.
    """

    _cancelled = threading.Event()

    def __init__(
        self,
        storage_options: Bags | str | None = None,
        play_options: PlayOptions | None = None,
        log_level: str = "info",
        node_name: str = "rosbag2_player",
    ) -> None:
        if isinstance(storage_options, str):
            log_level, storage_options = storage_options, None
        self._level = level_of(log_level)
        self._made: _Playing | None = None
        Player._cancelled.clear()
        if storage_options is not None:
            self._made = _Playing(storage_options, play_options or PlayOptions(), self._level, node_name)
            weakref.finalize(self, self._made.close)

    def start_spin(self) -> None:
        """Answer the services of its node from now on, on a thread."""
        self._playing.session.start_spin()

    def stop_spin(self) -> None:
        """Answer them no longer."""
        self._playing.session.stop_spin()

    def play(self, storage_options: Bags | None = None, play_options: PlayOptions | None = None) -> None:
        """Start to play; with options here, play until the end, `cancel`, Ctrl-C or the service `~/stop`.

        Args:
            storage_options: The bags, for a player that was made without them.
            play_options: Topics to play, when and how fast.

        Raises:
            RuntimeError: if a bag cannot be read, or there is nothing to play.
        """
        if storage_options is None:
            self._playing.start()
        else:
            self._play(storage_options, play_options or PlayOptions(), None)

    def burst(
        self,
        storage_options: Bags | int | None = None,
        play_options: PlayOptions | None = None,
        num_messages: int = 0,
    ) -> int:
        """Play messages as fast as possible while it pauses, and return their number: `burst(10)`.

        Args:
            storage_options: The bags, for a player that was made without them, which then goes on like `play`; else
                the number of messages.
            play_options: Topics to play; `start_paused` has to be set.
            num_messages: Number of messages; all that are left for 0.

        Raises:
            RuntimeError: as `play` does.
        """
        if storage_options is None or isinstance(storage_options, int):
            return self._playing.served.playback.burst(storage_options or num_messages)
        return self._play(storage_options, play_options or PlayOptions(), num_messages)

    def wait_for_playback_to_start(self, timeout: float = -1.0) -> bool:
        """Wait until `play` was called, `timeout` seconds at most (for ever below 0); True if it was."""
        return waits.wait(self._playing.started, timeout if timeout >= 0 else None)

    def wait_for_playback_to_finish(self, timeout: float = -1.0) -> bool:
        """Wait until all is played, `timeout` seconds at most (for ever below 0); True if it is."""
        return self._playing.served.player.wait(timeout if timeout >= 0 else None)

    wait_for_playback_to_start_exclusively = wait_for_playback_to_start
    wait_for_playback_to_finish_exclusively = wait_for_playback_to_finish

    def stop(self) -> None:
        """End the playing."""
        self._playing.served.playback.stop()

    def pause(self) -> None:
        """Pause."""
        self._playing.served.playback.pause()

    def resume(self) -> None:
        """Go on."""
        self._playing.served.playback.resume()

    def is_paused(self) -> bool:
        """Return whether it pauses."""
        return self._playing.served.playback.is_paused

    def get_starting_time(self) -> int:
        """Return the time of the first message, in nanoseconds since 1970."""
        return self._playing.served.playback.start_time

    def get_playback_duration(self) -> int:
        """Return the length of the bags, in nanoseconds."""
        playback = self._playing.served.playback
        return playback.end_time - playback.start_time

    def play_next(self) -> bool:
        """Play the next message while it pauses; return whether there was one."""
        return self._playing.served.playback.play_next()

    def seek(self, time_point: int) -> None:
        """Go on from a time of the bag, in nanoseconds since 1970; a time that it does not have changes nothing."""
        self._playing.served.playback.seek(time_point)

    @staticmethod
    def cancel() -> None:
        """End each `play` and `burst` of this process that blocks."""
        Player._cancelled.set()

    @property
    def _playing(self) -> _Playing:
        if self._made is None:
            raise BagError("Player is not initialized. Please use constructor with storage and play options.")
        return self._made

    def _play(self, bags: Bags, options: PlayOptions, count: int | None) -> int:
        """Play until something ends it; with a count, so many messages first. Return how many these were."""
        made = _Playing(bags, options, self._level, "rosbag2_player")
        try:
            made.session.start_spin()
            made.start()
            done = 0 if count is None else made.served.playback.burst(count)
            while not (self._cancelled.wait(LOOK) or made.is_over):
                pass
            return done
        finally:
            Player._cancelled.clear()
            made.close()


class _Playing:
    """Player with the session that it is made in."""

    def __init__(self, bags: Bags, options: PlayOptions, level: LoggingSeverity, name: str) -> None:
        self._until = options.playback_until_timestamp
        settings = settings_of(options)
        paths = [each.uri for each in ([bags] if isinstance(bags, StorageOptions) else bags)]
        self.started = threading.Event()
        self.session = Session(name, level, options.topic_remapping_options)
        try:
            self.served = ServedPlayer(self.session.node, paths, settings)
        except BaseException:
            self.session.close()
            raise

    @property
    def is_over(self) -> bool:
        """True once it has ended by itself."""
        return self.served.player.ended.is_set() or self.session.is_over

    def start(self) -> None:
        """Begin to play, also again."""
        self.served.start()
        self.session.node.get_logger().info(f"Playback until timestamp: {self._until}")  # programs wait for this line
        self.started.set()

    def close(self) -> None:
        """End everything. Safe to call twice."""
        self.served.close()
        self.session.close()


def settings_of(options: PlayOptions) -> PlaySettings:
    """Return the settings of a player that options mean. Raises PlayError (a RuntimeError) for what is out of range."""
    asks = options.publish_service_requests
    topics = frozenset(options.clock_topics) or None
    return PlaySettings(
        rate=options.rate,
        loop=options.loop,
        delay=options.delay,
        start_offset=options.start_offset,
        duration=options.playback_duration if options.playback_duration >= 0 else None,
        until=options.playback_until_timestamp if options.playback_until_timestamp >= 0 else None,
        start_paused=options.start_paused,
        selection=selection_of(options),
        qos_overrides=options.topic_qos_profile_overrides,
        clock_rate=max(0.0, options.clock_publish_frequency),
        clock_topics=topics if options.clock_publish_on_topic_publish else frozenset(),
        order=SENT if options.message_order == MessageOrder.SENT_TIMESTAMP else RECEIVED,
        read_ahead=options.read_ahead_queue_size,
        service_requests=ServiceRequestsSource(options.service_requests_source).name.lower() if asks else "",
    ).checked()


def selection_of(options: PlayOptions) -> Selection:
    """Return the selection of topics that options mean: everything, unless something is named."""
    chosen = (options.topics_to_filter, options.services_to_filter, options.actions_to_filter, options.regex_to_filter)
    everything = not any(chosen)
    return Selection(
        all_topics=everything,
        all_services=everything,
        all_actions=everything,
        topics=tuple(options.topics_to_filter),
        services=services_of(options.services_to_filter),
        actions=tuple(options.actions_to_filter),
        regex=options.regex_to_filter,
        exclude_regex=options.exclude_regex_to_filter,
        exclude_topics=tuple(options.exclude_topics_to_filter),
        exclude_services=services_of(options.exclude_service_events_to_filter),
        exclude_actions=tuple(options.exclude_actions_to_filter),
        include_hidden=True,
    )
