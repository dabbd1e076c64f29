"""The programs of the judge, copied to a folder where they can be run, and what the real rclpy printed."""

from __future__ import annotations

import itertools
import shutil
import sys
from pathlib import Path

HERE = Path(__file__).parent
PROGRAMS = HERE / "programs"
RECORDINGS = HERE / "recordings"
TEST_MSGS = HERE.parent / "data" / "workspace" / "src" / "test_msgs"

OURS = [sys.executable, "-m", "robolink", "run"]
"""The command that runs a program by robolink."""

BY_EVENTS = (
    "actions",
    "await_in_exclusive_group",
    "callables",
    "cancelled_call",
    "deadlines_and_liveliness",
    "exceptions_in_callbacks",
    "groups",
    "introspection",
    "keywords",
    "logger_service",
    "nodes_without_references",
    "parameter_services",
    "service_that_raises",
    "services_answered_later",
    "shutdown_in_callback",
    "shutdown_in_thread",
    "sigint_caught",
    "sigint_several_threads",
    "sigint_sleeping_main_thread",
    "sigint_twice",
    "sigterm_caught",
    "simulated_time",
    "spin_until_future_complete",
    "subclass_forms",
    "timer_drift",
)
"""Programs that are run by an EventsExecutor too.

Of the others that spin, the real one crashes in some (`call_in_callback`, `executors`) and refuses a guard condition or
a callback of some at once (`order_of_service`, `message_info`). Some show rounds, which an EventsExecutor does not have
(`backlog`, `fairness`, `order_of_queues`), or nothing that depends on the executor.
"""

_BY_EVENTS = "_by_events"
_HELPERS = ("probe", "by_events")
_UNSTEADY = "--- unsteady\n"


def names() -> list[str]:
    """Return the names of the programs; what runs one by an EventsExecutor has its name with ``_by_events`` behind."""
    found = [path.stem for path in PROGRAMS.glob("*.py") if path.stem not in _HELPERS]
    return sorted([*found, *(name + _BY_EVENTS for name in BY_EVENTS)])


def copied_to(folder: Path) -> Path:
    """Copy the programs into a folder, beside ROS 2's test_msgs, which the real rclpy has in a package of its own."""
    shutil.copytree(PROGRAMS, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    for name in BY_EVENTS:
        (folder / f"{name}{_BY_EVENTS}.py").write_text(_by_events(name), encoding="utf-8")
    shutil.copytree(TEST_MSGS, folder / "interfaces" / "test_msgs", dirs_exist_ok=True)
    return folder


def _by_events(name: str) -> str:
    """Return a program that runs this one by an EventsExecutor, with the same first lines."""
    lines = (PROGRAMS / f"{name}.py").read_text(encoding="utf-8").splitlines(keepends=True)
    first = itertools.takewhile(lambda line: line.startswith("# "), lines)
    return "".join(first) + f"import by_events\n\nby_events.run({name!r})\n"


def recording(name: str) -> tuple[str, list[str]]:
    """Return the output of the real rclpy, and the lines that were not the same each time; of a new program nothing."""
    if not (RECORDINGS / f"{name}.txt").exists():
        return "", []
    text, _, unsteady = (RECORDINGS / f"{name}.txt").read_text(encoding="utf-8").partition(_UNSTEADY)
    return text, unsteady.splitlines()


def record(name: str, text: str, unsteady: list[str]) -> None:
    """Keep what the real rclpy printed."""
    foot = _UNSTEADY + "".join(line + "\n" for line in unsteady) if unsteady else ""
    (RECORDINGS / f"{name}.txt").write_text(text + foot, encoding="utf-8")
