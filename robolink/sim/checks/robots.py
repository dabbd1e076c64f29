"""Checks of a robot's description: its drive, its wheels, its sensors."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from robolink.sim.checks.appearance import colour_problems, null_colour, sign_problems
from robolink.sim.checks.shapes import Problem, repeated_names, shape_problems, speed_problems, under
from robolink.sim.description import Drive, RobotDescription, Wheel, steps_between
from robolink.sim.sensors import Encoders, Sensor
from robolink.system.terminal import shown

TAKEN = (
    "clock",
    "cmd_vel",
    "diagnostics",
    "ground_truth",
    "joint_command",
    "joint_commands",
    "odom",
    "parameter_events",
    "robot_description",
    "rosout",
    "tf",
    "tf_static",
)
"""Topics that the simulation itself publishes or listens to."""

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
_LONGEST_NAME = 64
_MOST_THREES = 2000
_ABREAST = 1e-4
"""Least distance of wheels across the way that they roll, in metres: nearer ones cannot turn a robot."""
_CROOKED = 0.02
"""Largest angle from ahead, in radians, of a wheel of a drive that cannot go sideways."""
_ONLY_ACKERMANN = ("wheelbase", "steer_max", "steer_rate")


def robot_misfits(data: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield the keys of a robot's plain data, valid otherwise, that mean nothing there."""
    yield from null_colour(data)
    drive = data.get("drive", {})
    kind = drive.get("type", Drive().type)
    for key in _ONLY_ACKERMANN if kind != "ackermann" else ():
        if key in drive:
            reason = f"a drive of type '{kind}' has no '{key}': leave it out, or say 'type: ackermann'"
            yield Problem(f".drive.{key}", reason, key=True)


def robot_problems(robot: RobotDescription, dt: float) -> Iterator[Problem]:
    """Yield the problems of a robot in a world with steps of `dt` seconds."""
    if not _NAME.fullmatch(robot.name):
        yield Problem(".name", _bad_name(robot.name))
    shape = list(_outline_problems(robot))
    yield from under(".shape", iter(shape))
    yield from colour_problems(robot.colour)
    yield from sign_problems(robot.signs)
    yield from under(".drive", _drive_problems(robot, dt, has_shape=not shape))
    yield from under(".wheels", _wheel_problems(robot))
    yield from under(".odom.rate", _rate_problems(robot.odom.rate, dt))
    yield from under(".ground_truth.rate", _rate_problems(robot.ground_truth.rate, dt))
    for index, sensor in enumerate(robot.sensors):
        yield from under(f".sensors[{index}]", _sensor_problems(sensor, robot, dt))
    yield from _repeated_topics(robot.sensors)


def _bad_name(name: str) -> str:
    return f"'{shown(name)}' is not a name: a-z, A-Z, digits and '_', a letter first, {_LONGEST_NAME} at most"


def _outline_problems(robot: RobotDescription) -> Iterator[Problem]:
    found = list(shape_problems(robot.shape))
    yield from found
    if not found and robot.shape.inner_radius() < 0.001:
        yield Problem(".polygon", "it must go round [0, 0], the point that the robot's pose is about")


def _drive_problems(robot: RobotDescription, dt: float, *, has_shape: bool) -> Iterator[Problem]:
    drive = robot.drive
    if has_shape:
        speed = list(speed_problems(drive.v_max, dt, robot.shape, "walls"))
        yield from under(".v_max", iter(speed)) if speed else _corner_problems(robot, dt)
    if drive.w_max * dt > math.pi / 2:
        yield Problem(".w_max", f"more than a quarter turn in a step of {dt:g} s: at most {math.pi / 2 / dt:.4g}")
    if drive.timeout < dt:
        yield Problem(".timeout", f"shorter than a step, so that no command would count: at least {dt:g}")
    if drive.type == "ackermann" and has_shape:
        yield from under(".wheelbase", _steering_problems(robot, dt))


def _corner_problems(robot: RobotDescription, dt: float) -> Iterator[Problem]:
    """Yield a problem if a corner of the turning robot could pass through a wall in one step."""
    v, w, inner = robot.drive.v_max, robot.drive.w_max, robot.shape.inner_radius()
    beyond = robot.shape.outer_radius() - inner
    if v + w * beyond > inner / dt:
        way = f"at {v:g} m/s and {w:g} rad/s its corners go {(v + w * beyond) * dt:.3g} m in a step of {dt:g} s"
        through = f"and a shape of {inner:.3g} m could pass through walls"
        most = (inner / dt - v) / beyond
        right = f"at most {most:.4g}, or a lower v_max" if most > 0.01 else "it needs a lower v_max"
        yield Problem(".w_max", f"{way}, {through}: {right}")


def _steering_problems(robot: RobotDescription, dt: float) -> Iterator[Problem]:
    drive, length = robot.drive, 2 * robot.shape.outer_radius()
    tightest = drive.v_max * math.tan(drive.steer_max) * dt / (math.pi / 2)
    if drive.wheelbase > length:
        yield Problem(
            "", f"axles {drive.wheelbase:g} m apart do not fit a robot of {length:.4g} m: at most {length:.4g}"
        )
    elif drive.wheelbase < tightest:
        turning = f"at {drive.v_max:g} m/s and steered by {drive.steer_max:g} rad"
        yield Problem("", f"{turning}, more than a quarter turn in a step of {dt:g} s: at least {tightest:.4g}")


def _wheel_problems(robot: RobotDescription) -> Iterator[Problem]:
    for index, wheel in enumerate(robot.wheels):
        if not wheel.motor or not wheel.motor.isprintable() or len(wheel.motor) > _LONGEST_NAME:
            yield Problem(f"[{index}].motor", f"expected 1 to {_LONGEST_NAME} letters, got {wheel.motor[:80]!r}")
    yield from repeated_names([each.motor for each in robot.wheels], "[{}].motor", "two motors are called")
    if robot.wheels:
        crooked = [] if robot.drive.type == "omni" else list(_crooked(robot))
        yield from crooked or _driving_problems(robot)


def _crooked(robot: RobotDescription) -> Iterator[Problem]:
    for index, wheel in enumerate(robot.wheels):
        if abs(math.sin(wheel.at.theta)) > _CROOKED:
            reason = f"a wheel of a drive of type '{robot.drive.type}' rolls ahead"
            yield Problem(f"[{index}].at", f"{reason}, theta 0, not {wheel.at.theta:g}: or say 'type: omni'")


def _driving_problems(robot: RobotDescription) -> Iterator[Problem]:
    """Yield a problem if no turning of the wheels can make all the motions of the drive."""
    kind = robot.drive.type
    sides = [each.at.y for each in robot.wheels]
    if kind == "diff" and max(sides) - min(sides) < _ABREAST:
        reason = f"all stand {sides[0]:g} m to the left: put one on each side"
        yield Problem("", f"these wheels cannot turn the robot, {reason}" if len(sides) > 1 else _lonely())
    if kind == "omni" and not any(_independent(*three) for three in _threes(robot.wheels)):
        yield Problem(
            "", "these wheels cannot drive it ahead, sideways and round: it takes three that roll different ways"
        )


def _threes(wheels: Sequence[Wheel]) -> Iterator[tuple[Wheel, ...]]:
    """Yield wheels by three: all ways to choose from a few, and of many, which all roll alike, only some."""
    return itertools.islice(itertools.combinations(wheels, 3), _MOST_THREES)


def _lonely() -> str:
    return "one wheel cannot turn the robot: put one on each side"


def _independent(*wheels: Wheel) -> bool:
    """True if three wheels, each turned alone, make three independent motions: by the determinant."""
    (a, b, c), (d, e, f), (g, h, i) = (_motion(each) for each in wheels)
    return abs(a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)) > _ABREAST


def _motion(wheel: Wheel) -> tuple[float, float, float]:
    """Return the rolling speed of a wheel when the robot goes ahead, goes sideways, and turns."""
    cos, sin = math.cos(wheel.at.theta), math.sin(wheel.at.theta)
    return cos, sin, sin * wheel.at.x - cos * wheel.at.y


def _sensor_problems(sensor: Sensor, robot: RobotDescription, dt: float) -> Iterator[Problem]:
    if not _NAME.fullmatch(sensor.topic):
        yield Problem(f".{sensor.kind}", _bad_name(sensor.topic))
    elif sensor.topic in TAKEN or (sensor.topic == "joint_states" and tells_joints(robot)):
        yield Problem(f".{sensor.kind}", f"the simulation itself has a topic '{sensor.topic}': take another name")
    yield from under(".rate", _rate_problems(sensor.rate, dt))
    for key, reason in sensor.problems(len(robot.wheels)):
        yield Problem(f".{key}" if key else "", reason)


def tells_joints(robot: RobotDescription) -> bool:
    """True if the simulation itself publishes joint_states: of wheels without encoders."""
    return bool(robot.wheels) and not any(isinstance(each, Encoders) for each in robot.sensors)


def _repeated_topics(sensors: Sequence[Sensor]) -> Iterator[Problem]:
    for problem in repeated_names([each.topic for each in sensors], "{}", "two sensors publish on"):
        yield problem._replace(path=f".sensors[{problem.path}].{sensors[int(problem.path)].kind}")


def _rate_problems(rate: float, dt: float) -> Iterator[Problem]:
    """Yield a problem if a rate's period is not a whole number of steps of `dt` seconds."""
    if steps_between(rate, dt):
        return
    steps = math.floor(1.0 / (rate * dt))
    fitting = " or ".join(f"{1.0 / (dt * whole):.6g}" for whole in (steps + 1, steps) if whole)
    yield Problem("", f"{rate:g} Hz is not a whole number of steps of {dt:g} s: take {fitting}")
