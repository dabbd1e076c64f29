"""tools/newcomer.py: which commands of the first page it types, what it measures, and that it sees a robot move."""

from __future__ import annotations

import os
import shlex
import sys
from pathlib import Path

import pytest

from tests.support.domains import free_domain
from tools import newcomer
from tools.newcomer import Newcomer, Step, reported, until_it_moves, waiting

LOG = """\
2026-11-26T14:27:20,000 Processing ./robolink-0.2.0-py3-none-any.whl
2026-11-26T14:27:20,500   Downloading eclipse_zenoh-1.10.2-cp39-abi3-manylinux_2_17_x86_64.whl (10.3 MB)
2026-11-26T14:27:21,500   Using cached numpy-2.4.6-cp311-cp311-manylinux_2_27_x86_64.whl (16.9 MB)
2026-11-26T14:27:22,000   Downloading msgspec-0.22.0-cp311-cp311-manylinux2014_x86_64.whl (200 kB)
2026-11-26T14:27:24,250 Installing collected packages: msgspec, numpy, eclipse-zenoh, robolink
2026-11-26T14:27:29,000 Successfully installed robolink-0.2.0
"""


class Typed(Newcomer):
    """Notes what is typed, and runs nothing."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, Path("x.whl"), sys.executable, 0)
        self.typed: list[str] = []

    def enter(self, words: list[str], *, fails: bool) -> None:
        self.typed.append(shlex.join(words) + " # fails" * fails)


def test_it_types_all_that_the_first_page_has(tmp_path: Path) -> None:
    person = Typed(tmp_path)
    person.read(newcomer.PAGE.read_text(encoding="utf-8"))
    assert person.typed[:5] == [
        "mkdir my_robots",
        "cd my_robots",
        "python -m venv .venv",
        "source .venv/bin/activate",
        "pip install PATH/OF/ROBOLINK",
    ]
    assert [each for each in person.typed if each.split()[1] in newcomer.MOVES] == [
        "robolink launch wander --view",
        "robolink pub /cmd_vel Twist '{linear: {x: 0.3}}' -r 10",
    ]
    assert "robolink run wrold # fails" in person.typed


def test_pips_log_tells_the_wait_for_packages_and_what_came() -> None:
    assert waiting(LOG) == (4.25, 10.5)
    with pytest.raises(AssertionError, match="Installing collected packages"):
        waiting(LOG.replace("Installing", "Leaving"))


def test_packages_are_told_apart_and_what_comes_after_the_robot_moves_does_not_count() -> None:
    steps = [
        Step(3.0, "venv"),
        Step(20.0, "packages", waits=True),
        Step(2.0, "launch", moves=True),
        Step(9.0, "doctor"),
    ]
    assert until_it_moves(steps) == (25.0, 20.0)
    *_, last = reported("cold", steps).splitlines()
    assert last == "  25.0 s  from the empty folder until the robot moves, 20.0 s of them waiting for packages"
    with pytest.raises(AssertionError, match="moves no robot"):
        until_it_moves(steps[:2])


@pytest.mark.parametrize(("seconds", "code"), [(59.0, 0), (61.0, 1)])
def test_a_minute_without_packages_is_the_limit(
    seconds: float, code: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "x.whl").touch()
    steps = [Step(100.0, "packages", waits=True), Step(seconds, "launch", moves=True)]
    monkeypatch.setattr(newcomer, "visit", lambda *words: steps)
    assert newcomer.main([str(tmp_path), "--once"]) == code
    assert capsys.readouterr().out.count(f"{seconds + 100:.1f} s  from the empty folder") == 1


PAGE = """
```sh
mkdir my_robots
cd my_robots
robolink launch wander
```

<!-- run: fails -->
```sh
robolink run wrold
```
"""


@pytest.mark.processes
def test_a_robot_that_moves_is_seen_over_the_network(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(Path(sys.executable).parent) + os.pathsep + os.environ["PATH"])
    with free_domain() as domain, Newcomer(tmp_path, Path("x.whl"), sys.executable, domain) as person:
        person.read(PAGE)
        assert person.running == []
    assert [(each.words, each.moves) for each in person.steps] == [
        ("robolink launch wander", True),
        ("robolink run wrold", False),
    ]
    assert (tmp_path / "my_robots").is_dir()
