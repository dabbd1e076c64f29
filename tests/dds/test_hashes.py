"""Hashes of types whose owner does not tell them."""

from __future__ import annotations

import pytest

from robolink.dds import hashes
from robolink.dds.hashes import Hashes
from robolink.interfaces.std_msgs.msg import String
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import type_hash
from robolink.wire import NO_HASH

THEIRS = "RIHS01_" + "ab" * 32


def test_installed_types_are_known() -> None:
    table = Hashes(print)
    assert table.of("std_msgs/msg/String") == type_hash(String)
    assert table.of("std_srvs/srv/SetBool") == type_hash(SetBool)
    assert table.of_part("std_srvs/srv/SetBool", "Request") == type_hash(SetBool.Request)
    assert table.of_part("std_srvs/srv/SetBool", "Nothing") == NO_HASH


@pytest.mark.parametrize("name", ["my/msg/Unknown", "std_msgs/msg/Unknown", "x", "", "a" * 5000, "std_msgs/srv/String"])
def test_what_is_not_installed_is_unknown(name: str) -> None:
    assert Hashes(print).of(name) == NO_HASH


def test_an_unknown_one_is_learned_once_and_told() -> None:
    learned: list[str] = []
    table = Hashes(learned.append)
    table.note("my/msg/First", THEIRS)  # nobody has asked for it yet
    assert table.of("my/msg/Second") == NO_HASH
    for _ in range(2):
        table.note("my/msg/Second", NO_HASH)
        table.note("my/msg/Second", THEIRS)
    assert learned == ["my/msg/Second"]
    assert [table.of(f"my/msg/{name}") for name in ("First", "Second")] == [THEIRS, THEIRS]


def test_strangers_names_are_looked_for_only_so_often(monkeypatch: pytest.MonkeyPatch) -> None:
    looked: list[str] = []

    def look(name: str, part: str) -> str:
        looked.append(name)
        return NO_HASH

    monkeypatch.setattr(hashes, "_installed", look)
    learned: list[str] = []
    table = Hashes(learned.append)
    for number in range(3000):
        assert table.of(f"my/msg/T{number}") == NO_HASH
    assert len(looked) == hashes.MOST_UNKNOWN
    table.note("my/msg/T2999", THEIRS)
    assert table.of("my/msg/T2999") == THEIRS
    assert learned == ["my/msg/T2999"]
