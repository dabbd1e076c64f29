"""Tokens that are alive in one session's view of a DDS domain, and the watches that are told of changes."""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Callable

from robolink.dds.worker import Worker
from robolink.system.waits import fork_lock
from robolink.transport.patterns import matcher

OnChange = Callable[[str, bool], object]


class Tokens:
    """Set of tokens: this session's own, and those that stand for what other participants have."""

    def __init__(self, worker: Worker) -> None:
        self._worker = worker
        self._lock = fork_lock()
        self._alive: Counter[str] = Counter()
        self._watches: tuple[Watch, ...] = ()

    def add(self, token: str) -> None:
        """Add a token; one that is there already is counted."""
        with self._lock:
            self._alive[token] += 1
            if self._alive[token] == 1:
                self._tell(token, True)

    def remove(self, token: str) -> None:
        """Remove a token that was added; it goes when it has been removed as often."""
        with self._lock:
            self._alive[token] -= 1
            if self._alive[token] <= 0:
                del self._alive[token]
                self._tell(token, False)

    def matching(self, pattern: str) -> list[str]:
        """Return the tokens that match a key expression, sorted."""
        with self._lock:
            return sorted(filter(matcher(pattern), self._alive))

    def watch(self, pattern: str, on_change: OnChange) -> Watch:
        """Call `on_change` on the worker's thread for each token that matches, those already there first."""
        watch = Watch(self, pattern, on_change)
        with self._lock:
            self._watches = (*self._watches, watch)
            for token in filter(watch.matches, sorted(self._alive)):
                self._worker.post(functools.partial(watch.tell, token, True))
        return watch

    def forget(self, watch: Watch) -> None:
        """Forget a watch, which is called no more."""
        with self._lock:
            self._watches = tuple(each for each in self._watches if each is not watch)

    def close(self) -> None:
        """End all watches."""
        for watch in self._watches:
            watch.close()

    def _tell(self, token: str, alive: bool) -> None:
        for watch in self._watches:
            if watch.matches(token):
                self._worker.post(functools.partial(watch.tell, token, alive))


class Watch:
    """A watch of tokens, until it is closed."""

    def __init__(self, tokens: Tokens, pattern: str, on_change: OnChange) -> None:
        self._tokens, self.matches = tokens, matcher(pattern)
        self._on_change: OnChange | None = on_change

    def tell(self, token: str, alive: bool) -> None:
        """Report a change, unless the watch has been closed meanwhile."""
        if (on_change := self._on_change) is not None:
            on_change(token, alive)

    def close(self) -> None:
        """Report no more changes. Safe to call twice."""
        self._on_change = None
        self._tokens.forget(self)
