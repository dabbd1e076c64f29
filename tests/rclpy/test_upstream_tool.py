"""tools/upstream.py: it finds what upstream has and robolink lacks, and nothing that robolink has."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.compat import ALWAYS, activate
from tools.upstream import PACKAGES, Name, compared, lines, missing, names_in, packages_in

UPSTREAM = """
class TimerAction:
    def __init__(self, *, period, actions, wind=None): ...
    def cancel(self, gently=False): ...
    def rewind(self): ...
    def _hidden(self): ...

class Catapult:
    def shoot(self, far): ...
"""


@pytest.fixture(autouse=True)
def names_of_ros() -> None:
    activate(ALWAYS)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A checkout of launch with one module of its own, one that robolink lacks, and tests."""
    package = tmp_path / "launch" / "launch"
    (package / "actions").mkdir(parents=True)
    (package / "__init__.py").write_text("from .launch_context import LaunchContext\n")
    (package / "actions" / "__init__.py").write_text("from .timer_action import TimerAction\n")
    (package / "actions" / "timer_action.py").write_text(UPSTREAM)
    (package / "siege.py").write_text("class Ladder:\n    def climb(self): ...\n")
    (tmp_path / "test" / "launch").mkdir(parents=True)
    (tmp_path / "test" / "launch" / "__init__.py").write_text("def only_in_tests(): ...\n")
    return tmp_path


def test_missing_modules_names_and_arguments_are_found(checkout: Path) -> None:
    (found,) = compared(checkout).values()
    timer = "launch.actions.timer_action"
    assert set(found) == {
        Name(timer, "Catapult"),
        Name(timer, "TimerAction.rewind"),
        Name(timer, "TimerAction.cancel", "gently"),
        Name("launch.siege"),
        Name("launch.siege", "Ladder"),
    }
    assert list(lines(found)) == [
        f"{timer}: TimerAction.rewind, Catapult",
        "launch.siege (no such module): Ladder",
        f"{timer}.TimerAction.cancel(): gently=",
    ]


def test_what_an_older_checkout_has_is_left_out(checkout: Path) -> None:
    assert compared(checkout, since=checkout) == {"launch": []}


def test_the_package_is_that_which_is_installed(checkout: Path) -> None:
    assert packages_in(checkout) == {"launch": checkout / "launch" / "launch"}
    with pytest.raises(FileNotFoundError, match="has no package rclpy"):
        compared(checkout, package="rclpy")


def test_names_of_a_compiled_module_are_those_of_its_package(tmp_path: Path) -> None:
    (tmp_path / "_storage.pyi").write_text("def made(arg0: int, uri: str) -> None: ...\n")
    here = tmp_path.name
    assert list(names_in(tmp_path)) == [Name(here), Name(here, "made"), Name(here, "made", "uri")]


def test_attributes_that_instances_have_are_here() -> None:
    assert missing([Name("rclpy.node", "Node.create_timer", "callback"), Name("rclpy.node", "Node.gone")]) == [
        Name("rclpy.node", "Node.gone")
    ]


def test_the_page_has_a_row_for_each_package() -> None:
    page = Path(__file__).parents[2] / "docs" / "development" / "upstream.md"
    told = "".join(
        line.split("|")[1] for line in page.read_text(encoding="utf-8").splitlines() if line.startswith("| `")
    )
    assert [each for each in PACKAGES if f"`{each}`" not in told] == []
