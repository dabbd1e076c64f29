"""Recording of a bag: listens to the topics of a selection and writes what is published into a bag."""

from __future__ import annotations

import functools
import threading
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.bag.reader import open_bag
from robolink.bag.recording.listener import Collector, Listener, SimClock, Switch
from robolink.bag.recording.topics import Arrived, Definitions, RecordedTopic, RecordSettings
from robolink.bag.recording.writing import Cache, WritableBag, Writing
from robolink.bag.selection import Selection
from robolink.bag.writer import BagWriter
from robolink.exceptions import RobolinkError
from robolink.graph.endpoint import ALL_BEST_EFFORT, timed_arrival
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.message import type_hash, type_name
from robolink.system import clocks, waits
from robolink.time_source import CLOCK_TOPIC
from robolink.wire import DataKey, format_key

if TYPE_CHECKING:
    from robolink.node import Node

WITHIN = 10.0
"""Longest wait for the writer to split or to write a snapshot, in seconds."""


class RecordingError(RobolinkError, RuntimeError):
    """A recording is used before its start or after its end."""


class Figures(NamedTuple):
    """State of a recording."""

    path: Path
    seconds: float
    """Time since the start, in seconds of this computer."""
    messages: int
    """Number of messages in the bag."""
    bytes: int
    """Bytes of those messages."""
    topics: int
    """Number of topics in the bag."""
    dropped: dict[str, int]
    """Number of messages that came and had no room, by topic; only topics with some."""
    lost: dict[str, int]
    """Number of messages that were published and did not come, by topic; only topics with some."""
    paused: bool
    waiting: int
    """Bytes of messages that wait to be written."""
    error: str
    """Reason why the recording has ended by itself, '' if it has not."""


class News(NamedTuple):
    """Callbacks of a recording, on threads of its own; they must not wait for it."""

    info: Callable[[str], object] = lambda text: None
    """Called with what happens: topics that are subscribed to, pauses."""
    warn: Callable[[str], object] = lambda text: None
    """Called with what is wrong and does not end it."""
    failed: Callable[[str], object] = lambda text: None
    """Called once when it ends by itself, since the bag cannot be written any more."""
    split: Callable[[Path, Path], object] = lambda closed, opened: None
    """Called with the file that was closed and the one that was begun."""


class Recording:
    """Recorder of topics to a bag, with the services of no node: those are `RecorderServices`.

        recording = Recording(node, "lap", Selection(all_topics=True))
        recording.start()
        ...
        recording.stop()

    Args:
        node: Node in whose name topics are subscribed to; nobody needs to spin it.
        path: Folder of the bag, which must not be there yet.
        selection: Topics to record.
        settings: How to record them.
        news: Callbacks.
        make_bag: Maker of the bag's writer.
    """

    def __init__(
        self,
        node: Node,
        path: str | Path,
        selection: Selection,
        settings: RecordSettings | None = None,
        news: News | None = None,
        *,
        make_bag: Callable[[Path, RecordSettings], WritableBag] | None = None,
    ) -> None:
        self.path = Path(path)
        self.settings = settings = settings or RecordSettings()
        self._selection, self._news = selection.checked(), news or News()
        self._node, self._context = node, node.context
        self._make_bag = make_bag or open_writer
        self._cache = Cache(
            settings.max_cache_size, round(settings.max_cache_duration * 1e9), is_ring=settings.snapshot_mode
        )
        self._collector = Collector(
            self._context.transport.read, self._cache, self._begin if settings.use_sim_time else None
        )
        self._collector.paused = self._paused = settings.start_paused
        self._arrival = timed_arrival(self._collector.queue.put, clocks.now)
        self._definitions = Definitions(self._context, self._on_definition, self._news.warn)
        self._listener = Listener(node, self._selection, settings, self._arrival, self._on_topic, self._news.warn)
        self._writing: Writing | None = None
        self._clock: Any = None
        self._paused_at = 0
        self._state = threading.Lock()
        self._began = self._took = 0.0
        self._error = ""
        self._reported: dict[str, tuple[int, int]] = {}

    # Life

    def start(self) -> None:
        """Make the bag and listen.

        Raises BagError (a ValueError) or OSError if the bag cannot be made, RecordingError (a RuntimeError) the second
        time.
        """
        with self._state:
            if self._began:
                raise RecordingError(f"{self.path}: a recording starts once; make another one")
            bag = self._make_bag(self.path, self.settings)
            self._began = clocks.monotonic()
        self._writing = Writing(bag, self._cache, self._now, self._news.split, self._fail, self._tell_of_losses)
        self._writing.start()
        self._collector.start()
        if self.settings.use_sim_time:
            self._news.info("use_sim_time set, waiting for /clock before starting recording...")
            key = format_key(DataKey(self._context.get_domain_id(), CLOCK_TOPIC, type_name(Clock), type_hash(Clock)))
            sink = functools.partial(self._arrival, SimClock())
            self._clock = self._context.transport.subscribe(key, ALL_BEST_EFFORT, sink)
        else:
            self._listen()

    def stop(self) -> Any:
        """End the subscriptions, write all that has come and close the bag; return its metadata. Safe to call twice."""
        with self._state:
            writing = self._writing
            if writing is None or self._took:
                return writing and writing.metadata
            self._took = clocks.monotonic() - self._began
        self._listener.close()
        if self._clock is not None:
            self._clock.close()
        self._collector.close()
        self._definitions.close()
        writing.close()
        self._tell_of_losses()
        if self._error:
            writing.messages = _messages_in(self.path)
        return writing.metadata

    def _begin(self) -> None:
        self._news.info("Sim time /clock found, starting recording.")
        self._listen()

    def _listen(self) -> None:
        self._listener.start()
        self._definitions.start()  # now that all publishers of what is there are known: a bag has their profiles

    def _now(self) -> int:
        sim_time = self._collector.sim_time
        return clocks.now() if sim_time is None else sim_time

    # What is asked of it

    @property
    def has_started(self) -> bool:
        """True once there is a bag."""
        return self._writing is not None

    @property
    def is_running(self) -> bool:
        """True from the start until `stop`, or until the bag can no longer be written."""
        return self._writing is not None and not self._took and not self._error

    @property
    def is_discovering(self) -> bool:
        """True while topics that appear are recorded, too."""
        return self.is_running and (self._listener.discovers or self._is_before_clock)

    @property
    def is_paused(self) -> bool:
        """True while messages are let pass."""
        return self._paused

    def start_discovery(self) -> None:
        """Record topics that appear from now on, too. Raises RecordingError if it does, or nothing is recorded."""
        self._running()
        if self.is_discovering:
            raise RecordingError("Discovery is already running.")
        self._listener.discover()

    def stop_discovery(self) -> None:
        """Record no topics but those that are there. Raises RecordingError if it does, or while it waits for /clock."""
        if self._is_before_clock:
            raise RecordingError("Discovery begins with the first message on /clock.")
        if not self.is_discovering:
            raise RecordingError("Discovery is not running.")
        self._listener.stop_discovery()

    def pause(self) -> None:
        """Let messages pass from now on."""
        if not self._paused:
            self._paused, self._paused_at = True, self._now()
            self._keep_latched()
            self._arrival(Switch(True, lambda: None), None)
            self._news.info("Pausing recording.")

    def resume(self) -> None:
        """Record again; what was latched meanwhile, or before a start in pause, comes first."""
        writing = self._writing
        if self._paused and writing is not None:
            self._paused = False
            self._arrival(Switch(False, lambda: writing.do(self._write_latched)), None)
            self._news.info("Resuming recording.")

    def toggle_paused(self) -> None:
        """Pause, or record again."""
        (self.resume if self.is_paused else self.pause)()

    def split(self) -> None:
        """Close the file and begin the next one. Raises RecordingError when there is no recording."""
        self._do(self._running().split)

    def snapshot(self) -> bool:
        """Write the messages of the cache into the bag; False if it was not started in snapshot mode or has nothing.

        Raises RecordingError when there is no recording.
        """
        writing = self._running()
        if not self.settings.snapshot_mode:
            return False
        taken = self._cache.take_ring()
        self._do(functools.partial(writing.write_snapshot, taken))
        return bool(taken)

    def figures(self) -> Figures:
        """Return its state."""
        writing, topics = self._writing, list(self._listener.topics.values())
        seconds = self._took or (clocks.monotonic() - self._began if self._began else 0.0)
        return Figures(
            self.path,
            seconds,
            writing.messages if writing is not None else 0,
            writing.bytes if writing is not None else 0,
            len(writing.topics) if writing is not None else 0,
            {each.name: each.dropped for each in topics if each.dropped},
            {each.name: each.lost for each in topics if each.lost > 0},
            self.is_paused,
            self._cache.held,
            self._error,
        )

    @property
    def _is_before_clock(self) -> bool:
        return self.settings.use_sim_time and self._collector.sim_time is None

    def _running(self) -> Writing:
        if self._writing is None or self._took or self._error:
            raise RecordingError(f"{self.path}: nothing is being recorded")
        return self._writing

    def _do(self, command: Callable[[], object]) -> None:
        waits.result(self._running().do(command), WITHIN)

    # News of its threads

    def _on_topic(self, topic: RecordedTopic) -> None:
        self._news.info(f"Subscribed to topic '{topic.name}'")
        depth = self.settings.repeat_latched.get(topic.name, 0)
        if depth or (topic.is_latched and (self.settings.repeat_all_latched or self.is_paused)):
            topic.keep(depth or topic.latched_depth)
        self._definitions.look_up(topic)

    def _on_definition(self, topic: RecordedTopic, text: str) -> None:
        if self._writing is not None:
            self._writing.do(functools.partial(self._writing.add_topic, topic, text))

    def _keep_latched(self) -> None:
        for topic in list(self._listener.topics.values()):
            if topic.retained is None and topic.is_latched:
                topic.keep(topic.latched_depth)

    def _write_latched(self) -> None:
        """Write the messages that were latched in the pause, on the writer's thread."""
        assert self._writing is not None
        now = self._now()
        for topic in list(self._listener.topics.values()):
            retained: list[Arrived] = [each for each in list(topic.retained or ()) if each.log_time >= self._paused_at]
            if topic.is_latched:
                self._writing.write_again(retained, now)
            if not (self.settings.repeat_all_latched or topic.name in self.settings.repeat_latched):
                topic.retained = None

    def _fail(self, reason: str) -> None:
        self._error = reason
        self._collector.paused = True  # what comes now is not dropped for want of speed
        self._news.failed(reason)

    def _tell_of_losses(self) -> None:
        """Warn of what was dropped and lost since the last warning: each topic in one line."""
        for topic in list(self._listener.topics.values()):
            dropped, lost = self._reported.get(topic.name, (0, 0))
            self._reported[topic.name] = topic.dropped, max(lost, topic.lost)
            if topic.dropped > dropped:
                self._news.warn(
                    f"{topic.name}: {topic.dropped - dropped} messages dropped, {topic.dropped} in all: they come"
                    f" faster than they can be written (the cache of {self.settings.max_cache_size:,} bytes is full)"
                )
            if topic.lost > lost:
                self._news.warn(
                    f"{topic.name}: {topic.lost - lost} messages lost on the way, {topic.lost} in all: the network did"
                    " not bring them"
                )


def _messages_in(path: Path) -> int:
    """Count the messages of a bag whose disk failed: the last ones that were written may not be there."""
    try:
        with open_bag(path) as bag:
            return sum(bag.counts.values())
    except (RobolinkError, OSError):
        return 0


def open_writer(path: Path, settings: RecordSettings) -> WritableBag:
    """Make the bag of a recording."""
    return BagWriter(
        path,
        storage=settings.storage,
        compression=settings.compression,
        compression_mode=settings.compression_mode,
        max_size=settings.max_bag_size,
        max_duration=settings.max_bag_duration,
        max_files=settings.max_bag_files,
        custom_data=settings.custom_data,
    )
