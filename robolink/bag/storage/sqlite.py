"""Storage in sqlite3 databases (.db3), the default of rosbag2 until Humble: schemas 1 to 4."""

from __future__ import annotations

import contextlib
import itertools
import os
import shutil
import sqlite3
import tempfile
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import Any

from robolink.bag.metadata import BagMetadata, parse_metadata, spell_metadata
from robolink.bag.qos import profiles_or_none, text_of
from robolink.bag.storage.base import StorageReader, StorageWriter, Written
from robolink.bag.storage.sqlite_salvage import Salvage, allow_cut, lost_end
from robolink.bag.topic import BagError, BagMessage, BagTopic
from robolink.system import clocks
from robolink.system.processes import ROS_DISTRO

MAGIC = b"SQLite format 3\0"
SCHEMA_VERSION = 4

_SCHEMA = """
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
    serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL,
    encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
    data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
"""
LONGEST_TEXT = 16 << 20
"""Length of the longest name, definition or metadata that is read, in bytes."""
SORTED_WHOLE = 1 << 20
"""Size in bytes up to which messages are sorted with their data; of larger ones sqlite would hold several copies."""
_COMMIT_AFTER = 0.25
"""Longest time, in seconds, after which written messages are committed."""


class SqliteReader(StorageReader):
    """Reader of a .db3 file; of a damaged one it reads what can be read.

    Raises:
        BagError: if it is not a database of a bag, or none whose topics can be read.
    """

    identifier = "sqlite3"

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self._strange = 0
        self._damage = ""
        self._salvaged: Salvage | None = None
        self._opened = contextlib.ExitStack()
        try:
            file, is_cut = self._without_cut_page(path)
            self._database = self._opened.enter_context(contextlib.closing(_opened(file, path, is_cut)))
            with self._errors():
                self._read_topics()
                try:
                    self._read_summary()
                except sqlite3.DatabaseError as error:
                    self._salvage(error)
        except BagError:
            self.close()
            raise

    def _without_cut_page(self, path: Path) -> tuple[Path, bool]:
        """Return a file, or a copy without a last page of which a part is left, and whether its end is lost."""
        try:
            is_cut, rest = lost_end(path)
            if not rest:
                return path, is_cut
            made = tempfile.TemporaryDirectory(prefix="robolink-bag-", ignore_cleanup_errors=True)
            folder = self._opened.enter_context(made)
            copy = Path(shutil.copyfile(path, Path(folder) / path.name))
            os.truncate(copy, copy.stat().st_size - rest)
        except OSError as error:
            raise BagError(f"{path} cannot be read: {error.strerror}") from None
        return copy, is_cut

    @property
    def is_damaged(self) -> bool:
        """True if only a part of the messages could be read, as far as it was tried."""
        return self._salvaged is not None

    def _salvage(self, error: sqlite3.Error) -> Salvage:
        """Find what of a damaged file can be read, and take its times."""
        if self._salvaged is None:
            self._damage, self._salvaged = str(error), Salvage(self._database)
            self.message_count = len(self._salvaged)
            self.start_time, self.end_time = self._salvaged.start_time, self._salvaged.end_time
        return self._salvaged

    def _read_topics(self) -> None:
        """Read what the file says before its messages."""
        columns = {row[1] for row in self._database.execute("PRAGMA table_info(topics)")}
        tables = {row[0] for row in self._database.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
        if not {"topics", "messages"} <= tables:
            raise BagError(f"{self.path} is a sqlite3 database, but no bag: it lacks the tables topics and messages")
        definitions = self._definitions() if "message_definitions" in tables else {}
        query = ", ".join(_short(_column(columns, name)) for name in _COLUMNS)
        rows = self._database.execute(f"SELECT id, {query} FROM topics ORDER BY id").fetchall()
        self._ids = [row[0] for row in rows]
        self.topics = [_topic(row, definitions) for row in rows]
        self.metadata = self._metadata() if "metadata" in tables else None

    def _read_summary(self) -> None:
        """Read the number of messages and their times, which the ends of table and index have."""
        self.message_count = self._number("SELECT MAX(id) FROM messages")
        self.start_time, self.end_time = self._time("MIN"), self._time("MAX")

    def _definitions(self) -> dict[str, tuple[str, str]]:
        columns = ", ".join(map(_short, ("topic_type", "encoding", "encoded_message_definition")))
        query = f"SELECT {columns} FROM message_definitions"
        return {str(row[0]): (str(row[1]), str(row[2])) for row in self._database.execute(query)}

    def _metadata(self) -> BagMetadata | None:
        with contextlib.suppress(BagError, sqlite3.DatabaseError):  # a copy: what counts is metadata.yaml, and messages
            query = f"SELECT {_short('metadata')} FROM metadata ORDER BY id DESC LIMIT 1"
            row = self._database.execute(query).fetchone()
            return parse_metadata(str(row[0])) if row else None
        return None

    def _number(self, query: str) -> int:
        found = self._database.execute(query).fetchone()[0]
        return found if isinstance(found, int) else 0

    def _time(self, which: str) -> int:
        """Return the first (MIN) or the last (MAX) time; the usual way takes it from the end of an index."""
        query = f"SELECT {which}(timestamp) FROM messages"
        found = self._database.execute(query).fetchone()[0]
        return found if isinstance(found, int) else self._number(f"{query} WHERE typeof(timestamp) = 'integer'")

    @property
    def problems(self) -> list[str]:
        """Lines for damage that was found, and for rows that have no time, or no bytes."""
        damage = f"{self.path} is damaged ({self._damage}): {self.message_count} messages of it can be read"
        strange = f"{self.path}: {self._strange} rows are not messages: they are left out"
        return ([damage] if self._damage else []) + ([strange] if self._strange else [])

    def counts(self) -> list[int]:
        """Return the number of messages of each of `topics`, which reads the whole file."""
        query = "SELECT topic_id, COUNT(*) FROM messages GROUP BY topic_id"
        with self._errors():
            try:
                found = self._salvaged.counts() if self._salvaged else dict(self._database.execute(query))
            except sqlite3.DatabaseError as error:
                found = self._salvage(error).counts()
        return [int(found.get(each, 0)) for each in self._ids]

    def messages(
        self, topics: Collection[str] | None, start: int | None, end: int | None, *, reverse: bool = False
    ) -> Iterator[BagMessage]:
        """Yield messages in the order of their times; sqlite3 knows only the time at which one was received."""
        names = {id_: each.name for id_, each in zip(self._ids, self.topics, strict=True)}
        selected = {id_: name for id_, name in names.items() if topics is None or name in topics}
        conditions, values = ["1"], list[int]()
        for condition, value in (("timestamp >= ?", start), ("timestamp < ?", end)):
            if value is not None:
                conditions.append(condition)
                values.append(max(-(2**63), min(value, 2**63 - 1)))
        order = "DESC" if reverse else "ASC"
        query = (
            f"SELECT topic_id, timestamp, CASE WHEN length(data) <= {SORTED_WHOLE} THEN data END, id"
            f" FROM messages WHERE {' AND '.join(conditions)}"
            f" ORDER BY timestamp {order}, id {order}"
        )
        strange, given = 0, 0
        with self._errors():
            try:
                rows = self._database.execute(query, values) if self._salvaged is None else ()
                for id_, stamp, small, number in rows:
                    if (name := selected.get(id_)) is None:
                        continue
                    data = self._large(number) if small is None else small
                    if type(data) is bytes and type(stamp) is int:
                        yield BagMessage(name, data, stamp, stamp)
                        given += 1
                    else:
                        strange += 1
                        self._strange = max(self._strange, strange)
            except sqlite3.DatabaseError as error:
                self._salvage(error)
            if self._salvaged is not None:
                rest = self._salvaged.rows(selected, start, end, reverse=reverse)
                for id_, stamp, data in itertools.islice(rest, given, None):  # in the same order as those before
                    yield BagMessage(selected[id_], data, stamp, stamp)

    def _large(self, number: int) -> object:
        """Return the data of a row that is too large to be sorted with the others; None if it has none."""
        row = self._database.execute("SELECT data FROM messages WHERE id = ?", (number,)).fetchone()
        return row[0] if row else None

    def close(self) -> None:
        """Close the database."""
        self._opened.close()

    @contextlib.contextmanager
    def _errors(self) -> Iterator[None]:
        try:
            yield
        except (sqlite3.Error, OverflowError, ValueError) as error:
            if isinstance(error, BagError):
                raise
            raise BagError(f"{self.path} is damaged: {error}") from None


class SqliteWriter(StorageWriter):
    """Writer of a .db3 file, which readers find whole after each `flush`, whatever happens later."""

    identifier = "sqlite3"
    ending = ".db3"

    def __init__(self, path: Path) -> None:
        if path.exists():
            raise BagError(f"{path} exists already")
        self._path, self._database = path, _created(path)
        self._types: set[str] = set()
        self._size = 0
        self._counts: dict[int, int] = {}
        self._first = self._last = 0
        self._committed = clocks.monotonic()

    @property
    def size(self) -> int:
        """Bytes of messages so far, with what each row costs."""
        return self._size

    @property
    def written(self) -> Written:
        """Messages that were written so far."""
        return Written(list(self._counts.values()), self._first, self._last)

    def add_topic(self, topic: BagTopic) -> int:
        """Add a topic, and return its number."""
        self._begin()
        row = (topic.name, topic.type_name, topic.serialization_format, text_of(topic.offered_qos), topic.type_hash)
        added = self._run(
            "INSERT INTO topics(name, type, serialization_format, offered_qos_profiles, type_description_hash)"
            " VALUES (?, ?, ?, ?, ?)",
            row,
        )
        if topic.message_definition and topic.type_name not in self._types:
            self._types.add(topic.type_name)
            self._run(
                "INSERT INTO message_definitions(topic_type, encoding, encoded_message_definition,"
                " type_description_hash) VALUES (?, ?, ?, ?)",
                (topic.type_name, topic.definition_encoding, topic.message_definition, topic.type_hash),
            )
        assert added.lastrowid is not None
        self._counts[added.lastrowid] = 0
        return added.lastrowid

    def write(self, topic: int, log_time: int, publish_time: int, sequence: int, data: bytes | memoryview) -> None:
        """Write a message; sqlite3 keeps its log time alone."""
        self._begin()
        self._run("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", (topic, log_time, data))
        if not self._size:
            self._first = self._last = log_time
        elif log_time > self._last:
            self._last = log_time
        elif log_time < self._first:
            self._first = log_time
        self._counts[topic] += 1
        self._size += len(data) + 32

    def tick(self) -> None:
        """Commit what was written, if it is time."""
        if clocks.monotonic() - self._committed >= _COMMIT_AFTER:
            self.flush()

    def flush(self) -> None:
        """Commit what was written."""
        self._committed = clocks.monotonic()
        if self._database.in_transaction:
            self._run("COMMIT")

    def close(self, metadata: BagMetadata | None) -> None:
        """Close the database, with a copy of the bag's metadata; one file is left."""
        try:
            if metadata is not None:
                self._begin()
                self._run(
                    "INSERT INTO metadata(metadata_version, metadata) VALUES (?, ?)",
                    (metadata.version, spell_metadata(metadata)),
                )
            self.flush()
            self._run("PRAGMA journal_mode = DELETE")
        finally:
            self._database.close()

    def _begin(self) -> None:
        if not self._database.in_transaction:
            self._run("BEGIN")

    def _run(self, query: str, values: Sequence[Any] = ()) -> sqlite3.Cursor:
        try:
            return self._database.execute(query, values)
        except (sqlite3.Error, OverflowError) as error:
            raise BagError(f"{self._path} cannot be written: {error}") from None


_COLUMNS = ("name", "type", "serialization_format", "offered_qos_profiles", "type_description_hash")


def _created(path: Path) -> sqlite3.Connection:
    """Make a database with the tables of a bag. Raises BagError if it cannot be made."""
    distro = os.environ.get("ROS_DISTRO", ROS_DISTRO)
    try:
        database = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
        database.execute("PRAGMA journal_mode = WAL")
        database.execute("PRAGMA synchronous = NORMAL")
        database.executescript(_SCHEMA)
        database.execute("INSERT INTO schema VALUES (?, ?)", (SCHEMA_VERSION, distro))
    except sqlite3.Error as error:
        raise BagError(f"{path} cannot be made: {error}") from None
    return database


def _column(columns: set[str], name: str) -> str:
    return name if name in columns else "''"


def _short(column: str) -> str:
    """Return the expression of a column, '' where it is longer than a text of a bag ever is."""
    return f"CASE WHEN length({column}) <= {LONGEST_TEXT} THEN {column} ELSE '' END"


def _topic(row: tuple[Any, ...], definitions: dict[str, tuple[str, str]]) -> BagTopic:
    _, name, type_name, format_, qos, type_hash = (str(each or "") for each in row)
    encoding, text = definitions.get(type_name, ("ros2msg", ""))
    return BagTopic(name, type_name, format_, type_hash, profiles_or_none(qos), text, encoding if text else "ros2msg")


def _opened(path: Path, named: Path, is_cut: bool) -> sqlite3.Connection:
    """Open a database to read, also one on a disk that is read-only or beside the log of a writer that was killed.

    `named` is the file's name in errors, `is_cut` says that its end is lost.
    """
    last = ""
    for way in ("mode=ro", "immutable=1"):
        database = None
        try:
            database = sqlite3.connect(f"{path.resolve().as_uri()}?{way}", uri=True, check_same_thread=False)
            database.text_factory = _text
            if is_cut:
                allow_cut(database)
            database.execute("SELECT COUNT(*) FROM sqlite_master").fetchone()
        except sqlite3.Error as error:
            if database is not None:
                database.close()
            last = str(error)
        else:
            return database
    raise BagError(f"{named} is damaged: {last}")


def _text(raw: bytes) -> str:
    return raw.decode("utf-8", "replace")
