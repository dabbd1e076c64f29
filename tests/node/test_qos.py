"""QoS profiles behave as rclpy's."""

from __future__ import annotations

import subprocess
import sys

import pytest

from robolink import qos
from robolink.duration import Duration, Infinite
from robolink.exceptions import RobolinkError
from robolink.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    InvalidQoSProfileException,
    LivelinessPolicy,
    QoSCompatibility,
    QoSPolicyKind,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)


def test_depth_alone_keeps_the_last() -> None:
    profile = QoSProfile(depth=3)
    assert (profile.history, profile.depth) == (HistoryPolicy.KEEP_LAST, 3)
    assert (profile.reliability, profile.durability) == (ReliabilityPolicy.RELIABLE, DurabilityPolicy.VOLATILE)
    assert profile.liveliness is LivelinessPolicy.SYSTEM_DEFAULT
    assert profile.lifespan == profile.deadline == profile.liveliness_lease_duration == Duration()
    assert profile.avoid_ros_namespace_conventions is False


def test_keep_all_needs_no_depth() -> None:
    assert QoSProfile(history=HistoryPolicy.KEEP_ALL).depth == 10


@pytest.mark.parametrize("history", [None, HistoryPolicy.KEEP_LAST, 1])
def test_history_or_depth_is_required(history: HistoryPolicy | None) -> None:
    with pytest.raises(InvalidQoSProfileException, match="depth setting"):
        QoSProfile(history=history)


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("depth", "ten", "depth must be of type int, got 'ten'"),
        ("depth", -1, "must not be negative"),
        ("history", 9, "history must be one of SYSTEM_DEFAULT, KEEP_LAST, KEEP_ALL, UNKNOWN, got 9"),
        ("reliability", "reliable", "of type ReliabilityPolicy"),
        ("liveliness", 2, "one of SYSTEM_DEFAULT, AUTOMATIC, MANUAL_BY_TOPIC"),
        ("deadline", 3, "of type Duration, got 3"),
        ("avoid_ros_namespace_conventions", 1, "of type bool"),
    ],
)
def test_wrong_values_are_refused(name: str, value: object, text: str) -> None:
    profile = QoSProfile(depth=1)
    with pytest.raises(InvalidQoSProfileException, match=text) as caught:
        setattr(profile, name, value)
    assert isinstance(caught.value, RobolinkError)
    assert isinstance(caught.value, AssertionError)
    assert profile == QoSProfile(depth=1)


def test_a_misspelt_policy_is_refused() -> None:
    with pytest.raises(AttributeError, match="did you mean 'reliability'"):
        setattr(QoSProfile(depth=1), "relability", 1)  # noqa: B010 - mypy knows that it isn't there


def test_numbers_stand_for_policies() -> None:
    profile = QoSProfile(history=2, reliability=2, durability=1, liveliness=3)
    assert profile.history is HistoryPolicy.KEEP_ALL
    assert profile.reliability is ReliabilityPolicy.BEST_EFFORT
    assert profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
    assert profile.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC


def test_profiles_compare_by_value() -> None:
    assert QoSProfile(depth=1, deadline=Duration(seconds=2)) == QoSProfile(depth=1, deadline=Duration(seconds=2))
    assert QoSProfile(depth=1) != QoSProfile(depth=2)
    assert QoSProfile(depth=1) != "QoSProfile(depth=1)"


def test_a_profile_is_copied_through_its_dict() -> None:
    profile = QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        depth=12,
        reliability=ReliabilityPolicy.BEST_EFFORT,
        lifespan=Duration(seconds=5),
        avoid_ros_namespace_conventions=True,
    )
    copy = QoSProfile(**profile.get_c_qos_profile().to_dict())
    assert copy == profile
    copy.depth = 13
    assert profile.depth == 12


def test_repr_is_the_constructor() -> None:
    profile = QoSProfile(depth=7, lifespan=Duration(seconds=1), liveliness=LivelinessPolicy.AUTOMATIC)
    assert eval(repr(profile), vars(qos)) == profile
    assert repr(profile).startswith("QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=7, reliability=")
    assert str(profile).startswith(
        "QoSProfile(history=1, depth=7, reliability=1, durability=2, lifespan=1000000000 nanos"
    )


def test_a_depth_of_zero_is_warned_about() -> None:
    with pytest.warns(UserWarning, match="A zero depth with KEEP_LAST doesn't make sense"):
        profile = QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=0)
    with pytest.warns(UserWarning, match="SYSTEM_DEFAULT"):
        profile.depth = 0
    assert profile.depth == 0
    assert QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=0).depth == 0


def test_short_keys() -> None:
    assert HistoryPolicy.short_keys() == ["system_default", "keep_last", "keep_all", "unknown"]
    assert HistoryPolicy.get_from_short_key("KEEP_last") == HistoryPolicy.KEEP_LAST.value
    assert DurabilityPolicy.TRANSIENT_LOCAL.short_key == "transient_local"
    assert QoSPresetProfiles.get_from_short_key("Sensor_Data") is qos.qos_profile_sensor_data
    assert "services_default" in QoSPresetProfiles.short_keys()
    with pytest.raises(KeyError):
        ReliabilityPolicy.get_from_short_key("keep_last")


def test_rmws_long_names_still_work_with_a_warning() -> None:
    with pytest.warns(UserWarning, match="Use HistoryPolicy.KEEP_ALL instead"):
        assert HistoryPolicy.RMW_QOS_POLICY_HISTORY_KEEP_ALL is HistoryPolicy.KEEP_ALL
    with pytest.raises(AttributeError):
        _ = HistoryPolicy.RMW_QOS_POLICY_DURABILITY_VOLATILE
    with pytest.raises(AttributeError):
        _ = HistoryPolicy.KEEP_NONE


@pytest.mark.parametrize(
    ("preset", "depth", "reliability", "durability"),
    [
        (qos.qos_profile_default, 10, 1, 2),
        (qos.qos_profile_services_default, 10, 1, 2),
        (qos.qos_profile_sensor_data, 5, 2, 2),
        (qos.qos_profile_parameters, 1000, 1, 2),
        (qos.qos_profile_parameter_events, 1000, 1, 2),
        (qos.qos_profile_rosout_default, 1000, 1, 1),
        (qos.qos_profile_action_status_default, 1, 1, 1),
        (qos.qos_profile_system_default, 0, 0, 0),
        (qos.qos_profile_unknown, 0, 3, 3),
        (qos.qos_profile_best_available, 10, 4, 4),
    ],
)
def test_presets_are_rmws(preset: QoSProfile, depth: int, reliability: int, durability: int) -> None:
    assert (preset.depth, preset.reliability, preset.durability) == (depth, reliability, durability)


@pytest.mark.parametrize("preset", [each.value for each in QoSPresetProfiles])
def test_resolved_leaves_nothing_open(preset: QoSProfile) -> None:
    full = qos.resolved(preset)
    assert full.depth == (preset.depth or 42)
    assert full.history is HistoryPolicy.KEEP_LAST
    assert full.reliability in (ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT)
    assert full.durability in (DurabilityPolicy.TRANSIENT_LOCAL, DurabilityPolicy.VOLATILE)
    assert full.deadline == full.liveliness_lease_duration == Infinite
    assert full.lifespan == (preset.lifespan if preset.lifespan.nanoseconds else Infinite)
    assert full == qos.resolved(full)


def test_what_a_volatile_subscription_may_miss_is_a_warning() -> None:
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    best_effort = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    assert qos.qos_check_compatible(best_effort, QoSProfile(depth=1)) == (QoSCompatibility.OK, "")
    assert qos.qos_check_compatible(latched, latched) == (QoSCompatibility.OK, "")
    verdict, reason = qos.qos_check_compatible(latched, QoSProfile(depth=1))
    assert (verdict, reason[:8]) == (QoSCompatibility.WARNING, "WARNING:")


def test_policy_names() -> None:
    assert qos.qos_policy_name_from_kind(QoSPolicyKind.LIFESPAN) == "LIFESPAN"
    assert qos.qos_policy_name_from_kind(2) == "DURABILITY"
    with pytest.raises(ValueError, match="3"):
        qos.qos_policy_name_from_kind(3)


@pytest.mark.processes
def test_importing_it_is_light() -> None:
    code = "import sys, robolink.qos; print(*{'zenoh', 'msgspec', 'numpy'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
