"""A fleet from one launch file: each robot has its own controller, all in one process, and no scan is lost."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink import Context
from robolink.cli.running_nodes import container
from robolink.documents.yamlfile import parse, read_text, spell
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.launch import plan, shared_process
from robolink.logging import LoggingSeverity
from robolink.sim import load_world
from robolink.task import Future
from robolink.utilities import set_default_context
from robolink.workspace import find_launch, find_node, find_world
from tests.support.commands import Command

ROBOTS = 10
SCANS = 20

COUNTING = """
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.workspace import find_node, load_node

class Counting(load_node(find_node('reactive_controller'))):
    '''The reactive controller, which looks at the numbers of the scans that it gets.'''

    def __init__(self):
        self.numbers = []
        super().__init__()

    def create_subscription(self, msg_type, topic, callback, qos_profile, **rest):
        if msg_type is not LaserScan:
            return super().create_subscription(msg_type, topic, callback, qos_profile, **rest)

        def on_scan(scan, info):
            self.numbers.append(info['publication_sequence_number'])
            callback(scan)
            if len(self.numbers) == SCANS:
                first = self.numbers[0]
                lost = [each for each in range(first, first + SCANS) if each not in self.numbers]
                is_complete = not lost and self.numbers == sorted(self.numbers)
                print('scans:', 'complete' if is_complete else f'lost {lost} of {self.numbers}', flush=True)

        return super().create_subscription(msg_type, topic, on_scan, 1000, **rest)
""".replace("SCANS", str(SCANS))


@pytest.mark.slow
def test_the_fleet_has_a_controller_for_each_of_its_robots() -> None:
    world, controllers = plan(find_launch("fleet"))
    assert (world.name, controllers.name) == ("world", "controllers")
    members = shared_process.read(controllers.input)
    assert [each.name for each in members] == [
        f"{robot.name}/reactive_controller" for robot in load_world(find_world("fleet")).robots
    ]
    assert len(members) == 100


@pytest.fixture
def fleet(tmp_path: Path) -> Path:
    """A launch file of a part of the fleet, whose controllers count."""
    data: Any = parse(read_text(find_world("fleet")))
    (tmp_path / "few.yaml").write_text(spell({**data, "robots": data["robots"][:ROBOTS]}))
    (tmp_path / "counting.py").write_text(COUNTING)
    system = f"""
nodes:
- {{node: world, parameters: {{world: "{tmp_path.as_posix()}/few.yaml"}}}}
- {{node: "{tmp_path.as_posix()}/counting.py", count: {ROBOTS}, namespace: "r{{i}}", process: controllers}}
"""
    path = tmp_path / "fleet.yaml"
    path.write_text(system)
    return path


@pytest.fixture
def nodes(fleet: Path, virtual: Context, monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Any]]:
    """All nodes of that system in one process, in virtual time."""
    monkeypatch.setattr(sys, "argv", sys.argv)
    set_default_context(virtual)
    text = fleet.read_text().replace("- {node: world,", "- {node: world, process: controllers,")
    [process] = plan(fleet, text=text)
    yield [container.make(each, find_node(each.node), virtual) for each in shared_process.read(process.input)]
    set_default_context(None)


@pytest.mark.slow
def test_in_virtual_time_each_robot_gets_its_scans_and_drives(
    nodes: list[Any], executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    world, *controllers = nodes
    for node in nodes:
        executor.add_node(node)
    robots = world.simulation.world.robots
    before = {name: robot.pose for name, robot in robots.items()}
    executor.spin_until_future_complete(Future[None](), timeout_sec=3.05)
    assert [each.get_namespace() for each in controllers] == [f"/{name}" for name in robots]
    assert [each.numbers for each in controllers] == [list(range(1, 31))] * ROBOTS
    assert all(robot.pose != before[name] for name, robot in robots.items())
    assert not [each.message for each in log_lines if each.severity > LoggingSeverity.INFO]


@pytest.mark.processes
def test_over_a_network_no_scan_is_lost(fleet: Path, domain: int) -> None:
    with Command(domain, "launch", str(fleet)) as launch:
        told = [launch.wait_for("scans: ").text for _ in range(ROBOTS)]
        launch.interrupt()
        assert launch.end() == 0
    assert told == ["[controllers] scans: complete"] * ROBOTS
