"""Payload in pieces: buffers that follow each other, for a transport that copies each to where it goes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

LARGE = 32 * 1024
"""Payload size in bytes from which it may be in pieces, and subscriptions are looked for before it is copied."""

PIECE = 256 * 1024
"""Size in bytes of what is copied at a time by way of a bytes object: two of them fit into the cache of most cores."""


class Pieces:
    """Payload in pieces: a program's own buffers, to be read before the program goes on.

    Args:
        buffers: Contiguous objects with the buffer protocol, in their order.
    """

    __slots__ = ("_size", "_views")

    def __init__(self, buffers: Iterable[Any]) -> None:
        views = [memoryview(each) for each in buffers]
        self._views = [view.cast("B") for view in views if view.nbytes]  # one of a shape with a zero cannot be cast
        self._size = sum(map(len, self._views))

    def __len__(self) -> int:
        return self._size

    def __bytes__(self) -> bytes:
        return b"".join(self._views)

    def __iter__(self) -> Iterator[bytes]:
        """Yield the payload in parts of at most PIECE bytes."""
        for view in self._views:
            for begin in range(0, len(view), PIECE):
                yield bytes(view[begin : begin + PIECE])
