"""What a short name means: written once for nodes, robots and settings, with one kind of error."""

from __future__ import annotations

from collections.abc import Collection

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.exceptions import AmbiguousNameError, NotFoundError
from robolink.text.names import meant, near, the_one

FLEET = ["world", "/ada/scan", "bob/scan", "bob/arm/scan", "scanner"]


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("world", ["world"]),
        ("/world", ["world"]),
        ("scan", ["/ada/scan", "bob/scan", "bob/arm/scan"]),
        ("bob/scan", ["bob/scan"]),
        ("/ada/scan", ["/ada/scan"]),
        ("ada/scan", ["/ada/scan"]),
        ("arm/scan", ["bob/arm/scan"]),
        ("can", []),
        ("ada", []),
    ],
)
def test_a_whole_name_goes_before_its_last_part(name: str, found: list[str]) -> None:
    assert meant(name, FLEET) == found
    assert meant(name, iter(FLEET)) == found


def test_a_name_at_the_top_is_not_that_of_others() -> None:
    assert meant("odom", ["/odom", "/ada/odom"]) == ["/odom"]


def test_the_only_one_is_given() -> None:
    assert the_one("node", "arm/scan", FLEET) == "bob/arm/scan"


def test_none_is_told_with_the_nearest() -> None:
    with pytest.raises(
        NotFoundError, match=r"^no node named 'wrld' in the system \(did you mean 'world'\?\)$"
    ) as caught:
        the_one("node", "wrld", FLEET, "the system")
    assert (caught.value.kind, caught.value.name) == ("node", "wrld")
    assert not isinstance(caught.value, AmbiguousNameError)


def test_several_are_all_told() -> None:
    with pytest.raises(
        AmbiguousNameError,
        match=r"^which node 'scan'\? There are /ada/scan, bob/scan, bob/arm/scan: give a whole name$",
    ) as caught:
        the_one("node", "scan", FLEET)
    assert isinstance(caught.value, LookupError)
    assert (caught.value.kind, caught.value.name) == ("node", "scan")


def test_the_same_last_part_is_nearer_than_similar_letters() -> None:
    assert near("/odom", ["/ada/odom", "/odor"]) == " (did you mean '/ada/odom'?)"
    assert near("/odom", ["/odor"]) == " (did you mean '/odor'?)"
    assert near("/odom", []) == ""


PARTS = st.lists(st.sampled_from(["a", "b", "c"]), min_size=1, max_size=3).map("/".join)


@given(PARTS, st.lists(PARTS, max_size=6, unique=True))
def test_what_is_meant_is_known_and_ends_so(name: str, known: Collection[str]) -> None:
    found = meant(name, known)
    assert set(found) <= set(known)
    assert all(f"/{each}".endswith(f"/{name}") for each in found)
    assert found == [name] or name not in known
