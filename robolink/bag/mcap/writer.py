"""Writer of MCAP files: the file is valid at every moment, and an ordinary one once it is closed."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from robolink.bag.mcap.chunk import chunk_data, compressor
from robolink.bag.mcap.contents import Contents, Packed
from robolink.bag.mcap.disk import BackgroundSave, DiskFile
from robolink.bag.mcap.records import (
    MAGIC,
    MESSAGE,
    MESSAGE_HEAD,
    OPENING,
    Attachment,
    Buffer,
    Channel,
    McapError,
    Schema,
    Statistics,
    header_record,
)
from robolink.bag.mcap.tail import ROOM, Create, Tail
from robolink.system import clocks

CHUNK_SIZE = 768 * 1024
"""Size of a chunk in bytes, as rosbag2 has it."""
SHOWN_EARLY = 0.05
"""Time after which a chunk that is full is shown at once, in seconds."""
_pack = struct.Struct("<BQHIQQ").pack


class Writer:
    """A new MCAP file, which any reader opens at any moment; what was written is shown to them by `tick`.

    It is for one thread. Call `tick` often, each 50 ms or 64 messages: a process that is killed loses what came after
    the last call that was due. Each failure of the disk, such as a full one, is a McapError; the file keeps what was
    shown before, and each further call raises the same error. Where neither chunks grow too old nor anything is shown
    (`max_age` and `flush_every` are infinite), its bytes depend on the calls alone.

    Args:
        path: Path of the file, which must not be there yet.
        profile: What kind of messages it holds.
        library: Name of the program that writes it.
        compression: How chunks are packed once they are full: ``""``, ``"zstd"`` or ``"lz4"``.
        chunk_size: Size of a chunk before it is packed, in bytes; a larger message has a chunk of its own.
        max_age: Time after which a chunk is closed though it is not full, in seconds.
        flush_every: Shortest time between two writes that show what is new, in seconds.
        sync_every: Shortest time between two times that it is forced to the disk, in seconds; 0 for never. A thread
            does that; writing waits for it only where the disk is some megabytes behind. After a power cut `Reader`
            finds all that was forced to the disk, and other readers may need `reindex` before. If it is not longer
            than `flush_every`, writing waits each time, and the file stays valid for all of them.
        room: Smallest hole behind the closed chunks while the file is open, in bytes.
        create: Maker of the file.

    Raises McapError if the file is there already or cannot be made, or a package for the compression is missing.
    """

    def __init__(
        self,
        path: str | Path,
        *,
        profile: str = "ros2",
        library: str = "robolink",
        compression: str = "",
        chunk_size: int = CHUNK_SIZE,
        max_age: float = 10.0,
        flush_every: float = 0.15,
        sync_every: float = 0.2,
        room: int = ROOM,
        create: Create = DiskFile.create,
    ) -> None:
        self.path = Path(path)
        self._compression, self._compress = compression, compressor(compression)
        self._chunk_size, self._max_age = chunk_size, max_age
        self._flush_every, self._sync_every = flush_every, sync_every
        self._is_strict = 0 < sync_every <= flush_every
        self._contents = Contents(self.path)
        self._failure: McapError | None = None
        self._is_open = True
        self._limit = chunk_size
        self._parts: list[bytes] = []
        self._entries: dict[int, list[int]] = {}
        self._size, self._begun = 0, 0.0
        self._shown_size = 0
        self._shown_at = self._saved_at = clocks.monotonic()
        self._is_saved = True
        self._summary_size = 0
        if self.path.exists():
            raise McapError(f"{self.path}: a file is there already; a bag never replaces one")
        head = MAGIC + header_record(profile, library)
        with self._guarded("cannot be made"):
            summary = self._contents.summary()
            self._tail = Tail(create, self.path, head, summary, chunk_size, room, sync_every > 0, self._is_strict)
        self._saving = BackgroundSave(self._tail.save)

    def __enter__(self) -> Writer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def schemas(self) -> Mapping[int, Schema]:
        """Schemas by id."""
        return self._contents.schemas

    @property
    def channels(self) -> Mapping[int, Channel]:
        """Channels by id."""
        return self._contents.channels

    @property
    def statistics(self) -> Statistics:
        """Number and time of the messages that were written."""
        return self._contents.statistics(self._entries)

    @property
    def size(self) -> int:
        """Size of what was written, in bytes: closed chunks as they are packed, and the open one."""
        return self._tail.offset + self._size

    @property
    def summary_size(self) -> int:
        """Size of the summary when it was last shown, in bytes. Each flush writes it: split before it is 1 MiB."""
        return self._summary_size

    def add_schema(self, name: str, encoding: str, data: bytes) -> int:
        """Add a schema, and return its id; the same one again has the same id. Raises McapError beyond 65,535."""
        self._check()
        return self._contents.add_schema(name, encoding, data)

    def add_channel(self, schema: int, topic: str, encoding: str, metadata: Mapping[str, str] | None = None) -> int:
        """Add a channel, and return its id.

        Args:
            schema: Id of its schema, 0 if its messages have none.
            topic: Name of its topic.
            encoding: Encoding of its messages, such as ``cdr``.
            metadata: What else is known of it.

        Raises McapError beyond 65,535, and for a schema that was not added.
        """
        self._check()
        return self._contents.add_channel(schema, topic, encoding, metadata or {})

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Add a record of metadata; a later one of the same name stands beside it. Raises McapError."""
        self._check()
        self._contents.add_metadata(name, values)

    def add_attachment(self, attachment: Attachment) -> None:
        """Add a file within the file. Raises McapError."""
        self._check()
        self._contents.add_attachment(attachment)

    def write(self, channel: int, log_time: int, publish_time: int, sequence: int, data: Buffer) -> None:
        """Write a message.

        Args:
            channel: Id of its channel.
            log_time: Time at which it was received, in nanoseconds.
            publish_time: Time at which it was sent, in nanoseconds.
            sequence: Its number, of which the lowest 32 bits are kept.
            data: Its bytes, which are copied unless they are `bytes`.

        Raises McapError.
        """
        if type(data) is not bytes:
            data = bytes(data)
        length = len(data)
        size = self._size
        if size + length > self._limit and size:
            self._make_room()
            size = 0
        entries = self._entries.get(channel)
        if entries is None:
            entries = self._first_of(channel)
        try:
            head = _pack(MESSAGE, length + MESSAGE_HEAD, channel, sequence & 0xFFFFFFFF, log_time, publish_time)
        except struct.error:
            raise McapError(f"{self.path}: a time is from 0 to 2**64 - 1 ns: {log_time}, {publish_time}") from None
        self._parts += (head, data)
        entries += (log_time, size)
        self._size = size + length + OPENING + MESSAGE_HEAD
        if not size:
            self._begun = clocks.monotonic()

    def tick(self) -> None:
        """Close the open chunk and show what is new, each if it is time. Raises McapError."""
        now = clocks.monotonic()
        is_old = self._size and now - self._begun >= self._max_age
        if is_old or not self._is_saved or now - self._shown_at >= self._flush_every or self._failure:
            self._check()
            with self._guarded():
                self._do_what_is_due(now)

    def flush(self) -> None:
        """Show all that was written. Raises McapError."""
        self._check()
        if self._is_dirty:
            with self._guarded():
                self._show()

    def close(self) -> None:
        """Make the file an ordinary one and close it. Raises McapError if the disk fails; the file stays valid then.

        A writer that has failed before only closes its file, and a closed one does nothing.
        """
        if not self._is_open:
            return
        self._is_open = False
        try:
            if self._failure is None:
                with self._guarded():
                    self._saving.wait()
                    self._finish()
        finally:
            with suppress(OSError):
                self._saving.wait()
            self._tail.close()
            self._fail(McapError(f"{self.path}: the file is closed"))

    @property
    def _is_dirty(self) -> bool:
        """True if something was not shown yet."""
        return self._size != self._shown_size or self._contents.changed

    def _clear(self) -> None:
        self._parts, self._entries = [], {}
        self._size, self._begun = 0, 0.0

    def _first_of(self, channel: int) -> list[int]:
        if channel not in self._contents.channels:
            raise McapError(f"{self.path}: a message of channel {channel}, which was not added")
        entries = self._entries[channel] = []
        return entries

    def _make_room(self) -> None:
        """Close the full chunk, and show it if it is time."""
        self._check()
        with self._guarded():
            self._close_chunk()
            if clocks.monotonic() - self._shown_at >= min(self._flush_every, SHOWN_EARLY):
                self._show()  # cheap now: no chunk is open
            self._keep_hole_wide()
        self.tick()

    def _close_chunk(self) -> None:
        data = chunk_data(self._parts, self._compression, self._compress)
        packed = self._contents.pack(self._tail.offset, data, self._entries)
        if packed.size:
            self._have_room(packed.size)
            self._tail.append(packed.pieces)
            self._contents.keep(packed)
            self._clear()

    def _packed_open(self) -> Packed:
        """Return the messages of the open chunk, as they are in the next slot."""
        return self._contents.pack(self._tail.next_slot, chunk_data(self._parts, "", bytes), self._entries)

    def _show(self) -> None:
        """Show all that was written: in a slot or, if it is too much for one, in a closed chunk."""
        if not self._show_in_slot():
            self._close_chunk()
            self._show_in_slot()

    def _show_in_slot(self) -> bool:
        """Show all that was written, if what is in no closed chunk has room in a slot."""
        if not self._tail.holds(self._size):
            return False
        packed = self._packed_open()
        if not self._tail.holds(packed.size):
            return False
        self._show_packed(packed)
        return True

    def _show_packed(self, packed: Packed | None) -> None:
        """Show all closed chunks, and what is packed."""
        summary = self._contents.summary(packed)
        if not self._tail.summarizes(len(summary)):
            self._extend(0)
            return
        self._tail.show(b"".join(packed.pieces) if packed else b"", summary, save=self._is_strict)
        self._shown_at, self._summary_size = clocks.monotonic(), len(summary)
        if packed:
            self._shown_size, self._contents.changed = self._size, False
        else:
            self._shown_size = 0
        self._is_saved = self._sync_every <= 0

    def _have_room(self, length: int) -> None:
        """Ensure room for so many bytes behind the closed chunks."""
        if not self._tail.reaches(length):
            self._extend(length)
        self._note_save()
        if not self._tail.has_room(length):
            self._wait()

    def _keep_hole_wide(self) -> None:
        """Move the end before the hole is full, so that nobody has to wait for the disk then."""
        self._note_save()
        if self._tail.is_narrow:
            self._extend(0)

    def _extend(self, need: int) -> None:
        """Move the end so far that there is room for so many bytes.

        The new slots show what the old ones do. These are overwritten only once the new ones are on the disk.
        """
        self._note_save()
        if self._tail.is_guarded:
            self._wait()
        is_shown = self._tail.shows_chunk  # then the new slots must have room for it, however large it is
        packed = self._packed_open() if is_shown or self._tail.holds(self._size) else None
        summary = self._contents.summary(packed)
        self._tail.extend(need, len(summary), packed.size if packed and is_shown else 0)
        if not self._show_in_slot():
            self._show_packed(None)
        if self._is_strict:
            self._force()
        elif self._sync_every > 0:
            self._saved_at = -math.inf
            self._save(clocks.monotonic())

    def _finish(self) -> None:
        """Close the last chunk and write an ordinary end; all was shown before, should the disk be full now."""
        if self._is_dirty:
            self._show()
        self._close_chunk()
        end = self._contents.end(self._tail.offset)
        self._have_room(len(end))
        self._tail.finish(end)

    def _do_what_is_due(self, now: float) -> None:
        if self._size and now - self._begun >= self._max_age:
            self._close_chunk()
        if self._is_dirty and now - self._shown_at >= self._flush_every:
            self._show()
        if not self._is_saved:
            self._save(now)
        self._keep_hole_wide()

    def _save(self, now: float) -> None:
        """Force to the disk what was shown, if it is time."""
        if self._is_strict:
            if not self._is_dirty and now - self._shown_at >= self._sync_every:  # else the next one that shows does so
                self._force()
        elif now - self._saved_at >= self._sync_every and self._saving.is_free():
            self._tail.end_save()
            self._tail.begin_save()
            self._saving.start()
            self._saved_at, self._is_saved = now, True

    def _note_save(self) -> None:
        """Let old slots be overwritten as soon as the disk has the new ones."""
        if self._tail.is_guarded and self._saving.is_free():
            self._tail.end_save()

    def _wait(self) -> None:
        """Wait until the disk has the new slots: it is slower than what is written."""
        self._tail.widen()
        self._saving.wait()
        self._tail.end_save()
        if self._tail.is_guarded:
            self._force()

    def _force(self) -> None:
        """Force to the disk what was shown, and wait for it."""
        self._tail.begin_save()
        self._tail.save()
        self._tail.end_save()
        self._saved_at, self._is_saved = clocks.monotonic(), True

    def _check(self) -> None:
        if self._failure is not None:
            raise self._failure.with_traceback(None)

    def _fail(self, error: McapError) -> None:
        """Refuse all that comes from now on: the next message finds its chunk full."""
        self._failure = self._failure or error
        self._limit, self._size = -1, 1

    @contextmanager
    def _guarded(self, what: str = "cannot be written") -> Iterator[None]:
        try:
            yield
        except OSError as error:
            failure = McapError(f"{self.path} {what}: {error.strerror or error}")
            self._fail(failure)
            raise failure from None
