"""How long commands take from start to end, beside bare Python and an import of typer, in the same run.

    python benchmarks/commands.py [--runs 10]

A system of a world and a controller runs meanwhile, as when somebody looks at a robot. The programs take turns, so that
whatever disturbs the machine disturbs all of them; the ratios carry over to other machines, the figures do not.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

DOMAIN = 98
ENVIRONMENT = {**os.environ, "ROS_DOMAIN_ID": str(DOMAIN)}
ROBOLINK = (sys.executable, "-m", "robolink")


class Row(NamedTuple):
    """A program, what it must print, and how many seconds its median may be."""

    name: str
    command: Sequence[str]
    shown: str = ""
    limit: float | None = None


ROWS = (
    Row("python -c pass", (sys.executable, "-c", "pass")),
    Row("python -c 'import typer'", (sys.executable, "-c", "import typer")),
    Row("robolink --help", (*ROBOLINK, "--help"), "Commands:", 0.2),
    Row("robolink run --list", (*ROBOLINK, "run", "--list"), "wall_follower"),
    Row("robolink topic list", (*ROBOLINK, "topic", "list"), "/odom", 0.6),
    Row("robolink node list", (*ROBOLINK, "node", "list"), "/world"),
)


def seconds(row: Row) -> float:
    """Run a program once; check what it prints."""
    started = time.perf_counter()
    output = subprocess.run(row.command, env=ENVIRONMENT, capture_output=True, text=True, check=True).stdout
    took = time.perf_counter() - started
    if row.shown not in output:
        raise SystemExit(f"{row.name}: expected '{row.shown}' in what it prints, got: {output}")
    return took


@contextmanager
def wandering_robot() -> Iterator[None]:
    """A robot that drives until the end of the block."""
    command = (*ROBOLINK, "launch", "wander")
    with subprocess.Popen(command, env=ENVIRONMENT, stdout=subprocess.PIPE, text=True) as launcher:
        try:
            assert launcher.stdout is not None
            next(line for line in launcher.stdout if "[reactive_controller]" in line)
            yield
        finally:
            launcher.terminate()


def report(runs: int) -> bool:
    """Print the table; say whether all medians keep to their limits."""
    with wandering_robot():
        rounds = [[seconds(row) for row in ROWS] for _ in range(runs + 1)][1:]  # the first fills caches
    medians = [statistics.median(column) for column in zip(*rounds, strict=True)]
    kept = True
    print(f"medians of {runs} runs{'':11} ms   / python   limit")
    for row, median in zip(ROWS, medians, strict=True):
        verdict = ""
        if row.limit is not None:
            verdict = f"{row.limit * 1e3:5.0f} {'kept' if median < row.limit else 'BROKEN'}"
            kept = kept and median < row.limit
        print(f"{row.name:26} {median * 1e3:6.0f}   {median / medians[0]:8.1f}   {verdict}".rstrip())
    return kept


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=10)
    raise SystemExit(0 if report(parser.parse_args().runs) else 1)


if __name__ == "__main__":
    main()
