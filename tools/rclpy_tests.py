"""Runner of rclpy's own tests against robolink; writes docs/reference/rclpy.md from the results.

    git clone https://github.com/ros2/rclpy
    python tools/rclpy_tests.py rclpy [--file test_node.py] [--transport memory] [--markdown docs/reference/rclpy.md]

The files are copied to a folder that is removed afterwards: nothing is written into the checkout. Each runs in a
process of its own, where `robolink.compat` stands for rclpy and the message packages; by default over Zenoh, as
users' programs do, on a domain that nothing else uses. A test function that takes parameters has passed when all its
cases have.

Exits with 1 when a test fails and `rclpy_reasons.yaml` does not say why, or passes although that says it cannot.
"""

from __future__ import annotations

import argparse
import ast
import collections
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import yaml
from rich.console import Console
from rich.progress import track
from rich.table import Table

ROOT = Path(__file__).parent.parent
REASONS = Path(__file__).with_name("rclpy_reasons.yaml")
SHIM = "robolink.compat"
TYPES = ROOT / "tests" / "data" / "workspace" / "src" / "test_msgs"
"""Package of the types that rclpy's tests import, on the path of each; it uses helpers of the tests."""
BEGIN, END = (
    "<!-- from here on: python tools/rclpy_tests.py CHECKOUT --markdown docs/reference/rclpy.md -->",
    "<!-- to here -->",
)

PASSED, FAILED, NOT_APPLICABLE = "passed", "failed", "not applicable"


class Reason(NamedTuple):
    """Why a test does not pass; `verdict` is FAILED or NOT_APPLICABLE."""

    verdict: str
    text: str


class Outcome(NamedTuple):
    """Outcome of a test function: PASSED, FAILED or NOT_APPLICABLE, and the error's first line."""

    verdict: str
    error: str = ""


Outcomes = dict[str, Outcome]
"""By test id: FILE::CLASS::FUNCTION."""


# --- The reasons ------------------------------------------------------------------------------------------------------


def read_reasons(path: Path = REASONS) -> dict[str, Reason]:
    """The reason for each test that is known not to pass. Raises ValueError for a test that is named twice."""
    found: dict[str, Reason] = {}
    for verdict, groups in yaml.safe_load(path.read_text(encoding="utf-8")).items():
        for group in groups:
            for test in group["tests"]:
                if test in found:
                    raise ValueError(f"{path.name}: {test} is there twice")
                found[test] = Reason(verdict, " ".join(group["reason"].split()))
    return found


def judged(outcomes: Outcomes, reasons: dict[str, Reason]) -> Outcomes:
    """The same, where a test that does not apply is not a failure."""
    return {
        test: Outcome(reasons[test].verdict, outcome.error)
        if test in reasons and outcome.verdict == FAILED
        else outcome
        for test, outcome in outcomes.items()
    }


def surprises(outcomes: Outcomes, reasons: dict[str, Reason]) -> Iterator[str]:
    """Return the failures without a reason, a line each."""
    for test, (verdict, error) in outcomes.items():
        if verdict == FAILED and test not in reasons:
            yield f"{test} failed: {error}"
        if verdict == NOT_APPLICABLE and test not in reasons:
            yield f"{test} was skipped: {error}"
        if verdict == PASSED and test in reasons:
            yield f"{test} passed, but {REASONS.name} says that it cannot: {reasons[test].text}"
    files = {test.partition("::")[0] for test in outcomes}
    for test in reasons:
        if test not in outcomes and any(is_of(test, file) for file in files):
            yield f"{test} is in {REASONS.name}, but there is no such test"


# --- Running ----------------------------------------------------------------------------------------------------------


def folder_of_tests(checkout: Path) -> Path:
    """Where a checkout has its tests. Raises FileNotFoundError when it has none."""
    for folder in (checkout / "rclpy" / "test", checkout / "test", checkout):
        if (folder / "test_node.py").is_file():
            return folder
    raise FileNotFoundError(f"{checkout} has no rclpy/test/test_node.py: expected a checkout of ros2/rclpy")


def functions(path: Path) -> list[str]:
    """The ids of the test functions of a file, as far as can be said without running it."""

    def within(node: ast.AST, prefix: str) -> Iterator[str]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.ClassDef):
                yield from within(child, f"{prefix}::{child.name}")
            elif isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef) and child.name.startswith("test"):
                yield f"{prefix}::{child.name}"

    return list(dict.fromkeys(within(ast.parse(path.read_text(encoding="utf-8")), path.name)))


def environment(transport: str, domain: int) -> dict[str, str]:
    """The environment of a file's process: nothing of the caller's that changes how nodes meet."""
    stored = {name: text for name, text in os.environ.items() if not name.startswith(("ROS_", "ROBOLINK_", "ZENOH_"))}
    chosen = {"ROBOLINK_TRANSPORT": "memory"} if transport == "memory" else {"ROS_DOMAIN_ID": str(domain)}
    path = os.pathsep.join(filter(None, (str(TYPES), str(ROOT), stored.get("PYTHONPATH"))))
    return {**stored, **chosen, "PYTHONPATH": path, "ROBOLINK_COMPAT": "always", "PYTHONDONTWRITEBYTECODE": "1"}


def run(path: Path, transport: str, limit: float) -> Outcomes:
    """Run one file, for `limit` seconds at most."""
    from tests.support.domains import free_domain

    report = path.with_suffix(".xml")
    plain = ("-q", "--import-mode=importlib", "-p", "no:cacheprovider", "-c", os.devnull, "--rootdir", str(path.parent))
    command = [sys.executable, "-m", "pytest", *plain, "-p", SHIM, f"--junit-xml={report}", str(path)]
    with free_domain() as domain:
        try:
            done = subprocess.run(
                command,
                env=environment(transport, domain),
                cwd=path.parent,
                stdin=subprocess.DEVNULL,
                capture_output=True,
                text=True,
                timeout=limit,
                check=False,
            )
            if done.returncode in (0, 1):
                return read_report(report, path.name)
            missing = f"pytest ended with {done.returncode}: {last_line(done.stdout + done.stderr)}"
        except subprocess.TimeoutExpired:
            missing = f"not ended after {limit:g} s"
    return dict.fromkeys(functions(path), Outcome(FAILED, missing))


def last_line(text: str) -> str:
    """Return the error that pytest prints, else the last line that says something."""
    lines = [line.strip() for line in text.splitlines() if line.strip()] or ["nothing was said"]
    return next((line[1:].strip() for line in reversed(lines) if line.startswith("E  ")), lines[-1])


def read_report(path: Path, file: str) -> Outcomes:
    """The test functions of pytest's report in JUnit's format."""
    found: Outcomes = {}
    for case in ElementTree.parse(path).iter("testcase"):  # noqa: S314 - pytest has just written it
        names = case.get("classname", "").split(".")[1:]
        test = "::".join((file, *names, case.get("name", "").partition("[")[0]))
        outcome = outcome_of(case)
        before = found.get(test, Outcome(NOT_APPLICABLE)).verdict
        if before == NOT_APPLICABLE or (before == PASSED and outcome.verdict == FAILED):
            found[test] = outcome
    return found


def outcome_of(case: ElementTree.Element) -> Outcome:
    """Outcome of one case."""
    for element in case:
        if element.tag in ("failure", "error"):
            return Outcome(FAILED, next(iter(element.get("message", "").splitlines()), ""))
        if element.tag == "skipped":
            return Outcome(NOT_APPLICABLE, element.get("message", ""))
    return Outcome(PASSED)


def run_all(files: list[Path], transport: str, limit: float, jobs: int, console: Console) -> Outcomes:
    """Run these files, so many at a time."""
    with ThreadPoolExecutor(jobs) as pool:
        running = [pool.submit(run, each, transport, limit) for each in files]
        shown = track(as_completed(running), "rclpy's tests", total=len(files), console=console, transient=True)
        outcomes = {test: outcome for each in shown for test, outcome in each.result().items()}
    return dict(sorted(outcomes.items()))


def run_again(
    found: Outcomes, files: list[Path], reasons: dict[str, Reason], transport: str, limit: float, console: Console
) -> Outcomes:
    """Run files again that have failures without a reason, one by one: some of them measure real time."""
    better = dict(found)
    for file in files:
        failed = [test for test in found if is_of(test, file.name) and found[test].verdict == FAILED]
        if any(test not in reasons for test in failed):
            again = run(file, transport, limit)
            late = [test for test in failed if again.get(test, found[test]).verdict == PASSED]
            better.update((test, again[test]) for test in late)
            for test in late:
                console.print(f"{test} passed only when it was run again", markup=False, highlight=False)
    return better


def is_of(test: str, file: str) -> bool:
    """Return whether a test is in this file."""
    return test.partition("::")[0] == file


# --- Telling ----------------------------------------------------------------------------------------------------------


class Row(NamedTuple):
    """A file, and how many of its tests passed, failed and do not apply."""

    file: str
    passed: int
    failed: int
    not_applicable: int


def rows(outcomes: Outcomes) -> list[Row]:
    """A row for each file, then their sum."""
    counts: dict[str, collections.Counter[str]] = collections.defaultdict(collections.Counter)
    for test, (verdict, _) in outcomes.items():
        counts[test.partition("::")[0]][verdict] += 1
    counts["all"] = sum(counts.values(), collections.Counter())
    return [
        Row(file, *(each[verdict] for verdict in (PASSED, FAILED, NOT_APPLICABLE))) for file, each in counts.items()
    ]


def show(outcomes: Outcomes, console: Console) -> None:
    """Print the table."""
    table = Table("file", *(PASSED, FAILED, NOT_APPLICABLE))
    for row in rows(outcomes):
        table.add_row(row.file, *(str(number or "") for number in row[1:]))
    console.print(table)


def markdown(outcomes: Outcomes, reasons: dict[str, Reason]) -> str:
    """The generated part of docs/reference/rclpy.md."""
    lines = ["| file | passed | failed | not applicable |", "|---|---:|---:|---:|"]
    lines += [f"| {row.file} | " + " | ".join(str(number) for number in row[1:]) + " |" for row in rows(outcomes)]
    for verdict in (FAILED, NOT_APPLICABLE):
        lines += ["", f"### {verdict.capitalize()}", ""]
        lines += [f"- `{test}`: {reason.text}" for test, reason in sorted(reasons.items()) if reason.verdict == verdict]
    return "\n".join(lines) + "\n"


def write(path: Path, text: str) -> None:
    """Put the text between the marks of a file. Raises ValueError when it has none."""
    before, begin, rest = path.read_text(encoding="utf-8").partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end):
        raise ValueError(f"{path} has no '{BEGIN}' ... '{END}' for the text to go between")
    path.write_text(f"{before}{BEGIN}\n\n{text}\n{END}{after}", encoding="utf-8")


# --- The command ------------------------------------------------------------------------------------------------------


def arguments(given: Iterable[str] | None = None) -> argparse.Namespace:
    """Options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkout", type=Path, help="a checkout of ros2/rclpy; the figures are for 8.0.0")
    parser.add_argument("--file", action="append", help="only this file; may be given more than once")
    parser.add_argument("--transport", choices=("zenoh", "memory"), default="zenoh")
    parser.add_argument("--limit", type=float, default=180.0, help="seconds that a file may take")
    parser.add_argument("--jobs", type=int, default=max(1, (os.cpu_count() or 1) // 2), help="files at a time")
    parser.add_argument("--markdown", type=Path, help="write the figures into this file, between its marks")
    found = parser.parse_args(None if given is None else list(given))
    if found.markdown and found.file:
        parser.error("--markdown needs all files: leave out --file")
    try:
        found.tests = folder_of_tests(found.checkout)
    except FileNotFoundError as error:
        parser.error(str(error))
    return found


def main(given: Iterable[str] | None = None) -> int:
    """Run, tell, and say whether all is as the reasons have it."""
    options, console, reasons = arguments(given), Console(), read_reasons()
    with tempfile.TemporaryDirectory() as folder:
        here = shutil.copytree(options.tests, Path(folder, "test"), ignore=shutil.ignore_patterns("__init__.py"))
        files = [each for each in sorted(here.glob("test_*.py")) if not options.file or each.name in options.file]
        found = run_all(files, options.transport, options.limit, options.jobs, console)
        found = run_again(found, files, reasons, options.transport, options.limit, console)
    outcomes = judged(found, reasons)
    show(outcomes, console)
    if options.markdown:
        write(options.markdown, markdown(outcomes, reasons))
    unexpected = list(surprises(found, reasons))
    for line in unexpected:
        console.print(line, style="red", markup=False, highlight=False, soft_wrap=True)
    return 1 if unexpected else 0


if __name__ == "__main__":
    sys.path.append(str(ROOT))
    raise SystemExit(main())
