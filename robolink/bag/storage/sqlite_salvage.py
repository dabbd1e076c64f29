"""Salvage from damaged sqlite3 databases: the rows of messages that can still be read, in the order of their times."""

from __future__ import annotations

import contextlib
import sqlite3
from array import array
from collections.abc import Collection, Iterator
from pathlib import Path

MOST_GAPS = 1000
"""Most places that cannot be read after which the rest is given up."""
_WIDEST = 40
"""Widest gap that is jumped over, as a power of two of row numbers."""

Row = tuple[int, int, bytes]
"""Number of the topic, time in nanoseconds since 1970, and bytes of a message."""


def allow_cut(database: sqlite3.Connection) -> None:
    """Allow a connection to read a file that is shorter than its header says, for as far as it goes."""
    # sqlite refuses such a file at its first read, except while its schema may be written by hand (btree.c, lockBtree)
    database.execute("PRAGMA writable_schema = ON")


def lost_end(path: Path) -> tuple[bool, int]:
    """Return whether a file is shorter than its header says, and the bytes after the last of its whole pages.

    sqlite takes the lost rest of a page for zeros, and would give messages that end in zeros.
    """
    with path.open("rb") as file:
        header = file.read(100)
    page = int.from_bytes(header[16:18], "big") if len(header) == 100 else 0
    page = 65536 if page == 1 else page
    size, pages = path.stat().st_size, int.from_bytes(header[28:32], "big")
    is_cut = page >= 512 and size < pages * page
    return is_cut, size % page if is_cut else 0


class Salvage:
    """Rows of the table `messages` that can be read, found by their row numbers, without an index.

    Args:
        database: A damaged database, whose table of topics can be read.
    """

    def __init__(self, database: sqlite3.Connection) -> None:
        self._database = database
        ids, stamps, topics = array("q"), array("q"), array("q")
        for id_, topic, stamp, data in self._scan():
            if type(data) is bytes and type(stamp) is int and type(topic) is int:
                ids.append(id_)
                stamps.append(stamp)
                topics.append(topic)
        self._ids, self._stamps, self._topics = ids, stamps, topics
        self._order = sorted(range(len(ids)), key=stamps.__getitem__)

    def __len__(self) -> int:
        return len(self._ids)

    @property
    def start_time(self) -> int:
        """Time of the first message, in nanoseconds since 1970; 0 without any."""
        return self._stamps[self._order[0]] if self._order else 0

    @property
    def end_time(self) -> int:
        """Time of the last message, in nanoseconds since 1970; 0 without any."""
        return self._stamps[self._order[-1]] if self._order else 0

    def counts(self) -> dict[int, int]:
        """Return the number of messages by the number of their topic."""
        return {topic: self._topics.count(topic) for topic in set(self._topics)}

    def rows(self, topics: Collection[int], start: int | None, end: int | None, *, reverse: bool) -> Iterator[Row]:
        """Yield the messages of some topics within a time, in the order of their times."""
        for place in reversed(self._order) if reverse else self._order:
            topic, stamp = self._topics[place], self._stamps[place]
            if topic in topics and (start is None or stamp >= start) and (end is None or stamp < end):
                found = self._database.execute("SELECT data FROM messages WHERE id = ?", (self._ids[place],))
                yield topic, stamp, found.fetchone()[0]

    def _scan(self) -> Iterator[tuple[int, int, int, object]]:
        """Yield the rows that can be read in the order of their numbers, past places that cannot."""
        query = "SELECT id, topic_id, timestamp, data FROM messages NOT INDEXED WHERE id > ? ORDER BY id"
        last = -(2**63)
        for _ in range(MOST_GAPS):
            try:
                for row in self._database.execute(query, (last,)):
                    if row[0] > last:  # a page that was cut has rows of zeros
                        last = row[0]
                        yield row
            except (sqlite3.Error, OverflowError):
                following = self._after(last)
                if following is None:
                    return
                last = following - 1
            else:
                return

    def _after(self, last: int) -> int | None:
        """Return the number of a row that can be read behind a gap; None if there is none."""
        query = "SELECT id, data FROM messages NOT INDEXED WHERE id > ? ORDER BY id LIMIT 1"
        for step in range(_WIDEST):
            with contextlib.suppress(sqlite3.Error, OverflowError):
                found = self._database.execute(query, (last + 2**step,)).fetchone()
                return None if found is None else int(found[0])
        return None
