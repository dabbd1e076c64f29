"""Programs for rclpy on every subject of the ROS 2 tutorials run as they are under `robolink run`, in processes.

Each subject has a domain of its own and starts while the test of the one before runs; each test waits for what it is
about.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.support.commands import Command
from tests.support.domains import free_domain

pytestmark = pytest.mark.processes

WORKSPACE = Path(__file__).parents[1] / "tutorials"

TUTORIALS: Mapping[str, tuple[tuple[str, ...], ...]] = {
    "topics": (("kettle",), ("cup",), ("glance",)),
    "services": (("scales",), ("weigh", "41", "1")),
    "interfaces": (("clerk",), ("warehouse",)),
    "parameters": (("lamp", "--ros-args", "-p", "colour:=red"), ("caretaker",)),
    "actions": (("farmer",), ("hutch",), ("miser",)),
    "turtles": (
        ("pond",),
        ("spotter", "--ros-args", "-r", "__node:=first", "-p", "whom:=turtle1"),
        ("spotter", "--ros-args", "-r", "__node:=second", "-p", "whom:=turtle2"),
        ("bait",),
        ("chaser", "--ros-args", "-p", "prey:=bait"),
    ),
    "static": (("rigger",), ("mast", "mast", "0", "0", "1", "0", "0", "1.5707963")),
    "lifecycle": (("fountain",), ("gardener",)),
    "executors": (("house",),),
    "qos": (("lighthouse",),),
    "logging": (("diary", "--ros-args", "--log-level", "diary:=debug"),),
}
"""By subject: its programs and their arguments."""


class Tutorial:
    """The running programs of a tutorial, in the order of the table."""

    def __init__(self, stack: ExitStack, name: str) -> None:
        self._stack = stack
        self.domain = stack.enter_context(free_domain())
        self.programs: list[Command] = []
        for program in TUTORIALS[name]:
            self.start(*program)

    def start(self, *program: str) -> Command:
        """Run another program."""
        command = Command(self.domain, "run", "--workspace", str(WORKSPACE), *program, merged=True)
        self.programs.append(self._stack.enter_context(command))
        return command

    def end(self) -> None:
        """Press Ctrl-C wherever one still runs: all of them end quietly."""
        for each in self.programs:
            if each.process.poll() is None:
                each.interrupt()
        assert [each.end() for each in self.programs] == [0] * len(self.programs)
        assert [line for each in self.programs for line in each.lines if "Traceback" in line.text] == []


class Tutorials:
    """The tutorials by name; with the one that is asked for, the next is started."""

    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack
        self._started: dict[str, Tutorial] = {}

    def __getitem__(self, name: str) -> Tutorial:
        names = [*TUTORIALS]
        for each in names[names.index(name) :][:2]:
            if each not in self._started:
                self._started[each] = Tutorial(self._stack, each)
        return self._started[name]


@pytest.fixture(scope="module")
def tutorials() -> Iterator[Tutorials]:
    with ExitStack() as stack:
        yield Tutorials(stack)


def said(command: Command) -> str:
    """All that it printed."""
    return "\n".join(line.text for line in command.lines)


def test_the_programs_know_nothing_of_robolink() -> None:
    programs = list((WORKSPACE / "nodes").glob("*.py"))
    assert len(programs) > 5
    for path in programs:
        imported = {
            name.partition(".")[0]
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.Import | ast.ImportFrom)
            for name in (
                [node.module or ""] if isinstance(node, ast.ImportFrom) else [each.name for each in node.names]
            )
        }
        assert "robolink" not in imported
        assert "rclpy" in imported


def test_a_publisher_and_a_subscriber(tutorials: Tutorials) -> None:
    kettle, cup, glance = tutorials["topics"].programs
    kettle.wait_for("[kettle]: told: 20 degrees")
    for _ in range(3):
        cup.wait_for("[cup]: the kettle says ")
    glance.wait_for("[guest]: water: True, String")
    glance.wait_for("[guest]: milk: False, NoneType")
    assert glance.end() == 0
    tutorials["topics"].end()


def test_a_service_and_its_client(tutorials: Tutorials) -> None:
    scales, weigh = tutorials["services"].programs
    weigh.wait_for("[grocer]: together they weigh 42 g")
    scales.wait_for("[scales]: weighing 1:")
    scales.wait_for("left 41, right 1")
    assert weigh.end() == 0
    tutorials["services"].end()


def test_interfaces_of_ones_own(tutorials: Tutorials) -> None:
    clerk, _ = tutorials["interfaces"].programs
    assert clerk.end() == 0
    for line in ("stacked 6", "6 parcels came", "the shelf at y=2.0 is 3.0 m wide"):
        assert f"[clerk]: {line}" in said(clerk)
    tutorials["interfaces"].end()


def test_parameters(tutorials: Tutorials) -> None:
    lamp, caretaker = tutorials["parameters"].programs
    lamp.wait_for("[lamp]: shines red")
    lamp.wait_for("[lamp]: shines white")
    while not {"colour is white now", "rounds is 3 now"} <= {line.text.partition("]: ")[2] for line in caretaker.lines}:
        caretaker.wait_for("is")
    tutorials["parameters"].end()


def test_an_action_server_and_its_clients(tutorials: Tutorials) -> None:
    farmer, hutch, miser = tutorials["actions"].programs
    farmer.wait_for("[farmer]: accepted: False")
    farmer.wait_for("[farmer]: accepted: True")
    for pairs in ("[0, 1, 1]", "[0, 1, 1, 2]", "[0, 1, 1, 2, 3]", "[0, 1, 1, 2, 3, 5]"):
        farmer.wait_for(f"so far {pairs}")
    farmer.wait_for("in the end [0, 1, 1, 2, 3, 5]")
    miser.wait_for("[miser]: 1 goal ends")
    hutch.wait_for("[hutch]: no more rabbits")
    assert (farmer.end(), miser.end()) == (0, 0)
    assert "[hutch]: somebody has enough" in said(hutch)
    tutorials["actions"].end()


def test_a_turtle_follows_another_by_tf2(tutorials: Tutorials) -> None:
    pond, *_, chaser = tutorials["turtles"].programs
    chaser.wait_for("[chaser]: turtle2 is in the pond")
    pond.wait_for("[pond]: the turtles meet")
    tutorials["turtles"].end()


def test_a_static_broadcaster(tutorials: Tutorials) -> None:
    rigger, _ = tutorials["static"].programs
    rigger.wait_for("[rigger]: the boom ends at y=2.0, z=1.0")
    assert rigger.end() == 0
    tutorials["static"].end()


def test_a_lifecycle_node_and_its_client(tutorials: Tutorials) -> None:
    fountain, gardener = tutorials["lifecycle"].programs
    for line in (
        "the fountain is inactive: True",
        "the fountain is active: True",
        "heard splash!",
        "the fountain is inactive: True",
        "the fountain is unconfigured: True",
        "the fountain is finalized: True",
    ):
        gardener.wait_for(f"[gardener]: {line}")
    for line in ("filled; it was ", "opened", "shut", "cleaned", "taken down"):
        fountain.wait_for(f"[fountain]: {line}")
    assert gardener.end() == 0
    tutorials["lifecycle"].end()


def test_nodes_and_executors_in_one_process(tutorials: Tutorials) -> None:
    (house,) = tutorials["executors"].programs
    house.wait_for("[attic]: stroke 1")
    house.wait_for("[attic]: stroke 9")
    tutorials["executors"].end()
    assert "[butler]: dinner is served" in said(house)


def test_quality_of_service(tutorials: Tutorials) -> None:
    (lighthouse,) = tutorials["qos"].programs
    lighthouse.wait_for("[lighthouse]: the rules are up")
    ship = tutorials["qos"].start("ship", "-s", "5")
    assert ship.end() == 0
    saw = [line.text.partition("]: ")[2] for line in ship.lines]
    assert sorted(saw) == ["past it", *["saw flash"] * 3, "saw rule 2", "saw rule 3"]
    assert saw[-1] == "past it"
    tutorials["qos"].end()


def test_logging(tutorials: Tutorials) -> None:
    (diary,) = tutorials["logging"].programs
    diary.wait_for("the end")
    tutorials["logging"].end()
    levels = [line.text.partition("]")[0].removeprefix("[") for line in diary.lines[:11]]
    assert levels == ["INFO", "INFO", "DEBUG", "ERROR", "INFO", "DEBUG", "WARN", "INFO", "DEBUG", "WARN", "FATAL"]
    assert [said(diary).count(each) for each in ("dear diary", "the roof leaks", "a secret")] == [1, 1, 0]
