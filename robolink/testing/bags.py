"""Bags of a system under test: recorded of it, and played into it."""

from __future__ import annotations

import itertools
import re
import shutil
import tempfile
import threading
import warnings
from collections import deque
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink.bag.topic import BagError, BagTopic, message_definition
from robolink.bag.writer import BagWriter
from robolink.exceptions import OverwrittenError, RobolinkError, WireError
from robolink.interfaces import find_announced
from robolink.logging import get_logger
from robolink.node import Node
from robolink.simulate.scenery import SceneryTrack
from robolink.system import waits
from robolink.system.processes import ROS_DISTRO
from robolink.testing.stage import NodeRequest
from robolink.wire import NO_HASH, unpack_attachment

if TYPE_CHECKING:
    from robolink.bag.metadata import BagMetadata
    from robolink.bag.playing import Player, PlaySettings
    from robolink.bag.playing.playback import Playback
    from robolink.message import Message
    from robolink.testing.recorder import Recorder, Topic
    from robolink.testing.stage import Stage

MOST_WAITING = 1000
"""Messages in virtual time after which they are written."""
PERIOD = 0.05
"""Seconds in real time after which they are written."""
PLAYER = "rosbag2_player"
"""Name of the node that plays a bag."""


class BagRecording:
    """Recording of a system into a bag; nobody in the system sees that there is a listener.

    Times are the system's. Made by `System.record`.

    Args:
        path: Folder of the bag, which must not be there yet.
        recorder: Recorder of the system.
        now: Function that returns the time that a message is noted with, in ns.
        class_of: Function that returns the class of a topic, None if nobody knows it.
        topics: Full names of the topics to record; None is all.
        in_real_time: True where messages come on threads of the network: one of its own then writes them.
        nodes: Function that returns the nodes whose simulated worlds are added as markers.
    """

    def __init__(
        self,
        path: Path,
        recorder: Recorder,
        now: Callable[[], int],
        class_of: Callable[[Topic], type[Message] | None],
        topics: Collection[str] | None = None,
        *,
        in_real_time: bool = False,
        nodes: Callable[[], Iterable[Node]] = tuple,
    ) -> None:
        self.path = path
        """Folder of the bag."""
        self._bag, self._recorder = BagWriter(path, ros_distro=ROS_DISTRO), recorder
        self._now, self._class_of, self._topics = now, class_of, topics
        self._numbers: dict[str, int] = {}
        self._types: dict[str, str] = {}
        self._reported: set[str] = set()
        self._waiting: deque[tuple[Topic, int, Any]] = deque()
        self._metadata: BagMetadata | None = None
        self._failure: Exception | None = None
        self._nodes, self._scenery = nodes, SceneryTrack(self._bag, max(0, now()), topics)
        self._lock = threading.RLock()
        self._ends = threading.Event()
        self._thread = threading.Thread(target=self._run, name="robolink test bag", daemon=True)
        if in_real_time:
            self._thread.start()
        recorder.follow_topics(self._follow)

    @property
    def messages(self) -> int:
        """Number of messages so far."""
        with self._lock:
            self._write()
            return self._bag.message_count

    def stop(self) -> BagMetadata:
        """End the recording, and return the bag's metadata. Safe to call twice.

        Raises BagError (a ValueError) if the bag could not be written to its end, as on a full disk.
        """
        self._ends.set()
        if self._thread.is_alive():
            waits.join(self._thread)
        with self._lock:
            if self._metadata is None:
                self._write()
                self._metadata = self._closed()
        if self._failure is not None:
            raise BagError(f"{self.path} ends early: {self._failure}") from self._failure
        return self._metadata

    def __enter__(self) -> BagRecording:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def _follow(self, topic: Topic) -> None:
        if self._metadata is None and (self._topics is None or topic.name in self._topics):
            self._recorder.arrivals(topic, lambda arrived: self._note(topic, arrived))

    def _note(self, topic: Topic, arrived: Any) -> None:
        if self._ends.is_set():
            return
        now = self._now()
        self._waiting.append((topic, now, arrived))
        self._scenery.look(self._nodes, now)
        if len(self._waiting) >= MOST_WAITING and not self._thread.is_alive():
            self._write()

    def _run(self) -> None:
        """Write the messages that have come, and show them, until the end."""
        while not self._ends.wait(PERIOD):
            with self._lock:
                self._write()
                self._try(self._bag.tick)

    def _write(self) -> None:
        with self._lock:
            while self._waiting:
                each = self._waiting.popleft()
                if self._metadata is None and self._failure is None:
                    self._write_one(*each)
            if self._metadata is None and self._failure is None:
                self._try(self._scenery.write)

    def _write_one(self, topic: Topic, at: int, arrived: Any) -> None:
        if self._is_other(topic):
            return
        try:
            sample = self._recorder.sample_of(arrived)
        except OverwrittenError:  # a large one came too late: its place was used again
            return
        sent, sequence = at, 0
        with suppress(WireError):
            attachment = unpack_attachment(sample.attachment)
            sent, sequence = attachment.timestamp, attachment.sequence
        number = self._numbers[topic.name]
        self._try(lambda: self._bag.write(number, max(0, at), max(0, sent), sequence, bytes(sample.payload)))

    def _is_other(self, topic: Topic) -> bool:
        """Add a topic to the bag; return whether it is there in another type: a bag has one for each."""
        known = self._types.setdefault(topic.name, topic.key)
        if known != topic.key:
            if topic.key not in self._reported:
                self._reported.add(topic.key)
                get_logger("bag").warning(f"topic '{topic.name}': a second type, {topic.type_name}, is not recorded")
            return True
        if topic.name not in self._numbers:
            self._try(lambda: self._numbers.setdefault(topic.name, self._bag.add_topic(self._described(topic))))
        return topic.name not in self._numbers

    def _closed(self) -> BagMetadata:
        self._try(self._bag.close)
        return self._bag.close()

    def _try(self, act: Callable[[], object]) -> None:
        """Act on the bag; what fails ends the recording, and not the system."""
        try:
            act()
        except (BagError, OSError) as error:
            self._failure = self._failure or error

    def _described(self, topic: Topic) -> BagTopic:
        cls: Any = self._class_of(topic)
        if cls is None:
            with suppress(RobolinkError):
                cls = find_announced(topic.type_name)
        stated = "" if topic.type_hash == NO_HASH else topic.type_hash
        text = "" if cls is None else message_definition(cls)
        return BagTopic(topic.name, topic.type_name, "cdr", stated, (topic.token.qos,), text)


class Bags:
    """Recordings and players of a system, which owns this; they end with it."""

    def __init__(self, stage: Stage, recorder: Recorder) -> None:
        self._stage, self._recorder = stage, recorder
        self._recordings: list[tuple[BagRecording, Path | None]] = []
        """Recordings, with the folder to delete if the test passes."""
        self._players: list[Player] = []

    def play(
        self,
        bag: str | PathLike[str],
        topics: Sequence[str] | None,
        exclude: Sequence[str],
        remappings: Mapping[str, str],
        **options: Any,
    ) -> Playback:
        """Play a bag from now on, with these options of PlaySettings."""
        __tracebackhide__ = True
        from robolink.bag.playing import PlaySettings
        from robolink.bag.selection import EVERYTHING, Selection

        chosen = EVERYTHING if topics is None else Selection(topics=self._full(topics))
        selection = chosen._replace(exclude_topics=self._full(exclude))
        player = self._started_player(Path(bag), PlaySettings(selection=selection, **options), remappings)
        self._players.append(player)
        player.start()
        return player.playback

    def _started_player(self, bag: Path, settings: PlaySettings, remappings: Mapping[str, str]) -> Player:
        """Start a node that plays: in memory a program of its own, else in the test's."""
        __tracebackhide__ = True
        from robolink.bag.playing import Player

        if not self._stage.virtual:
            words = [word for old, new in remappings.items() for word in ("-r", f"{old}:={new}")]
            node = Node(PLAYER, context=self._stage.node.context, cli_args=["--ros-args", *words])
            return Player(node, [bag], settings)
        made: list[Player] = []

        class PlayerNode(Node):
            def __init__(self) -> None:
                super().__init__(PLAYER)
                made.append(Player(self, [bag], settings))

        self._stage.start(NodeRequest(PlayerNode, PLAYER, remappings=remappings))
        return made[0]

    def record(self, path: str | PathLike[str] | None, topics: Sequence[str] | None) -> BagRecording:
        """Record into a folder, or into a temporary one that a test that passes deletes."""
        scratch = Path(tempfile.mkdtemp(prefix="robolink-bag-")) if path is None else None
        folder = Path(path) if path is not None else (scratch or Path()) / "bag"
        return self._recorded(folder, scratch, None if topics is None else frozenset(self._full(topics)))

    def record_for_failure(self, folder: Path, test: str) -> BagRecording:
        """Record the test of this name into a bag of its own in `folder`, which is deleted if it passes."""
        numbers = (f"_{number}" if number > 1 else "" for number in itertools.count(1))
        paths = (folder / f"{_folder_name(test)}{number}" for number in numbers)
        path = next(each for each in paths if not each.exists())
        return self._recorded(path, path, None)

    def _recorded(self, path: Path, scratch: Path | None, topics: frozenset[str] | None) -> BagRecording:
        stage = self._stage
        nodes = stage.nodes if stage.virtual else tuple  # in real time worlds publish their markers themselves
        made = BagRecording(
            path, self._recorder, stage.now_ns, stage.class_of, topics, in_real_time=not stage.virtual, nodes=nodes
        )
        self._recordings.append((made, scratch))
        return made

    def _full(self, names: Sequence[str]) -> tuple[str, ...]:
        return tuple(self._stage.node.resolve_topic_name(each) for each in names)

    def keep(self) -> list[Path]:
        """End all recordings and keep their bags, also those that a test that passes would delete; return where."""
        for recording, _ in self._recordings:
            _stop(recording)
        self._recordings = [(each, None) for each, _ in self._recordings]
        return [each.path for each, _ in self._recordings]

    def close(self) -> None:
        """End all players and recordings. Safe to call twice."""
        for player in self._players:
            player.close()
        for recording, scratch in self._recordings:
            _stop(recording)
            if scratch is not None:
                shutil.rmtree(scratch, ignore_errors=True)
        self._players, self._recordings = [], []


def _stop(recording: BagRecording) -> None:
    """End a recording; that its disk is full is a warning, and no reason to leave the rest of the system running."""
    try:
        recording.stop()
    except BagError as error:
        warnings.warn(str(error), RuntimeWarning, stacklevel=2)


def _folder_name(test: str) -> str:
    return re.sub(r"[^\w.-]+", "_", test)[:100].strip("_") or "test"
