"""Patches of the operating system's entropy: a program's comes from a generator seeded by the host, so that it repeats.

`os.urandom` is behind `uuid.uuid4`, `secrets`, `random.SystemRandom` and a generator of numpy's that is given no seed;
`random.Random` takes its own seed where it is given none. For everybody else nothing changes.
"""

from __future__ import annotations

import os
import random
from typing import Any

from robolink.host.participants import ProgramLike
from robolink.running.defaults import get_defaults

_real_urandom, _real_seed = os.urandom, random.Random.seed


def stream(seed: int, program: str) -> random.Random:
    """Return the seeded generator of a program's entropy; it goes on when the program starts again."""
    return random.Random(f"{seed} {program}")


def replacements() -> dict[str, Any]:
    """Return the replacements of this subject by the dotted path of Python's name."""
    return {
        "os.urandom": _urandom,
        "random._urandom": _urandom,
        "random.Random.seed": _seed,
        "random.seed": _seed_all,
    }


def _drawn(size: int) -> bytes | None:
    """Return bytes of the entropy of the program whose code this is; None if that is the operating system's."""
    program: ProgramLike | None = get_defaults().program
    return None if program is None else program.chance.randbytes(size)


def _urandom(size: int, /) -> bytes:
    return _real_urandom(size) if size < 0 or (drawn := _drawn(size)) is None else drawn


def _seed(self: random.Random, a: Any = None, version: int = 2) -> None:
    drawn = None if a is not None else _drawn(16)
    _real_seed(self, a if drawn is None else int.from_bytes(drawn, "big"), version)


def _seed_all(a: Any = None, version: int = 2) -> None:
    _seed(random._inst, a, version)
