"""Layout of a file that is valid at every moment: closed chunks, a hole, and the end in slots that take turns.

    head | closed chunks | gap ~ hole ~ | slot 0 | slot 1 | slot 2 | slot 3 | DataEnd footer magic

Each slot has two halves: `open chunk, filler` and `DataEnd, summary, filler`. Fillers are private records, which
readers skip, so that every byte belongs to a record. The gap is the filler behind the closed chunks: it leads over the
hole to a slot's open chunk. The filler behind a slot's summary leads to the footer. A reader with the index goes from
the footer to a summary; one without goes over the gap to the open chunk and a DataEnd.

What is new is put where nobody looks: into the hole, and into the next slot. Then two small writes show it, each within
a page: one at the gap, one in the footer. When the hole gets narrow, the summary is repeated with a filler up to a new
end, far behind, and one write of 50 bytes puts a new footer there. The old slots are part of the new hole, but they may
have all that the disk has of the open chunk: the hole ends before them until a save of the new ones is over.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from robolink.bag.mcap.disk import DiskFile
from robolink.bag.mcap.records import (
    DATA_END,
    END_SIZE,
    FILLER,
    MAGIC,
    OPENING,
    PAGE,
    SEAL_SIZE,
    SLOTS,
    Buffer,
    filler,
    footer,
    opening,
    record,
    seal,
)

ROOM = 4 << 20
"""Smallest hole behind the closed chunks, in bytes, when the end moves."""
LARGEST_ROOM = 64 << 20
"""The same where writing had to wait for the disk again and again."""
END_OF_DATA = record(DATA_END, bytes(4))
TAIL = len(END_OF_DATA) + END_SIZE
"""Size of what the file ends with: DataEnd, footer, magic."""

Create = Callable[[Path, Iterable[tuple[int, Buffer]], bool], DiskFile]
"""Maker of the file: its path, its first pieces, and whether it must outlast a power cut."""


class Tail:
    """The file of a writer, from the end of its closed chunks on.

    Args:
        create: Maker of the file.
        path: Path of the file.
        head: Bytes that it begins with.
        summary: First summary.
        largest: Size that open chunks can have, in bytes.
        room: Smallest hole behind the closed chunks, in bytes.
        durable: True to force the file to the disk once it is there.
        strict: True to do so when its end moves, too, before anything else is written.
    """

    def __init__(
        self,
        create: Create,
        path: Path,
        head: bytes,
        summary: bytes,
        largest: int,
        room: int,
        durable: bool,
        strict: bool,
    ) -> None:
        self.offset = len(head)
        """Place of the next closed chunk."""
        self._largest, self._room, self._durable, self._strict = largest, room, durable, strict
        self._slot, self._summary, self._body = 0, summary, 0
        self._saving: int | None = None
        self._saved: int | None = None
        self._half = PAGE
        self._place(self.offset, len(summary), 0)
        self._limit = self._base
        """Place up to which closed chunks may be put."""
        middle = self._base + self._half
        self._gap_at, self._gap = self.offset, filler(self.offset, self._end - TAIL)
        self._footer = footer(middle)
        self._hidden = b""
        """First bytes of what will be in the gap's place; the rest is there already."""
        pieces = [
            (0, head + self._gap),
            (middle - len(END_OF_DATA), self._second_half(middle, summary)),
            (self._end - TAIL, END_OF_DATA + self._footer + MAGIC),
        ]
        self._file = create(path, pieces, durable)

    @property
    def next_slot(self) -> int:
        """Place of the next slot's open chunk."""
        return self._base + self._next * 2 * self._half

    @property
    def _next(self) -> int:
        """Number of the next slot: one that is neither shown nor the newest that the disk surely has."""
        turn = ((self._slot + each) % SLOTS for each in range(1, SLOTS))
        return next(each for each in turn if each not in (self._saving, self._saved))

    def holds(self, body: int) -> bool:
        """True if an open chunk of this size, in bytes, has room in a slot."""
        return body + OPENING + len(END_OF_DATA) <= self._half

    def summarizes(self, summary: int) -> bool:
        """True if a summary of this size, in bytes, has room in a slot."""
        return summary + OPENING + SEAL_SIZE <= self._half

    def has_room(self, length: int) -> bool:
        """True if this many bytes have room in the hole now."""
        return self.offset + length + 2 * OPENING <= self._limit

    def reaches(self, length: int) -> bool:
        """True if this many bytes have room in the hole, now or once the new slots are on the disk."""
        return self.offset + length + 2 * OPENING <= self._base

    @property
    def is_narrow(self) -> bool:
        """True if the end should move now: until the hole is full, the disk has time for the new slots."""
        return not self.is_guarded and self._base - self.offset < self._margin

    @property
    def is_guarded(self) -> bool:
        """True from the moment in which the end moves until a save is over that began later."""
        return self._limit < self._base

    @property
    def shows_chunk(self) -> bool:
        """True if a slot with an open chunk is shown."""
        return self._body > 0

    def append(self, pieces: Sequence[Buffer]) -> None:
        """Put a closed chunk into the hole; it is not shown yet. The first piece has at least 9 bytes."""
        at, first = self.offset, pieces[0]
        if self._hidden:
            self._file.put(first, at)
        elif len(first) > OPENING:
            self._file.put(memoryview(first)[OPENING:], at + OPENING)
        at += len(first)
        for piece in pieces[1:]:
            self._file.put(piece, at)
            at += len(piece)
        if -at % PAGE < OPENING:  # the gap never lies across pages
            self._file.put(opening(FILLER, 0), at)
            at += OPENING
        self._hidden = self._hidden or bytes(first[:OPENING])
        self.offset = at

    def show(self, body: bytes, summary: bytes, save: bool) -> None:
        """Put the open chunk and the summary into the next slot, then show these and all that was appended.

        With `save`, a power cut at any moment leaves what was shown before or what is shown now.
        """
        at = self.next_slot
        middle = at + self._half
        gap = filler(self.offset, at if body else self._end - TAIL)
        if self._hidden:
            self._file.put(gap, self.offset)
        if body:
            self._file.put(body + filler(at + len(body), middle - len(END_OF_DATA)), at)
        self._file.put(self._second_half(middle, summary), middle - len(END_OF_DATA))
        if save:
            self._file.save()
        self._flip(self._gap, self._hidden or gap, self._gap_at)
        if save and self._hidden:
            self._file.save()  # before a summary names the chunk that begins there
        self._gap, self._gap_at, self._hidden = gap, self.offset, b""
        self._flip(self._footer, footer(middle), self._end - END_SIZE)
        self._footer, self._summary = footer(middle), summary
        self._slot, self._body = self._next, len(body)

    def extend(self, need: int, summary: int, body: int) -> None:
        """Move the end so far that there is room for this many bytes, and slots for an open chunk and a summary.

        The sizes are in bytes. `show` must follow, and then a save, unless nothing ever outlasts a power cut.
        """
        middle, old_end, old_base = self.next_slot + self._half, self._end, self._base
        self._place(max(self._end, self.offset + need), max(summary, len(self._summary)), body)
        self._limit = old_base if self._durable else self._base
        self._file.put(self._second_half(middle, self._summary), middle - len(END_OF_DATA))
        if self._strict:
            self._file.save()
        self._footer, self._slot = footer(middle), SLOTS - 1
        self._saving = self._saved = None
        try:
            self._file.put(END_OF_DATA + self._footer + MAGIC, self._end - TAIL)
        except OSError:
            self._file.cut(old_end)  # a few of these bytes may be there: the old end has its place again
            raise

    def finish(self, end: bytes) -> None:
        """Write the end of an ordinary file behind the closed chunks, and cut off all that is behind it."""
        self._file.put(end if self._hidden else memoryview(end)[OPENING:], self.offset + OPENING * (not self._hidden))
        self._file.save()
        self._flip(self._gap, self._hidden or end[:OPENING], self._gap_at)
        self._file.save()
        self._file.cut(self.offset + len(end))

    def save(self) -> None:
        """Force all that was written to the disk; a thread may do that."""
        self._file.save()

    def begin_save(self) -> None:
        """Keep what is shown now: a save of it begins."""
        self._saving = self._slot

    def end_save(self) -> None:
        """Keep what was shown when a save began, which is over, and no more what an earlier one had."""
        if self._saving is not None:
            self._saved, self._saving = self._saving, None
            self._limit = self._base

    def widen(self) -> None:
        """Make the holes to come larger: writing had to wait for the disk."""
        self._room = min(2 * self._room, max(LARGEST_ROOM, self._room))

    def close(self) -> None:
        """Close the file, and leave it as it is."""
        self._file.close()

    def _place(self, low: int, summary: int, body: int) -> None:
        """Place the slots and the end, behind a hole that begins at `low`."""
        half, body = self._half, body + OPENING + len(END_OF_DATA)
        while half < max(self._largest * 4 // 3, 2 * summary, body) or half.bit_length() % 8 == 7:
            half *= 2  # a power of two, so that one byte of the footer tells the slots apart
        span = SLOTS * 2 * half
        self._half = half
        self._base = -(-(low + self._room) // span) * span
        self._end = self._base + span + PAGE
        self._margin = (self._base - low) // 2

    def _second_half(self, middle: int, summary: bytes) -> bytes:
        """Return DataEnd, a summary that begins at `middle`, and the filler that leads to the footer."""
        return END_OF_DATA + summary + filler(middle + len(summary), self._end - END_SIZE) + seal(summary)

    def _flip(self, old: bytes, new: bytes, at: int) -> None:
        """Make old bytes new by the smallest write; they lie within a page."""
        differ = [place for place in range(len(new)) if old[place] != new[place]]
        if differ:
            self._file.put(new[differ[0] : differ[-1] + 1], at + differ[0])
