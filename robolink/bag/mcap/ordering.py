"""Merging of chunks whose times overlap, in time that grows with the number of their messages."""

from __future__ import annotations

import bisect
import heapq
from collections.abc import Callable, Iterable, Iterator
from operator import attrgetter

from robolink.bag.mcap.records import Message

_log_time = attrgetter("log_time")


def _backwards(message: Message) -> int:
    return -message.log_time


def in_log_order(chunks: Iterable[tuple[list[Message], int | None]], *, reverse: bool = False) -> Iterator[Message]:
    """Iterate over the messages of chunks in the order of their log times; of one time, the earlier chunk's come first.

    Args:
        chunks: Messages of each chunk, and the first log time of the chunks that follow (the last one with `reverse`);
            None behind the last chunk. The chunks come in the order of their own.
        reverse: True for the latest message first.
    """
    key: Callable[[Message], int] = _backwards if reverse else _log_time
    waiting: list[tuple[int, int, int, list[Message]]] = []
    """Chunks that are begun: key of their next message, number of the chunk, place of the message."""
    for number, (chunk, following) in enumerate(chunks):
        messages = sorted(reversed(chunk) if reverse else chunk, key=key)
        if messages:
            heapq.heappush(waiting, (key(messages[0]), number, 0, messages))
        bound = None if following is None else -following if reverse else following
        while waiting and (bound is None or waiting[0][0] <= bound):  # those of one time are not held together
            yield from _next_run(waiting, bound, key)


def _next_run(
    waiting: list[tuple[int, int, int, list[Message]]], bound: int | None, key: Callable[[Message], int]
) -> list[Message]:
    """Take the messages of the chunk that comes next, up to the bound or to the next message of another chunk."""
    _, number, at, messages = heapq.heappop(waiting)
    end = len(messages) if bound is None else bisect.bisect_right(messages, bound, at, key=key)
    if waiting:
        time, other = waiting[0][:2]
        find = bisect.bisect_right if number < other else bisect.bisect_left
        end = find(messages, time, at, end, key=key)
    if end < len(messages):
        heapq.heappush(waiting, (key(messages[end]), number, end, messages))
    return messages[at:end]
