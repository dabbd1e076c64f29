"""Readers of MCAP files that others wrote, to count the messages of a file: mcap, rosbags and @mcap/core."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path
from types import TracebackType

from mcap.reader import NonSeekingReader, make_reader
from rosbags.rosbag2 import Reader as RosbagsReader

from robolink.bag.mcap import Reader
from tests.support import node_modules

SCRIPT = node_modules.FOLDER / "read_mcap.cjs"
Found = int | str
"""Number of messages, or the error of a reader that cannot open the file."""


class Readers:
    """All readers, robolink's too, to try them on one file after the other; @mcap/core where node has it.

    Messages are numbered by their sequence. Each reader is to find them without a gap unless `gaps` is set; none may
    find one twice.
    """

    def __init__(self) -> None:
        self.gaps = False
        self.without = node_modules.missing("@mcap/core", "@mcap/support")
        """Why @mcap/core is not among them, '' if it is."""
        self._node: subprocess.Popen[str] | None = None

    def __enter__(self) -> Readers:
        if not self.without:
            self._node = subprocess.Popen(
                node_modules.command(SCRIPT),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
                env=node_modules.environment(),
            )
        return self

    def __exit__(self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None) -> None:
        if self._node is not None:
            self._node.communicate()

    def others(self, path: Path) -> dict[str, Found]:
        """Messages that each of the others finds, by its index and without it. Each is to be in the file's order."""
        found = {"mcap": self._tried(_by_mcap, path), "mcap, linear": self._tried(_linearly, path)}
        found["rosbags"] = self._tried(_by_rosbags, path)
        if self._node is not None:
            assert self._node.stdin is not None
            assert self._node.stdout is not None
            self._node.stdin.write(f"{path}\n")
            self._node.stdin.flush()
            indexed, linear = self._node.stdout.readline().split()
            found["@mcap/core"] = int(indexed) if indexed.isdigit() else indexed
            found["@mcap/core, linear"] = int(linear) if linear.isdigit() else linear
        return found

    def own(self, path: Path) -> Found:
        """Messages that robolink finds: those from the first on, without a gap."""
        return self._tried(_by_robolink, path)

    def _tried(self, read: Callable[[Path], list[int]], path: Path) -> Found:
        try:
            numbers = read(path)
        except Exception as error:
            return f"E:{type(error).__name__}:{str(error)[:80]}"
        if len(set(numbers)) != len(numbers):
            return "E: a message is there twice"
        if numbers != list(range(len(numbers))) and not self.gaps:
            return "E: a message is missing, or at another place"
        return len(numbers)


def _by_robolink(path: Path) -> list[int]:
    with Reader(path) as reader:
        return [each.sequence for each in reader.messages(in_log_order=False)]


def _by_mcap(path: Path) -> list[int]:
    with path.open("rb") as file:
        return sorted(each.sequence for _, _, each in make_reader(file, validate_crcs=True).iter_messages())


def _linearly(path: Path) -> list[int]:
    with path.open("rb") as file:
        found = NonSeekingReader(file, validate_crcs=True).iter_messages(log_time_order=False)
        return [each.sequence for _, _, each in found]


def _by_rosbags(path: Path) -> list[int]:
    """Number the messages, of which rosbags tells no sequence."""
    with RosbagsReader(path) as reader:
        return list(range(sum(1 for _ in reader.messages())))
