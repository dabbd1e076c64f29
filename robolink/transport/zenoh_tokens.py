"""Liveliness tokens of a Zenoh session: those that it announces, and how it learns of those of others."""

from __future__ import annotations

import functools
import queue
import threading
from collections.abc import Callable, Mapping
from typing import Any

import zenoh

from robolink.system import clocks
from robolink.system.waits import get_within
from robolink.transport.base import Sink
from robolink.transport.zenoh_handles import Declared, Holdings

QUIET = 0.03
"""Quiet time after which no more peers are expected, in seconds."""

PATIENCE = 0.5
"""Quiet time after which peers that have not answered count as frozen, in seconds."""

LONGEST = 3.0
"""Timeout of the discovery in seconds: even a busy machine's peers have announced everything by then."""


class ZenohToken(Declared):
    """A token that is announced."""

    __slots__ = ("_token",)

    def __init__(self, holdings: Holdings, announced: Any, token: str) -> None:
        self._token = token
        super().__init__(holdings, [announced])
        with holdings.lock:
            holdings.tokens[token] += 1

    def close(self) -> None:
        """Undeclare. Safe to call twice."""
        with self._holdings.lock:
            if self in self._holdings.handles:
                tokens = self._holdings.tokens
                tokens[self._token] -= 1
                if not tokens[self._token]:
                    del tokens[self._token]
        super().close()


class Changes:
    """Deduplicates token changes: Zenoh may report one token both as history and as a change."""

    def __init__(self, on_change: Callable[[str, bool], object], own: Mapping[str, int] | None = None) -> None:
        self._own: Mapping[str, int] = {} if own is None else own
        self._on_change: Callable[[str, bool], object] | None = on_change
        self._telling = threading.RLock()
        self._found: set[str] | None = None
        self.alive: set[str] = set()

    def __call__(self, sample: zenoh.Sample) -> None:
        """Handle a token change from Zenoh."""
        token, alive = str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT
        if alive or not self._own.get(token):  # else the end of another session in which it was announced, too
            self.change(token, alive)

    def change(self, token: str, alive: bool) -> object:
        """Report a token that has come or gone, unless that is known; return what `on_change` returns."""
        with self._telling:
            if self._found is not None:
                (self._found.add if alive else self._found.discard)(token)
            return self._tell(token, alive)

    def _tell(self, token: str, alive: bool) -> object:
        if self._on_change is None or alive == (token in self.alive):
            return None
        (self.alive.add if alive else self.alive.discard)(token)
        answer = self._on_change(token, alive)
        if answer is False:
            self.alive.discard(token)
        return answer

    def count_again(self) -> None:
        """Note from now on which tokens are found again, in another session."""
        with self._telling:
            self._found = set()

    def settle(self) -> None:
        """Report those as gone that have not been found again."""
        with self._telling:
            found, self._found = self._found, None
            for token in sorted(self.alive - found) if found is not None else ():
                self._tell(token, False)

    def end(self) -> None:
        """Stop reporting changes."""
        # Waits for what is just being told, but not for ever: its hearer may wait for whoever closes.
        waited = self._telling.acquire(timeout=0.1)
        self._on_change = None
        if waited:
            self._telling.release()


class ZenohWatch(Declared):
    """A watch of tokens."""

    __slots__ = ("_changes",)

    def __init__(self, holdings: Holdings, made: tuple[Any, Sink], changes: Changes) -> None:
        self._changes = changes
        subscriber, feed = made
        super().__init__(holdings, [subscriber], feed)

    def shut(self, why: str) -> list[Any]:
        """Stop reporting changes; return the entities to undeclare."""
        self._changes.end()
        return super().shut(why)


def settled(
    arrived: queue.SimpleQueue[Any], ask: Callable[[Callable[[], object], float], object], peers: Callable[[], set[str]]
) -> set[str]:
    """Collect tokens until all peers have announced theirs and no more peers turn up."""
    changes, known = Changes(lambda token, alive: None), set[str]()
    begin = news = clocks.monotonic()

    def left() -> float:
        return min(news + PATIENCE, begin + LONGEST) - clocks.monotonic()

    def collect(quiet: float) -> None:
        """Collect until the peers have answered, or nothing has come for `quiet` seconds."""
        nonlocal news
        while (longest := min(left(), quiet)) > 0:
            try:
                sample = get_within(arrived, longest)
            except queue.Empty:
                return
            if sample is None:
                return
            news = clocks.monotonic()
            changes(sample)

    was_quiet = False
    while left() > 0:
        before = peers()
        if not before <= known:
            news, known = clocks.monotonic(), known | before
        # Silence alone proves nothing: a busy peer is silent too. Its answer comes after all its tokens.
        ask(functools.partial(arrived.put, None), LONGEST)
        collect(LONGEST)
        if was_quiet and peers() == before:
            break
        collect(max(QUIET, (clocks.monotonic() - begin) / 2))  # what has taken long so far may have longer gaps
        was_quiet = True
    return changes.alive
