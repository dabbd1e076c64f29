"""The plugin for pytest: its fixtures, its options, what a failure shows, and that it stays out of others' way."""

from __future__ import annotations

import re
import subprocess
import sys

# pytester forgets what was imported meanwhile, and numpy cannot be imported twice.
import numpy  # noqa: F401
import pytest

import robolink.testing.one_process  # noqa: F401
import robolink.testing.processes  # noqa: F401
import robolink.testing.system  # noqa: F401
from tests.support.plugged import run

pytest_plugins = ["pytester"]

HEAVY = ("zenoh", "numpy", "yaml", "msgspec", "robolink.node", "robolink.context", "robolink.testing.system")


def test_a_test_has_a_system_a_node_and_a_clock(project: pytest.Pytester) -> None:
    text = """
from robolink.interfaces.std_msgs.msg import Int32

def test_counts(system, node, virtual_time):
    heard = []
    node.create_subscription(Int32, "count", heard.append, 10)
    system.start(Counter)
    virtual_time.run(1.05)
    assert [each.data for each in heard] == list(range(1, 11))
    assert virtual_time.now == system.time == 1.05

def test_begins_anew(system):
    assert system.nodes == []
    system.start(Counter)
    assert system.expect("count").data == 1
"""
    run(project, text).assert_outcomes(passed=2)


FAILS = """
def test_fails(system):
    system.start(Counter)
    system.expect("count", lambda count: count.data > 100, within=1.0)
"""


def test_a_failed_expectation_shows_what_came_and_how_to_replay_it(project: pytest.Pytester) -> None:
    result = run(project, FAILS)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        [
            ">   *system.expect(*",
            "E   *none of the 10 messages on /count fulfilled the condition within 1 s (from 0 s to 1 s)",
            "E  *1.000 s  /count  /counter  data=10",
            "E  *replay: pytest 'test_it.py::test_fails' --robolink-seed *",
        ]
    )
    result.stdout.no_fnmatch_line("*testing*expecting.py*def *")


def seed_of(result: pytest.RunResult) -> str:
    found = re.search(r"--robolink-seed (\d+)", result.stdout.str())
    assert found is not None
    return found[1]


@pytest.mark.slow
def test_the_seed_is_the_tests_own_and_the_same_each_time_or_the_one_asked_for(project: pytest.Pytester) -> None:
    assert seed_of(run(project, FAILS)) == seed_of(run(project, FAILS))
    assert seed_of(run(project, FAILS)) != seed_of(run(project, FAILS.replace("fails", "breaks")))
    assert seed_of(run(project, FAILS, "--robolink-seed", "7")) == "7"
    drawn = {seed_of(run(project, FAILS, "--robolink-seed", "random")) for _ in range(3)}
    assert len(drawn) > 1
    result = run(project, FAILS, "--robolink-seed", "often")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines(["*--robolink-seed: invalid whole number up to 4294967295, or 'random' value: 'often'"])


@pytest.mark.processes
def test_a_replay_tells_the_seed_of_hashes_too(project: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONHASHSEED", "5")
    told = "robolink: the order of sets of texts is chance; PYTHONHASHSEED=0 makes it the same"
    result = run(project, FAILS)
    result.stdout.fnmatch_lines(["E  *replay: PYTHONHASHSEED=5 pytest 'test_it.py::test_fails' --robolink-seed *"])
    result.stdout.no_fnmatch_line(told)
    monkeypatch.delenv("PYTHONHASHSEED")
    project.makepyfile(test_it="from counter import Counter\n" + FAILS)
    result = project.runpytest_subprocess("-p", "no:cacheprovider", "-p", "no:xdist")
    result.stdout.fnmatch_lines(["E  *replay: pytest 'test_it.py::test_fails' --robolink-seed *", told])
    project.makepyfile(test_it="def test_of_something_else():\n    assert False\n")
    result = project.runpytest_subprocess("-p", "no:cacheprovider", "-p", "no:xdist")
    result.stdout.no_fnmatch_line(told)


def test_what_replays_a_failure_can_be_pasted_in_any_folder(
    project: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = project.mkdir("robots")
    (folder / "test_it.py").write_text("from counter import Counter\n" + FAILS)
    project.makeini("[pytest]")
    monkeypatch.chdir(folder)
    result = project.runpytest_inprocess("-p", "no:cacheprovider", "-p", "no:xdist", "test_it.py")
    result.stdout.fnmatch_lines(["E  *replay: pytest 'test_it.py::test_fails' --robolink-seed *"])


def test_any_other_failure_has_the_story_and_the_seed_beside_it(project: pytest.Pytester) -> None:
    text = """
def test_fails(system):
    system.start(Counter)
    system.run(0.3)
    assert system.expect("count").data == 5

def test_of_something_else():
    assert False
"""
    result = run(project, text, "--robolink-seed=12")
    result.assert_outcomes(failed=2)
    result.stdout.fnmatch_lines(
        [
            "E  *assert 4 == 5",
            "*- robolink -*",
            "the system after 0.400 s",
            "  0.400 s  /count  /counter  data=4",
            "replay: pytest 'test_it.py::test_fails' --robolink-seed 12",
        ]
    )
    assert result.stdout.str().count("replay:") == 1


def test_a_node_that_breaks_is_shown_where_it_broke(project: pytest.Pytester) -> None:
    text = """
class Fragile(Counter):
    def on_timer(self):
        raise ValueError("broken")

def test_it(system):
    system.start(Fragile)
    system.run(10.0)
"""
    result = run(project, text)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        ["> *raise ValueError(*", "*NodeFailure: counter failed at 0.1 s: ValueError: broken (test_it.py:5)"]
    )


@pytest.mark.slow
def test_the_story_is_told_wherever_a_test_fails(project: pytest.Pytester) -> None:
    text = """
import unittest
import pytest

@pytest.fixture
def counting(system):
    system.start(Counter)
    assert system.expect("count").data == 100

def test_fails_before(counting):
    pass

@pytest.fixture
def counted(system):
    system.start(Counter)
    yield
    assert system.expect("count").data == 100

def test_fails_behind(counted):
    pass

class TestUnit(unittest.TestCase):
    @pytest.fixture(autouse=True)
    def begin(self, system):
        self.system = system

    def test_fails(self):
        self.system.start(Counter)
        self.assertEqual(self.system.expect("count").data, 100)
"""
    result = run(project, text)
    result.assert_outcomes(passed=1, failed=1, errors=2)
    assert result.stdout.str().count("replay: pytest 'test_it.py::") == 3
    assert result.stdout.str().count("0.100 s  /count  /counter  data=1") == 3


def test_what_is_expected_to_fail_is_shown_as_ever(project: pytest.Pytester) -> None:
    text = """
import pytest

@pytest.mark.xfail(reason="known")
def test_it(system):
    system.start(Counter)
    assert system.expect("count").data == 100

def test_skips(system):
    pytest.skip("not today")
"""
    result = run(project, text, "-rxs", "--xfail-tb")
    result.assert_outcomes(xfailed=1, skipped=1)
    result.stdout.fnmatch_lines([">*assert system.expect(*", "E*assert 1 == 100"])
    result.stdout.fnmatch_lines_random(["XFAIL test_it.py::test_it*known", "SKIPPED *test_it.py:*: not today"])


@pytest.mark.slow
def test_a_node_that_breaks_last_breaks_the_test(project: pytest.Pytester) -> None:
    text = """
class Rude(Counter):
    def destroy_node(self):
        super().destroy_node()
        raise ValueError("rude")

def test_it(system):
    system.start(Rude)
    system.stop("counter")
"""
    result = run(project, text)
    result.assert_outcomes(passed=1, errors=1)
    result.stdout.fnmatch_lines(["E *NodeFailure: counter failed at 0 s: ValueError: rude (test_it.py:*)"])


@pytest.mark.slow
def test_a_fault_that_comes_to_nothing_breaks_the_test_unless_that_has_failed(project: pytest.Pytester) -> None:
    text = """
import pytest

def test_misspells(system):
    system.start(Counter)
    system.faults.lose("cuont", 0.5)
    system.run(1.0)

def test_fails(system):
    system.faults.lose("cuont", 0.5)
    system.run(1.0)
    assert False

def test_skips(system):
    system.faults.lose("cuont", 0.5)
    system.run(1.0)
    pytest.skip("not today")
"""
    result = run(project, text)
    result.assert_outcomes(passed=1, errors=1, failed=1, skipped=1)
    result.stdout.fnmatch_lines(["E *ExpectationError: {topic: cuont, loss: 0.5} met nothing: no topic 'cuont' was*"])


@pytest.mark.slow
def test_what_lies_between_the_test_and_its_nodes_is_left_out(project: pytest.Pytester) -> None:
    text = """
class Fragile(Counter):
    def on_timer(self):
        raise ValueError("broken")

def test_breaks(system):
    system.start(Fragile)
    system.run(1.0)

def test_asks(system):
    system.start(Counter)
    system.expect("count", lambda count: count.nothing)

def test_starts(system):
    system.start(3)
"""
    result = run(project, text)
    result.assert_outcomes(failed=3)
    result.stdout.no_fnmatch_line("*robolink?host?*.py:*: in *")
    result.stdout.no_fnmatch_line("*robolink?testing?*.py:*: in *")
    result = run(project, text, "--full-trace")
    result.stdout.fnmatch_lines(["*robolink?host?*.py:*"])


def test_fixtures_of_a_projects_own_go_first(project: pytest.Pytester) -> None:
    project.makeconftest("""
import pytest

@pytest.fixture
def system():
    return "theirs"

@pytest.fixture
def node():
    return "their node"
""")
    result = run(project, "def test_it(system, node):\n    assert (system, node) == ('theirs', 'their node')\n")
    result.assert_outcomes(passed=1)


@pytest.mark.processes
def test_a_test_that_is_interrupted_leaves_nothing(project: pytest.Pytester) -> None:
    text = """
import pathlib

class Polite(Counter):
    def destroy_node(self):
        pathlib.Path("goodbye").touch()
        super().destroy_node()

def test_it(system):
    system.start(Polite)
    system.run(1.0)
    raise KeyboardInterrupt
"""
    project.makepyfile(test_it="from counter import Counter\n" + text)
    result = project.runpytest_subprocess("-p", "no:cacheprovider")
    assert result.ret == pytest.ExitCode.INTERRUPTED
    assert (project.path / "goodbye").exists()


@pytest.mark.processes
def test_nothing_heavy_is_imported_for_those_who_do_not_ask() -> None:
    code = f"import sys, robolink.testing.plugin; print([name for name in {HEAVY} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.strip() == "[]"
