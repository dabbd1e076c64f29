"""Runner of other projects' own tests, unmodified, against robolink; writes the tables of two pages from the results.

    git clone https://github.com/ros2/rclpy
    python tools/peer_tests.py rclpy rclpy [--file test_node.py] [--transport memory] [--markdown]
    git clone https://github.com/ros2/launch
    pip install osrf-pycommon  # which tests of launch and launch_ros import
    python tools/peer_tests.py launch launch

A suite is a file in `peer_reasons`: which folder of a checkout has the tests, and why a test does not pass here. The
tests are copied to a folder that is removed afterwards: nothing is written into the checkout. Each file runs in a
process of its own, where `robolink.compat` stands for ROS 2's packages; by default over Zenoh, as users' programs do,
on a domain that nothing else uses.

Exits with 1 when a test fails and the suite does not say why, or passes although that says it cannot.
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
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import msgspec
import yaml
from rich.console import Console
from rich.progress import track
from rich.table import Table

ROOT = Path(__file__).parent.parent
SUITES = Path(__file__).with_name("peer_reasons")
SHIM = "robolink.compat"
TYPES = ROOT / "tests" / "data" / "workspace" / "src" / "test_msgs"
"""Package of the types that the tests import, on the path of each; it uses helpers of the tests."""
LINTERS = {f"test_{each}.py" for each in ("copyright", "cpplint", "flake8", "mypy", "pep257", "xmllint")}
"""Files that judge the style of the other project."""

PASSED, FAILED, NOT_APPLICABLE = "passed", "failed", "not applicable"


class Group(msgspec.Struct):
    """Tests that do not pass for one reason."""

    reason: str
    tests: list[str]


class Suite(msgspec.Struct, forbid_unknown_fields=True, rename={"not_applicable": "not applicable"}):
    """Tests of another project.

    Args:
        repository: Its repository at GitHub, OWNER/NAME.
        version: Version and commit that the figures are for.
        tests: Folder of the tests in a checkout.
        within: Folder in `tests` of the files that are run; '.' is all of it.
        pattern: Pattern of their names.
        cases: True counts each case of a parametrized function; else it has passed when all have.
        real: Number of tests that pass with the real packages; 0 if nobody has counted.
        path: Folders of the checkout that are put on Python's path.
        installed: Folders of the checkout that the project's packages install, by their place in the prefix.
        depends: Packages in the prefix that the project depends on and nothing of which is needed but the name.
        commands: Commands that the project's packages install, and that `robolink shim` writes.
        options: Further options of pytest.
        environment: Variables that the project's build sets; `{tests}` is the folder of the tests, `{prefix}` the
            prefix, `{types}` the workspace with test_msgs.
        page: Page with the table, in docs/reference.
        failed: Why tests fail.
        not_applicable: Why tests do not apply to robolink.
    """

    repository: str
    version: str
    tests: str
    within: str = "."
    pattern: str = "test_*.py"
    cases: bool = True
    real: int = 0
    path: list[str] = []
    installed: dict[str, str] = {}
    depends: list[str] = []
    commands: list[str] = []
    options: list[str] = []
    environment: dict[str, str] = {}
    page: str = "peers.md"
    failed: list[Group] = []
    not_applicable: list[Group] = []


class Reason(NamedTuple):
    """Why a test does not pass; `verdict` is FAILED or NOT_APPLICABLE."""

    verdict: str
    text: str


class Outcome(NamedTuple):
    """Outcome of a test: PASSED, FAILED or NOT_APPLICABLE, and the error's first line."""

    verdict: str
    error: str = ""


Outcomes = dict[str, Outcome]
"""By test id: FILE::CLASS::FUNCTION, with [CASE] where cases are counted."""


def suites() -> dict[str, Path]:
    """Return the files of the suites by name."""
    return {each.stem: each for each in sorted(SUITES.glob("*.yaml"))}


def read_suite(path: Path) -> Suite:
    """Return the suite that a file describes. Raises msgspec.ValidationError for one that is not right."""
    return msgspec.convert(yaml.safe_load(path.read_text(encoding="utf-8")), Suite)


# --- The reasons ------------------------------------------------------------------------------------------------------


def reasons_of(suite: Suite) -> dict[str, Reason]:
    """Return the reason for each test that is known not to pass. Raises ValueError for a test that is named twice."""
    found: dict[str, Reason] = {}
    for verdict, groups in ((FAILED, suite.failed), (NOT_APPLICABLE, suite.not_applicable)):
        for group in groups:
            for test in group.tests:
                if test in found:
                    raise ValueError(f"{test} is there twice")
                found[test] = Reason(verdict, " ".join(group.reason.split()))
    return found


def reason_for(test: str, reasons: Mapping[str, Reason]) -> Reason | None:
    """Return the reason for a test: that of its case, of its function, or of its whole file."""
    function = test.partition("[")[0]
    return reasons.get(test) or reasons.get(function) or reasons.get(test.partition("::")[0])


def judged(outcomes: Outcomes, reasons: dict[str, Reason]) -> Outcomes:
    """Return the same, where a test that does not apply is not a failure."""
    found = {test: (outcome, reason_for(test, reasons)) for test, outcome in outcomes.items()}
    return {
        test: Outcome(reason.verdict, outcome.error) if reason and outcome.verdict == FAILED else outcome
        for test, (outcome, reason) in found.items()
    }


def surprises(outcomes: Outcomes, reasons: dict[str, Reason]) -> Iterator[str]:
    """Yield the failures without a reason, and the reasons without a failure, a line each."""
    for test, (verdict, error) in outcomes.items():
        reason = reason_for(test, reasons)
        if verdict == FAILED and reason is None:
            yield f"{test} failed: {error}"
        if verdict == NOT_APPLICABLE and reason is None:
            yield f"{test} was skipped: {error}"
        if verdict == PASSED and test in reasons:
            yield f"{test} passed, but the suite says that it cannot: {reasons[test].text}"
    files = {test.partition("::")[0] for test in outcomes}
    for name in reasons:
        meant = [test for test in outcomes if name in (test, test.partition("[")[0], test.partition("::")[0])]
        if name.partition("::")[0] in files and not meant:
            yield f"{name} has a reason, but there is no such test"
        elif meant and name not in outcomes and all(outcomes[test].verdict == PASSED for test in meant):
            yield f"{name} passed, but the suite says that it cannot: {reasons[name].text}"


# --- Running ----------------------------------------------------------------------------------------------------------


class Stage(NamedTuple):
    """Place and way in which the files of a suite are run.

    Args:
        tests: Folder with the copy of the tests.
        transport: `zenoh` or `memory`.
        limit: Longest run of a file, in seconds.
        suite: The suite.
        prefix: Folder that stands for the prefix into which the project's packages are installed.
        checkout: The checkout.
    """

    tests: Path
    transport: str
    limit: float
    suite: Suite
    prefix: Path
    checkout: Path


def folder_of_tests(checkout: Path, suite: Suite) -> Path:
    """Return the folder with a suite's tests. Raises FileNotFoundError when the checkout has none."""
    folder = checkout / suite.tests
    if not any((folder / suite.within).glob(f"**/{suite.pattern}")):
        raise FileNotFoundError(f"{checkout} has no {suite.tests}: expected a checkout of {suite.repository}")
    return folder


def functions(path: Path, name: str) -> list[str]:
    """Return the ids of the test functions of the file `name`, as far as can be said without running it."""

    def within(node: ast.AST, prefix: str) -> Iterator[str]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.ClassDef):
                yield from within(child, f"{prefix}::{child.name}")
            elif isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef) and child.name.startswith("test"):
                yield f"{prefix}::{child.name}"

    return list(dict.fromkeys(within(ast.parse(path.read_text(encoding="utf-8")), name)))


def install(checkout: Path, suite: Suite, prefix: Path) -> None:
    """Copy what the project's packages install to a prefix, as its build would, and note the packages."""
    for place, folder in suite.installed.items():
        shutil.copytree(checkout / folder, prefix / place, dirs_exist_ok=True)
    for package in (*(Path(place).parts[1] for place in suite.installed), *suite.depends):
        marker = prefix / "share" / "ament_index" / "resource_index" / "packages" / package
        marker.parent.mkdir(parents=True, exist_ok=True)
        marker.touch()
    for program in (prefix / "lib").glob("*/*"):
        program.chmod(0o755)
    (prefix / "bin").mkdir(parents=True, exist_ok=True)
    for command in suite.commands:
        shim = ("-m", "robolink", "shim", command, "--force", "--folder", str(prefix / "bin"))
        subprocess.run([sys.executable, *shim], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def environment(stage: Stage, domain: int) -> dict[str, str]:
    """Return the environment of a file's process: nothing of the caller's that changes how nodes meet."""
    stored = {name: text for name, text in os.environ.items() if not name.startswith(("ROS_", "ROBOLINK_", "ZENOH_"))}
    chosen = {"ROBOLINK_TRANSPORT": "memory"} if stage.transport == "memory" else {"ROS_DOMAIN_ID": str(domain)}
    if stage.suite.installed or stage.suite.depends:
        chosen["AMENT_PREFIX_PATH"] = str(stage.prefix)
    if stage.suite.commands:
        chosen["PATH"] = f"{stage.prefix / 'bin'}{os.pathsep}{os.environ.get('PATH', '')}"
    places = {"tests": stage.tests, "prefix": stage.prefix, "types": TYPES.parents[1]}
    chosen |= {name: text.format_map(places) for name, text in stage.suite.environment.items()}
    own = (str((stage.checkout / each).absolute()) for each in stage.suite.path)
    path = os.pathsep.join(filter(None, (*own, str(TYPES), str(ROOT), stored.get("PYTHONPATH"))))
    return {**stored, **chosen, "PYTHONPATH": path, "ROBOLINK_COMPAT": "always", "PYTHONDONTWRITEBYTECODE": "1"}


def run(path: Path, stage: Stage) -> Outcomes:
    """Run one file."""
    from tests.support.domains import free_domain

    name, report = path.relative_to(stage.tests / stage.suite.within).as_posix(), path.with_suffix(".xml")
    plain = ("-q", "--import-mode=importlib", "-p", "no:cacheprovider", "-c", os.devnull, "--rootdir", str(path.parent))
    options = ("-p", SHIM, *stage.suite.options, f"--junit-xml={report}")
    with free_domain() as domain:
        try:
            done = subprocess.run(
                [sys.executable, "-m", "pytest", *plain, *options, str(path)],
                env=environment(stage, domain),
                cwd=path.parent,
                stdin=subprocess.DEVNULL,
                capture_output=True,
                text=True,
                timeout=stage.limit,
                check=False,
            )
            if done.returncode in (0, 1):
                return read_report(report, name, cases=stage.suite.cases)
            missing = f"pytest ended with {done.returncode}: {last_line(done.stdout + done.stderr)}"
        except subprocess.TimeoutExpired:
            missing = f"not ended after {stage.limit:g} s"
    return dict.fromkeys(functions(path, name), Outcome(FAILED, missing))


def last_line(text: str) -> str:
    """Return the error that pytest prints, else the last line that says something."""
    lines = [line.strip() for line in text.splitlines() if line.strip()] or ["nothing was said"]
    return next((line[1:].strip() for line in reversed(lines) if line.startswith("E  ")), lines[-1])


def read_report(path: Path, file: str, *, cases: bool = False) -> Outcomes:
    """Return the tests of pytest's report in JUnit's format; of each parametrized function one, or all `cases`."""
    found: Outcomes = {}
    for case in ElementTree.parse(path).iter("testcase"):  # noqa: S314 - pytest has just written it
        names = case.get("classname", "").split(".")[1:]
        name = case.get("name", "")
        test = "::".join((file, *names, name if cases else name.partition("[")[0]))
        outcome = outcome_of(case)
        before = found.get(test, Outcome(NOT_APPLICABLE)).verdict
        if before == NOT_APPLICABLE or (before == PASSED and outcome.verdict == FAILED):
            found[test] = outcome
    return found


def outcome_of(case: ElementTree.Element) -> Outcome:
    """Return the outcome of one case."""
    for element in case:
        if element.tag in ("failure", "error"):
            return Outcome(FAILED, next(iter(element.get("message", "").splitlines()), ""))
        if element.tag == "skipped":
            return Outcome(NOT_APPLICABLE, element.get("message", ""))
    return Outcome(PASSED)


def run_all(files: list[Path], stage: Stage, jobs: int, console: Console) -> Outcomes:
    """Run these files, so many at a time."""
    with ThreadPoolExecutor(jobs) as pool:
        running = [pool.submit(run, each, stage) for each in files]
        shown = track(as_completed(running), "tests", total=len(files), console=console, transient=True)
        outcomes = {test: outcome for each in shown for test, outcome in each.result().items()}
    return dict(sorted(outcomes.items()))


def run_again(
    found: Outcomes, files: list[Path], reasons: dict[str, Reason], stage: Stage, console: Console
) -> Outcomes:
    """Run files again that have failures without a reason, one by one: some of them measure real time."""
    better = dict(found)
    for file in files:
        name = file.relative_to(stage.tests / stage.suite.within).as_posix()
        failed = [test for test in found if is_of(test, name) and found[test].verdict == FAILED]
        if any(reason_for(test, reasons) is None for test in failed):
            again = run(file, stage)
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
    """Return a row for each file, then their sum."""
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


def markdown(outcomes: Outcomes, suite: Suite) -> str:
    """Return the generated part of the page: the table, and the reasons."""
    of_real = f" With the real packages {suite.real} pass." if suite.real else ""
    lines = [f"`{suite.tests}` of {suite.repository} {suite.version}.{of_real}", ""]
    lines += ["| file | passed | failed | not applicable |", "|---|---:|---:|---:|"]
    lines += [f"| {row.file} | " + " | ".join(str(number) for number in row[1:]) + " |" for row in rows(outcomes)]
    reasons = sorted(reasons_of(suite).items())
    for verdict in (FAILED, NOT_APPLICABLE):
        of_verdict = [f"- `{test}`: {reason.text}" for test, reason in reasons if reason.verdict == verdict]
        lines += ["", f"### {verdict.capitalize()}", "", *of_verdict] if of_verdict else []
    return "\n".join(lines) + "\n"


def marks(name: str) -> tuple[str, str]:
    """Return the lines between which a page has the table of a suite."""
    return f"<!-- from here on: python tools/peer_tests.py {name} CHECKOUT --markdown -->", f"<!-- {name} to here -->"


def write(path: Path, name: str, text: str) -> None:
    """Put the text of a suite between its marks in a file. Raises ValueError when it has none."""
    begin_mark, end_mark = marks(name)
    before, begin, rest = path.read_text(encoding="utf-8").partition(begin_mark)
    _, end, after = rest.partition(end_mark)
    if not (begin and end):
        raise ValueError(f"{path} has no '{begin_mark}' ... '{end_mark}' for the text to go between")
    path.write_text(f"{before}{begin_mark}\n\n{text}\n{end_mark}{after}", encoding="utf-8")


# --- The command ------------------------------------------------------------------------------------------------------


def arguments(given: Iterable[str] | None = None) -> argparse.Namespace:
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("suite", choices=suites(), help="which tests; a file in tools/peer_reasons")
    parser.add_argument("checkout", type=Path, help="a checkout of the repository that the suite's file names")
    parser.add_argument("--file", action="append", help="only this file; may be given more than once")
    parser.add_argument("--transport", choices=("zenoh", "memory"), default="zenoh")
    parser.add_argument("--limit", type=float, default=180.0, help="seconds that a file may take")
    parser.add_argument("--jobs", type=int, default=max(1, (os.cpu_count() or 1) // 2), help="files at a time")
    parser.add_argument("--markdown", action="store_true", help="write the figures into the suite's page")
    found = parser.parse_args(None if given is None else list(given))
    if found.markdown and found.file:
        parser.error("--markdown needs all files: leave out --file")
    found.described = read_suite(suites()[found.suite])
    try:
        found.tests = folder_of_tests(found.checkout, found.described)
    except FileNotFoundError as error:
        parser.error(str(error))
    return found


def run_suite(options: argparse.Namespace, reasons: dict[str, Reason], console: Console) -> Outcomes:
    """Return the outcomes of a suite's tests, or of those in the files that the options name."""
    suite: Suite = options.described
    with tempfile.TemporaryDirectory() as folder:
        here = shutil.copytree(options.tests, Path(folder, "test"), ignore=shutil.ignore_patterns("__init__.py"))
        stage = Stage(here, options.transport, options.limit, suite, Path(folder, "prefix"), options.checkout)
        install(options.checkout, suite, stage.prefix)
        top = here / suite.within
        found = [each for each in sorted(top.rglob(suite.pattern)) if each.name not in LINTERS]
        files = [each for each in found if not options.file or each.relative_to(top).as_posix() in options.file]
        outcomes = run_all(files, stage, options.jobs, console)
        return run_again(outcomes, files, reasons, stage, console)


def main(given: Iterable[str] | None = None) -> int:
    """Run, tell, and say whether all is as the reasons have it."""
    options, console = arguments(given), Console()
    reasons = reasons_of(options.described)
    found = run_suite(options, reasons, console)
    outcomes = judged(found, reasons)
    show(outcomes, console)
    if options.markdown:
        page = ROOT / "docs" / "reference" / options.described.page
        write(page, options.suite, markdown(outcomes, options.described))
    unexpected = list(surprises(found, reasons))
    for line in unexpected:
        console.print(line, style="red", markup=False, highlight=False, soft_wrap=True)
    return 1 if unexpected else 0


if __name__ == "__main__":
    sys.path.append(str(ROOT))
    raise SystemExit(main())
