"""Contracts of extensions: checks that robolink's own commands, programs, sensors, types and nodes go through, too.

    from robolink.testing.contracts import check_package

    def test_the_package_keeps_its_contracts() -> None:
        check_package("robolink-compass")

A check names a part as its entry point does, so the package must be installed, `pip install -e .` for one.
"""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable
from typing import Any

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.extensions import registries
from robolink.interfaces import KINDS, find
from robolink.interfaces.standard import types_of
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import type_hash
from robolink.networks.kinds import Kind
from robolink.serialization import deserialize_message, serialize_message
from robolink.sim import Pose, RobotDescription, World, WorldDescription
from robolink.sim.description import Wheel
from robolink.sim.schema import world_schema
from robolink.sim.sensors import Sensor
from robolink.workspace import NodeSource, load_node
from robolink.workspace.load import check_needs_nothing
from robolink.workspace.programs import NODES, component, program
from robolink.world_node.messages import sensor_message, sensor_type

_WHEELS = (Wheel("left", Pose(0.0, 0.1)), Wheel("right", Pose(0.0, -0.1)))


class ContractError(RobolinkError, AssertionError):
    """A part does not do what robolink expects of its kind; the text names the part and what is wrong."""


def check_package(package: str) -> list[str]:
    """Check all that an installed package adds to robolink.

    Args:
        package: Name of the distribution, as pip has it.

    Returns:
        The parts that were checked, each as `GROUP NAME`.

    Raises:
        ContractError: If one does not keep its contract, or is hidden by another of its name.
        ExtensionError: If one cannot be loaded.
        NotFoundError: If the package adds nothing, or is not installed.
    """
    found = [(group, name) for group, registry in registries().items() for name in registry.of(package)]
    if not found:
        raise NotFoundError("package with entry points of robolink", package)
    for group, name in found:
        registry = registries()[group]
        _expect(name not in registry.table(), name, "robolink has one of this name itself, which goes first")
        _CHECKS[group](name)
    return [f"{group} {name}" for group, name in found]


def check_command(name: str) -> None:
    """Check a command: its line can be parsed, and it has a help text whose first line says what it does.

    Args:
        name: `NAME` for a noun, `NOUN.VERB` for a verb.
    """
    import typer

    part = _part("robolink.commands", name)
    app: typer.Typer = part if isinstance(part, typer.Typer) else importlib.import_module(part.module).app
    app.rich_markup_mode = None  # plain help, as the command line shows it
    command: Any = typer.main.get_command(app)
    for verb, each in getattr(command, "commands", {"": command}).items():
        text = each.get_short_help_str(limit=200)
        _expect(bool(text), f"{name} {verb}".strip(), "it has no help: the first line of its docstring is listed")
        with each.make_context(name, [], resilient_parsing=True) as context:
            _expect(text.split()[0] in each.get_help(context), name, "its help cannot be shown")


def check_program(name: str) -> None:
    """Check a program: it is found, can be imported, and can be started without arguments in code.

    Args:
        name: `PACKAGE.EXECUTABLE`, or `PACKAGE::CLASS` for a component, which must be a Node class.
    """
    _part("robolink.programs", name)
    package, _, executable = name.partition(".")
    source = component(name) if "::" in name else program(package, executable)
    assert source is not None
    _check_runs(name, source, is_class="::" in name)


def check_node(name: str) -> None:
    """Check a node: it is found, can be imported, and can be started without arguments in code.

    Args:
        name: Name for `robolink run`.
    """
    _part("robolink.nodes", name)
    source = NODES.get(name)
    assert source is not None
    _check_runs(name, source)


def check_network(name: str) -> None:
    """Check a network of another kind: its functions can be called.

    Args:
        name: Name for `--network`.
    """
    found = _part("robolink.networks", name)
    _expect(isinstance(found, Kind) and all(map(callable, found)), name, "it is not a robolink.networks.kinds.Kind")


def check_sensor(key: str) -> None:
    """Check a kind of sensor: its keys, what it measures in a world, and the message that becomes of it.

    Args:
        key: Key that names it in a world file.
    """
    kind = _part("robolink.sensors", key)
    struct: Any = kind.description
    _expect(issubclass(struct, Sensor), key, f"{struct.__name__} is not a subclass of Sensor")
    _expect(struct.__struct_fields__[:1] == (key,), key, f"the first field of {struct.__name__} must be '{key}'")
    config = struct.__struct_config__
    _expect(config.frozen and config.forbid_unknown_fields, key, "its Struct must be frozen, and forbid unknown fields")
    try:
        sensor = struct("topic")
    except TypeError as error:
        raise ContractError(f"{key}: all fields but the first need defaults: {error}") from error
    _expect(key in str(world_schema()), key, "the schema of world files does not have it")
    first, again = _measured(sensor), _measured(sensor)
    message = sensor_message(sensor, first, Header(frame_id="somewhere"))
    expected = sensor_type(sensor)
    _expect(type(message) is expected, key, f"its message is a {type(message).__name__}, not a {expected.__name__}")
    raw = serialize_message(message)
    _expect(serialize_message(deserialize_message(raw, expected)) == raw, key, "its message is another one once read")
    same = serialize_message(sensor_message(sensor, again, Header(frame_id="somewhere"))) == raw
    _expect(same, key, "two worlds with one seed give two values: take random numbers from carrier.random(sensor)")


def check_interfaces(package: str) -> None:
    """Check a package of types: ROS 2's rules for names, and that a message of each type survives its own bytes.

    Args:
        package: Name of the package.
    """
    _part("robolink.interfaces", package)
    _expect(package.islower() and package.isidentifier(), package, "a package's name has small letters, digits and _")
    for kind in KINDS:
        for short in types_of(package, kind):
            name = f"{package}/{kind}/{short}"
            _expect(short[:1].isupper() and short.isalnum(), name, "a type's name is letters and digits: WheelSpeeds")
            found = find(name, kind)
            parts = [getattr(found, each) for each in _PARTS if each in vars(found)] or [found]
            for each in parts:
                raw = serialize_message(each())
                _expect(serialize_message(deserialize_message(raw, each)) == raw, name, "it is another one once read")
                _expect(type_hash(each).startswith("RIHS01_"), name, "it has no hash")


_PARTS = ("Request", "Response", "Goal", "Result", "Feedback")
_CHECKS: dict[str, Callable[[str], None]] = {
    "robolink.commands": check_command,
    "robolink.programs": check_program,
    "robolink.sensors": check_sensor,
    "robolink.interfaces": check_interfaces,
    "robolink.nodes": check_node,
    "robolink.networks": check_network,
}


def _part(group: str, name: str) -> Any:
    registry = registries()[group]
    part = registry.get(name)
    if part is None:
        raise NotFoundError(f"name in {group}", name, registry.names())
    return part


def _check_runs(name: str, source: NodeSource, *, is_class: bool = False) -> None:
    found = load_node(source)
    check_needs_nothing(found)
    _expect(isinstance(found, type) or not is_class, name, "a component is a Node class, which can share a process")


def _measured(sensor: Sensor) -> Any:
    """Return the first value that a sensor measures on a robot in an empty world."""
    robot = RobotDescription("robot", Pose(1.0, 2.0, 0.5), wheels=_WHEELS, sensors=(sensor,))
    world = World(WorldDescription(robots=(robot,)))
    for _ in range(math.ceil(1.0 / (sensor.rate * 0.01))):
        world.step()
    readings = world.readings()
    _expect(len(readings) == 1, sensor.kind, f"it gives {len(readings)} values in one period")
    return readings[0].value


def _expect(holds: bool, name: str, reason: str) -> None:
    if not holds:
        raise ContractError(f"{name}: {reason}")
