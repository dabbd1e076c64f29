"""Defaults of Webots' fields here are Webots' own: what is read is compared with tests/data/webots_defaults.yaml."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from robolink.documents import yamlfile
from robolink.sim.sensors import Lidar
from robolink.sim.webots import read
from robolink.sim.webots.sensors import LIDARS
from robolink.sim.webots.vrml_node import KNOWN_FIELDS, Node

FACTS: Any = yamlfile.parse((Path(__file__).parents[2] / "data" / "webots_defaults.yaml").read_text())
ALL = """#VRML_SIM R2023b utf8
WorldInfo { }
Floor { } RectangleArena { } CircleArena { }
Wall { } Window { } SolidBox { physics Physics { } } WoodenBox { } CardboardBox { }
Solid {
  children [
    Shape { appearance PBRAppearance { } geometry Box { } }
    Shape { appearance Appearance { material Material { } } geometry Sphere { } }
  ]
  physics Physics { }
}
Transform {
  children [ Shape { geometry Cylinder { } } Shape { geometry Capsule { } } Shape { geometry Cone { } } ]
}
Pose { translation 50 50 0 children [ Robot { children [
  Shape { geometry Box { } }
  HingeJoint {
    jointParameters HingeJointParameters { } device [ RotationalMotor { } PositionSensor { } ]
    endPoint Solid { translation 0 1.1 0 rotation 0 1 0 1.5707963 children [ Shape { geometry Cylinder { } } ] }
  }
  Lidar { } DistanceSensor { } TouchSensor { } Camera { } RangeFinder { }
  HokuyoUrg04lx { } HokuyoUrg04lxug01 { } HokuyoUtm30lx { } RobotisLds01 { } SickLms291 { }
] } ] }
"""
"""A node of each kind that is read, with no field that has a default."""

OF_NO_EFFECT = {("RobotisLds01", "translation")}
"""Its height, which a flat world does not have."""
NO_FIELDS = {"scale"}
"""Read of all nodes, and a field of Transform alone."""


@pytest.fixture
def used(monkeypatch: pytest.MonkeyPatch) -> dict[tuple[str, str], Any]:
    """The defaults that are used while `ALL` is read, by node type and field."""
    found: dict[tuple[str, str], Any] = {}
    numbers, text, truth = Node.numbers, Node.text, Node.truth

    def spy_numbers(self: Node, field: str, *default: float) -> tuple[float, ...]:
        found[self.type, field] = list(default)
        return numbers(self, field, *default)

    def spy_text(self: Node, field: str, default: str = "") -> str:
        found[self.type, field] = default
        return text(self, field, default)

    def spy_truth(self: Node, field: str, default: bool) -> bool:
        found[self.type, field] = default
        return truth(self, field, default)

    monkeypatch.setattr(Node, "numbers", spy_numbers)
    monkeypatch.setattr(Node, "text", spy_text)
    monkeypatch.setattr(Node, "truth", spy_truth)
    assert read("w.wbt", ALL).description.robots
    return {key: value for key, value in found.items() if key[0] != "Shape" and key not in OF_NO_EFFECT}


def test_every_default_that_is_used_is_webots_own(used: dict[tuple[str, str], Any]) -> None:
    facts = FACTS["nodes"]
    assert {kind for kind, _ in used} == set(facts)
    for (kind, field), default in used.items():
        if field in NO_FIELDS and kind != "Transform":
            continue
        own = facts[kind][field]
        if isinstance(default, list):
            assert default == pytest.approx(own if isinstance(own, list) else [own], abs=1e-5), (kind, field)
        else:
            assert default == own, (kind, field)


def test_a_distance_sensors_default_table_is_webots_own() -> None:
    (robot,) = read("w.wbt", ALL).description.robots
    (sensor,) = [each for each in robot.sensors if type(each).__name__ == "RangeFinder"]
    table = FACTS["nodes"]["DistanceSensor"]["lookupTable"]
    assert sensor.range == (0.0, table[-3])  # type: ignore[attr-defined]


def test_lidars_of_the_library_are_as_their_protos_define_them() -> None:
    assert set(LIDARS) == set(FACTS["lidars"])
    for kind, (beams, fov, near, far) in FACTS["lidars"].items():
        text = f"#VRML_SIM R2023b utf8\nRobot {{ children [ Shape {{ geometry Box {{ }} }} {kind} {{ }} ] }}"
        (robot,) = read("w.wbt", text).description.robots
        (lidar,) = robot.sensors
        assert isinstance(lidar, Lidar)
        assert (lidar.beams, lidar.range) == (beams, (near, far))
        assert math.radians(lidar.fov) == pytest.approx(fov, abs=1e-3)
        assert lidar.noise == pytest.approx(FACTS["nodes"][kind]["noise"] * far)


def test_every_field_of_the_facts_is_known() -> None:
    for kind, fields in FACTS["nodes"].items():
        assert set(fields) <= KNOWN_FIELDS[kind], kind
