"""Run the programs by the real rclpy and by robolink, side by side, and compare what they print.

    python -m tests.judge.live [PROGRAM ...]              # ends with 1 if a line differs that the table does not name
    python -m tests.judge.live --record [PROGRAM ...]     # keeps what the real one prints as the recordings
    python -m tests.judge.live --environment FOLDER ...   # with a virtual environment that has the real one

The real one is installed in the temporary folder, once. Where that is not possible the run is skipped with its reason
and ends with 0, and nothing that the real one does wrong fails it: it is ended by force when it hangs or floods, and
only lines that were the same in all its runs are compared.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from tests.judge.comparison import Comparison, Difference, compare, unsteady
from tests.judge.programs import OURS, copied_to, names, record, recording
from tests.judge.table import Row, rows
from tests.judge.transcript import transcript
from tests.judge.wheels import NoWheelsError, interpreter
from tests.support.domains import free_dds_domain

RUNS = 2
"""How many times the real one runs a program."""
AGAIN = 2
"""How many times a program that differs is run again: what is seen once, on a busy machine, does not count."""


@dataclass(frozen=True)
class Outcome:
    """A program's run: what the real one printed each time, and what robolink printed."""

    name: str
    real: list[str]
    ours: str

    @property
    def fault(self) -> str:
        """How the real one failed to end by itself, or an empty text: such a run is not compared."""
        ends = [text.rstrip().rpartition("--- exit ")[2] for text in self.real]
        return next((end for end in ends if end in ("hangs", "floods") or end in _CRASHES), "")

    def compare(self) -> Comparison:
        return compare(self.real[0], self.ours, self.unsteady())

    def unsteady(self) -> list[str]:
        known = recording(self.name)[1]
        return known + [line for line in unsteady(self.real[0], self.real[1:]) if line not in known]


_CRASHES = {"-4", "-6", "-7", "-8", "-11"}  # SIGILL, SIGABRT, SIGBUS, SIGFPE, SIGSEGV


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else None)
    parser.add_argument("programs", nargs="*", metavar="PROGRAM", help="a program's name; all by default")
    parser.add_argument("--record", action="store_true", help="keep what the real one prints as the recordings")
    parser.add_argument("--environment", type=Path, help="a virtual environment that has the real rclpy")
    parser.add_argument("--runs", type=int, default=RUNS, help="how many times the real one runs each program")
    parser.add_argument("--jobs", type=int, default=3, help="how many programs run at the same time")
    parser.add_argument("--seconds", type=float, default=900.0, help="after so long no further program is begun")
    chosen = parser.parse_args(arguments)
    try:
        real = interpreter(chosen.environment)
    except NoWheelsError as reason:
        print(f"skipped: the real rclpy cannot be run here: {reason}")
        return 0
    if unknown := set(chosen.programs) - set(names()):
        parser.error(f"no program named {', '.join(sorted(unknown))} in tests/judge/programs")
    return _judge(real, chosen)


def _judge(real: list[str], chosen: argparse.Namespace) -> int:
    table, bad, counts = rows(), 0, [0, 0, 0]
    end = time.monotonic() + chosen.seconds
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(chosen.jobs) as pool:

        def run(name: str) -> Outcome | None:
            return None if time.monotonic() > end else _outcome(name, real, chosen.runs, Path(folder) / name)

        for outcome in pool.map(run, chosen.programs or names()):
            if outcome is None:
                print("stopped: the time is over")
                break
            if chosen.record:
                record(outcome.name, outcome.real[0], outcome.unsteady())
            new = _report(outcome, table, counts)
            for _ in range(AGAIN):
                if not new:
                    break
                again = _outcome(outcome.name, real, chosen.runs, Path(folder) / outcome.name)
                seen = {each.label for each in _not_in(table, again)}
                new = [each for each in new if each.label in seen]
            for each in new:
                print(f"  not in the table: `{each.label}`\n{each}")
            bad += len(new)
    print(f"{counts[0]} lines: {counts[1]} differ, {counts[2]} more in an error's text; {bad} are not in the table")
    return 1 if bad and not chosen.record else 0


def _outcome(name: str, real: list[str], runs: int, folder: Path) -> Outcome:
    """Run a program by both, one after the other: each has the machine as much for itself as it can be."""
    program = copied_to(folder) / f"{name}.py"
    with free_dds_domain() as domain:
        return Outcome(
            name, [transcript(program, real, domain) for _ in range(runs)], transcript(program, OURS, domain)
        )


def _report(outcome: Outcome, table: list[Row], counts: list[int]) -> list[Difference]:
    """Print and count what a program showed; return what the table does not name."""
    if outcome.fault:
        print(f"{outcome.name}: the real one {outcome.fault}: not compared")
        return []
    result = outcome.compare()
    for index, count in enumerate((result.lines, result.differing, result.texts)):
        counts[index] += count
    print(f"{outcome.name}: {result.lines} lines, {result.differing} differ, {result.texts} more in an error's text")
    return _not_in(table, outcome)


def _not_in(table: list[Row], outcome: Outcome) -> list[Difference]:
    its = [row for row in table if row.program == outcome.name]
    return [each for each in outcome.compare().differences if not any(row.covers(each) for row in its)]


if __name__ == "__main__":
    raise SystemExit(main())
