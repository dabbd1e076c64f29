"""Each kind of sensor stands in every table that needs it: a missing entry is named with its file and table."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

from robolink.interfaces.std_msgs.msg import Header
from robolink.message import type_name
from robolink.serialization import deserialize_message, serialize_message
from robolink.sim import Pose, RobotDescription, World, WorldDescription
from robolink.sim import sensors as descriptions
from robolink.sim.description import Wheel
from robolink.sim.sensing.devices import DEVICES
from robolink.sim.sensors import SENSORS, Bumper, Imu, Lidar, Looking, Sensor
from robolink.world_node.messages import SENSOR_MESSAGES, sensor_message, sensor_type

SIMULATOR_PAGE = Path(__file__).parents[2] / "docs" / "simulator.md"
WHEELS = (Wheel("left", Pose(0.0, 0.1)), Wheel("right", Pose(0.0, -0.1)))


def require(table: Iterable[object], name: str, kinds: Iterable[type[object]]) -> None:
    """Fail with one sentence that names the table's file and the sensors that it lacks."""
    if lacking := sorted(each.__name__ for each in set(kinds) - set(table)):
        recipe = "see 'Add a sensor' in docs/development/recipes.md"
        pytest.fail(f"the table {name} has no entry for {', '.join(lacking)}: {recipe}", pytrace=False)


def has_device(*kinds: type[object]) -> None:
    require(DEVICES, "DEVICES in robolink/sim/sensing/devices.py", kinds)


def has_message(*kinds: type[object]) -> None:
    require(SENSOR_MESSAGES, "SENSOR_MESSAGES in robolink/world_node/messages.py", kinds)


def test_every_sensor_is_in_the_table_of_kinds() -> None:
    structs = [each for each in vars(descriptions).values() if isinstance(each, type) and issubclass(each, Sensor)]
    require(SENSORS.values(), "SENSORS in robolink/sim/sensors.py", set(structs) - {Sensor, Looking})


def test_every_sensor_has_a_device_that_measures() -> None:
    has_device(*SENSORS.values())


def test_every_sensor_has_a_message() -> None:
    has_message(*SENSORS.values())


def test_no_table_has_more_than_there_are_sensors() -> None:
    assert (set(DEVICES) | set(SENSOR_MESSAGES)) - set(SENSORS.values()) == set()


def test_a_missing_entry_is_named_with_its_table() -> None:
    with pytest.raises(pytest.fail.Exception, match=r"^the table DEVICES has no entry for Imu: see 'Add a sensor' in "):
        require([Bumper, Lidar], "DEVICES", [Bumper, Imu, Lidar])


@pytest.mark.parametrize("kind", SENSORS)
def test_what_a_sensor_measures_becomes_its_message(kind: str) -> None:
    described: Any = SENSORS[kind]
    has_device(described)
    has_message(described)
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
    has_message(SENSORS[kind])
    wanted = type_name(SENSOR_MESSAGES[SENSORS[kind]][0]).replace("/msg/", "/")
    rows = [line.split("|") for line in SIMULATOR_PAGE.read_text(encoding="utf-8").splitlines()]
    messages = [row[3].strip() for row in rows if len(row) > 3 and row[1].strip() == f"`{kind}`"]
    assert messages == [wanted], (
        f"docs/simulator.md: the table of sensors needs a row | `{kind}` | what it measures | {wanted} |"
    )
