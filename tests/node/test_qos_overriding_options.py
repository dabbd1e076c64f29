"""QoS by parameters: which there are, what they change, and what they cannot say."""

from __future__ import annotations

from typing import Any

import pytest

from robolink import Context, Duration, Node, Parameter, QoSProfile
from robolink.exceptions import InvalidParameterTypeException, ParameterImmutableException
from robolink.interfaces.std_msgs.msg import Int32
from robolink.qos import DurabilityPolicy, HistoryPolicy, InvalidQoSProfileException, QoSPolicyKind, ReliabilityPolicy
from robolink.qos_overriding_options import InvalidQosOverridesError, QosCallbackResult, QoSOverridingOptions

ALL = QoSOverridingOptions([each for each in QoSPolicyKind if each is not QoSPolicyKind.INVALID])
USUAL = QoSOverridingOptions.with_default_policies()
PUBLISHED = "qos_overrides./lab/scan.publisher."


def made(context: Context, **overrides: Any) -> Node:
    given = [Parameter(PUBLISHED + name, value=value) for name, value in overrides.items()]
    return Node("robot", namespace="/lab", context=context, parameter_overrides=given)


def names(node: Node) -> list[str]:
    return sorted(node.get_parameters_by_prefix("qos_overrides"))


def test_without_options_there_are_no_parameters(context: Context) -> None:
    node = made(context, depth=5)
    assert node.create_publisher(Int32, "scan", 10).qos_profile.depth == 10
    assert names(node) == []


def test_the_usual_ones_are_history_depth_and_reliability(context: Context) -> None:
    node = made(context)
    node.create_publisher(Int32, "scan", 10, qos_overriding_options=USUAL)
    node.create_subscription(Int32, "scan", print, 10, qos_overriding_options=USUAL)
    ends = [
        f"/lab/scan.{end}.{each}"
        for end in ("publisher", "subscription")
        for each in ("depth", "history", "reliability")
    ]
    assert names(node) == ends
    assert node.get_parameter(PUBLISHED + "history").value == "keep_last"
    assert node.get_parameter(PUBLISHED + "depth").value == 10
    with pytest.raises(ParameterImmutableException):
        node.undeclare_parameter(PUBLISHED + "depth")


def test_parameters_change_the_profile_but_not_the_callers_copy(context: Context) -> None:
    profile = QoSProfile(depth=10)
    overrides = {"depth": 3, "reliability": "best_effort", "durability": "transient_local", "deadline": 10**9}
    publisher = made(context, **overrides).create_publisher(Int32, "scan", profile, qos_overriding_options=ALL)
    found = publisher.qos_profile
    assert (found.depth, found.reliability) == (3, ReliabilityPolicy.BEST_EFFORT)
    assert (found.durability, found.deadline) == (DurabilityPolicy.TRANSIENT_LOCAL, Duration(seconds=1))
    assert profile == QoSProfile(depth=10)


def test_a_subscription_has_no_lifespan(context: Context) -> None:
    node = made(context)
    node.create_subscription(Int32, "scan", print, 10, qos_overriding_options=ALL)
    assert len(names(node)) == len(list(ALL.policy_kinds)) - 1
    assert not node.has_parameter("qos_overrides./lab/scan.subscription.lifespan")


def test_an_id_tells_two_apart_and_the_same_one_shares(context: Context) -> None:
    node = made(context, depth=4)
    special = QoSOverridingOptions([QoSPolicyKind.DEPTH], entity_id="slow")
    depths = [
        node.create_publisher(Int32, "scan", 10, qos_overriding_options=options).qos_profile.depth
        for options in (special, USUAL, USUAL)
    ]
    assert depths == [10, 4, 4]
    assert node.has_parameter("qos_overrides./lab/scan.publisher_slow.depth")


@pytest.mark.parametrize(
    ("overrides", "error", "text"),
    [
        ({"reliability": "best_efort"}, InvalidQosOverridesError, r"best_efort' \(did you mean 'best_effort'\?\)"),
        ({"history": ""}, InvalidQosOverridesError, "it can be system_default, keep_last"),
        ({"depth": -1}, InvalidQoSProfileException, "must not be negative"),
        ({"depth": "ten"}, InvalidParameterTypeException, "INTEGER"),
    ],
)
def test_what_is_no_profile_is_refused(context: Context, overrides: Any, error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        made(context, **overrides).create_publisher(Int32, "scan", 10, qos_overriding_options=USUAL)


def test_the_nodes_own_check_sees_the_outcome_and_may_refuse(context: Context) -> None:
    def check(profile: QoSProfile) -> QosCallbackResult:
        return QosCallbackResult(successful=profile.depth < 100, reason="too deep")

    options = QoSOverridingOptions.with_default_policies(callback=check)
    assert made(context, depth=99).create_publisher(Int32, "scan", 1, qos_overriding_options=options)
    with pytest.raises(InvalidQosOverridesError, match=r"/lab/scan.*too deep"):
        made(context, depth=100).create_publisher(Int32, "scan", 1, qos_overriding_options=options)


def test_a_profile_that_leaves_a_policy_unknown_has_no_default(context: Context) -> None:
    profile = QoSProfile(history=HistoryPolicy.UNKNOWN, depth=1)
    with pytest.raises(ValueError, match="history is UNKNOWN"):
        made(context).create_publisher(Int32, "scan", profile, qos_overriding_options=USUAL)
