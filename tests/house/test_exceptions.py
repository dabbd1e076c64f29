"""The tree of exceptions that is drawn at the top of its file is the one that the classes make."""

from __future__ import annotations

import re

import robolink.exceptions as exceptions
from robolink.exceptions import RobolinkError

DRAWN = exceptions.__doc__ or ""


def test_every_exception_is_drawn_below_its_base() -> None:
    known = {name: kind for name, kind in vars(exceptions).items() if isinstance(kind, type)}
    errors = {name: kind for name, kind in known.items() if issubclass(kind, RobolinkError)}
    above: dict[int, str] = {0: "RobolinkError"}
    found = set()
    for line in DRAWN.splitlines():
        if not (match := re.match(r"(?P<lead>(?:│   |    )*)[├└]─ (?P<names>\w+(?:, \w+)*)", line)):
            continue
        level = len(match["lead"]) // 4 + 1
        names = match["names"].split(", ")
        above[level] = names[0]
        for name in names:
            assert errors[above[level - 1]] in errors[name].__bases__, f"{name} is not a {above[level - 1]}"
            found.add(name)
    assert found == set(errors) - {"RobolinkError"}
