"""The JSON schema of world files: what editors complete, explain and underline while one writes.

Draft 7, which the editors' YAML servers know; msgspec writes a later draft, whose pairs look otherwise.
"""

from __future__ import annotations

import inspect
import json
from typing import Any, TypeAlias

import msgspec

from robolink.sim.description import SENSORS, Sensor, WorldDescription

Schema: TypeAlias = "dict[str, Any]"

DRAFT = "http://json-schema.org/draft-07/schema#"

MEANINGS = {
    "WorldDescription.world": "The world as a whole.",
    "WorldDescription.map": "A map of ROS's map_server, whose occupied cells become walls.",
    "WorldDescription.walls": "Lines of walls, without thickness.",
    "WorldDescription.obstacles": "What else stands or moves in the world.",
    "WorldDescription.robots": "The robots; with several, each one's name is the namespace of its topics.",
    "Settings.name": "What the world is called.",
    "Settings.size": "Width and height in metres, from [0, 0]; everything must lie within.",
    "Settings.dt": "Seconds of a step.",
    "Settings.rtf": "How many times faster than real time; 0 is as fast as it goes.",
    "Settings.seed": "What all noise is made from: the same seed, the same noise.",
    "Map.yaml": "The path of the map's YAML file, from the world file's folder.",
    "Wall.polyline": "Points [x, y] in metres, joined in this order.",
    "Wall.closed": "Whether the last point is joined to the first.",
    "Obstacle.pose": "Where it stands: [x, y, theta].",
    "Obstacle.mass": "Kilograms: with a mass it can be pushed.",
    "Obstacle.path": "Points [x, y] along which it moves by itself.",
    "Obstacle.speed": "m/s along its path.",
    "Obstacle.closed": "Round and round, from the last point of the path to the first, instead of to and fro.",
    "Pose.x": "Metres.",
    "Pose.y": "Metres.",
    "Pose.theta": "Radians, counter-clockwise from the x axis.",
    "RobotDescription.name": "Letters, digits and '_', a letter first.",
    "RobotDescription.pose": "Where it starts: [x, y, theta].",
    "RobotDescription.shape": "Its outline about its origin; 0.17 m round by default.",
    "RobotDescription.mass": "Kilograms.",
    "RobotDescription.drive": "What drives it, and its limits.",
    "RobotDescription.wheels": "Wheels, each turned by a motor of its own that can be driven by name.",
    "RobotDescription.odom": "Odometry, on the topic odom and as a transform.",
    "RobotDescription.ground_truth": "Where it truly is.",
    "RobotDescription.sensors": "What it senses with; each one's first key says its kind and names its topic.",
    "Drive.type": "diff: ahead and round; omni: sideways too; ackermann: steered like a car.",
    "Drive.v_max": "Most m/s.",
    "Drive.w_max": "Most rad/s.",
    "Drive.a_max": "Most m/s².",
    "Drive.alpha_max": "Most rad/s².",
    "Drive.timeout": "Seconds after the last command until it stops.",
    "Drive.wheelbase": "Metres between the axles (ackermann).",
    "Drive.steer_max": "Most radians that the front wheels turn by (ackermann).",
    "Drive.steer_rate": "Most rad/s that they turn at (ackermann).",
    "Wheel.motor": "The motor's name.",
    "Wheel.at": "Where it stands on the robot, and which way it rolls: [x, y, theta].",
    "Wheel.radius": "Metres.",
    "Wheel.speed_max": "Most rad/s.",
    "Odom.noise": "How wrong odometry's speeds are.",
    "OdomNoise.v": "Standard deviation as a share of the speed.",
    "OdomNoise.w": "Standard deviation as a share of the turning speed.",
    "ImuNoise.gyro": "Standard deviation in rad/s.",
    "ImuNoise.accel": "Standard deviation in m/s².",
    "Imu.noise": "Standard deviations of a reading.",
    "Bumper.fov": "Degrees of the sector that feels; 360 is all round.",
    "Encoders.ticks": "Ticks to a turn; 0 counts exactly.",
    "RangeFinder.radiation": "What it measures with.",
    "Lidar.beams": "Beams of a scan.",
    "Lidar.dropout": "The share of beams that get no return.",
    "Lidar.intensities": "Whether a scan also tells how much light came back.",
    "box": "Length along x and width along y in metres.",
    "circle": "Radius in metres.",
    "polygon": "Corners [x, y] in metres, in their order round the outline.",
    "fov": "Field of view in degrees.",
    "noise": "Standard deviation in metres.",
    "offset": "Where it sits on the robot: [x, y, theta].",
    "range": "Nearest and farthest in metres.",
    "rate": "Times a second; a whole number of steps must lie between two.",
    "reflectance": "The share of light that it sends back, which a lidar's intensities tell.",
    "start": "Degrees of the right end of the field of view; by default half of it to the right.",
}
"""What each key means, by Struct and key, or by a key that means the same wherever it stands."""

_OUTLINES = [{"required": [kind]} for kind in ("box", "circle", "polygon")]


def world_schema() -> Schema:
    """Give the schema of world files as plain data."""
    types = [WorldDescription, *SENSORS.values()]
    _, parts = msgspec.json.schema_components(types, schema_hook=_any_sensor, ref_template="#/definitions/{name}")
    definitions = {name: _described(name, _draft_7(part)) for name, part in sorted(parts.items())}
    for shape in ("Shape", "Obstacle"):
        definitions[shape]["oneOf"] = _OUTLINES
    whole = definitions.pop("WorldDescription")
    return {"$schema": DRAFT, **whole, "title": "A world of robolink", "definitions": definitions}


def schema_text() -> str:
    """Give the schema as the text of a file."""
    return json.dumps(world_schema(), indent=2, ensure_ascii=False) + "\n"


def _any_sensor(kind: type) -> Schema:
    """Give the schema of what can stand in a list of sensors."""
    if kind is not Sensor:
        raise NotImplementedError(kind)
    return {"oneOf": [{"$ref": f"#/definitions/{each.__name__}"} for each in SENSORS.values()]}


def _draft_7(part: Any) -> Any:
    """Spell a part of a schema as draft 7 does: pairs, and what stands beside a reference."""
    if isinstance(part, list):
        return [_draft_7(each) for each in part]
    if not isinstance(part, dict):
        return part
    told = {key: value for key, value in part.items() if key != "default" or _is_telling(value)}
    made = {key: _draft_7(value) for key, value in told.items()}
    if "description" in made:
        made["description"] = inspect.cleandoc(made["description"])
    if "prefixItems" in made:
        made["items"], made["additionalItems"] = made.pop("prefixItems"), False
    if "$ref" in made and len(made) > 1:
        made["allOf"] = [{"$ref": made.pop("$ref")}]
    return made


def _is_telling(default: Any) -> bool:
    """Say whether a default tells a writer anything: those of whole parts only say that they may be left out."""
    return default is not None and default != [] and not isinstance(default, dict)


def _described(name: str, part: Schema) -> Schema:
    """Add what each key of a Struct means."""
    for key, schema in part.get("properties", {}).items():
        meaning = "The topic that it publishes on." if key in SENSORS else MEANINGS.get(f"{name}.{key}")
        schema["description"] = meaning or MEANINGS[key]
        if "$ref" in schema:
            schema["allOf"] = [{"$ref": schema.pop("$ref")}]
    return part
