"""Base of a system under test that plays bags into it and records it."""

from __future__ import annotations

import itertools
import re
import shutil
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from robolink.bag.topic import BagError
from robolink.node import Node
from robolink.testing.bags import BagRecording
from robolink.testing.stage import Wanted
from robolink.testing.system_base import SystemBase

if TYPE_CHECKING:
    from robolink.bag.playing import Player, PlaySettings
    from robolink.bag.playing.playback import Playback


class SystemWithBags(SystemBase):
    """A system with recordings and players of bags, which end with it."""

    _recordings: tuple[tuple[BagRecording, Path | None], ...] = ()
    """Recordings, with the folder to delete if the test passes."""
    _players: tuple[Player, ...] = ()

    def play(
        self,
        bag: str | PathLike[str],
        topics: Sequence[str] | None = None,
        *,
        exclude: Sequence[str] = (),
        rate: float = 1.0,
        start_offset: float = 0.0,
        duration: float | None = None,
        loop: bool = False,
        clock: float = 0.0,
        remappings: Mapping[str, str] | None = None,
    ) -> Playback:
        """Play a bag into the system, by a node ``rosbag2_player``, from now on while time passes.

        In virtual time the messages keep their distances to the nanosecond, so that each run is the same.

        Args:
            bag: The bag: a folder, or one .mcap or .db3 file.
            topics: Topics to play; None is all.
            exclude: Topics to leave out.
            rate: Seconds of the bag in a second of the system.
            start_offset: Point of the bag to begin at, in seconds from its start.
            duration: Length of what is played, in seconds of the bag; None is all.
            loop: True to begin again at the end.
            clock: Messages on /clock in a second, for nodes with `use_sim_time`; 0 for none.
            remappings: New names by old names, as ``{"/scan": "/front/scan"}``.

        Returns:
            The playback, to `pause`, `resume`, `seek`, `play_next` or `stop`; `is_over` is true after its end.

        Raises:
            BagError: (a ValueError) if the bag cannot be read.
            PlayError: (a ValueError) if a value is out of range, or nothing is selected.
        """
        __tracebackhide__ = True
        from robolink.bag.playing import PlaySettings
        from robolink.bag.selection import EVERYTHING, Selection

        self._check_open()
        chosen = EVERYTHING if topics is None else Selection(topics=self._full(topics))
        settings = PlaySettings(
            rate=rate,
            loop=loop,
            start_offset=start_offset,
            duration=duration,
            selection=chosen._replace(exclude_topics=self._full(exclude)),
            clock_rate=clock,
        )
        player = self._started_player(Path(bag), settings, remappings or {})
        self._players += (player,)
        player.start()
        self._begin()
        return player.playback

    def record(self, path: str | PathLike[str] | None = None, topics: Sequence[str] | None = None) -> BagRecording:
        """Record the system into a bag from now on, until `stop` of what is returned, or the end of the system.

        Nobody in the system sees it. The bag of a test that fails is kept, and the failure says where.

        Args:
            path: Folder of the bag, which must not be there yet. None makes one, which a test that passes deletes.
            topics: Topics to record; None is all.

        Returns:
            The recording: `path`, `messages` and `stop()`; also for a `with`.

        Raises:
            BagError: (a ValueError) if the folder is there already.
            OSError: if it cannot be made.
        """
        __tracebackhide__ = True
        self._check_open()
        scratch = Path(tempfile.mkdtemp(prefix="robolink-bag-")) if path is None else None
        folder = Path(path) if path is not None else (scratch or Path()) / "bag"
        return self._recorded(folder, scratch, None if topics is None else frozenset(self._full(topics)))

    def record_for_failure(self, folder: Path, test: str) -> BagRecording:
        """Record a test into a bag of its own, which is deleted if it passes.

        Args:
            folder: Folder for the bags of tests.
            test: Name of the test.
        """
        numbers = (f"_{number}" if number > 1 else "" for number in itertools.count(1))
        paths = (folder / f"{folder_name(test)}{number}" for number in numbers)
        path = next(each for each in paths if not each.exists())
        return self._recorded(path, path, None)

    def keep_bags(self) -> list[Path]:
        """End all recordings and keep their bags, also those that a test that passes would delete; return where."""
        for recording, _ in self._recordings:
            _stop(recording)
        self._recordings = tuple((each, None) for each, _ in self._recordings)
        return [each.path for each, _ in self._recordings]

    def close(self) -> None:
        """End all programs and release everything. Safe to call twice."""
        for player in self._players:
            player.close()
        for recording, scratch in self._recordings:
            _stop(recording)
            if scratch is not None:
                shutil.rmtree(scratch, ignore_errors=True)
        self._players = self._recordings = ()
        super().close()

    def _recorded(self, path: Path, scratch: Path | None, topics: frozenset[str] | None) -> BagRecording:
        made = BagRecording(
            path, self.story.recorder, self._stage.now_ns, self._stage.class_of, topics, in_real_time=not self.virtual
        )
        self._recordings += ((made, scratch),)
        return made

    def _full(self, names: Sequence[str]) -> tuple[str, ...]:
        return tuple(self.node.resolve_topic_name(each) for each in names)

    def _started_player(self, bag: Path, settings: PlaySettings, remappings: Mapping[str, str]) -> Player:
        """Start a node that plays: in memory a program of its own, else in the test's."""
        __tracebackhide__ = True
        from robolink.bag.playing import Player

        if not self.virtual:
            words = [word for old, new in remappings.items() for word in ("-r", f"{old}:={new}")]
            return Player(Node(NAME, context=self.node.context, cli_args=["--ros-args", *words]), [bag], settings)
        made: list[Player] = []

        class PlayerNode(Node):
            def __init__(self) -> None:
                super().__init__(NAME)
                made.append(Player(self, [bag], settings))

        self._stage.start(Wanted(PlayerNode, NAME, remappings=remappings))
        return made[0]


def _stop(recording: BagRecording) -> None:
    """End a recording; that its disk is full is a warning, and no reason to leave the rest of the system running."""
    try:
        recording.stop()
    except BagError as error:
        warnings.warn(str(error), RuntimeWarning, stacklevel=2)


NAME = "rosbag2_player"


def folder_name(test: str) -> str:
    """Return a test's name as that of a folder."""
    return re.sub(r"[^\w.-]+", "_", test)[:100].strip("_") or "test"
