"""Profiles of quality of service, their values, presets and compatibility."""

import rclpy.qos as Q
from probe import show, typed
from rclpy.duration import Duration
from rclpy.qos import *

for name in (
    "qos_profile_sensor_data",
    "qos_profile_system_default",
    "qos_profile_services_default",
    "qos_profile_parameters",
    "qos_profile_parameter_events",
    "qos_profile_action_status_default",
    "qos_profile_best_available",
    "qos_profile_unknown",
    "qos_profile_rosout_default",
    "qos_profile_default",
):
    show(name, lambda: str(getattr(Q, name)))
show("repr", lambda: QoSProfile(depth=1))
show("no depth", lambda: QoSProfile())
show("keep last only", lambda: QoSProfile(history=HistoryPolicy.KEEP_LAST))
show("keep all", lambda: QoSProfile(history=HistoryPolicy.KEEP_ALL))
show("positional", lambda: QoSProfile(10))
show("depth str", lambda: QoSProfile(depth="1"))
show("depth neg", lambda: QoSProfile(depth=-1))
show("depth float", lambda: QoSProfile(depth=1.0))
show("unknown", lambda: QoSProfile(depth=1, foo=2))
show("reliability int", lambda: QoSProfile(depth=1, reliability=1))
show("reliability int 9", lambda: QoSProfile(depth=1, reliability=9))
show("reliability str", lambda: QoSProfile(depth=1, reliability="reliable"))
show("deadline", lambda: QoSProfile(depth=1, deadline=Duration(seconds=1)).deadline)
show("deadline float", lambda: QoSProfile(depth=1, deadline=1.0))
show(
    "defaults",
    lambda: (QoSProfile(depth=1).deadline, QoSProfile(depth=1).lifespan, QoSProfile(depth=1).liveliness_lease_duration),
)
show("avoid", lambda: QoSProfile(depth=1).avoid_ros_namespace_conventions)
show("eq", lambda: QoSProfile(depth=1) == QoSProfile(depth=1))
show("ne", lambda: QoSProfile(depth=1) == QoSProfile(depth=2))
show("eq int", lambda: QoSProfile(depth=1) == 1)
show("hash", lambda: hash(QoSProfile(depth=1)))
show("copy", lambda: __import__("copy").copy(QoSProfile(depth=4)).depth)
show("deepcopy", lambda: __import__("copy").deepcopy(QoSProfile(depth=4)).depth)
show("set", lambda: (lambda q: (setattr(q, "depth", 7), q.depth)[1])(QoSProfile(depth=4)))
show("set unknown", lambda: setattr(QoSProfile(depth=4), "foo", 1))
show("dict", lambda: sorted(QoSProfile(depth=4).get_c_qos_profile().to_dict()) if False else "skip")
show("enums", lambda: [list(e) for e in (HistoryPolicy, ReliabilityPolicy, DurabilityPolicy, LivelinessPolicy)])
show("str", lambda: str(ReliabilityPolicy.RELIABLE))
show(
    "aliases",
    lambda: (
        QoSReliabilityPolicy is ReliabilityPolicy,
        QoSHistoryPolicy is HistoryPolicy,
        QoSDurabilityPolicy is DurabilityPolicy,
        QoSLivelinessPolicy is LivelinessPolicy,
    ),
)
show("old", lambda: QoSReliabilityPolicy.RMW_QOS_POLICY_RELIABILITY_RELIABLE)
show("short", lambda: [p.short_key for p in ReliabilityPolicy])
show("short_keys", lambda: ReliabilityPolicy.short_keys())
show("from_short", lambda: ReliabilityPolicy.get_from_short_key("best_effort"))
show("from_short bad", lambda: ReliabilityPolicy.get_from_short_key("x"))
show("from_short upper", lambda: ReliabilityPolicy.get_from_short_key("RELIABLE"))
show("by name", lambda: ReliabilityPolicy["RELIABLE"])
show("by value", lambda: DurabilityPolicy(1))
show("int eq", lambda: ReliabilityPolicy.RELIABLE == 1)
show("arith", lambda: HistoryPolicy.KEEP_LAST | HistoryPolicy.KEEP_ALL)
show("presets", lambda: [p.name for p in QoSPresetProfiles])
show("preset short", lambda: QoSPresetProfiles.short_keys())
show("preset get", lambda: QoSPresetProfiles.get_from_short_key("sensor_data").depth)
show("preset bad", lambda: QoSPresetProfiles.get_from_short_key("x"))
show("preset value", lambda: QoSPresetProfiles.SENSOR_DATA.value == qos_profile_sensor_data)
R, B = QoSProfile(depth=1), QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
TL = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
D1, D2 = QoSProfile(depth=1, deadline=Duration(seconds=1)), QoSProfile(depth=1, deadline=Duration(seconds=2))
SD = QoSProfile(depth=1, reliability=ReliabilityPolicy.SYSTEM_DEFAULT)
names = {"R": R, "B": B, "TL": TL, "D1": D1, "D2": D2, "SD": SD}
import rclpy

rclpy.init()
for a in names:
    for b in names:
        if a != b:
            typed(f"compat {a} {b}", lambda: tuple(str(x) for x in qos_check_compatible(names[a], names[b]))[:1])
show("InvalidQoS", lambda: InvalidQoSProfileException.__mro__[1].__name__)
show("policy kinds", lambda: [x.name for x in QoSPolicyKind])
show(
    "names attributes",
    lambda: sorted(
        x
        for x in dir(Q)
        if not x.startswith("_")
        and x
        not in (
            "Any",
            "Iterable",
            "List",
            "Tuple",
            "Type",
            "TypedDict",
            "TypeVar",
            "Union",
            "TYPE_CHECKING",
            "Unpack",
            "TypeAlias",
            "Generic",
            "cast",
            "Optional",
            "warnings",
            "IntEnum",
            "Enum",
            "Callable",
        )
    ),
)
show("preset objects same", lambda: qos_profile_sensor_data is QoSPresetProfiles.SENSOR_DATA.value)
show("unsettable infinite", lambda: QoSProfile(depth=1, lifespan=Duration(seconds=-1)))
