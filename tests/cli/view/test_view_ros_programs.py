"""rviz2 and rqt by their own names open the page of `robolink view` with the right panels."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink.cli import view
from robolink.cli.main import main
from robolink.testing import System
from robolink.workspace import find_executable, load_node, program_names
from tests.support.commands import Command

LAYOUT = Path(view.__file__).parents[2] / "view/page/layouts.js"
PROGRAMS = sorted(name for name in program_names() if name.startswith(("rqt", "rviz")))


def test_the_panels_are_those_of_the_page() -> None:
    listed = re.search(r"PANELS = \[(.*?)\]", LAYOUT.read_text(encoding="utf-8"), re.DOTALL)
    assert listed is not None
    assert re.findall(r'"(\w+)"', listed[1]) == list(view.PANELS)


@pytest.mark.parametrize("name", PROGRAMS)
def test_each_opens_panels_that_are_there(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[str] = []
    monkeypatch.setattr(view, "show_system", lambda *_, panels, browser: shown.append(panels))
    run: Any = load_node(find_executable(name, name))
    run()
    assert [each in view.PANELS for each in shown[0].split("+")] == [True] * len(shown[0].split("+"))


def test_a_panel_that_is_not_there_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["view", "--panels", "log+grpah"]) == 2
    assert "no panel 'grpah' (did you mean 'graph'?): world, topics" in capsys.readouterr().err


@pytest.fixture
def system() -> Iterator[System]:
    with System() as made:
        yield made


def test_in_virtual_time_it_runs_and_nothing_is_opened(system: System) -> None:
    system.start("rviz2 rviz2")
    system.run(1.0)
    assert (system.nodes, system.programs) == ([], ["rviz2"])


@pytest.mark.processes
def test_one_word_is_enough_and_the_address_asks_for_the_panel(domain: int) -> None:
    with Command(domain, "run", "rqt_graph", "--", "--force-discover") as command:
        assert command.wait_for("robolink view: http").text.endswith("#graph")
        command.interrupt()
        assert command.end() in {0, 130}
        assert command.errors[0].text == "rqt_graph: its own arguments are not read here: --force-discover"
