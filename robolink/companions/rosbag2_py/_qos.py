"""QoS profiles as rosbag2_py has them: rclcpp's QoS with its chained setters, and rmw's numbers of policies."""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntEnum
from typing import Any

from robolink.bag.offered_qos import profiles_of_text
from robolink.duration import Duration as Span
from robolink.exceptions import DocumentError
from robolink.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSPolicyEnum, QoSProfile, ReliabilityPolicy


def _rmw(name: str, policy: type[QoSPolicyEnum]) -> Any:
    return IntEnum(
        f"rmw_qos_{name}_policy_t", {f"RMW_QOS_POLICY_{name.upper()}_{each.name}": each.value for each in policy}
    )


rmw_qos_history_policy_t = _rmw("history", HistoryPolicy)
"""Histories by rmw's names."""
rmw_qos_reliability_policy_t = _rmw("reliability", ReliabilityPolicy)
"""Reliabilities by rmw's names."""
rmw_qos_durability_policy_t = _rmw("durability", DurabilityPolicy)
"""Durabilities by rmw's names."""
rmw_qos_liveliness_policy_t = _rmw("liveliness", LivelinessPolicy)
"""Kinds of liveliness by rmw's names."""


class Duration(Span):
    """Span of time as rclcpp makes it: of seconds and nanoseconds."""

    def __init__(self, seconds: int, nanoseconds: int) -> None:
        super().__init__(seconds=seconds, nanoseconds=nanoseconds)


class QoS:
    """Profile with setters that return it: `QoS(10).reliable().transient_local()`.

    Args:
        history_depth: Number of samples that are kept.
    """

    def __init__(self, history_depth: int) -> None:
        self._profile = QoSProfile(depth=history_depth)

    @classmethod
    def of(cls, profile: QoSProfile) -> QoS:
        """Return the QoS of an rclpy profile."""
        made = cls(1)
        made._profile = QoSProfile(**(profile.to_dict() | {"history": HistoryPolicy.SYSTEM_DEFAULT}))
        made._profile.history = profile.history
        return made

    def to_profile(self) -> QoSProfile:
        """Return it as an rclpy profile."""
        return self._profile

    def keep_last(self, depth: int) -> QoS:
        """Keep the last `depth` samples."""
        self._profile.depth = depth
        return self._with(history=HistoryPolicy.KEEP_LAST)

    def keep_all(self) -> QoS:
        """Keep all samples."""
        return self._with(history=HistoryPolicy.KEEP_ALL)

    def reliable(self) -> QoS:
        """Set the reliability RELIABLE."""
        return self._with(reliability=ReliabilityPolicy.RELIABLE)

    def best_effort(self) -> QoS:
        """Set the reliability BEST_EFFORT."""
        return self._with(reliability=ReliabilityPolicy.BEST_EFFORT)

    def durability_volatile(self) -> QoS:
        """Set the durability VOLATILE."""
        return self._with(durability=DurabilityPolicy.VOLATILE)

    def transient_local(self) -> QoS:
        """Set the durability TRANSIENT_LOCAL."""
        return self._with(durability=DurabilityPolicy.TRANSIENT_LOCAL)

    def history(self, policy: int) -> QoS:
        """Set the history."""
        return self._with(history=HistoryPolicy(policy))

    def reliability(self, policy: int) -> QoS:
        """Set the reliability."""
        return self._with(reliability=ReliabilityPolicy(policy))

    def durability(self, policy: int) -> QoS:
        """Set the durability."""
        return self._with(durability=DurabilityPolicy(policy))

    def liveliness(self, policy: int) -> QoS:
        """Set the liveliness."""
        return self._with(liveliness=LivelinessPolicy(policy))

    def deadline(self, duration: Span) -> QoS:
        """Set the deadline."""
        return self._with(deadline=duration)

    def lifespan(self, duration: Span) -> QoS:
        """Set the lifespan."""
        return self._with(lifespan=duration)

    def liveliness_lease_duration(self, duration: Span) -> QoS:
        """Set the lease duration of the liveliness."""
        return self._with(liveliness_lease_duration=duration)

    def avoid_ros_namespace_conventions(self, avoids: bool) -> QoS:
        """Set whether the topic's name is not a ROS name."""
        return self._with(avoid_ros_namespace_conventions=avoids)

    def _with(self, **policies: Any) -> QoS:
        for name, value in policies.items():
            setattr(self._profile, name, value)
        return self

    def __eq__(self, other: object) -> bool:
        return isinstance(other, QoS) and self._profile == other._profile

    __hash__ = None  # type: ignore[assignment]  # mutable and compared by value

    def __repr__(self) -> str:
        return f"QoS of {self._profile!r}"


def to_rclcpp_qos_vector(serialized: str, version: int = 9) -> list[QoS]:
    """Return the profiles of a YAML text, in numbers or in words; `version` is for rosbag2's sake.

    Raises RuntimeError for a text that is not YAML.
    """
    try:
        return [QoS.of(each) for each in profiles_of_text(serialized)]
    except DocumentError as error:
        raise RuntimeError(f"Exception on parsing QoS: {error}") from None


def convert_rclcpp_qos_to_rclpy_qos(qos: QoS) -> QoSProfile:
    """Return a profile of rclpy."""
    return QoS.of(qos.to_profile()).to_profile()


def profiles_of(offered: str | Iterable[QoS | QoSProfile]) -> tuple[QoSProfile, ...]:
    """Return the profiles that a program gives for a topic: a YAML text, as in Humble, or a list."""
    found = to_rclcpp_qos_vector(offered) if isinstance(offered, str) else offered
    return tuple(each.to_profile() if isinstance(each, QoS) else each for each in found)
