"""Generator of constraints for pip: the lowest versions that pyproject.toml allows, to test that they are enough.

Usage: python tools/lowest.py > lowest.txt; pip install -c lowest.txt PATH/OF/THE/CLONE
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

PYPROJECT = Path(__file__).resolve().parent.parent / "pyproject.toml"
LOWER = re.compile(r'"([\w.-]+)(?:\[[\w,]+\])?\s*>=\s*([\w.]+)')
USERS = ("bag", "plot", "vision", "xacro", "security", "test")
"""Extras that users install; developers' tools are taken as they come."""


def lowest(text: str) -> Iterator[str]:
    """Yield a line for each dependency of a pyproject.toml that has a lower bound: `numpy==1.26`.

    It is read without tomllib, which Python 3.10 has not.
    """
    for name in ("dependencies", *USERS):
        found = re.search(rf"^{name} = \[(.*?)\](?: *#.*)?$", text, re.MULTILINE | re.DOTALL)
        for requirement, version in LOWER.findall(found[1] if found else ""):
            yield f"{requirement}=={version}"
            if requirement == "opencv-python":  # developers have its twin, which needs no window system
                yield f"{requirement}-headless=={version}"


if __name__ == "__main__":
    lines = lowest(PYPROJECT.read_text(encoding="utf-8"))
    sys.stdout.write("".join(f"{each}\n" for each in lines))
