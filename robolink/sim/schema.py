"""The JSON schema of world files, with which editors complete, explain and check them.

Draft 7, which the editors' YAML servers know; msgspec writes a later draft, whose pairs look otherwise.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import msgspec

from robolink.documents.json_schema import DRAFT, described, draft_7, text_of
from robolink.sim.description import WorldDescription
from robolink.sim.sensors import SENSORS, Sensor

Schema: TypeAlias = "dict[str, Any]"

MEANINGS = {
    "WorldDescription.world": "The world as a whole.",
    "WorldDescription.map": "A map of ROS's map_server, whose occupied cells become walls.",
    "WorldDescription.walls": "Lines of walls, without thickness.",
    "WorldDescription.obstacles": "Obstacles: fixed, pushed, or moving along a path.",
    "WorldDescription.robots": "The robots; with several, each one's name is the namespace of its topics.",
    "WorldDescription.paint": "Lines and outlines painted on the floor, which cameras see.",
    "WorldDescription.signs": "Upright signs, which cameras see: fiducial markers and pictures.",
    "Settings.floor": "Look of the floor, for cameras.",
    "FloorSettings.image": "Picture on the floor: PNG, JPEG or PGM, from the world file's folder.",
    "FloorSettings.resolution": "Side of a pixel in metres; 0.005 by default.",
    "FloorSettings.origin": "The picture's lower left corner: [x, y].",
    "Paint.line": "Points [x, y] in metres, joined by a line.",
    "Paint.width": "Width of the line in metres.",
    "Paint.closed": "True: the last point is joined to the first.",
    "Paint.radius": "Radius in metres of the arcs that round the line's corners.",
    "Paint.dashes": "Lengths of a dash and of the gap behind it, in metres.",
    "Paint.pose": "Pose of the outline: [x, y, theta].",
    "Sign.pose": "Where it stands, and where it looks to: [x, y, theta].",
    "Sign.tag": "Fiducial marker, such as 36h11/3: family and number.",
    "Sign.image": "Picture: PNG, JPEG or PGM, from the world file's folder.",
    "Sign.z": "Height of its middle in metres.",
    "Sign.size": "Side of a tag's black square in metres, without the white margin, or width of a picture.",
    "Settings.name": "Name of the world.",
    "Settings.size": "Width and height in metres, from [0, 0]; everything must lie within.",
    "Settings.dt": "Length of a step in seconds.",
    "Settings.rtf": "Real-time factor; 0 is as fast as possible.",
    "Settings.seed": "Seed of all noise: the same seed, the same noise.",
    "Map.yaml": "The path of the map's YAML file, from the world file's folder.",
    "Wall.polyline": "Points [x, y] in metres, joined in this order.",
    "Wall.closed": "True: the last point is joined to the first.",
    "Obstacle.pose": "Pose: [x, y, theta].",
    "Obstacle.mass": "Mass in kg: with a mass it can be pushed.",
    "Obstacle.path": "Points [x, y] along which it moves by itself.",
    "Obstacle.speed": "Speed along its path, in m/s.",
    "Obstacle.closed": "True: round and round, from the last point to the first; false: to and fro.",
    "RobotDescription.name": "Letters, digits and '_', a letter first.",
    "RobotDescription.pose": "Pose at the start: [x, y, theta].",
    "RobotDescription.shape": "Outline about its origin; a circle with a radius of 0.17 m by default.",
    "RobotDescription.mass": "Mass in kg.",
    "RobotDescription.drive": "Kind of drive, and its limits.",
    "RobotDescription.wheels": "Wheels, each turned by a motor of its own that can be driven by name.",
    "RobotDescription.odom": "Odometry, on the topic odom and as a transform.",
    "RobotDescription.ground_truth": "True pose, on the topic ground_truth.",
    "RobotDescription.sensors": "Sensors; the first key of each is its kind, with its topic as the value.",
    "Drive.type": "diff: ahead and round; omni: sideways too; ackermann: steered like a car.",
    "Drive.v_max": "Largest speed in m/s.",
    "Drive.w_max": "Largest turning speed in rad/s.",
    "Drive.a_max": "Largest acceleration in m/s².",
    "Drive.alpha_max": "Largest angular acceleration in rad/s².",
    "Drive.timeout": "Time from the last command until it stops, in seconds.",
    "Drive.wheelbase": "Distance between the axles in metres (ackermann).",
    "Drive.steer_max": "Largest steering angle in radians (ackermann).",
    "Drive.steer_rate": "Largest steering speed in rad/s (ackermann).",
    "Drive.stamped": "True: cmd_vel has the type TwistStamped, as a TurtleBot3 since Jazzy; false: Twist.",
    "Wheel.motor": "The motor's name.",
    "Wheel.at": "Position on the robot and rolling direction: [x, y, theta].",
    "Wheel.radius": "Radius in metres.",
    "Wheel.speed_max": "Largest speed in rad/s.",
    "Odom.noise": "Noise of the speeds of odometry, drawn at each step.",
    "Odom.scale": "Systematic error of the speeds of odometry.",
    "Odom.drift": "Turn in rad that odometry sees in each metre ahead, counter-clockwise.",
    "OdomNoise.v": "Standard deviation as a share of the speed.",
    "OdomNoise.w": "Standard deviation as a share of the turning speed.",
    "OdomScale.v": "Measured speed as a share of the true one: 1.02 is 2 % too far.",
    "OdomScale.w": "Measured turning speed as a share of the true one.",
    "box": "Length along x and width along y in metres.",
    "circle": "Radius in metres.",
    "polygon": "Corners [x, y] in metres, in their order round the outline.",
    "colour": "Colour, for cameras: '#rrggbb' in quotes, or a name such as red.",
    "fov": "Field of view in degrees.",
    "height": "Height in metres, for cameras.",
    "noise": "Standard deviation in metres.",
    "offset": "Pose on the robot: [x, y, theta].",
    "range": "Shortest and longest range in metres.",
    "rate": "Rate in Hz; the period must be a whole number of steps.",
    "reflectance": "Share of light that it reflects, for a lidar's intensities.",
    "signs": "Signs on it, in its own frame.",
    "start": "Right end of the field of view in degrees; by default half of it to the right.",
}
"""Descriptions of keys: by Struct and key, or by a key that means the same everywhere; those of sensors stand there."""

_OUTLINES = [{"required": [kind]} for kind in ("box", "circle", "polygon")]


def world_schema() -> Schema:
    """Return the schema of world files as plain data."""
    types = [WorldDescription, *(each.description for each in SENSORS.usable().values())]
    _, parts = msgspec.json.schema_components(types, schema_hook=_any_sensor, ref_template="#/definitions/{name}")
    meanings = {**MEANINGS, **dict.fromkeys(SENSORS.usable(), "The topic that it publishes on.")}
    definitions = {name: described(name, draft_7(part), meanings) for name, part in sorted(parts.items())}
    for shape in ("Shape", "Obstacle"):
        definitions[shape]["oneOf"] = _OUTLINES
    definitions["Paint"]["oneOf"] = [{"required": ["line"]}, *_OUTLINES]
    definitions["Sign"]["oneOf"] = [{"required": ["tag"]}, {"required": ["image"]}]
    whole = definitions.pop("WorldDescription")
    return {"$schema": DRAFT, **whole, "title": "A world of robolink", "definitions": definitions}


def schema_text() -> str:
    """Return the schema as the text of a file."""
    return text_of(world_schema())


def _any_sensor(kind: type) -> Schema:
    """Return the schema of an item in a list of sensors."""
    if kind is not Sensor:
        raise NotImplementedError(kind)
    structs = [each.description.__name__ for each in SENSORS.usable().values()]
    return {"oneOf": [{"$ref": f"#/definitions/{each}"} for each in structs]}
