"""The plugin for pytest over Zenoh: the same tests run against processes."""

from __future__ import annotations

# pytester forgets what was imported meanwhile, and numpy cannot be imported twice.
import numpy  # noqa: F401
import pytest

import robolink.testing.one_process  # noqa: F401
import robolink.testing.processes  # noqa: F401
import robolink.testing.system  # noqa: F401
from tests.support.plugged import run

pytest_plugins = ["pytester"]


@pytest.mark.processes
def test_the_same_test_runs_against_processes(project: pytest.Pytester) -> None:
    text = """
def test_counts(system):
    node = system.start(Counter, name="teller", namespace="ada", remappings={"count": "/number"})
    assert node.get_fully_qualified_name() == "/ada/teller"
    first = system.expect("number").data
    assert system.expect("number", lambda number: number.data > first + 3)
    assert (system.publishers("number"), system.nodes) == (["/ada/teller"], ["/ada/teller"])
    system.crash(node)
    assert system.nodes == []
    system.restart(node)
    assert system.expect("number").data < 9
    assert system.parameter("ada/teller", "use_sim_time") is False

def test_faults(system):
    system.faults.lose("number", 0.5)

def test_virtual_time(virtual_time):
    virtual_time.run(3600)
"""
    run(project, text).assert_outcomes(passed=3)
    result = run(project, text, "--robolink-transport=zenoh", "-rs")
    result.assert_outcomes(passed=1, skipped=2)
    result.stdout.fnmatch_lines(["SKIPPED *test_it.py:*MessageFault: faults strike in memory alone; run this with*"])
    result.stdout.fnmatch_lines(["SKIPPED *test_it.py:*: real processes have no virtual time*"])


@pytest.mark.processes
def test_processes_that_fail_are_told_and_none_is_left(project: pytest.Pytester) -> None:
    text = """
import os

class Fragile(Counter):
    def on_timer(self):
        super().on_timer()
        if self.count == 5:
            raise ValueError("broken")

class Broken(Counter):
    def __init__(self):
        raise ValueError("no such thing")

def test_breaks(system):
    system.start(Fragile)
    system.run(20.0)

def test_never_begins(system):
    system.start(Broken)

def test_waits_in_vain(system):
    system.start(Counter)
    system.expect("count", lambda count: count.data < 0, within=0.5)
"""
    result = run(project, text, "--robolink-transport=zenoh", "--robolink-seed=3")
    result.assert_outcomes(failed=3)
    result.stdout.fnmatch_lines(
        [
            "*NodeFailure: counter failed at * s: ended with exit code 1: ValueError: broken",
            "*replay: pytest 'test_it.py::test_breaks' --robolink-seed 3 --robolink-transport zenoh",
            "*NodeFailure: *failed at its start: ended with exit code 1: ValueError: no such thing",
            "*messages on /count fulfilled the condition within 0.5 s*",
            "*/count  /counter  data=*",
        ]
    )


@pytest.mark.processes
def test_whoever_cannot_import_rclpys_names_is_told_how(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(test_a="from std_msgs.msg import String", test_b="import rclpy", test_c="import nowhere")
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider", "-p", "no:xdist")
    advice = "`import robolink.compat` first, here or in conftest.py, and std_msgs is robolink's"
    assert advice in result.stdout.str()
    assert result.stdout.str().count("import robolink.compat") == 2
