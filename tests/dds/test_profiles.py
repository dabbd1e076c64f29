"""Quality of service on DDS: what profiles announce, and by which policies a reader and a writer do not match."""

from __future__ import annotations

import warnings

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.dds.profiles import announced, profile_of, shortcomings
from robolink.duration import Duration
from robolink.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_system_default,
    resolved,
)
from robolink.rtps import Qos
from robolink.rtps.discovery import fits

spans = st.one_of(st.none(), st.integers(1, 10**14).map(lambda ns: ns / 1e9))
qualities = st.builds(
    Qos,
    reliable=st.booleans(),
    transient_local=st.booleans(),
    depth=st.integers(-1, 5),
    deadline=spans,
    lifespan=spans,
    liveliness=st.sampled_from([0, 1, 2]),
    lease=spans,
)
profiles = st.builds(
    QoSProfile,
    history=st.sampled_from([HistoryPolicy.KEEP_LAST, HistoryPolicy.KEEP_ALL]),
    depth=st.integers(1, 100),
    reliability=st.sampled_from([ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT]),
    durability=st.sampled_from([DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL]),
    deadline=st.integers(0, 10**12).map(lambda ns: Duration(nanoseconds=ns)),
    liveliness=st.sampled_from([LivelinessPolicy.AUTOMATIC, LivelinessPolicy.MANUAL_BY_TOPIC]),
)


@given(profiles)
def test_a_profile_comes_back(profile: QoSProfile) -> None:
    expected = resolved(profile)
    if profile.history is HistoryPolicy.KEEP_ALL:
        expected.depth = 0  # nobody tells one
    assert profile_of(announced(profile)) == expected


def test_what_is_left_to_the_system_is_announced_as_the_default() -> None:
    assert announced(qos_profile_system_default) == Qos(True, False, 42, None, None, 0, None)


def test_a_peer_that_tells_no_depth_has_the_systems() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = profile_of(Qos(depth=-1))
    assert (found.history, found.depth) == (HistoryPolicy.SYSTEM_DEFAULT, 0)


@given(qualities)
def test_any_quality_of_a_peer_is_a_profile(quality: Qos) -> None:
    assert isinstance(profile_of(quality), QoSProfile)


@given(qualities, qualities)
def test_what_lacks_nothing_is_what_the_participant_matches(requested: Qos, offered: Qos) -> None:
    assert (shortcomings(requested, offered) == []) == fits(offered, requested)


@pytest.mark.parametrize(
    ("requested", "offered", "lacking"),
    [
        (Qos(), Qos(), []),
        (Qos(reliable=False), Qos(transient_local=True), []),
        (Qos(), Qos(reliable=False), ["reliability"]),
        (Qos(transient_local=True), Qos(), ["durability"]),
        (Qos(deadline=1.0), Qos(), ["deadline"]),
        (Qos(deadline=1.0), Qos(deadline=1.0), []),
        (Qos(liveliness=2, lease=1.0), Qos(liveliness=0, lease=2.0), ["liveliness", "liveliness lease"]),
    ],
)
def test_the_policies_that_lack_are_named(requested: Qos, offered: Qos, lacking: list[str]) -> None:
    assert shortcomings(requested, offered) == lacking
