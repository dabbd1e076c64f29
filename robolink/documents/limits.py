"""Limits of how many mistakes of a file are looked for, and reported."""

from __future__ import annotations

import itertools
from collections.abc import Iterable

from robolink.exceptions import DocumentError

MOST_TOLD, MOST_MISTAKES = 20, 100
"""Most mistakes of a file that are reported, and that are looked for."""


def first_mistakes(errors: Iterable[DocumentError], looked_for: int | None = None) -> list[DocumentError]:
    """Return the first `errors` of a file, and in place of the others one that says how many they are.

    No more than `looked_for` are counted, where finding each takes time.
    """
    found = list(itertools.islice(errors, looked_for))
    if len(found) <= MOST_TOLD + 1:
        return found
    more = f"{len(found) - MOST_TOLD:,}" if looked_for is None or len(found) < looked_for else "many"
    return [*found[:MOST_TOLD], DocumentError(f"and {more} more mistakes", found[MOST_TOLD].file)]
