"""robolink prints the lines recorded of the real rclpy, but for the table's in docs/reference/rclpy.md names."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.judge.comparison import Comparison, compare
from tests.judge.programs import OURS, copied_to, names, recording
from tests.judge.table import Row, rows
from tests.judge.transcript import transcript
from tests.support.domains import free_domain

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(sys.platform != "linux", reason="signals and exit codes were recorded on Linux"),
]

AT_ONCE = 4  # they wait for most of their time

Run = Callable[[str], Comparison]


@pytest.fixture(scope="module")
def first(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Run]:
    """The first run of each program: those of the tests that were chosen are begun together."""
    chosen = [name for item in request.session.items if (name := _program(item)) is not None]
    with ThreadPoolExecutor(AT_ONCE) as pool:
        runs: dict[str, Future[Comparison]] = {
            name: pool.submit(_run, name, tmp_path_factory.mktemp(name)) for name in chosen
        }
        yield lambda name: runs[name].result()
        pool.shutdown(cancel_futures=True)


def _program(item: pytest.Item) -> str | None:
    if item.path != Path(__file__) or not isinstance(item, pytest.Function) or not hasattr(item, "callspec"):
        return None
    name = item.callspec.params.get("program")
    return name if isinstance(name, str) else None


def _run(name: str, folder: Path) -> Comparison:
    with free_domain() as domain:
        ours = transcript(copied_to(folder) / f"{name}.py", OURS, domain)
    real, unsteady = recording(name)
    return compare(real, ours, unsteady)


def _faults(result: Comparison, table: list[Row]) -> list[str]:
    """Return the lines that are not in step: differences without a row, and labels of rows that no longer differ."""
    new = [each for each in result.differences if not any(row.covers(each) for row in table)]
    gone = [label for row in table for label in row.unused(result.differences)]
    return [f"not in the table: `{each.label}`\n{each}" for each in new] + [
        f"no longer differs, so it leaves the table: `{label}`" for label in gone
    ]


@pytest.mark.timeout(240)
@pytest.mark.parametrize("program", names())
def test_lines_are_the_real_ones_or_in_the_table(program: str, first: Run, tmp_path: Path) -> None:
    """A difference seen only once, on a machine with much else to do, does not count."""
    table = [row for row in rows() if row.program == program]
    faults = _faults(first(program), table)
    for again in range(2):
        if not faults:
            return
        seen = _faults(_run(program, tmp_path / str(again)), table)
        faults = [fault for fault in faults if fault in seen]
    assert not faults, "\n".join(["", *faults])
