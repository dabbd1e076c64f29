"""What docs/testing.md shows passes as it stands there, and has the names that there are."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

# pytester forgets what was imported meanwhile, and numpy cannot be imported twice.
import robolink.testing.one_process  # noqa: F401
from robolink.testing import System
from robolink.testing.faults import Faults

pytest_plugins = ["pytester"]

DOCS = (Path(__file__).parents[2] / "docs" / "testing.md").read_text(encoding="utf-8")
PROGRAMS = re.findall(r'```python\n("""(\w+)\.py""".*?)```', DOCS, re.DOTALL)


def _marks(text: str) -> list[pytest.MarkDecorator]:
    return [pytest.mark.processes] if "generate_test_description" in text else []


@pytest.mark.parametrize(
    ("text", "name"), [pytest.param(text, name, marks=_marks(text), id=name) for text, name in PROGRAMS]
)
def test_its_tests_pass(text: str, name: str, pytester: pytest.Pytester) -> None:
    pytester.makepyfile(**{name: text})
    result = pytester.runpytest_inprocess("-p", "no:cacheprovider", "-p", "no:xdist")
    assert result.ret == pytest.ExitCode.OK
    assert result.parseoutcomes()["passed"] == text.count("def test_") + text.count("parametrize")


def test_there_are_programs() -> None:
    assert len(PROGRAMS) == DOCS.count("```python")


def test_what_its_tables_name_is_there() -> None:
    cells = [row.split("|")[1] for row in DOCS.splitlines() if row.startswith("| `")]
    names = [name for cell in cells for name in re.findall(r"`(\w+)", cell)]
    assert len(names) > 30
    assert [each for each in names if not hasattr(System, each) and not hasattr(Faults, each)] == ["clock", "seed"]
    with System() as system:
        assert hasattr(system, "clock")
        assert system.seed == 0
