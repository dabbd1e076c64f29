"""Quality of service (QoS): profiles of publishers, subscriptions, services and clients, and their policies."""

from __future__ import annotations

import warnings
from enum import Enum, EnumMeta, IntEnum
from typing import Any

from robolink.duration import Duration, Infinite
from robolink.exceptions import RobolinkError, nearest


class InvalidQoSProfileException(RobolinkError, ValueError, AssertionError):  # noqa: N818 - rclpy's name
    """A QoSProfile was given a value that it cannot have: `message` says which.

    rclpy asserts on wrong types, hence the third base.
    """

    def __init__(self, message: str) -> None:
        super().__init__(f"Invalid QoSProfile: {message}")


class QoSPolicyKind(IntEnum):
    """The policies of a profile, numbered as in rmw."""

    INVALID = 1 << 0
    DURABILITY = 1 << 1
    DEADLINE = 1 << 2
    LIVELINESS = 1 << 3
    RELIABILITY = 1 << 4
    HISTORY = 1 << 5
    LIFESPAN = 1 << 6
    DEPTH = 1 << 7
    LIVELINESS_LEASE_DURATION = 1 << 8
    AVOID_ROS_NAMESPACE_CONVENTIONS = 1 << 9


def qos_policy_name_from_kind(policy_kind: QoSPolicyKind | int) -> str:
    """Return the name of a policy, such as 'RELIABILITY'. Raises ValueError if no policy is `policy_kind`."""
    return QoSPolicyKind(policy_kind).name


class _PolicyMeta(EnumMeta):
    """Metaclass that finds rmw's long names of old, `RMW_QOS_POLICY_HISTORY_KEEP_LAST`, with a warning."""

    def __getattr__(cls, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if name in cls.__members__:  # Python 3.10 looks members up here
            return cls.__members__[name]
        prefix = f"RMW_QOS_POLICY_{cls.__name__.removesuffix('Policy').upper()}_"
        short = name.removeprefix(prefix)
        if short == name or short not in cls.__members__:
            raise AttributeError(name)
        warnings.warn(f"{cls.__name__}.{name} is deprecated. Use {cls.__name__}.{short} instead.", stacklevel=2)
        return cls.__members__[short]


class QoSPolicyEnum(IntEnum, metaclass=_PolicyMeta):
    """Base of the policies: values as in rmw, and short names for the command line."""

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the names of the values in lower case."""
        return [name.lower() for name in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> int:
        """Return the number of the value called `name`, in any case. Raises KeyError if there is none."""
        return cls[name.upper()].value

    @property
    def short_key(self) -> str:
        """Name of the value in lower case."""
        return self.name.lower()


class HistoryPolicy(QoSPolicyEnum):
    """History: which samples are kept until they are taken.

    KEEP_LAST keeps the latest `depth` samples and drops older ones, KEEP_ALL keeps all. SYSTEM_DEFAULT is KEEP_LAST.
    """

    SYSTEM_DEFAULT = 0
    KEEP_LAST = 1
    KEEP_ALL = 2
    UNKNOWN = 3


class ReliabilityPolicy(QoSPolicyEnum):
    """Reliability: RELIABLE samples are lost only to a peer that has long had no room, BEST_EFFORT ones at any time.

    SYSTEM_DEFAULT and BEST_AVAILABLE are RELIABLE.
    """

    SYSTEM_DEFAULT = 0
    RELIABLE = 1
    BEST_EFFORT = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class DurabilityPolicy(QoSPolicyEnum):
    """Durability: a TRANSIENT_LOCAL publisher sends late subscriptions its last samples, a VOLATILE one does not.

    The subscription must be TRANSIENT_LOCAL too to get them. SYSTEM_DEFAULT and BEST_AVAILABLE are VOLATILE.
    """

    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class LivelinessPolicy(QoSPolicyEnum):
    """Liveliness: how a publisher shows that it is alive. See `assert_liveliness` of a publisher."""

    SYSTEM_DEFAULT = 0
    AUTOMATIC = 1
    MANUAL_BY_TOPIC = 3
    UNKNOWN = 4
    BEST_AVAILABLE = 5


QoSHistoryPolicy = HistoryPolicy
QoSReliabilityPolicy = ReliabilityPolicy
QoSDurabilityPolicy = DurabilityPolicy
QoSLivelinessPolicy = LivelinessPolicy

DeadlineBestAvailable = Duration(nanoseconds=2**63 - 2)
"""Deadline that stands for "as the other end has it"."""
LivelinessLeaseDurationeBestAvailable = Duration(nanoseconds=2**63 - 2)  # rclpy spells it so
"""Lease duration that stands for "as the other end has it"."""

_FIELDS: dict[str, tuple[type, object]] = {
    "history": (HistoryPolicy, HistoryPolicy.KEEP_LAST),
    "depth": (int, 10),
    "reliability": (ReliabilityPolicy, ReliabilityPolicy.RELIABLE),
    "durability": (DurabilityPolicy, DurabilityPolicy.VOLATILE),
    "lifespan": (Duration, Duration()),
    "deadline": (Duration, Duration()),
    "liveliness": (LivelinessPolicy, LivelinessPolicy.SYSTEM_DEFAULT),
    "liveliness_lease_duration": (Duration, Duration()),
    "avoid_ros_namespace_conventions": (bool, False),
}
"""Fields of a profile in rclpy's order, each with its type and its default."""


class QoSProfile:
    """Quality of service of a publisher, subscription, service or client: `QoSProfile(depth=10)`.

    `history` or `depth` is required, and KEEP_LAST requires a depth. Policies may be given as rmw's numbers. Over
    Zenoh every pair of profiles can talk; where they differ, the weaker one holds. Deadline and
    liveliness have events, for which a publisher or subscription has callbacks. Nothing enforces a lifespan.

    Args:
        history: KEEP_LAST keeps the latest `depth` samples, KEEP_ALL keeps all; by default KEEP_LAST.
        depth: Number of samples that KEEP_LAST keeps: in a subscription until its callback takes them, in a
            TRANSIENT_LOCAL publisher for late joiners. 0 is the system's default, 42. By default 10 with KEEP_ALL.
        reliability: RELIABLE (the default) loses samples only to a peer that has long had no room; BEST_EFFORT may
            lose any, for data that is soon out of date, such as that of sensors.
        durability: VOLATILE (the default) or TRANSIENT_LOCAL, whose publishers send late subscriptions their last
            samples.
        lifespan: Duration after which a sample is out of date; zero (the default) is unlimited.
        deadline: Longest expected duration from sample to sample; zero (the default) is unlimited.
        liveliness: How a publisher shows that it is alive; by default SYSTEM_DEFAULT, which is AUTOMATIC.
        liveliness_lease_duration: Duration after which a silent publisher counts as gone; zero (the default) is
            unlimited.
        avoid_ros_namespace_conventions: True announces that the topic's name is not a ROS name; by default False.

    Raises:
        InvalidQoSProfileException: (a ValueError) if history and depth are missing, or for a value that a policy
            cannot have.
    """

    __slots__ = tuple(_FIELDS)
    __hash__ = None  # type: ignore[assignment]  # mutable and compared by value, like a list

    history: HistoryPolicy
    depth: int
    reliability: ReliabilityPolicy
    durability: DurabilityPolicy
    lifespan: Duration
    deadline: Duration
    liveliness: LivelinessPolicy
    liveliness_lease_duration: Duration
    avoid_ros_namespace_conventions: bool

    def __init__(
        self,
        history: HistoryPolicy | int | None = None,
        depth: int | None = None,
        reliability: ReliabilityPolicy | int | None = None,
        durability: DurabilityPolicy | int | None = None,
        lifespan: Duration | None = None,
        deadline: Duration | None = None,
        liveliness: LivelinessPolicy | int | None = None,
        liveliness_lease_duration: Duration | None = None,
        avoid_ros_namespace_conventions: bool | None = None,
    ) -> None:
        given = dict(locals())
        if history is None and depth is None:
            raise InvalidQoSProfileException("history and/or depth settings are required")
        for name, (_, default) in _FIELDS.items():
            setattr(self, name, default if given[name] is None else given[name])
        if self.history is HistoryPolicy.KEEP_LAST and depth is None:
            raise InvalidQoSProfileException("history is KEEP_LAST without a depth setting")

    def __setattr__(self, name: str, value: Any) -> None:
        """Set a policy. Raises InvalidQoSProfileException for a value that it cannot have."""
        if name not in _FIELDS:
            raise AttributeError(f"a QoSProfile has no policy {name!r}{nearest(name, _FIELDS)}")
        checked = _checked(name, value)
        if name == "depth" and checked == 0 and self.history is HistoryPolicy.KEEP_LAST:
            warnings.warn(
                "A zero depth with KEEP_LAST doesn't make sense: nothing could be stored. "
                "It is taken as SYSTEM_DEFAULT.",
                stacklevel=2,
            )
        object.__setattr__(self, name, checked)

    def to_dict(self) -> dict[str, Any]:
        """Return the keyword arguments that make an equal profile."""
        return {name: getattr(self, name) for name in _FIELDS}

    def get_c_qos_profile(self) -> QoSProfile:
        """Return a copy; rclpy returns rmw's own struct here."""
        return QoSProfile(**self.to_dict())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, QoSProfile) and self.to_dict() == other.to_dict()

    def __str__(self) -> str:
        """Return the profile as rclpy prints it: policies as rmw's numbers. Its repr has their names."""
        values = {name: int(each) if isinstance(each, QoSPolicyEnum) else each for name, each in self.to_dict().items()}
        return f"{type(self).__name__}({', '.join(f'{name}={each!s}' for name, each in values.items())})"

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{k}={_shown(v)}' for k, v in self.to_dict().items())})"


def _checked(name: str, value: Any) -> Any:
    kind = _FIELDS[name][0]
    number = issubclass(kind, int) and isinstance(value, int)
    if not (isinstance(value, kind) or (number and kind is not bool)):
        raise InvalidQoSProfileException(f"{name} must be of type {kind.__name__}, got {value!r}")
    if name == "depth" and value < 0:
        raise InvalidQoSProfileException(f"depth must not be negative, got {value}")
    if not issubclass(kind, QoSPolicyEnum):
        return value
    try:
        return kind(value)
    except ValueError:
        known = ", ".join(each.name for each in kind)
        raise InvalidQoSProfileException(f"{name} must be one of {known}, got {value}") from None


def _shown(value: object) -> str:
    return f"{type(value).__name__}.{value.name}" if isinstance(value, QoSPolicyEnum) else repr(value)


def as_profile(profile: QoSProfile | int) -> QoSProfile:
    """Return `profile`, or for a number a reliable, volatile KEEP_LAST one of that depth.

    Raises TypeError for anything else, and ValueError for a negative number.
    """
    if isinstance(profile, QoSProfile):
        return profile
    if isinstance(profile, int) and not isinstance(profile, bool):
        if profile < 0:
            raise ValueError("history depth must be greater than or equal to zero")
        return QoSProfile(depth=profile)
    raise TypeError(f"Expected QoSProfile or int, but received {type(profile)!r}")


def resolved(profile: QoSProfile) -> QoSProfile:
    """Return a copy of `profile` in which nothing is left to the system: what is unset becomes rmw_zenoh's default.

    So does "best available". The defaults are KEEP_LAST, depth 42, RELIABLE, VOLATILE, AUTOMATIC and infinite
    durations.
    """
    history, reliability, durability = profile.history, profile.reliability, profile.durability
    return QoSProfile(
        history=history if history in (1, 2) else HistoryPolicy.KEEP_LAST,
        depth=profile.depth or 42,
        reliability=reliability if reliability in (1, 2) else ReliabilityPolicy.RELIABLE,
        durability=durability if durability in (1, 2) else DurabilityPolicy.VOLATILE,
        lifespan=_set_or_infinite(profile.lifespan),
        deadline=_set_or_infinite(profile.deadline),
        liveliness=profile.liveliness if profile.liveliness in (1, 3) else LivelinessPolicy.AUTOMATIC,
        liveliness_lease_duration=_set_or_infinite(profile.liveliness_lease_duration),
        avoid_ros_namespace_conventions=profile.avoid_ros_namespace_conventions,
    )


def _set_or_infinite(span: Duration) -> Duration:
    return span if 0 < span.nanoseconds < DeadlineBestAvailable.nanoseconds else Infinite


def _reliable(depth: int, durability: DurabilityPolicy = DurabilityPolicy.VOLATILE) -> QoSProfile:
    return QoSProfile(depth=depth, durability=durability)


qos_profile_default = _reliable(10)
qos_profile_services_default = _reliable(10)
qos_profile_parameters = _reliable(1000)
qos_profile_parameter_events = _reliable(1000)
qos_profile_action_status_default = _reliable(1, DurabilityPolicy.TRANSIENT_LOCAL)
qos_profile_sensor_data = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
qos_profile_rosout_default = QoSProfile(
    depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(seconds=10)
)
qos_profile_system_default = QoSProfile(
    history=HistoryPolicy.SYSTEM_DEFAULT,
    depth=0,
    reliability=ReliabilityPolicy.SYSTEM_DEFAULT,
    durability=DurabilityPolicy.SYSTEM_DEFAULT,
)
qos_profile_unknown = QoSProfile(
    history=HistoryPolicy.UNKNOWN,
    depth=0,
    reliability=ReliabilityPolicy.UNKNOWN,
    durability=DurabilityPolicy.UNKNOWN,
    liveliness=LivelinessPolicy.UNKNOWN,
)
qos_profile_best_available = QoSProfile(
    depth=10,
    reliability=ReliabilityPolicy.BEST_AVAILABLE,
    durability=DurabilityPolicy.BEST_AVAILABLE,
    deadline=DeadlineBestAvailable,
    liveliness=LivelinessPolicy.BEST_AVAILABLE,
    liveliness_lease_duration=LivelinessLeaseDurationeBestAvailable,
)


class QoSPresetProfiles(Enum):
    """Presets by name; equal ones are aliases of each other."""

    UNKNOWN = qos_profile_unknown
    DEFAULT = qos_profile_default
    SYSTEM_DEFAULT = qos_profile_system_default
    SENSOR_DATA = qos_profile_sensor_data
    SERVICES_DEFAULT = qos_profile_services_default
    PARAMETERS = qos_profile_parameters
    PARAMETER_EVENTS = qos_profile_parameter_events
    ACTION_STATUS_DEFAULT = qos_profile_action_status_default
    BEST_AVAILABLE = qos_profile_best_available
    ROSOUT_DEFAULT = qos_profile_rosout_default

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the names of the presets in lower case."""
        return [name.lower() for name in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> QoSProfile:
        """Return the preset called `name`, in any case. Raises KeyError if there is none."""
        profile: QoSProfile = cls[name.upper()].value
        return profile


class QoSCompatibility(Enum):
    """Compatibility of two profiles: OK, WARNING (not all may arrive) or ERROR (nothing does)."""

    OK = 0
    WARNING = 1
    ERROR = 2


def qos_check_compatible(publisher_qos: QoSProfile, subscription_qos: QoSProfile) -> tuple[QoSCompatibility, str]:
    """Return the compatibility of a publisher's and a subscription's profile, and the reason unless it is OK.

    Over Zenoh every pair can talk. A VOLATILE subscription only misses what a TRANSIENT_LOCAL publisher sent before
    it came: that is a WARNING.

    Args:
        publisher_qos: Profile of the publisher.
        subscription_qos: Profile of the subscription.
    """
    retained = publisher_qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
    if retained and subscription_qos.durability is DurabilityPolicy.VOLATILE:
        return QoSCompatibility.WARNING, (
            "WARNING: the publisher is TRANSIENT_LOCAL and the subscription VOLATILE: "
            "what was published before it came does not arrive;"
        )
    return QoSCompatibility.OK, ""
