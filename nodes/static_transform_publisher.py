"""Publish a static transform: the pose of one frame in another.

robolink run static_transform_publisher --x 1 --yaw 0.5 --frame-id map --child-frame-id base
"""

import contextlib
import math
import sys
import uuid
from typing import Any

import robolink
from robolink import Node
from robolink.exceptions import ExternalShutdownException, RobolinkError, nearest
from robolink.geometry.transformations import quaternion_from_euler
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor
from robolink.parameter import Parameter
from robolink.tf2 import StaticTransformBroadcaster
from robolink.utilities import remove_ros_args

Values = dict[str, Any]

FIXED = ParameterDescriptor(read_only=True)

DEFAULTS: Values = {
    "translation.x": 0.0,
    "translation.y": 0.0,
    "translation.z": 0.0,
    "rotation.x": 0.0,
    "rotation.y": 0.0,
    "rotation.z": 0.0,
    "rotation.w": 1.0,
    "frame_id": "/frame",
    "child_frame_id": "/child",
}
"""Defaults of the parameters: metres, a unit quaternion, and two names."""

OLD_FORMS = {
    8: ["x", "y", "z", "yaw", "pitch", "roll", "frame_id", "child_frame_id"],
    9: ["x", "y", "z", "qx", "qy", "qz", "qw", "frame_id", "child_frame_id"],
}
"""Names of arguments without flags, by their number."""

PLACE, ANGLES, QUATERNION = ("x", "y", "z"), ("roll", "pitch", "yaw"), ("qx", "qy", "qz", "qw")
FRAMES = ("frame_id", "child_frame_id")

HELP = """usage: static_transform_publisher [FLAGS] --frame-id FRAME --child-frame-id CHILD

Publish where the frame CHILD stands in FRAME; what is not given is 0.

  --x X --y Y --z Z               where it stands, in metres
  --roll R --pitch P --yaw Y      how it is turned, in radians
  --qx X --qy Y --qz Z --qw W     or that as a quaternion

Older form: x y z yaw pitch roll FRAME CHILD, or x y z qx qy qz qw FRAME CHILD
"""


class UsageError(RobolinkError, ValueError):
    """Arguments that are not a transform."""


class StaticTransformPublisher(Node):
    """A node that publishes one transform, made from its parameters, on /tf_static, for late subscribers too."""

    def __init__(self, name: str = "static_transform_publisher", **options: Any) -> None:
        super().__init__(name, **options)
        values = {each: self.declare_parameter(each, default, FIXED).value for each, default in DEFAULTS.items()}
        transform = checked(values)
        transform.header.stamp = self.get_clock().now().to_msg()
        self.broadcaster = StaticTransformBroadcaster(self)
        self.broadcaster.sendTransform(transform)
        place, turn = transform.transform.translation, transform.transform.rotation
        self.get_logger().info(
            "Spinning until stopped - publishing transform\n"
            f"translation: ('{place.x:.6f}', '{place.y:.6f}', '{place.z:.6f}')\n"
            f"rotation: ('{turn.x:.6f}', '{turn.y:.6f}', '{turn.z:.6f}', '{turn.w:.6f}')\n"
            f"from '{transform.header.frame_id}' to '{transform.child_frame_id}'"
        )


def checked(values: Values) -> TransformStamped:
    """Make the transform from the parameters. Raises UsageError for one that every buffer would refuse."""
    frame, child = values["frame_id"].removeprefix("/"), values["child_frame_id"].removeprefix("/")
    if not frame or not child:
        raise UsageError("frame_id and child_frame_id: expected the names of two frames, got nothing")
    if frame == child:
        raise UsageError(f"frame_id and child_frame_id are both '{frame}': a frame cannot stand in itself")
    numbers = [values[each] for each in DEFAULTS if "." in each]
    if not all(map(math.isfinite, numbers)):
        raise UsageError(f"expected finite numbers, got {numbers}")
    norm = math.hypot(*numbers[3:])
    if norm < 1e-6:
        raise UsageError(f"rotation: expected a quaternion, got {numbers[3:]}")
    made = TransformStamped(child_frame_id=child)
    made.header.frame_id = frame
    place, turn = made.transform.translation, made.transform.rotation
    place.x, place.y, place.z = numbers[:3]
    turn.x, turn.y, turn.z, turn.w = (each / norm for each in numbers[3:])
    return made


def parameters(args: list[str]) -> Values:
    """Read a command line: ROS 2's flags, or the older form without. Raises UsageError."""
    given, plain = parted(args)
    if plain and given:
        raise UsageError("either flags or the older form without, not both (see --help)")
    if plain:
        names = OLD_FORMS.get(len(plain))
        if names is None:
            raise UsageError(f"the older form has 8 or 9 arguments, got {len(plain)} (see --help)")
        given = dict(zip(names, plain, strict=True))
    for name in FRAMES:
        if not given.get(name):
            raise UsageError(f"--{name.replace('_', '-')}: the name of a frame is needed (see --help)")
    numbers = {name: number(name, text) for name, text in given.items() if name not in FRAMES}
    if any(each in numbers for each in ANGLES):
        if any(each in numbers for each in QUATERNION):
            raise UsageError("either a quaternion (--qx ...) or angles (--roll ...), not both")
        roll, pitch, yaw = (numbers.get(each, 0.0) for each in ANGLES)
        turn = quaternion_from_euler(roll, pitch, yaw)
        numbers.update(zip(QUATERNION, turn, strict=True))
    named = {f"translation.{each}": each for each in PLACE} | {f"rotation.{each[1]}": each for each in QUATERNION}
    return {each: given[each] for each in FRAMES} | {
        parameter: numbers[name] for parameter, name in named.items() if name in numbers
    }


def parted(args: list[str]) -> tuple[dict[str, str], list[str]]:
    """Split arguments into flags with their values, and plain ones."""
    flags = {f"--{each.replace('_', '-')}": each for each in (*PLACE, *QUATERNION, *ANGLES, *FRAMES)}
    given: dict[str, str] = {}
    plain: list[str] = []
    rest = iter(args)
    for each in rest:
        flag, equals, text = each.partition("=")
        if flag in flags:
            value = text if equals else next(rest, None)
            if value is None:
                raise UsageError(f"{flag}: a value is needed (see --help)")
            given[flags[flag]] = value
        elif each.startswith("--"):
            raise UsageError(f"no such option: {flag}{nearest(flag, flags)} (see --help)")
        else:
            plain.append(each)
    return given, plain


def number(name: str, text: str) -> float:
    """Read a number. Raises UsageError."""
    try:
        return float(text)
    except ValueError:
        raise UsageError(f"{name}: expected a number, got '{text}'") from None


def main() -> None:
    """Publish the transform of the command line until Ctrl-C. Raises UsageError without its two frames, as in ROS 2."""
    with robolink.init(), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        args = remove_ros_args(sys.argv)[1:]
        if {"-h", "--help"} & set(args):
            print(HELP, end="")  # noqa: T201 - that is what was asked for
            return
        values = parameters(args)
        name = f"static_transform_publisher_{uuid.uuid4().hex[:16]}"
        node = StaticTransformPublisher(
            name, parameter_overrides=[Parameter(each, value=value) for each, value in values.items()]
        )
        robolink.spin(node)


if __name__ == "__main__":
    main()
