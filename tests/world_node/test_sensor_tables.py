"""Each Struct of a sensor is in the registry, and the manual's table of sensors says what the registry does."""

from __future__ import annotations

from pathlib import Path

from robolink.message import type_name
from robolink.sim import sensors as descriptions
from robolink.sim.sensors import SENSORS, Looking, Sensor

SIMULATOR_PAGE = Path(__file__).parents[2] / "docs" / "reference" / "simulator.md"


def test_every_sensor_is_in_the_registry() -> None:
    structs = {each for each in vars(descriptions).values() if isinstance(each, type) and issubclass(each, Sensor)}
    assert structs - {Sensor, Looking} <= {each.description for each in SENSORS.table().values()}


def test_the_manual_has_the_messages_of_the_sensors() -> None:
    rows = [line.split("|") for line in SIMULATOR_PAGE.read_text(encoding="utf-8").splitlines()]
    messages = {key: type_name(kind.part("message")).replace("/msg/", "/") for key, kind in SENSORS.table().items()}
    written = {row[1].strip(" `"): row[3].strip() for row in rows if len(row) > 3 and row[1].strip(" `") in messages}
    assert written == {key: messages[key] for key in written}
    assert len(written) >= 6
