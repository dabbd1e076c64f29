"""Named random number streams: the same on every machine, and independent of each other."""

from __future__ import annotations

import random
from collections.abc import Callable
from hashlib import blake2b


def uniform(seed: int, *names: str) -> Callable[[], float]:
    """Return a function that draws from [0, 1), its numbers determined by the seed and the names alone.

    Only `random` of Python's Mersenne Twister is used, which is the same in every version and on every machine.
    """
    text = "\0".join((str(seed), *names))
    return random.Random(int.from_bytes(blake2b(text.encode(), digest_size=16).digest(), "big")).random
