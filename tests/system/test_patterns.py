"""Patterns that are compiled late: each is right, and used once it behaves as a compiled one."""

from __future__ import annotations

import importlib
import pkgutil
import re
from pathlib import Path

import pytest

import robolink
from robolink.system.patterns import late


def late_patterns() -> list[tuple[str, re.Pattern[str]]]:
    kind = type(late(""))
    found = []
    for each in pkgutil.walk_packages(robolink.__path__, "robolink."):
        spec = each.module_finder.find_spec(each.name, None)
        origin = spec.origin if spec is not None else None
        if origin is None or "system.patterns import late" not in Path(origin).read_text(encoding="utf-8"):
            continue
        module = importlib.import_module(each.name)
        found += [(f"{each.name}.{name}", value) for name, value in vars(module).items() if isinstance(value, kind)]
    return found


@pytest.mark.slow
def test_each_pattern_of_robolink_can_be_compiled() -> None:
    found = late_patterns()
    assert len(found) > 50
    for name, pattern in found:
        assert pattern.groups >= 0, name


def test_a_late_pattern_has_what_a_pattern_has() -> None:
    pattern = late(r"(?P<word>[a-z]+)\d", re.IGNORECASE)
    match = pattern.fullmatch("Ab1")
    assert match is not None
    assert match["word"] == "Ab"
    assert pattern.sub("_", "ab1 cd2") == "_ _"
    assert (pattern.groups, pattern.pattern) == (1, r"(?P<word>[a-z]+)\d")
    assert late(rb"\d").search(b"a1") is not None


def test_a_late_pattern_is_not_compiled_before_its_use() -> None:
    wrong = late("(")
    with pytest.raises(re.error):
        wrong.search("")
