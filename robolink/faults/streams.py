"""Random numbers of a name: the same on every machine, and none of them changes when somebody draws elsewhere."""

from __future__ import annotations

import random
from collections.abc import Callable
from hashlib import blake2b


def uniform(seed: int, *names: str) -> Callable[[], float]:
    """Give the function that draws from [0, 1), its numbers a matter of the seed and the names alone.

    Only `random` of Python's Mersenne Twister is used, which is the same in every version and on every machine.
    """
    text = "\0".join((str(seed), *names))
    return random.Random(int.from_bytes(blake2b(text.encode(), digest_size=16).digest(), "big")).random
