"""Files of QoS profiles by topic."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.bag.qos import read_qos_overrides
from robolink.duration import Duration
from robolink.exceptions import DocumentError
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy


def test_profiles_are_read_by_topic(tmp_path: Path) -> None:
    path = tmp_path / "qos.yaml"
    path.write_text(
        "/scan:\n  history: keep_last\n  depth: 7\n  reliability: best_effort\n  deadline: {sec: 1, nsec: 500}\n"
        "/map:\n  history: keep_all\n  durability: transient_local\n"
    )
    assert read_qos_overrides(path) == {
        "/scan": QoSProfile(
            depth=7, reliability=ReliabilityPolicy.BEST_EFFORT, deadline=Duration(seconds=1, nanoseconds=500)
        ),
        "/map": QoSProfile(history=HistoryPolicy.KEEP_ALL, durability=DurabilityPolicy.TRANSIENT_LOCAL),
    }


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("/scan:\n  depth: 1\n  reliabilty: reliable\n", r"qos.yaml:3:3: .*reliabilty"),
        ("/scan:\n  depth: 1\n  reliability: maybe\n", r"qos.yaml:3:16: .*maybe"),
        ("/scan:\n  depth: -1\n", r"qos.yaml:2:10: .*depth"),
        ("/scan:\n  reliability: reliable\n", r"qos.yaml:\d+:\d+: .*history and/or depth"),
        ("/scan:\n  depth: 1\n  deadline: {sec: 1}\n", r"qos.yaml:3:13: .*nsec"),
        ("scan:\n  depth: 1\n", r"qos.yaml:1:1: .*full name"),
        ("- /scan\n", r"qos.yaml:1:1: "),
    ],
)
def test_mistakes_are_told_with_their_place(text: str, said: str) -> None:
    with pytest.raises(DocumentError, match=said):
        read_qos_overrides("qos.yaml", text=text)


@given(st.text() | st.recursive(st.none() | st.integers() | st.text(), lambda each: st.lists(each)).map(repr))
def test_any_text_is_profiles_or_one_error(text: str) -> None:
    said, found = "", dict[str, QoSProfile]()
    try:
        found = read_qos_overrides("qos.yaml", text=text)
    except DocumentError as error:
        said = str(error)
    assert "\n" not in said
    assert all(isinstance(each, QoSProfile) for each in found.values())
