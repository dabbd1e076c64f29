"""Robolink's own commands, programs, sensors, types and nodes keep the contracts that extensions are checked by."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from robolink.cli.shared.commands import NOUNS
from robolink.exceptions import NotFoundError, RobolinkError
from robolink.extensions import ExtensionError, registries
from robolink.sim.sensors import SENSORS
from robolink.testing.contracts import (
    ContractError,
    check_command,
    check_interfaces,
    check_network,
    check_node,
    check_package,
    check_program,
    check_sensor,
)

CHECKS: dict[str, Callable[[str], None]] = {
    "robolink.commands": check_command,
    "robolink.programs": check_program,
    "robolink.sensors": check_sensor,
    "robolink.interfaces": check_interfaces,
    "robolink.nodes": check_node,
    "robolink.networks": check_network,
}
OWN = [(group, name) for group, registry in registries().items() for name in registry.table()]
HIDDEN = {name for name, entry in NOUNS.items() if entry.hidden}
"""Commands that robolink itself starts."""


@pytest.mark.slow
@pytest.mark.parametrize(("group", "name"), [each for each in OWN if each[1] not in HIDDEN])
def test_what_comes_with_robolink_keeps_its_contract(group: str, name: str) -> None:
    CHECKS[group](name)


CODE = """\
from msgspec import Struct
from robolink.interfaces.std_msgs.msg import Float64
from robolink.sim.sensors import Sensor, SensorKind
import random, robolink

def silent() -> None:
    pass

def needy(word) -> None:
    pass

class Late(Sensor, Struct, frozen=True, forbid_unknown_fields=True):
    rate: float
    late: str

class Bare(Sensor, Struct, frozen=True, forbid_unknown_fields=True):
    bare: str
    rate: float

class Chance(Sensor, Struct, frozen=True, forbid_unknown_fields=True):
    chance: str
    rate: float = 10.0

class Device:
    def __init__(self, description, carrier):
        self.description = description
    def measure(self):
        return random.random()

def message(value, header, description):
    return Float64(data=value)

LATE = SensorKind(Late, Device, Float64, message)
BARE = SensorKind(Bare, Device, Float64, message)
CHANCE = SensorKind(Chance, Device, Float64, message)
"""
ENTRY_POINTS = """\
[robolink.commands]
silent = faulty_extension:silent

[robolink.programs]
faulty.needy = faulty_extension:needy
faulty::Component = faulty_extension:silent

[robolink.sensors]
late = faulty_extension:LATE
bare = faulty_extension:BARE
chance = faulty_extension:CHANCE
lidar = faulty_extension:CHANCE

[robolink.interfaces]
faulty_msgs = faulty_types

[robolink.nodes]
lacking = faulty_extension:Lacking
"""


@pytest.fixture
def faulty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An installed package whose parts have a fault each."""
    (tmp_path / "faulty_extension-1.0.dist-info").mkdir()
    (tmp_path / "faulty_extension-1.0.dist-info/METADATA").write_text("Name: faulty-extension\nVersion: 1.0\n")
    (tmp_path / "faulty_extension-1.0.dist-info/entry_points.txt").write_text(ENTRY_POINTS)
    (tmp_path / "faulty_extension.py").write_text(CODE)
    (tmp_path / "faulty_types/msg").mkdir(parents=True)
    (tmp_path / "faulty_types/msg/wheel_speeds.msg").write_text("float64 left\n")
    monkeypatch.syspath_prepend(tmp_path)


@pytest.mark.usefixtures("faulty")
@pytest.mark.parametrize(
    ("check", "name", "reason"),
    [
        (check_command, "silent", "silent: it has no help"),
        (check_program, "faulty.needy", "needy() needs 'word'"),
        (check_program, "faulty::Component", "a component is a Node class"),
        (check_sensor, "late", "the first field of Late must be 'late'"),
        (check_sensor, "bare", "all fields but the first need defaults"),
        (check_sensor, "chance", "take random numbers from carrier.random(sensor)"),
        (check_interfaces, "faulty_msgs", "faulty_msgs/msg/wheel_speeds: a type's name is letters and digits"),
        (check_node, "lacking", "no class or function named 'Lacking'"),
        (check_node, "absent", "no name in robolink.nodes named 'absent'"),
    ],
)
def test_a_fault_is_named(check: Callable[[str], None], name: str, reason: str) -> None:
    with pytest.raises((RobolinkError, AssertionError)) as caught:
        check(name)
    assert reason in str(caught.value)


@pytest.mark.usefixtures("faulty")
def test_a_package_is_checked_as_a_whole() -> None:
    with pytest.raises(ContractError, match="silent: it has no help"):
        check_package("faulty_extension")
    with pytest.raises(NotFoundError, match="no package with entry points of robolink named 'numpy'"):
        check_package("numpy")
    assert "chance" in SENSORS.names()


@pytest.mark.usefixtures("faulty")
def test_a_name_that_robolink_has_is_a_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(type(SENSORS), "of", lambda self, _: ["lidar"] if self is SENSORS else [])
    with pytest.raises(ContractError, match="lidar: robolink has one of this name itself"):
        check_package("faulty-extension")
    assert not issubclass(ContractError, ExtensionError)
