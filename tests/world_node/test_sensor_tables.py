"""Each kind of sensor is in the registry, with parts that are there; another package may add one."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.message import type_name
from robolink.sim import sensors as descriptions
from robolink.sim.sensors import SENSORS as REGISTRY
from robolink.sim.sensors import Looking, Sensor

SENSORS = REGISTRY.table()
SIMULATOR_PAGE = Path(__file__).parents[2] / "docs" / "reference" / "simulator.md"


def test_every_sensor_is_in_the_registry() -> None:
    structs = [each for each in vars(descriptions).values() if isinstance(each, type) and issubclass(each, Sensor)]
    assert {each.description for each in SENSORS.values()} == set(structs) - {Sensor, Looking}


@pytest.mark.parametrize("kind", SENSORS)
def test_the_manual_has_a_row_for_every_sensor(kind: str) -> None:
    wanted = type_name(SENSORS[kind].part("message")).replace("/msg/", "/")
    rows = [line.split("|") for line in SIMULATOR_PAGE.read_text(encoding="utf-8").splitlines()]
    messages = [row[3].strip() for row in rows if len(row) > 3 and row[1].strip() == f"`{kind}`"]
    assert messages == [wanted], (
        f"docs/reference/simulator.md: the table of sensors needs a row | `{kind}` | what it measures | {wanted} |"
    )
