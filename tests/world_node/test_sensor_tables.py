"""Each kind of sensor is in the registry, with parts that are there; another package may add one."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from robolink.interfaces.std_msgs.msg import Header
from robolink.message import type_name
from robolink.serialization import deserialize_message, serialize_message
from robolink.sim import Pose, RobotDescription, World, WorldDescription
from robolink.sim import sensors as descriptions
from robolink.sim.description import Wheel
from robolink.sim.sensors import SENSORS as REGISTRY
from robolink.sim.sensors import Looking, Sensor
from robolink.world_node.messages import sensor_message, sensor_type

SENSORS = REGISTRY.table()
SIMULATOR_PAGE = Path(__file__).parents[2] / "docs" / "reference" / "simulator.md"
WHEELS = (Wheel("left", Pose(0.0, 0.1)), Wheel("right", Pose(0.0, -0.1)))


def test_every_sensor_is_in_the_registry() -> None:
    structs = [each for each in vars(descriptions).values() if isinstance(each, type) and issubclass(each, Sensor)]
    assert {each.description for each in SENSORS.values()} == set(structs) - {Sensor, Looking}


@pytest.mark.parametrize("kind", SENSORS)
def test_every_part_of_a_sensor_is_there(kind: str) -> None:
    row = SENSORS[kind]
    assert all(callable(row.part(name)) for name in ("device", "message", "convert"))


@pytest.mark.parametrize("kind", SENSORS)
def test_what_a_sensor_measures_becomes_its_message(kind: str) -> None:
    described: Any = SENSORS[kind].description
    sensor = described("topic")
    robot = RobotDescription("robot", Pose(1.0, 2.0, 0.5), wheels=WHEELS, sensors=(sensor,))
    world = World(WorldDescription(robots=(robot,)))
    for _ in range(math.ceil(1.0 / (sensor.rate * 0.01))):
        world.step()
    (reading,) = world.readings()
    message = sensor_message(reading.sensor, reading.value, Header(frame_id="somewhere"))
    assert type(message) is sensor_type(sensor)
    raw = serialize_message(message)
    assert serialize_message(deserialize_message(raw, sensor_type(sensor))) == raw


@pytest.mark.parametrize("kind", SENSORS)
def test_the_manual_has_a_row_for_every_sensor(kind: str) -> None:
    wanted = type_name(SENSORS[kind].part("message")).replace("/msg/", "/")
    rows = [line.split("|") for line in SIMULATOR_PAGE.read_text(encoding="utf-8").splitlines()]
    messages = [row[3].strip() for row in rows if len(row) > 3 and row[1].strip() == f"`{kind}`"]
    assert messages == [wanted], (
        f"docs/reference/simulator.md: the table of sensors needs a row | `{kind}` | what it measures | {wanted} |"
    )
