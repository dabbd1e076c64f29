"""Tree of the known frames, and the path from one frame to another; times in ns, not thread-safe."""

from __future__ import annotations

import math
from collections.abc import Iterator

from robolink.exceptions import nearest
from robolink.system.terminal import shown
from robolink.tf2 import listing
from robolink.tf2.cache import LATEST, Link, StaticCache, TimeCache
from robolink.tf2.exceptions import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
)
from robolink.tf2.rigid import IDENTITY, Rigid, compose, inverse, signed, unit

NORM_TOLERANCE = 0.01
"""Tolerance of a quaternion's squared norm, beyond which it is refused."""

Path = tuple[list[Link], list[Link]]
"""Links from a source frame up to where it meets a target frame, and from the target up to there."""


class Tree:
    """Frames by name, each with its cache; a frame that is only a parent has none."""

    def __init__(self, keep: int) -> None:
        self.keep = keep
        self.caches: dict[str, TimeCache | StaticCache | None] = {}

    # Input

    def insert(self, parent: str, child: str, stamp: int, rigid: Rigid, *, static: bool) -> tuple[str, str] | None:
        """Insert a transform; return None, or tf2's word for what is wrong with it and the reason."""
        wrong = _what_is_wrong(parent, child, rigid)
        if wrong is not None:
            return wrong
        if self._would_loop(parent, child, stamp):  # tf2 takes it in, and then fails at each lookup
            return "TF_LOOP", f"'{parent}' is below '{child}' already"
        if static:
            self.caches[child] = StaticCache(parent, unit(rigid))
        else:
            cache = self.caches.get(child)
            if not isinstance(cache, TimeCache):
                cache = self.caches[child] = TimeCache(self.keep)
            if not cache.insert(stamp, parent, unit(rigid)):
                late = (cache.newest - stamp) / 1e9
                return "TF_OLD_DATA", f"it is {late:.3f} s older than the latest, and {self.keep / 1e9:g} s are kept"
        self.caches.setdefault(parent)
        return None

    def _would_loop(self, parent: str, child: str, stamp: int) -> bool:
        """True if the parent is below the child at that time, as far as is known."""
        if child not in self.caches or self._parent(child, stamp) == parent:
            return False
        seen: set[str] = set()
        above: str | None = parent
        while above is not None and above not in seen:
            if above == child:
                return True
            seen.add(above)
            above = self._parent(above, stamp)
        return False

    def _parent(self, frame: str, stamp: int) -> str | None:
        cache = self.caches.get(frame)
        return None if cache is None else cache.parent_near(stamp)

    def clear(self) -> None:
        """Remove all transforms but the static ones; the frames stay known."""
        for cache in self.caches.values():
            if cache is not None:
                cache.clear()

    # Queries

    def check(self, frame: str, asker: str) -> None:
        """Raise InvalidArgumentException for an invalid name, LookupException for an unknown frame."""
        if not frame or frame.startswith("/"):
            wrong = "cannot start with a '/'" if frame else "cannot be empty"
            raise InvalidArgumentException(
                f'Invalid argument "{shown(frame)}" passed to {asker} - in tf2 frame_ids {wrong}'
            )
        if frame not in self.caches:
            close = nearest(frame[:100], self.caches)
            raise LookupException(f'"{shown(frame)}" passed to {asker} does not exist.{close}')

    def transform(self, target: str, source: str, time: int, asker: str) -> tuple[Rigid, int]:
        """Return the transform from source to target at a time, and that time itself where it is the latest."""
        (up, down), stamp = self.path(target, source, time, asker)
        total = _total(up)
        if down:
            total = compose(inverse(_total(down)), total)
        return signed(unit(total)), stamp

    def path(self, target: str, source: str, time: int, asker: str) -> tuple[Path, int]:
        """Return the links between two frames at a time, and that time itself where it is the latest.

        Raises what `check` raises, ConnectivityException and ExtrapolationException.
        """
        if target == source:
            cache = self.caches.get(target)
            return ([], []), cache.newest if cache is not None and time == LATEST else time
        self.check(target, f"{asker} target_frame")
        self.check(source, f"{asker} source_frame")
        path = self._path(target, source, time)
        if time != LATEST:
            return path, time
        stamps = {link.stamp for half in path for link in half} - {LATEST}
        common = min(stamps, default=LATEST)
        return path if len(stamps) < 2 else self._path(target, source, common), common

    def chain(self, target: str, source: str, time: int, asker: str) -> list[str]:
        """Return the frames from source to target, with both of them. Raises what `path` raises."""
        (up, down), _ = self.path(target, source, time, asker)
        names = [source, *(link.parent for link in up)]
        return [*names, *(link.parent for link in reversed(down[:-1])), target] if down else names

    def _path(self, target: str, source: str, time: int) -> Path:
        """Return the links from both frames up to the first frame that they share, and no further."""
        up: list[Link] = []
        down: list[Link] = []
        met = {source: 0}
        gap: ExtrapolationException | None = None
        try:
            for link in self._links(source, time):
                up.append(link)
                if link.parent == target:
                    return up, []
                met[link.parent] = len(up)
        except ExtrapolationException as error:
            gap = error  # which does not matter when they meet below
        try:
            for link in self._links(target, time):
                down.append(link)
                if link.parent in met:
                    return up[: met[link.parent]], down
        except ExtrapolationException as error:
            gap = error
        if gap is not None:
            raise ExtrapolationException(f"{gap}, when looking up transform from frame [{source}] to frame [{target}]")
        raise ConnectivityException(
            f"Could not find a connection between '{target}' and '{source}' because they are not part of the same"
            f" tree. Tf has two or more unconnected trees: '{target}' is in that of '{_top(down, target)}',"
            f" '{source}' in that of '{_top(up, source)}'."
        )

    def _links(self, frame: str, time: int) -> Iterator[Link]:
        """Yield the links from a frame up to the root of its tree."""
        seen = {frame}
        while True:
            cache = self.caches.get(frame)
            if cache is None or (time == LATEST and not len(cache)):
                return
            link = cache.at(time)
            yield link
            frame = link.parent
            if frame in seen:
                text = listing.as_text(self.caches)
                raise LookupException(f"The tf tree is invalid because it contains a loop.\n{text}")
            seen.add(frame)


def _what_is_wrong(parent: str, child: str, rigid: Rigid) -> tuple[str, str] | None:
    if not child:
        return "TF_NO_CHILD_FRAME_ID", "its child_frame_id is empty"
    if not parent:
        return "TF_NO_FRAME_ID", "its header.frame_id is empty"
    if parent == child:
        return "TF_SELF_TRANSFORM", "parent and child are one frame"
    if not all(map(math.isfinite, rigid)):
        return "TF_NAN_INPUT", f"not all of its values are finite numbers: {rigid[:3]} {rigid[3:]}"
    square = sum(each * each for each in rigid[3:])
    if abs(square - 1.0) >= NORM_TOLERANCE:
        return "TF_DENORMALIZED_QUATERNION", f"its rotation {rigid[3:]} has a norm of {square**0.5:.3g}, not 1"
    return None


def _total(links: list[Link]) -> Rigid:
    """Compose links, the lowest first."""
    if not links:
        return IDENTITY
    total = links[0].rigid()
    for link in links[1:]:
        total = compose(link.rigid(), total)
    return total


def _top(links: list[Link], frame: str) -> str:
    return links[-1].parent if links else frame
